"""A material: a model and the values of its parameters, prepared for evaluation.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Union

import numpy as np

from ._arrays import (DOUBLE, Array, ArrayLike, as_reals, as_triples, check_out, common_shape, direction, fill_view,
                      loop_of, new_triples, precision, run, view)
from ._library import check, fail, ffi, lib, text

Value = Union[float, str, "tuple[float, float, float]"]


class Sample(NamedTuple):
    """Directions drawn for given views; all leading axes are those of wo and u, broadcast."""

    wi: Array
    """The directions, shape (..., 3); (0, 0, 0) where there is no sample."""
    pdf: Array
    """Their density [1/sr], shape (...); 0: there is no sample.  Of a delta lobe, its probability [1]."""
    weight: Array
    """f |cos theta_i| / pdf, shape (..., 3)."""


class LobeSample(NamedTuple):
    """A Sample that tells which lobe each direction came from."""

    wi: Array
    pdf: Array
    weight: Array
    lobe: Array
    """Lobe bits, int32, shape (...)."""
    eta: Array
    """Index of refraction on wi's side over that on wo's; 1 unless the sample refracts.  Shape (...)."""


class Material:
    """A reflection model with values for its parameters; it does not change.

    Directions are unit vectors in the last axis of an array, (..., 3), in the local frame whose normal is (0, 0, 1), and
    point away from the surface: wi to the light, wo to the viewer.  Leading axes broadcast.  Results are float64 if an
    array that was given is, and float32 otherwise; both come from the library's own kernels of that precision.

    >>> import facet
    >>> m = facet.material("ggx alpha=.3 ks=.9,.7,.3")
    >>> m.eval(wi=[0, .6, .8], wo=[0, -.6, .8])
    array([0.9704913 , 0.75490326, 0.32372713], dtype=float32)
    """

    __slots__ = ("_c", "_bsdf", "_bsdf64")

    def __init__(self, spec: str) -> None:
        """Parses a specification such as "ggx alpha=.3 ks=.9,.7,.3"."""
        c, why = ffi.new("facet_material *"), ffi.new("facet_error *")
        if not isinstance(spec, str):
            raise TypeError(f"spec: {spec!r} is not a text such as 'ggx alpha=.3'")
        encoded = spec.encode()
        if b"\0" in encoded:
            raise ValueError("a specification has no zero bytes")
        check(lib.facet_material_parse(encoded, c, why), why)
        self._prepare(c)

    @classmethod
    def _of_values(cls, model: str, values: Mapping[str, Any], given: Any = None) -> Material:
        c, why = ffi.new("facet_material *"), ffi.new("facet_error *")
        check(lib.facet_material_defaults(model.encode(), c, why), why)
        for name, value in values.items():
            _set(c, name, value)
        made = cls.__new__(cls)
        made._prepare(c)
        return made

    def _prepare(self, c: Any) -> None:
        why = ffi.new("facet_error *")
        self._c = c
        self._bsdf = ffi.new("facet_bsdf *")
        self._bsdf64: Any = None
        check(lib.facet_bsdf_prepare(c, self._bsdf, why), why)

    def _prepared(self, dtype: np.dtype[Any]) -> Any:
        if dtype != DOUBLE:
            return self._bsdf
        if self._bsdf64 is None:
            why, bsdf64 = ffi.new("facet_error *"), ffi.new("facet_bsdf64 *")
            check(lib.facet_bsdf64_prepare(self._c, bsdf64, why), why)
            self._bsdf64 = bsdf64
        return self._bsdf64

    # ---- What it is ----------------------------------------------------------------------------------------

    @property
    def model(self) -> str:
        """The model's name: "ggx"."""
        return text(lib.facet_model_get(self._c.model).name)

    @property
    def values(self) -> dict[str, Value]:
        """The value of every parameter, given or default."""
        return {name: value for name, value, _ in self._rows()}

    @property
    def given(self) -> dict[str, Value]:
        """The values that were given."""
        return {name: value for name, value, is_given in self._rows() if is_given}

    def __getitem__(self, name: str) -> Value:
        """The value of one parameter: m["alpha"]."""
        return self.values[name]

    def _rows(self) -> list[tuple[str, Value, bool]]:
        info, rows = lib.facet_model_get(self._c.model), []
        for i in range(info.n_parameters):
            p, three = info.parameters[i], self._c.values[i]
            value: Value = three[0]
            if p.kind == lib.FACET_COLOUR:
                value = (three[0], three[1], three[2])
            elif p.kind == lib.FACET_CHOICE:
                value = text(p.choices).split("|")[int(three[0])]
            rows.append((text(p.name), value, bool(self._c.given >> i & 1)))
        return rows

    @property
    def spec(self) -> str:
        """The specification: `facet.material(m.spec)` is the same material."""
        return " ".join([self.model] + [f"{name}={_value_text(value)}" for name, value in self.given.items()])

    def replace(self, **values: Any) -> Material:
        """The same material but for these parameters.

        >>> import facet
        >>> facet.ggx(alpha=.3, ks=.9).replace(alpha=.1)
        facet.material('ggx alpha=0.1 ks=0.9')
        """
        return Material._of_values(self.model, {**self.given, **values})

    @property
    def lobes(self) -> int:
        """All the bits that samples of this material can have: facet.REFLECTION | facet.GLOSSY, ..."""
        return int(lib.facet_bsdf_lobes(self._bsdf))

    def __repr__(self) -> str:
        return f"facet.material({self.spec!r})"

    def __eq__(self, other: object) -> bool:
        return self.spec == other.spec if isinstance(other, Material) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.spec)

    def __reduce__(self) -> Any:
        return Material, (self.spec,)

    def _repr_svg_(self) -> str:
        from ._lobe_svg import lobe_svg
        return lobe_svg(self)

    # ---- Evaluation ----------------------------------------------------------------------------------------

    def eval(self, wi: ArrayLike, wo: ArrayLike, *, out: Array | None = None, check_inputs: bool = True) -> Array:
        """f(wi, wo) |cos theta_i| as red, green, blue [1/sr]: shape (..., 3).

        0 where nothing is scattered, as below the horizon.  `out`, if given, is filled and returned.  Directions that are
        not of length 1 raise ValueError.  With check_inputs=False, float32 is taken as it is, which saves up to half of
        the time: what has another length then gives numbers without meaning, but no error.  float64 is always checked.
        """
        dtype, shape, i, o = _pair(wi, wo)
        f = new_triples(shape, dtype, (i, o)) if out is None else check_out(out, (*shape, 3), dtype, (i, o))
        self._evaluate(dtype, shape, i, o, f, None, check_inputs)
        return f

    def pdf(self, wi: ArrayLike, wo: ArrayLike, *, out: Array | None = None, check_inputs: bool = True) -> Array:
        """The density with which `sample` draws wi for this wo, per solid angle of wi [1/sr]: shape (...).

        `out` and `check_inputs` as for eval.
        """
        dtype, shape, i, o = _pair(wi, wo)
        p = np.empty(shape, dtype) if out is None else check_out(out, shape, dtype, (i, o))
        self._evaluate(dtype, shape, i, o, None, p, check_inputs)
        return p[()] if out is None else p

    def eval_pdf(self, wi: ArrayLike, wo: ArrayLike, *,
                 out: tuple[Array, Array] | None = None, check_inputs: bool = True) -> tuple[Array, Array]:
        """eval and pdf at once, for less than the two, with the same bits: shapes (..., 3) and (...) [1/sr].

        `out`, the result of an earlier call of the same shape, is filled and returned; `check_inputs` as for eval.
        """
        dtype, shape, i, o = _pair(wi, wo)
        if out is None:
            f, p = new_triples(shape, dtype, (i, o)), np.empty(shape, dtype)
        else:
            f = check_out(out[0], (*shape, 3), dtype, (i, o))
            p = check_out(out[1], shape, dtype, (i, o, f))
        self._evaluate(dtype, shape, i, o, f, p, check_inputs)
        return (f, p[()]) if out is None else out

    def _evaluate(self, dtype: np.dtype[Any], shape: tuple[int, ...], wi: Array, wo: Array, f: Array | None,
                  pdf: Array | None, check_inputs: bool) -> None:
        run(loop_of("eval", dtype), self._prepared(dtype), shape, ("wi", "wo"),
            (view(wi, shape, 3), view(wo, shape, 3), view(f, shape, 3), view(pdf, shape, 1)),
            check_inputs or dtype == DOUBLE)

    def sample(self, wo: ArrayLike, u: ArrayLike, *, out: Sample | None = None, check_inputs: bool = True) -> Sample:
        """Draws wi for wo, shape (..., 3), from numbers u in [0, 1), shape (..., 3), that are drawn by the caller.

        u[..., 0] and u[..., 1] place the direction, u[..., 2] picks the lobe.  `out`, the result of an earlier call of the
        same shape, is filled and returned.  `check_inputs` as for eval; u is checked, too.

        >>> import numpy as np, facet
        >>> s = facet.ggx(alpha=.3).sample([0, .6, .8], np.random.default_rng(1).random((1000, 3), np.float32))
        >>> s.wi.shape, s.pdf.shape, s.weight.shape
        ((1000, 3), (1000,), (1000, 3))
        """
        wi, p, weight, _, _ = self._draw(wo, u, False, out, check_inputs)
        return Sample(wi, p[()], weight) if out is None else out

    def sample_lobes(self, wo: ArrayLike, u: ArrayLike) -> LobeSample:
        """The same draws, with the lobe of each and the ratio of indices where it refracts; not in batches, thus slower."""
        wi, p, weight, lobe, eta = self._draw(wo, u, True)
        return LobeSample(wi, p[()], weight, lobe[()], eta[()])

    def _draw(self, wo: ArrayLike, u: ArrayLike, has_lobes: bool,
              out: Sample | None = None, check_inputs: bool = True) -> tuple[Array, Array, Array, Array, Array]:
        dtype = precision(wo, u)
        o, x = as_triples(wo, dtype, "wo"), as_triples(u, dtype, "u")
        shape = common_shape(("wo", o), ("u", x))
        if out is None:
            wi, weight = new_triples(shape, dtype, (o, x)), new_triples(shape, dtype, (o, x))
            p = np.empty(shape, dtype)
        else:
            wi, weight = (check_out(a, (*shape, 3), dtype, (o, x)) for a in (out.wi, out.weight))
            p = check_out(out.pdf, shape, dtype, (o, x, wi, weight))
        n = shape if has_lobes else (0,)
        lobe, eta = np.empty(n, np.int32), np.empty(n, dtype)
        c = ffi.new("facet_python_samples *")
        fill_view(c.wi, wi, shape, 3)
        fill_view(c.pdf, p, shape, 1)
        fill_view(c.weight, weight, shape, 3)
        if has_lobes:
            fill_view(c.lobe, lobe, shape, 1)
            fill_view(c.eta, eta, shape, 1)
        run(loop_of("sample", dtype), self._prepared(dtype), shape, ("wo", "u"),
            (view(o, shape, 3), view(x, shape, 3), c), check_inputs or dtype == DOUBLE)
        return wi, p, weight, lobe, eta

    # ---- The distribution of normals ---------------------------------------------------------------------

    def D(self, m: ArrayLike) -> Array:
        """The density of microfacet normals at the unit vectors m [1/sr]: shape (...).  0 without a distribution."""
        return self._term(m, 0)

    def Lambda(self, v: ArrayLike) -> Array:
        """Smith's Lambda of the directions v: shape (...)."""
        return self._term(v, 1)

    def G1(self, v: ArrayLike) -> Array:
        """Smith's masking 1/(1 + Lambda(v)): shape (...)."""
        return self._term(v, 2)

    def _term(self, m: ArrayLike, which: int) -> Array:
        dtype = precision(m)
        v = as_triples(m, dtype, "m" if which == 0 else "v")
        shape = v.shape[:-1]
        out = np.empty(shape, dtype)
        run(loop_of("terms", dtype), self._prepared(dtype), shape, ("m" if which == 0 else "v",),
            (view(v, shape, 3), *(view(out if k == which else None, shape, 1) for k in range(3))))
        result: Array = out[()]
        return result

    # ---- Integrals -----------------------------------------------------------------------------------------

    def albedo(self, cos: ArrayLike = 1.0, phi: ArrayLike = 0.0) -> Array:
        """The directional albedo: the share of light from all around that is reflected to the view, float64, (..., 3).

        cos is that of the angle between the view and the normal, in [-1, 1], negative for a view from inside; phi is the
        view's azimuth [rad].  Both broadcast.  Within 1e-6; 1 to 30 ms each, up to 200 ms under total reflection.
        """
        return self._albedo(cos, phi)[0]

    def transmitted(self, cos: ArrayLike = 1.0, phi: ArrayLike = 0.0) -> Array:
        """The share that comes through the surface, with the factor (n_o/n_i)^2 of radiance; as albedo."""
        return self._albedo(cos, phi)[1]

    def _albedo(self, cos: ArrayLike, phi: ArrayLike) -> tuple[Array, Array]:
        c, p = np.broadcast_arrays(as_reals(cos, DOUBLE, "cos"), as_reals(phi, DOUBLE, "phi"))
        if not (np.abs(c) <= 1).all() or not np.isfinite(p).all():
            raise ValueError("cos: a cosine is in [-1, 1], and phi is finite")
        views = direction(np.arccos(c), p).reshape(-1, 3)
        reflected, through = np.empty((len(views), 3)), np.empty((len(views), 3))
        bsdf, wo, r, t = self._prepared(DOUBLE), *(ffi.new("double[3]") for _ in range(3))
        for k, v in enumerate(views):
            wo[0:3] = v.tolist()
            check(lib.facet_bsdf64_albedo(bsdf, wo, r, t, ffi.NULL))
            reflected[k], through[k] = list(r), list(t)
        return reflected.reshape(*c.shape, 3), through.reshape(*c.shape, 3)

    def average_albedo(self, *, is_inside: bool = False) -> Array:
        """The share of perfectly diffuse light that is reflected, float64, shape (3,): 0.1 s, anisotropic ones seconds."""
        r, t = ffi.new("double[3]"), ffi.new("double[3]")
        check(lib.facet_bsdf64_average_albedo(self._prepared(DOUBLE), is_inside, r, t, ffi.NULL))
        return np.array(list(r))


