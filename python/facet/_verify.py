"""facet.verify: whether a BRDF written in Python is what every BRDF must be.

The checks and their tolerances are those of `facet verify` (docs/verification.md): each holds a function against another
one, or against a number that is known.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Callable, Protocol

import numpy as np

from ._arrays import Array, direction
from ._chi_square import chi_square
from ._library import lib
from ._material import Material
from ._quadrature import Integral, coordinates, integrate, over_light, S_MOST, towards

Evaluation = Callable[[Array, Array], Any]
Sampler = Callable[[Array, Array], Sequence[Any]]


class HasEval(Protocol):
    """Anything with eval(wi, wo), and perhaps pdf(wi, wo) and sample(wo, u)."""

    def eval(self, wi: Array, wo: Array) -> Any: ...


# Of integrals; the tolerances below leave ten times that, or more.
_PART = 1e-5
_COSINES = (0.9, 0.7, 0.45, 0.2, 0.04)
# Ends of chi-square tests by chance in one run of 100.
_LEVEL = 0.01


@dataclass(frozen=True)
class Check:
    """What one check found."""

    name: str
    passed: bool | None
    """None: left out, and `found` says why."""
    worst: float
    """The largest deviation over all views; for chi-square, the least p."""
    tolerance: float
    """What is allowed; for chi-square, the p below which it fails."""
    found: str
    """In words."""
    wo: tuple[float, float, float] | None = None
    """Where."""
    wi: tuple[float, float, float] | None = None

    @property
    def verdict(self) -> str:
        return "left out" if self.passed is None else "ok" if self.passed else "FAILS"


@dataclass(frozen=True)
class Verification:
    """All that facet.verify found: true if no check failed; prints as a table."""

    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return all(c.passed is not False for c in self.checks)

    @property
    def failures(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return tuple(c for c in self.checks if c.passed is False)

    def __bool__(self) -> bool:
        return self.passed

    def __getitem__(self, name: str) -> Check:
        """A check by name: verification["furnace"]."""
        for c in self.checks:
            if c.name == name:
                return c
        raise KeyError(name)

    def raise_if_failed(self) -> None:
        """AssertionError with the table, for use in tests."""
        if not self.passed:
            raise AssertionError(f"the BRDF is not right:\n{self}")

    def __str__(self) -> str:
        rows = [f"{c.name:18}{c.verdict:10}{c.found}{_place(c)}" for c in self.checks]
        n = len(self.failures)
        return "\n".join([*rows, f"{n} check{'s' if n > 1 else ''} fail{'' if n > 1 else 's'}" if n else "all checks hold"])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        colour = {"ok": "#2a7", "FAILS": "#c33", "left out": "#888"}
        rows = "".join(f"<tr><td>{c.name}</td><td style='color:{colour[c.verdict]}'>{c.verdict}</td>"
                       f"<td>{html.escape(c.found + _place(c))}</td></tr>" for c in self.checks)
        return f"<table>{rows}</table>"


def _place(c: Check) -> str:
    def words(name: str, w: tuple[float, float, float] | None) -> str:
        return f", {name} = ({w[0]:.4g}, {w[1]:.4g}, {w[2]:.4g})" if w else ""

    return words("wo", c.wo) + words("wi", c.wi) if c.passed is False else ""


def _triple(w: Array) -> tuple[float, float, float]:
    return float(w[0]), float(w[1]), float(w[2])


class _Subject:
    """The functions of what is verified, with their results checked for shape."""

    def __init__(self, f: Any, pdf: Evaluation | None, sample: Sampler | None, has_cosine: bool) -> None:
        if not callable(f):
            if not hasattr(f, "eval"):
                raise TypeError(f"verify: a {type(f).__name__} has no eval; give f(wi, wo), or something that has")
            if isinstance(f, Material) and f.lobes & (lib.FACET_TRANSMISSION | lib.FACET_DELTA):
                raise NotImplementedError(f"{f.model} transmits or mirrors: `facet verify '{f.spec}'` looks at such models")
            pdf, sample, f = pdf or getattr(f, "pdf", None), sample or getattr(f, "sample", None), f.eval
        if (pdf is None) != (sample is None):
            raise TypeError("verify: pdf and sample go together: give both, or none")
        self._f, self._pdf, self._sample, self._has_cosine = f, pdf, sample, has_cosine
        self.has_sampler = pdf is not None

    @staticmethod
    def _call(name: str, f: Any, *inputs: Array) -> Any:
        return f(*inputs) if f is not None else None

    def eval(self, wi: Array, wo: Array) -> Array:
        """f |cos theta_i|, (n, 1) or (n, 3)."""
        wo = np.broadcast_to(wo, wi.shape)
        value = np.asarray(self._f(wi, wo), dtype=np.float64)
        if value.shape not in ((len(wi),), (len(wi), 1), (len(wi), 3)):
            raise ValueError(f"f: of {len(wi)} directions, an array of shape {value.shape}; give ({len(wi)},) or "
                             f"({len(wi)}, 3): f is called with arrays of directions, (n, 3)")
        value = value.reshape(len(wi), -1)
        return value if self._has_cosine else value * np.abs(wi[:, 2:])

    def pdf(self, wi: Array, wo: Array) -> Array:
        assert self._pdf is not None
        value = np.asarray(self._pdf(wi, np.broadcast_to(wo, wi.shape)), dtype=np.float64)
        if value.shape != (len(wi),):
            raise ValueError(f"pdf: of {len(wi)} directions, an array of shape {value.shape}; give ({len(wi)},)")
        return value

    def sample(self, wo: Array, u: Array) -> tuple[Array, Array, Array]:
        assert self._sample is not None
        drawn = self._sample(np.broadcast_to(wo, u.shape), u)
        if len(drawn) != 3:
            raise ValueError(f"sample: {len(drawn)} results; give wi, pdf and weight")
        wi, pdf, weight = (np.asarray(x, dtype=np.float64) for x in drawn)
        n = len(u)
        if wi.shape != (n, 3) or pdf.shape != (n,) or weight.shape not in ((n,), (n, 1), (n, 3)):
            raise ValueError(f"sample: of {n} views, arrays of shapes {wi.shape}, {pdf.shape}, {weight.shape}; give "
                             f"wi ({n}, 3), pdf ({n},) and weight ({n},) or ({n}, 3)")
        return wi, pdf, weight.reshape(n, -1)


def _views(is_isotropic: bool) -> list[Array]:
    """Normal incidence exactly, and five cosines in one azimuth or three."""
    azimuths = (0.4,) if is_isotropic else (0.4, 2.0, 4.5)
    return [np.array([0.0, 0.0, 1.0])] + [direction(np.float64(np.arccos(c)), a) for c in _COSINES for a in azimuths]


def _pairs(rng: np.random.Generator, n: int) -> tuple[Array, Array]:
    """Pairs above the surface: half of them anywhere, half with a half vector near the normal, where lobes are."""

    def upper(n: int) -> Array:
        w = rng.standard_normal((n, 3))
        w /= np.linalg.norm(w, axis=1, keepdims=True)
        w[:, 2] = np.abs(w[:, 2])
        return w

    wo = upper(n)
    wi = upper(n)
    slope = np.exp(rng.uniform(-9, 0, n))
    azimuth = rng.uniform(0, 2 * np.pi, n)
    h = np.stack([slope * np.cos(azimuth), slope * np.sin(azimuth), np.ones(n)], axis=1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    near = 2 * np.sum(wo * h, axis=1, keepdims=True) * h - wo
    near /= np.linalg.norm(near, axis=1, keepdims=True)
    is_near = (np.arange(n) % 2 == 0) & (near[:, 2] > 0)
    return np.where(is_near[:, None], near, wi), wo


def _check_positive(s: _Subject, rng: np.random.Generator, views: list[Array]) -> Check:
    wi, wo = _pairs(rng, 20000)
    grazing = direction(np.full(40, np.pi / 2 - 1e-6), np.linspace(0, 6, 40))
    special = np.concatenate([np.stack(views), grazing])
    pairs = np.array([(i, o) for i in special for o in special])
    wi, wo = np.concatenate([wi, pairs[:, 0]]), np.concatenate([wo, pairs[:, 1]])
    down = np.array([1.0, 1.0, -1.0])
    is_above = np.concatenate([np.ones(len(wi), bool), np.zeros(3 * len(wi), bool)])
    wi, wo = np.concatenate([wi, wi * down, wi, wi * down]), np.concatenate([wo, wo, wo * down, wo * down])
    values = [("f", s.eval(wi, wo))] + ([("pdf", s.pdf(wi, wo)[:, None])] if s.has_sampler else [])
    for name, v in values:
        for what, is_wrong in [("is not finite", ~np.isfinite(v)), ("is negative", v < 0),
                               ("below the horizon", (v != 0) & ~is_above[:, None])]:
            if is_wrong.any():
                k = int(np.argmax(is_wrong.any(axis=1)))
                bad = v[k][is_wrong[k]][0]
                found = f"{name} = {bad:.6g} {what}" + ("; give 0" if what == "below the horizon" else "")
                return Check("positive", False, abs(bad), 0, found, _triple(wo[k]), _triple(wi[k]))
    for o in views if s.has_sampler else []:
        drawn, pdf, weight = s.sample(o, rng.random((2000, 3)))
        is_real = pdf > 0
        length = np.linalg.norm(drawn, axis=1)
        for what, is_wrong in [("pdf of a sample is not a number >= 0", ~(np.isfinite(pdf) & (pdf >= 0))),
                               ("weight is not a number >= 0", ~(np.isfinite(weight) & (weight >= 0)).all(axis=1)),
                               ("a sample is not a unit vector", is_real & ~(np.abs(length - 1) < 1e-6)),
                               ("a sample is below the horizon", is_real & (drawn[:, 2] < 0))]:
            if is_wrong.any():
                k = int(np.argmax(is_wrong))
                return Check("positive", False, 1, 0, what, _triple(o), _triple(drawn[k]))
    return Check("positive", True, 0, 0, f"finite and not negative at {len(wi)} pairs of directions, 0 below the horizon")


def _worst(name: str, rows: list[tuple[float, float, str, Array]], words: str = "") -> Check:
    """The check of rows (deviation, tolerance, what was found, wo): the worst of them by share of the tolerance."""
    deviation, tolerance, found, wo = max(rows, key=lambda r: r[0] / r[1] if np.isfinite(r[0]) else np.inf)
    return Check(name, bool(deviation <= tolerance), deviation, tolerance, found + words, _triple(wo))


def _check_furnace(s: _Subject, views: list[Array], is_lossless: bool) -> Check:
    rows = []
    for o in views:
        found: Integral = over_light(lambda wi: s.eval(wi, o), o, _PART)
        albedo = float(found.values.max())
        off = float(np.abs(found.values - 1).max()) if is_lossless else max(albedo - 1, 0.0)
        tolerance = 1e-3 if is_lossless else 1e-4
        slack = 0.0 if is_lossless else max(1 - albedo, 0.0)
        if found.error > tolerance + slack and off <= tolerance + found.error:  # it may be so, and it may not
            return Check("furnace", None, off, tolerance,
                         f"f is too rough to integrate: albedo {albedo:.6f} within {found.error:.2g}", _triple(o))
        rows.append((off, tolerance, f"albedo {albedo:.6f}", o))
    if not is_lossless and all(r[0] == 0 for r in rows):
        highest = max(rows, key=lambda r: r[2])
        return Check("furnace", True, 0, 1e-4, f"{highest[2]} at most", _triple(highest[3]))
    return _worst("furnace", rows)


def _check_reciprocity(s: _Subject, rng: np.random.Generator) -> Check:
    wi, wo = _pairs(rng, 20000)
    is_well = (wi[:, 2] > 1e-3) & (wo[:, 2] > 1e-3)
    wi, wo = wi[is_well], wo[is_well]
    there, back = s.eval(wi, wo) / wi[:, 2:], s.eval(wo, wi) / wo[:, 2:]
    return _compare("reciprocity", there, back, wi, wo, "f(wi, wo) = {:.7g}, f(wo, wi) = {:.7g}")


def _check_isotropy(s: _Subject, rng: np.random.Generator) -> Check:
    wi, wo = _pairs(rng, 20000)
    angle = rng.uniform(0, 2 * np.pi, len(wi))
    cos, sine = np.cos(angle), np.sin(angle)

    def turned(w: Array) -> Array:
        return np.stack([cos * w[:, 0] - sine * w[:, 1], sine * w[:, 0] + cos * w[:, 1], w[:, 2]], axis=1)

    return _compare("isotropy", s.eval(wi, wo), s.eval(turned(wi), turned(wo)), wi, wo, "f = {:.7g}, turned {:.7g}")


def _compare(name: str, a: Array, b: Array, wi: Array, wo: Array, words: str) -> Check:
    largest = np.maximum(np.abs(a), np.abs(b))
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.where(largest > 1e-300, np.abs(a - b) / largest, 0.0)
    off = np.where(np.isfinite(off), off, np.inf)
    worst = float(off.max())
    # What is shown of many that fail is where most light is at stake.
    shown = np.where(off > 1e-6, np.abs(a - b), -1) if worst > 1e-6 else off
    k, channel = np.unravel_index(int(np.argmax(shown)), off.shape)
    return Check(name, worst <= 1e-6, worst, 1e-6, words.format(a[k, channel], b[k, channel]), _triple(wo[k]), _triple(wi[k]))


def _borders(values: Array, n: int, low: float, high: float) -> Array:
    inner = np.quantile(values, np.linspace(0, 1, n + 1)[1:-1]) if len(values) else np.linspace(low, high, n + 1)[1:-1]
    return np.concatenate([[low], inner, [high]])


def _chi_square_cells(phi: Array, s: Array) -> Array:
    """20 x 20 cells with borders at quantiles of a pilot, of shape (20, 20, 4)."""
    columns = _borders(phi, 20, 0.0, 2 * np.pi)
    cells = np.empty((20, 20, 4))
    for k in range(20):
        inside = s[(phi >= columns[k]) & (phi <= columns[k + 1])]
        rows = _borders(inside, 20, -S_MOST, S_MOST)
        cells[k, :, 0], cells[k, :, 1] = columns[k], columns[k + 1]
        cells[k, :, 2], cells[k, :, 3] = rows[:-1], rows[1:]
    return cells


def _check_sampler(s: _Subject, rng: np.random.Generator, views: list[Array], n: int) -> list[Check]:
    norms: list[tuple[float, float, str, Array]] = []
    weights: list[tuple[float, float, str, Array]] = []
    chances: list[tuple[float, str, Array]] = []
    for o in views:
        wi, pdf, weight = s.sample(o, rng.random((n, 3)))
        is_real = pdf > 0
        wi, pdf, weight = wi[is_real], pdf[is_real], weight[is_real]
        missing = 1 - len(wi) / n

        pilot = s.sample(o, rng.random((n // 4, 3)))
        cells = _chi_square_cells(*coordinates(pilot[0][pilot[1] > 0], o))
        found = integrate(towards(lambda w: s.pdf(w, o), o), cells.reshape(-1, 4), np.arange(400), _PART)
        total = float(found.values.sum())
        deviation = np.sqrt(max(missing * (1 - missing), 0.0) / n)
        norms.append((abs(total - (1 - missing)), 1e-3 + 4 * deviation,
                      f"Int pdf = {total:.6f}, samples {1 - missing:.6f}", o))

        phi, slope = coordinates(wi, o)
        column = np.clip(np.searchsorted(cells[:, 0, 1], phi, side="right"), 0, 19)
        row = np.clip((slope[:, None] >= cells[column, :, 3]).sum(axis=1), 0, 19)
        counts = np.bincount(column * 20 + row, minlength=400)
        expected = np.append(found.values[:, 0], max(1 - total, 0.0)) * n
        p, statistic, freedom = chi_square(np.append(counts, n - len(wi)), expected)
        chances.append((p, f"p = {p:.3g}, chi-square {statistic:.0f} with {freedom} degrees of freedom", o))

        f = s.eval(wi, o)
        off = np.abs(weight * pdf[:, None] - f)
        with np.errstate(invalid="ignore", divide="ignore"):
            off = np.where(off > 1e-12 * np.abs(f).max(initial=0), off / np.maximum(np.abs(f), 1e-300), 0)
        also = np.abs(s.pdf(wi, o) / np.maximum(pdf, 1e-300) - 1) if len(wi) else np.zeros(1)
        if len(wi):
            k = int(np.argmax(off.max(axis=1)))
            weights.append((float(off.max()), 1e-5, f"weight = {weight[k].max():.7g}, f cos/pdf = "
                            f"{(f[k] / pdf[k]).max():.7g}", o))
            k = int(np.argmax(also))
            weights.append((float(also.max()), 1e-5, f"pdf of the sample = {pdf[k]:.7g}, of pdf() = "
                            f"{s.pdf(wi[k:k + 1], o)[0]:.7g}", o))
    level = 1 - (1 - _LEVEL) ** (1 / len(views))
    p, found_words, o = min(chances, key=lambda c: c[0])
    return [_worst("pdf-normalisation", norms),
            Check("chi-square", p >= level, p, level, f"{found_words}; {level:.2g} is allowed", _triple(o)),
            _worst("weight", weights) if weights else Check("weight", None, 0, 1e-5, "there are no samples")]


def verify(f: Evaluation | HasEval, pdf: Evaluation | None = None, sample: Sampler | None = None, *,
           includes_cosine: bool = True, reciprocal: bool = True, passive: bool = True, lossless: bool = False,
           isotropic: bool = False, n_samples: int = 50000, seed: int = 1) -> Verification:
    """Holds a BRDF to what every BRDF must satisfy, and its sampler, if there is one, to its density.

    f(wi, wo): f |cos theta_i| [1/sr], of shape (n,) or (n, 3), for directions wi and wo of shape (n, 3), float64; 0 below
        the horizon.  With includes_cosine=False, f alone.  Or an object with eval, pdf and sample, such as a Material.
    pdf(wi, wo): the density with which sample draws wi for wo [1/sr], (n,).
    sample(wo, u): wi (n, 3), pdf (n,) and weight = f |cos theta_i|/pdf, for u (n, 3) in [0, 1); pdf 0 is no sample.
    reciprocal, passive, lossless, isotropic: what the model claims: f(wi, wo) = f(wo, wi); albedo at most 1; albedo 1;
        nothing changes as wi and wo turn about the normal.

    The same seed gives the same verdict.  Chi-square fails a right sampler in one of 100 runs.

    >>> import numpy as np, facet
    >>> lambert = lambda wi, wo: np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), 0.8 / np.pi * wi[:, 2], 0)
    >>> bool(facet.verify(lambert))
    True
    """
    s = _Subject(f, pdf, sample, includes_cosine)
    rng = np.random.default_rng(seed)
    views = _views(isotropic)
    checks = [_check_positive(s, rng, views)]
    names = ["furnace", "reciprocity", "isotropy", "pdf-normalisation", "chi-square", "weight"]
    if checks[0].passed is False:  # numbers that are none would be everywhere
        return Verification((checks[0], *(Check(n, None, 0, 0, "f is not positive") for n in names)))
    checks.append(_check_furnace(s, views, lossless) if passive or lossless
                  else Check("furnace", None, 0, 0, "not claimed"))
    checks.append(_check_reciprocity(s, rng) if reciprocal else Check("reciprocity", None, 0, 0, "not claimed"))
    checks.append(_check_isotropy(s, rng) if isotropic else Check("isotropy", None, 0, 0, "not claimed"))
    checks += (_check_sampler(s, rng, views, n_samples) if s.has_sampler
               else [Check(n, None, 0, 0, "there is no sampler") for n in names[3:]])
    return Verification(tuple(checks))
