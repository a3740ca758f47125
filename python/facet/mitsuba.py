"""facet's materials as BSDF plugins of Mitsuba 3, in the variants scalar_rgb and llvm_ad_rgb.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import facet.mitsuba
    facet.mitsuba.register()
    scene = mi.load_dict({..., "bsdf": {"type": "facet_gtr", "alpha": 0.1, "gamma": 1.5}})
    picture = facet.mitsuba.render(scene, spp=64)

Each model is a plugin `facet_NAME` with the model's parameters: numbers, names of choices, and colours as numbers or
`{"type": "rgb", "value": [...]}`.  The plugin `facet` takes a whole specification: {"type": "facet", "spec": "ggx alpha=.2"}.

What is evaluated are the library's own kernels, in single precision, the same bits as everywhere: Dr.Jit cannot call a C
function from the code that it compiles, so that wavefronts are handed over as arrays.  Mitsuba therefore has to evaluate
its loops and calls step by step, which `facet.mitsuba.render`, or any code under `with facet.mitsuba.evaluated():`, makes
it do.  No derivatives go through these plugins.

Lights and cameras see a surface of most models from its front only, as with Mitsuba's own plugins; put such a plugin into
`twosided` where both sides are to reflect.  glass transmits.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from ._arrays import Array
from ._library import lib
from ._material import Material
from ._table import MODELS

__all__ = ["evaluated", "register", "render"]

_VARIANTS = ("scalar_rgb", "llvm_ad_rgb")
_classes: dict[str, Any] = {}


def _mitsuba() -> Any:
    try:
        mi = importlib.import_module("mitsuba")
    except ImportError:
        raise ImportError("facet.mitsuba needs Mitsuba 3: pip install 'facet-brdf[mitsuba]'") from None
    if mi.variant() not in _VARIANTS:
        raise ValueError(f"Mitsuba's variant is {mi.variant()}; call mi.set_variant with one of {', '.join(_VARIANTS)}")
    return mi


@contextlib.contextmanager
def evaluated() -> Iterator[None]:
    """Makes Mitsuba evaluate loops and calls step by step, as these plugins need; nothing in scalar_rgb."""
    mi = _mitsuba()
    if mi.variant() == "scalar_rgb":
        yield
        return
    dr = importlib.import_module("drjit")
    flags = (dr.JitFlag.SymbolicCalls, dr.JitFlag.SymbolicLoops, dr.JitFlag.SymbolicConditionals)
    before = [dr.flag(f) for f in flags]
    try:
        for f in flags:
            dr.set_flag(f, False)
        yield
    finally:
        for f, was in zip(flags, before):
            dr.set_flag(f, was)


def render(scene: Any, **arguments: Any) -> Any:
    """mi.render for scenes with these plugins: the same arguments, the same result."""
    mi = _mitsuba()
    with evaluated():
        picture = mi.render(scene, **arguments)
        if mi.variant() != "scalar_rgb":
            importlib.import_module("drjit").eval(picture)
    return picture


def register() -> None:
    """Registers `facet` and a plugin `facet_NAME` for each model with the current variant; again after mi.set_variant."""
    mi = _mitsuba()
    variant = mi.variant()
    if variant not in _classes:
        _classes[variant] = _bsdf_class(mi)
    bsdf = _classes[variant]
    mi.register_bsdf("facet", lambda props: bsdf(props, None))
    for name in MODELS:
        mi.register_bsdf(f"facet_{name}", lambda props, name=name: bsdf(props, name))


def _material(props: Any, model: str | None) -> Material:
    """The material that a plugin's properties describe; wrong ones are errors that name the property."""
    values = {}
    for name in props.keys():
        value = props[name]
        values[name] = value if isinstance(value, (str, int, float)) else [float(x) for x in value]
    if model is not None:
        return MODELS[model](**values)
    if set(values) != {"spec"} or not isinstance(values["spec"], str):
        raise ValueError(f"the plugin facet has one property, spec, a text such as 'ggx alpha=.2'; got {sorted(values)}")
    return Material(values["spec"])


def _kinds(mi: Any, lobes: int) -> int:
    """Mitsuba's words for lobes."""
    f, flags = mi.BSDFFlags, 0
    for kind, reflected, transmitted in ((lib.FACET_DIFFUSE, f.DiffuseReflection, f.DiffuseTransmission),
                                         (lib.FACET_GLOSSY, f.GlossyReflection, f.GlossyTransmission),
                                         (lib.FACET_DELTA, f.DeltaReflection, f.DeltaTransmission)):
        if lobes & kind:
            flags |= int(reflected) if lobes & lib.FACET_REFLECTION else 0
            flags |= int(transmitted) if lobes & lib.FACET_TRANSMISSION else 0
    return flags


