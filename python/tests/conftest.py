"""What the tests share.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import os
import pathlib
import shutil

import numpy as np
import pytest
from hypothesis import settings

import facet

# The same examples in every run; a time limit would make a loaded machine a failure.
settings.register_profile("facet", deadline=None, derandomize=True, database=None, max_examples=60)
settings.load_profile("facet")

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def root() -> pathlib.Path:
    """The source tree."""
    return ROOT


@pytest.fixture
def program() -> str:
    """The path of the program `facet`, or the test is skipped: $FACET, or on PATH."""
    found = os.environ.get("FACET") or shutil.which("facet")
    if not found:
        pytest.skip("the program `facet` was not found: build it, and name it in $FACET")
    return found


def unit_vectors(rng: np.random.Generator, n: int, dtype: type = np.float32, above: bool = False) -> np.ndarray:
    """n directions, uniform over the sphere or the upper half of it."""
    v = rng.standard_normal((n, 3))
    v[:, 2] = np.abs(v[:, 2]) if above else v[:, 2]
    return (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(dtype)


def some_materials() -> list[facet.Material]:
    """Every model with its defaults, and what takes other paths through the kernels."""
    specs = ["ggx alpha_x=.1 alpha_y=.4 kd=.2", "beckmann alpha=.3 ior=1.5", "phong exponent=40", "gtr alpha=.2 gamma=1.3",
             "ggx alpha=.5 energy=multi metal=Au", "glass ior=1.5 alpha=.2", "ward variant=gmd", "disney clearcoat=1 sheen=1"]
    return [facet.material(s) for s in [*facet.models(), *specs]]
