"""Arrays of any shape, layout and precision give what the library gives for each element.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from conftest import some_materials, unit_vectors
from hypothesis import given
from hypothesis import strategies as st

import facet
from facet._library import ffi, lib


def singly_eval(m: facet.Material, wi: np.ndarray, wo: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """f and pdf by the library's functions for one pair of directions, of broadcast arrays."""
    wi, wo = np.broadcast_arrays(wi, wo)
    real, name = ("double", "bsdf64") if wi.dtype == np.float64 else ("float", "bsdf")
    f, p = np.empty(wi.shape, wi.dtype), np.empty(wi.shape[:-1], wi.dtype)
    c = ffi.new(f"{real}[3]")
    for at in np.ndindex(wi.shape[:-1]):
        i, o = ffi.new(f"{real}[3]", wi[at].tolist()), ffi.new(f"{real}[3]", wo[at].tolist())
        getattr(lib, f"facet_{name}_eval")(m._prepared(wi.dtype), i, o, c)
        f[at], p[at] = list(c), getattr(lib, f"facet_{name}_pdf")(m._prepared(wi.dtype), i, o)
    return f, p


def singly_sample(m: facet.Material, wo: np.ndarray, u: np.ndarray) -> list[np.ndarray]:
    wo, u = np.broadcast_arrays(wo, u)
    real, name = ("double", "bsdf64") if wo.dtype == np.float64 else ("float", "bsdf")
    shape = wo.shape[:-1]
    out = [np.empty(wo.shape, wo.dtype), np.empty(shape, wo.dtype), np.empty(wo.shape, wo.dtype),
           np.empty(shape, np.int32), np.empty(shape, wo.dtype)]
    for at in np.ndindex(shape):
        s = getattr(lib, f"facet_{name}_sample")(m._prepared(wo.dtype), ffi.new(f"{real}[3]", wo[at].tolist()),
                                                 ffi.new(f"{real}[3]", u[at].tolist()))
        for k, value in enumerate((list(s.wi), s.pdf, list(s.weight), s.lobe, s.eta)):
            out[k][at] = value
    return out


MATERIALS = some_materials()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("m", MATERIALS, ids=[m.spec for m in MATERIALS])
def test_every_material_gives_the_bits_of_single_calls(m: facet.Material, dtype: type) -> None:
    rng = np.random.default_rng(3)
    wi, wo, u = unit_vectors(rng, 40, dtype), unit_vectors(rng, 40, dtype), rng.random((40, 3), dtype)
    f, p = singly_eval(m, wi, wo)
    assert (f.any() and p.any()) or m.lobes & facet.DELTA
    np.testing.assert_array_equal(m.eval(wi, wo), f)
    np.testing.assert_array_equal(m.pdf(wi, wo), p)
    for both, alone in zip(m.eval_pdf(wi, wo), (f, p)):
        np.testing.assert_array_equal(both, alone)
    drawn = singly_sample(m, wo, u)
    for got, expected in zip(m.sample(wo, u), drawn):
        np.testing.assert_array_equal(got, expected)
    for got, expected in zip(m.sample_lobes(wo, u), drawn):
        np.testing.assert_array_equal(got, expected)


def layouts(shape: tuple[int, ...], dtype: type) -> st.SearchStrategy[np.ndarray]:
    """Writable arrays of this shape with their memory in some order, with gaps, and backwards."""

    @st.composite
    def one(draw: st.DrawFn) -> np.ndarray:
        order = draw(st.permutations(range(len(shape))))
        steps = [draw(st.sampled_from([1, 1, 2, -1, -3])) for _ in shape]
        block = np.zeros([shape[axis] * abs(steps[axis]) for axis in order], dtype)
        return block.transpose(np.argsort(order))[tuple(slice(None, None, s) for s in steps)]

    return one()