def _flags(mi: Any, lobes: int) -> int:
    """... and for a material with them."""
    f = mi.BSDFFlags
    sides = int(f.FrontSide) | (int(f.BackSide) | int(f.NonSymmetric) if lobes & lib.FACET_TRANSMISSION else 0)
    return _kinds(mi, lobes) | sides | int(f.Anisotropic)


def _bsdf_class(mi: Any) -> Any:
    """The plugin's class for the current variant, whose types its methods take and give."""
    is_scalar = mi.variant() == "scalar_rgb"
    dr = importlib.import_module("drjit")

    def arrays(active: Any, *values: Any) -> tuple[Array, list[Array]]:
        """Which lanes are active, and the values as arrays of as many lanes, their parts in the last axis.

        Lanes that are not active, or have no direction, hold anything: they get the normal.
        """
        if is_scalar:
            return np.array([bool(active)]), [np.array([[*w]], np.float32) for w in values]
        if dr.flag(dr.JitFlag.SymbolicScope):
            raise RuntimeError("facet's plugins need evaluated loops and calls: use facet.mitsuba.render(scene), or `with "
                               "facet.mitsuba.evaluated():` around what renders")
        on = mi.Bool(active)
        n = max(dr.width(v) for v in (on, *values))
        is_on = np.broadcast_to(on.numpy(), n)
        parts = [np.stack([np.broadcast_to(x.numpy(), n) for x in w]).T for w in values]
        return is_on, parts

    def where_real(is_on: Array, *directions: Array) -> tuple[Array, list[Array]]:
        """Lanes with unit vectors, and the vectors, with the normal in the others."""
        for w in directions:
            is_on = is_on & (np.abs(np.einsum("nk,nk->n", w, w) - 1) < 5e-5)
        if is_on.all():
            return is_on, list(directions)
        return is_on, [np.where(is_on[:, None], w, np.array([0, 0, 1], np.float32)) for w in directions]

    def pair(si: Any, wo: Any, active: Any) -> tuple[Array, Array, Array]:
        """Active lanes, the direction to the light and the one to the viewer, which are Mitsuba's wo and si.wi."""
        is_on, both = arrays(active, wo, si.wi)
        is_on, (wi, view) = where_real(is_on, *both)
        return is_on, wi, view

    def reals(a: Array) -> Any:
        return float(a[0]) if is_scalar else mi.Float(np.ascontiguousarray(a, np.float32))

    def spectrum(f: Array) -> Any:
        return mi.Color3f(*(reals(f[:, k]) for k in range(3)))

    class FacetBSDF(mi.BSDF):  # type: ignore[misc]
        """A material of facet."""

        def __init__(self, props: Any, model: str | None) -> None:
            mi.BSDF.__init__(self, props)
            self.material = _material(props, model)
            flags = _flags(mi, self.material.lobes)
            self.m_components = [flags]
            self.m_flags = flags

        def to_string(self) -> str:
            return f"FacetBSDF[{self.material.spec}]"

        __repr__ = to_string

        def traverse(self, callback: Any) -> None:
            """There is nothing to differentiate."""

        def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            is_on, wi, view = pair(si, wo, active)
            return spectrum(self.material.eval(wi, view) * is_on[:, None])

        def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            is_on, wi, view = pair(si, wo, active)
            return reals(self.material.pdf(wi, view) * is_on)

        def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            is_on, wi, view = pair(si, wo, active)
            f, p = self.material.eval_pdf(wi, view)
            return spectrum(f * is_on[:, None]), reals(p * is_on)

        def sample(self, ctx: Any, si: Any, sample1: Any, sample2: Any, active: Any = True) -> Any:
            a, (view, u) = arrays(active, si.wi, (sample2.x, sample2.y, sample1))
            a, (view,) = where_real(a, view)
            u = np.clip(np.where(a[:, None], u, 0), 0, np.float32(1 - 2**-24))
            lobes = self.material.lobes
            eta, kinds = np.ones(a.shape, np.float32), np.full(a.shape, _kinds(mi, lobes), np.uint32)
            if lobes & (lib.FACET_TRANSMISSION | lib.FACET_DELTA):
                wi, p, weight, lobe, eta = self.material.sample_lobes(view, u)
                for each in np.unique(lobe):
                    kinds[lobe == each] = _kinds(mi, int(each))
            else:
                wi, p, weight = self.material.sample(view, u)
            is_real = a & (p > 0)
            bs = mi.BSDFSample3f()
            bs.wo = mi.Vector3f(*(reals(wi[:, k]) for k in range(3)))
            bs.pdf = reals(p * is_real)
            bs.eta = reals(eta)
            bs.sampled_type = int(kinds[0]) if is_scalar else mi.UInt32(kinds)
            bs.sampled_component = 0 if is_scalar else mi.UInt32(0)
            return bs, spectrum(weight * is_real[:, None])

    return FacetBSDF