def material(spec: str) -> Material:
    """A material from its text form, as on the command line: "MODEL key=value key=r,g,b ...".

    ValueError names the key that is wrong, and its range.
    """
    return Material(spec)


def _pair(wi: ArrayLike, wo: ArrayLike) -> tuple[np.dtype[Any], tuple[int, ...], Array, Array]:
    dtype = precision(wi, wo)
    i, o = as_triples(wi, dtype, "wi"), as_triples(wo, dtype, "wo")
    return dtype, common_shape(("wi", i), ("wo", o)), i, o


def _value_text(value: Value) -> str:
    if isinstance(value, tuple):
        same = len(set(value)) == 1
        return _value_text(value[0]) if same else ",".join(_value_text(x) for x in value)
    return value if isinstance(value, str) else f"{value:.17g}" if float(f"{value:.9g}") != value else f"{value:.9g}"


def _set(c: Any, name: str, value: Any) -> None:
    """One parameter of a facet_material from a Python value."""
    info, why = lib.facet_model_get(c.model), ffi.new("facet_error *")
    names = [text(info.parameters[i].name) for i in range(info.n_parameters)]
    if name in names and info.parameters[names.index(name)].kind == lib.FACET_CHOICE:
        choices = text(info.parameters[names.index(name)].choices).split("|")
        if not isinstance(value, str):
            raise TypeError(f"{name}: {value!r} is not a text; give one of {'|'.join(choices)}")
        if value not in choices:
            fail(lib.FACET_BAD_VALUE, name, f"'{value}' is not a choice; give one of {'|'.join(choices)}")
        value = choices.index(value)
    elif name in names and isinstance(value, str):
        raise TypeError(f"{name}: '{value}' is a text; give a number")
    try:
        if value is None:
            raise TypeError
        numbers = [float(x) for x in np.atleast_1d(np.asarray(value, dtype=np.float64))]
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {value!r} is neither a number nor red, green and blue") from None
    check(lib.facet_material_set(c, name.encode(), ffi.new("double[]", numbers), len(numbers), why), why)