@st.composite
def broadcast_pairs(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """Directions whose leading axes broadcast, in any layout."""
    shape = draw(st.lists(st.integers(0, 4), max_size=3))
    shapes = []
    for _ in range(2):
        mine = [n if draw(st.booleans()) else 1 for n in shape]
        shapes.append((*mine[draw(st.integers(0, len(mine))):], 3))
    dtype = draw(st.sampled_from([np.float32, np.float64]))
    rng = np.random.default_rng(draw(st.integers(0, 100)))
    pair = []
    for s in shapes:
        a = draw(layouts(s, dtype))
        a[...] = unit_vectors(rng, int(np.prod(s[:-1])), dtype).reshape(s)
        pair.append(a)
    return pair[0], pair[1]


@given(broadcast_pairs())
def test_shapes_and_layouts_change_nothing(pair: tuple[np.ndarray, np.ndarray]) -> None:
    wi, wo = pair
    m = facet.ggx(alpha=0.4, kd=0.3, ks=(0.9, 0.5, 0.1))
    f, p = singly_eval(m, wi, wo)
    np.testing.assert_array_equal(m.eval(wi, wo), f)
    np.testing.assert_array_equal(m.pdf(wi, wo), p)
    assert m.eval(wi, wo).dtype == wi.dtype
    u = np.abs(wi) * 0.999
    for got, expected in zip(m.sample(wo, u), singly_sample(m, wo, u)):
        np.testing.assert_array_equal(got, expected)
    np.testing.assert_array_equal(m.G1(wo), np.vectorize(lambda *v: m.G1(np.array(v, wo.dtype)), otypes=[wo.dtype])(
        wo[..., 0], wo[..., 1], wo[..., 2]))


@given(st.data(), st.sampled_from([1, 127, 128, 129, 255, 256, 257, 500, 1500]))
def test_blocks_meet_without_a_seam(data: st.DataObject, n: int) -> None:
    """More elements than a block of the loops, in shapes whose inner axes end inside blocks."""
    rng = np.random.default_rng(n)
    inner = data.draw(st.sampled_from([k for k in (1, 2, 3, 7, 100, 500) if n % k == 0]))
    wi, wo = (unit_vectors(rng, n).reshape(n // inner, inner, 3) for _ in range(2))
    out = data.draw(layouts((n // inner, inner, 3), np.float32))
    gapped = data.draw(layouts((n // inner, inner, 3), np.float32))
    gapped[...] = wo
    m = facet.ggx(alpha=0.4)
    got = m.eval(wi, gapped, out=out)
    assert got is out
    singles = np.concatenate([m.eval(wi[k:k + 1], wo[k:k + 1]) for k in range(n // inner)])
    np.testing.assert_array_equal(out, singles)
    u = rng.random((n // inner, inner, 3), np.float32)
    weights = np.concatenate([m.sample(wo[k:k + 1], u[k:k + 1]).weight for k in range(n // inner)])
    np.testing.assert_array_equal(m.sample(gapped, u).weight, weights)


@pytest.mark.parametrize("check_inputs", [True, False])
@pytest.mark.parametrize("n", [1, 511, 512, 513, 2047, 2048, 2049, 5000])
def test_columns_meet_without_a_seam(n: int, check_inputs: bool) -> None:
    """Their blocks are larger than those of rows, or all of them are one."""
    rng = np.random.default_rng(n)
    wi, wo = unit_vectors(rng, n, above=True), unit_vectors(rng, n, above=True)
    u, m = rng.random((n, 3), np.float32), facet.ggx(alpha=0.4)
    u[::1000, 1] = -0.0  # a number in [0, 1)
    i, o, x = (np.asfortranarray(a) for a in (wi, wo, u))
    drawn = m.sample(o, x, check_inputs=check_inputs)
    assert drawn.weight.flags.f_contiguous
    for got, expected in zip(drawn, m.sample(wo, u)):
        np.testing.assert_array_equal(got, expected)
    for got, expected in zip(m.eval_pdf(i, o, check_inputs=check_inputs), m.eval_pdf(wi, wo)):
        np.testing.assert_array_equal(got, expected)
    np.testing.assert_array_equal(m.eval(i, o, check_inputs=check_inputs), m.eval(wi, wo))
    np.testing.assert_array_equal(m.pdf(i, o, check_inputs=check_inputs), m.pdf(wi, wo))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("n", [1, 128, 256, 257, 1000])
def test_one_direction_goes_with_many(n: int, dtype: type) -> None:
    rng = np.random.default_rng(n)
    many, one = unit_vectors(rng, n, dtype, above=True), unit_vectors(rng, 1, dtype, above=True)[0]
    copies, u = np.tile(one, (n, 1)), rng.random((n, 3), dtype)
    m = facet.ggx(alpha=0.4)
    for got, expected in ((m.eval(many, one), m.eval(many, copies)), (m.pdf(one, many), m.pdf(copies, many)),
                          (m.sample(one, u).wi, m.sample(copies, u).wi)):
        assert got.any()
        np.testing.assert_array_equal(got, expected)


def test_an_output_that_is_one_number_holds_the_last() -> None:
    rng = np.random.default_rng(4)
    wi, wo = unit_vectors(rng, 300, above=True), unit_vectors(rng, 300, above=True)
    m, out = facet.ggx(), np.lib.stride_tricks.as_strided(np.zeros(1, np.float32), (300,), (0,))
    assert m.pdf(wi, wo, out=out)[0] == m.pdf(wi, wo)[-1]


@pytest.mark.parametrize("place", [0, 127, 128, 300, 2048, 2499])
@pytest.mark.parametrize("lay", [np.ascontiguousarray, np.asfortranarray, lambda a: np.repeat(a, 2, axis=0)[::2]])
def test_a_fault_is_found_in_any_block(lay: Callable[[np.ndarray], np.ndarray], place: int) -> None:
    good = unit_vectors(np.random.default_rng(place), 2500)
    bad = good.copy()
    bad[place:, 1] += 0.5
    bad, m = lay(bad), facet.lambert()
    for call in (lambda: m.eval(bad, good), lambda: m.pdf(bad, good), lambda: m.eval_pdf(bad, [0, 0, 1])):
        with pytest.raises(ValueError, match=rf"wi\[{place}\] is "):
            call()
    u = np.full((2500, 3), 0.5, np.float32)
    for wrong in (1, -0.5, np.nan):
        u[place, 2] = wrong
        with pytest.raises(ValueError, match=rf"u\[{place}\] is "):
            m.sample(lay(good), lay(u))


def test_a_fault_is_named_where_it_is() -> None:
    m = facet.lambert()
    wi = np.zeros((700, 3), np.float32)
    wi[:, 2] = 1
    wi[613] = 0, 0, 2
    with pytest.raises(ValueError, match=r"wi\[613\] is \(0.0, 0.0, 2.0\), of length 2; give unit vectors"):
        m.eval(wi, [0, 0, 1])
    with pytest.raises(ValueError, match=r"wo\[613, 1\] is \(0.0, 0.0, 2.0\)"):
        m.eval([0, 0, 1], np.stack([np.roll(wi, 1, axis=0), wi], axis=1))
    with pytest.raises(ValueError, match=r"wo is \(nan, 0.0, 1.0\)"):
        m.pdf([0, 0, 1], [np.nan, 0, 1])
    with pytest.raises(ValueError, match=r"u\[1\] is \(0.0, 1.0, 0.0\); give numbers in \[0, 1\)"):
        m.sample([0, 0, 1], [[0, 0, 0], [0, 1, 0]])
    with pytest.raises(ValueError, match=r"v is \(0.0, 0.0, 0.5\)"):
        facet.ggx().G1([0, 0, 0.5])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("m", MATERIALS, ids=[m.spec for m in MATERIALS])
def test_no_number_does_harm(m: facet.Material, dtype: type) -> None:
    """Float loops look at directions after they have used them."""
    up, half = np.array([0, 0, 1], dtype), np.full(3, 0.5, dtype)
    wrong = np.tile(up, (70, 1))
    numbers = (np.nan, np.inf, -np.inf, 3e38, -3e38, 1e-45, -2, 7)
    for k, number in enumerate(numbers):
        wrong[7 * k + 5, k % 3] = number
    for bad in (wrong, wrong[:, ::-1], np.asfortranarray(wrong)):
        for call in (lambda: m.eval(bad, up), lambda: m.pdf(up, bad), lambda: m.eval_pdf(bad, bad),
                     lambda: m.sample(bad, half), lambda: m.sample_lobes(bad, half), lambda: m.G1(bad)):
            with pytest.raises(ValueError, match="unit vectors"):
                call()
        for call in (lambda: m.sample(up, bad), lambda: m.sample_lobes(up, bad)):
            with pytest.raises(ValueError, match="numbers in"):
                call()


@pytest.mark.parametrize("m", MATERIALS, ids=[m.spec for m in MATERIALS])
def test_no_number_does_harm_unchecked(m: facet.Material) -> None:
    """What is wrong gives numbers without meaning, and leaves its neighbours alone; float64 is checked all the same."""
    rng = np.random.default_rng(8)
    good, u = unit_vectors(rng, 72, above=True), rng.random((72, 3), np.float32)
    wrong, is_wrong = good.copy(), np.zeros(72, bool)
    for k, number in enumerate((np.nan, np.inf, -np.inf, 3e38, -3e38, 1e-45, -2, 7)):
        wrong[9 * k + 5, k % 3], is_wrong[9 * k + 5] = number, True
    for lay in (np.ascontiguousarray, np.asfortranarray, lambda a: np.repeat(a, 2, axis=0)[::2]):
        bad, fine, x = lay(wrong), lay(good), lay(u)
        for got, expected in ((m.eval(bad, fine, check_inputs=False), m.eval(good, good)),
                              (m.pdf(fine, bad, check_inputs=False), m.pdf(good, good)),
                              (m.eval_pdf(bad, bad, check_inputs=False)[0], m.eval(good, good)),
                              (m.sample(bad, x, check_inputs=False).wi, m.sample(good, u).wi),
                              (m.sample(fine, np.abs(bad), check_inputs=False).wi, m.sample(good, np.abs(good)).wi)):
            np.testing.assert_array_equal(got[~is_wrong], expected[~is_wrong])
    for call in (m.eval, m.pdf, m.eval_pdf, m.sample):
        with pytest.raises(ValueError, match=r"\[5\] is \(nan"):
            call(wrong.astype(float), good, check_inputs=False)


@pytest.mark.parametrize("excess, is_unit", [(4e-5, True), (6e-5, False), (-4e-5, True), (-6e-5, False), (-1, False)])
def test_directions_may_be_rounded(excess: float, is_unit: bool) -> None:
    """|w|^2 = 1 within 1e-4, thus |w| = 1 within 5e-5."""
    wi = np.array([0, 0, 1 + excess])
    if is_unit:
        assert facet.lambert().eval(wi, [0, 0, 1])[0] > 0
    else:
        with pytest.raises(ValueError, match="unit vectors"):
            facet.lambert().eval(wi, [0, 0, 1])


def test_shapes_that_do_not_fit_are_refused() -> None:
    m, n = facet.ggx(), [0, 0, 1]
    with pytest.raises(ValueError, match=r"wi: shape \(2,\); the last axis must hold x, y, z"):
        m.eval([0, 1], n)
    with pytest.raises(ValueError, match=r"wi \(2, 3\) and wo \(3, 3\) do not broadcast"):
        m.eval(np.tile(n, (2, 1)), np.tile(n, (3, 1)))
    with pytest.raises(ValueError, match=r"wo: shape \(\)"):
        m.pdf(n, 1.0)
    with pytest.raises(TypeError, match="wi: an array of complex128; give real numbers"):
        m.eval(np.array([0, 0, 1j]), n)
    with pytest.raises(TypeError, match="wi: an array of <U"):
        m.eval("up", n)


def test_out_is_refused_where_it_cannot_be_filled() -> None:
    m, n = facet.ggx(), np.array([[0, 0, 1]], np.float32)
    for out, why in [(np.empty((1, 3)), "the result is float32"), (np.empty((3,), np.float32), r"of shape \(1, 3\)"),
                     (n, "shares memory"), (np.broadcast_to(np.float32(1), (1, 3)), "cannot be written")]:
        with pytest.raises(ValueError, match=why):
            m.eval(n, n, out=out)
    with pytest.raises(TypeError, match="out: a list"):
        m.eval(n, n, out=[0, 0, 0])  # type: ignore[arg-type]


def test_samples_are_drawn_into_arrays_that_are_there() -> None:
    m, rng = facet.ggx(alpha=0.2), np.random.default_rng(2)
    wo, u, v = unit_vectors(rng, 30, above=True), rng.random((30, 3), np.float32), rng.random((30, 3), np.float32)
    first = m.sample(wo, u)
    kept = [a.copy() for a in first]
    assert m.sample(wo, v, out=first) is first
    for got, expected, old in zip(first, m.sample(wo, v), kept):
        np.testing.assert_array_equal(got, expected)
        assert not np.array_equal(got, old)
    with pytest.raises(ValueError, match="the result is float32 of shape"):
        m.sample(wo[:3], u[:3], out=first)


def test_values_and_densities_fill_arrays_that_are_there() -> None:
    m, rng = facet.ggx(alpha=0.2), np.random.default_rng(2)
    wi, wo = unit_vectors(rng, 30, above=True), unit_vectors(rng, 30, above=True)
    pair = m.eval_pdf(wo, wo)
    assert m.eval_pdf(wi, wo, out=pair) is pair
    for got, expected in zip(pair, m.eval_pdf(wi, wo)):
        np.testing.assert_array_equal(got, expected)
    with pytest.raises(ValueError, match="shares memory"):
        m.eval_pdf(wi, wo, out=(pair[0], pair[0][:, 0]))
    with pytest.raises(ValueError, match="the result is float32 of shape"):
        m.eval_pdf(wi[:3], wo[:3], out=pair)


def test_precision_is_that_of_the_arrays() -> None:
    m = facet.ggx()
    single, double = np.array([0, 0, 1], np.float32), np.array([0, 0, 1.0])
    assert m.eval([0, 0, 1.0], (0, 0, 1)).dtype == np.float32
    assert m.eval(single, [0, 0, 1.0]).dtype == np.float32
    assert m.eval(single, double).dtype == np.float64
    assert m.eval(np.array([0, 0, 1]), single.astype(np.float16)).dtype == np.float32
    assert m.pdf(double, single).dtype == np.float64
    assert m.D(double).dtype == np.float64
    assert [a.dtype for a in m.sample_lobes(double, single * 0)] == [np.float64] * 3 + [np.int32, np.float64]
    # Double precision is the double kernels', not widened floats.
    wi, wo = facet.direction(np.float64(0.3)), facet.direction(np.float64(0.2))
    f = m.eval(wi, wo)[0]
    assert f != np.float32(f) and abs(m.eval(wi.astype(np.float32), wo.astype(np.float32))[0] - f) < 1e-5 * f


def test_results_are_laid_out_as_inputs_are() -> None:
    """All x, then all y: results too, so that the next call copies nothing either."""
    rng = np.random.default_rng(1)
    rows = unit_vectors(rng, 100)
    columns = np.asfortranarray(rows)
    m = facet.ggx()
    assert m.eval(rows, rows).flags.c_contiguous
    assert m.eval(columns, columns).T.flags.c_contiguous
    assert m.eval(columns, [0, 0, 1]).T.flags.c_contiguous
    assert m.sample(columns, np.asfortranarray(np.abs(rows) * 0.9)).wi.T.flags.c_contiguous
    assert m.eval(columns, rows).flags.c_contiguous


def test_nothing_is_no_error() -> None:
    m, none = facet.gtr(), np.empty((0, 3), np.float32)
    assert m.eval(none, none).shape == (0, 3) and m.pdf(none, [0, 0, 1]).shape == (0,)
    assert m.sample(none, none).weight.shape == (0, 3) and m.Lambda(none).shape == (0,)
    assert m.albedo([]).shape == (0, 3)


def test_structs_have_the_compilers_size() -> None:
    """The library writes struct_size = sizeof as the compiler has it."""
    c = ffi.new("facet_material *")
    assert lib.facet_material_defaults(b"ggx", c, ffi.NULL) == lib.FACET_OK
    assert c.struct_size == ffi.sizeof("facet_material")


def test_threads_evaluate_side_by_side() -> None:
    from concurrent.futures import ThreadPoolExecutor
    rng = np.random.default_rng(5)
    wi, wo = unit_vectors(rng, 20000), unit_vectors(rng, 20000)
    m = facet.gtr(alpha=0.2, gamma=1.4)
    alone = m.eval(wi, wo)
    with ThreadPoolExecutor(4) as pool:
        for f in pool.map(lambda _: m.eval(wi, wo), range(8)):
            np.testing.assert_array_equal(f, alone)
