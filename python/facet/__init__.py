"""facet: microfacet reflection, exact where the literature approximates.

>>> import facet
>>> facet.ggx(alpha=.3, ks=.9).eval(wi=[0, .6, .8], wo=[0, -.6, .8])
array([0.9704913, 0.9704913, 0.9704913], dtype=float32)

One constructor for each model (facet.models()), or a material from its text form (facet.material).  All of them have
eval, pdf, sample, albedo, D, Lambda and G1, over NumPy arrays of any shape.  facet.verify holds a BRDF of your own to
what every BRDF must satisfy, and facet.render runs the path tracer.

Conventions: directions are unit vectors that point away from the surface, in the frame whose normal is (0, 0, 1); wi is
to the light, wo to the viewer; eval is f |cos theta_i| [1/sr]; colours are linear Rec.709.

SPDX-License-Identifier: MIT
"""
from . import _models
from ._arrays import direction
from ._library import instruction_sets, lib as _lib, version as _version
from ._material import LobeSample, Material, Sample, material
from ._models import *  # noqa: F403
from ._render import find_program, read_exr, render
from ._table import Model, Parameter, models
from ._verify import Check, Verification, verify

__version__: str = _version()

# What a sample is: bits of LobeSample.lobe and Material.lobes.
REFLECTION: int = _lib.FACET_REFLECTION
TRANSMISSION: int = _lib.FACET_TRANSMISSION
DIFFUSE: int = _lib.FACET_DIFFUSE
GLOSSY: int = _lib.FACET_GLOSSY
DELTA: int = _lib.FACET_DELTA

__all__ = ["DELTA", "DIFFUSE", "GLOSSY", "REFLECTION", "TRANSMISSION", "LobeSample", "Material", "Model", "Parameter",
           "Check", "Sample", "Verification", "direction", "find_program", "instruction_sets",
           "material", "models", "read_exr", "render", "verify", *_models.__all__]
