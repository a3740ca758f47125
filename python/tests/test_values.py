"""Values against numbers that are known from elsewhere: closed forms, and tables of 25 digits.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import csv
import pathlib

import numpy as np
import pytest

import facet


def test_lambert_is_its_formula() -> None:
    wi = facet.direction(np.linspace(0, 1.5, 20), np.arange(20.0))
    m = facet.lambert(kd=(0.2, 0.4, 0.8))
    expected = np.array([0.2, 0.4, 0.8]) * wi[:, 2:] / np.pi
    np.testing.assert_allclose(m.eval(wi, [0.0, 0.0, 1.0]), expected, rtol=4 * np.finfo(float).eps)
    np.testing.assert_allclose(m.pdf(wi, [0.0, 0.0, 1.0]), wi[:, 2] / np.pi, rtol=4 * np.finfo(float).eps)
    np.testing.assert_allclose(m.albedo([1, 0.5, 0.1]), np.tile([0.2, 0.4, 0.8], (3, 1)), atol=1e-6)
    np.testing.assert_allclose(m.average_albedo(), [0.2, 0.4, 0.8], atol=1e-6)
    assert (m.eval([0, 0, -1], [0, 0, 1]) == 0).all() and m.pdf([0, 0, 1], [0, 0, -1]) == 0


def test_ggx_terms_are_their_formulas() -> None:
    theta, alpha = np.linspace(0, 1.5, 30), 0.3
    m, v = facet.ggx(alpha=alpha), facet.direction(theta)
    tan2, cos = np.tan(theta) ** 2, np.cos(theta)
    D = alpha**2 / (np.pi * cos**4 * (alpha**2 + tan2) ** 2)
    Lambda = (np.sqrt(1 + alpha**2 * tan2) - 1) / 2
    # tan loses digits as theta nears pi/2: its condition number at 1.5 is 15.
    np.testing.assert_allclose(m.D(v), D, rtol=1e-13)
    np.testing.assert_allclose(m.Lambda(v), Lambda, rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(m.G1(v), 1 / (1 + Lambda), rtol=1e-13)
    assert m.Lambda(v).dtype == np.float64
    np.testing.assert_array_equal(facet.lambert().D(v), 0)


def rows(path: pathlib.Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_terms_agree_with_tables_of_25_digits(root: pathlib.Path) -> None:
    table = [r for r in rows(root / "tests/data/reference/g1_smith.csv") if r["model"] in ("ggx", "beckmann")]
    assert len(table) > 50
    for r in table:
        m = facet.models()[r["model"]](alpha_x=float(r["alpha_x"]), alpha_y=float(r["alpha_y"]))
        cos, phi = float(r["cos_theta_v"]), float(r["phi_v"])
        sine = np.sqrt((1 - cos) * (1 + cos))
        v = np.array([sine * np.cos(phi), sine * np.sin(phi), cos])
        # docs/verification.md: 1.1e-16; rounding sine and cosine of phi adds as much for each.
        assert abs(m.G1(v) - float(r["G1"])) < 1e-14, r


@pytest.mark.parametrize("spec", ["ggx alpha=.3", "gtr alpha=.2 gamma=1.5", "glass ior=1.5 alpha=.3", "lambert kd=.7"])
def test_the_mean_weight_is_the_albedo(spec: str) -> None:
    """Int f cos = E[weight]: 2e5 samples, within five standard deviations."""
    m, rng = facet.material(spec), np.random.default_rng(7)
    wo = facet.direction(np.float64(0.9), 0.3)
    weight = m.sample(wo, rng.random((200000, 3))).weight
    deviation = weight.std(axis=0) / np.sqrt(len(weight))
    cos = float(wo[2])
    expected = m.albedo(cos, 0.3) + m.transmitted(cos, 0.3)
    assert (np.abs(weight.mean(axis=0) - expected) < 5 * deviation + 1e-6).all()


def test_glass_sends_light_both_ways() -> None:
    m = facet.glass(ior=1.5)
    assert m.lobes & facet.DELTA and m.lobes & facet.TRANSMISSION and not facet.lambert().lobes & facet.TRANSMISSION
    s = m.sample_lobes([0, 0.6, 0.8], np.random.default_rng(1).random((400, 3)))
    through = (s.lobe & facet.TRANSMISSION) != 0
    assert (s.wi[through, 2] < 0).all() and (s.wi[~through, 2] > 0).all() and 0 < through.sum() < 400
    np.testing.assert_allclose(s.wi[through, 1], -0.6 / 1.5, rtol=1e-6)  # Snell
    np.testing.assert_allclose(s.eta[through], 1.5) and np.testing.assert_array_equal(s.eta[~through], 1)
    # Exact Fresnel at normal incidence; what goes in carries 1/n^2, and comes out with n^2.
    np.testing.assert_allclose(m.albedo(1.0), 0.04, atol=1e-7)
    np.testing.assert_allclose(m.transmitted(1.0) * m.transmitted(-1.0), 0.96**2, atol=1e-6)


def test_albedo_broadcasts_and_is_checked() -> None:
    m = facet.ggx(alpha_x=0.1, alpha_y=0.5)
    a = m.albedo([[1.0], [0.4]], [0.0, 1.0, 2.0])
    assert a.shape == (2, 3, 3) and a.dtype == np.float64
    np.testing.assert_array_equal(a[1, 2], m.albedo(0.4, 2.0))
    np.testing.assert_allclose(a[0, 0], a[0, 2], rtol=1e-12)
    assert m.albedo(0.4).shape == (3,)
    for bad in (1.1, np.nan):
        with pytest.raises(ValueError, match="cos"):
            m.albedo(bad)


def test_directions_are_where_angles_say() -> None:
    v = facet.direction(np.array([[0.3], [1.2]]), np.array([0.0, 2.0, -1.0]))
    assert v.shape == (2, 3, 3) and v.dtype == np.float64
    np.testing.assert_allclose(np.linalg.norm(v, axis=-1), 1, rtol=1e-15)
    np.testing.assert_allclose(np.arccos(v[..., 2]), [[0.3] * 3, [1.2] * 3], rtol=1e-12)
    np.testing.assert_allclose(np.arctan2(v[..., 1], v[..., 0]), [[0, 2, -1]] * 2, rtol=1e-12)
    assert facet.direction(0.3).dtype == np.float32
