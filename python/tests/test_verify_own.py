"""facet.verify passes what is right, and fails what is wrong by the check that its mistake belongs to.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Any, Callable

import numpy as np
import pytest

import facet
from facet._chi_square import chi_square, upper_gamma
from facet._quadrature import over_light

ALPHA = 0.3


class Ggx:
    """GGX with separable masking and no Fresnel term, drawn from all normals; each argument is a way to be wrong."""

    def __init__(self, *, scale: float = 1.0, sampler_alpha: float = ALPHA, jacobian: bool = True, half: bool = False,
                 below: bool = False, weight_scale: float = 1.0, pdf_scale: float = 1.0, skew: float = 0.0,
                 masking: bool = True, negative: bool = False, blind: bool = False, twist: float = 0.0,
                 flipped: bool = False, long: bool = False) -> None:
        self.__dict__.update({k: v for k, v in locals().items() if k != "self"})

    @staticmethod
    def D(cos: np.ndarray, alpha: float) -> np.ndarray:
        return alpha**2 / np.pi / (cos**2 * (alpha**2 - 1) + 1) ** 2

    @staticmethod
    def G1(cos: np.ndarray) -> np.ndarray:
        return 2 * cos / (cos + np.sqrt(ALPHA**2 + (1 - ALPHA**2) * cos**2))

    @staticmethod
    def normal(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        h = wi + wo
        return h / np.maximum(np.linalg.norm(h, axis=1, keepdims=True), 1e-12)

    def eval(self, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        h, ci, co = self.normal(wi, wo), np.abs(wi[:, 2]), np.abs(wo[:, 2])
        G = self.G1(ci) * self.G1(co) if self.masking else 1.0
        f = self.scale * self.D(np.abs(h[:, 2]), ALPHA) * G / (4 * np.maximum(co, 1e-12))
        f = f * (1 + self.skew * co) * (1 + self.twist * wi[:, 0] * wo[:, 0])
        f = np.where(self.negative & (ci < 0.1), -f, f)
        f = np.where(self.blind & (np.abs(wo[:, 2] - 1) < 1e-12), np.nan, f)
        return np.where(((wi[:, 2] > 0) | self.below) & (wo[:, 2] > 0), f, 0)

    def pdf(self, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        h = self.normal(wi, wo)
        p = self.pdf_scale * self.D(h[:, 2], ALPHA) * h[:, 2]
        p = p / (4 * np.maximum(np.sum(wo * h, axis=1), 1e-12)) if self.jacobian else p
        return np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), p, 0)

    def sample(self, wo: np.ndarray, u: np.ndarray) -> Any:
        a = self.sampler_alpha
        tan2, phi = a**2 * u[:, 0] / (1 - u[:, 0]), 2 * np.pi * u[:, 1] * (0.5 if self.half else 1)
        cos = 1 / np.sqrt(1 + tan2)
        sine = np.sqrt(1 - cos**2)
        m = np.stack([sine * np.cos(phi), sine * np.sin(phi), cos], axis=1)
        wi = 2 * np.sum(wo * m, axis=1, keepdims=True) * m - wo
        p = self.pdf(wi, wo)
        weight = self.weight_scale * self.eval(wi, wo) / np.where(p > 0, p, 1)
        wi = -wi if self.flipped else wi * 1.01 if self.long else wi
        return wi, p, np.where(p > 0, weight, 0)


def names(v: facet.Verification) -> set[str]:
    return {c.name for c in v.failures}


def test_a_right_model_passes() -> None:
    v = facet.verify(Ggx(), isotropic=True)
    assert v and v.passed and not v.failures and all(c.passed for c in v.checks), str(v)
    assert str(v).endswith("all checks hold") and "<table>" in v._repr_html_()
    v.raise_if_failed()
    assert v["furnace"].found.startswith("albedo 0.877358") and v["chi-square"].worst > v["chi-square"].tolerance


@pytest.mark.parametrize("mistake, check", [
    ({"scale": 1.2}, "furnace"),
    ({"masking": False}, "furnace"),
    ({"skew": 0.1, "scale": 0.5}, "reciprocity"),
    ({"twist": 0.1, "scale": 0.5}, "isotropy"),
    ({"negative": True}, "positive"),
    ({"blind": True}, "positive"),
    ({"below": True}, "positive"),
    ({"flipped": True}, "positive"),
    ({"long": True}, "positive"),
    ({"sampler_alpha": ALPHA * 1.1}, "chi-square"),
    ({"half": True}, "chi-square"),
    ({"jacobian": False}, "chi-square"),
    ({"jacobian": False}, "pdf-normalisation"),
    ({"pdf_scale": 0.98}, "pdf-normalisation"),
    ({"weight_scale": 1.001}, "weight"),
], ids=lambda x: x if isinstance(x, str) else "-".join(x))
def test_a_wrong_model_fails_by_the_check_of_its_mistake(mistake: dict[str, Any], check: str) -> None:
    v = facet.verify(Ggx(**mistake), isotropic=True, n_samples=20000)
    assert check in names(v), str(v)
    assert not v and f"{check:18}FAILS" in str(v)
    with pytest.raises(AssertionError, match=check):
        v.raise_if_failed()


def test_one_mistake_fails_one_check() -> None:
    """What a check blames is not blamed by the others too."""
    assert names(facet.verify(Ggx(weight_scale=1.001), isotropic=True, n_samples=10000)) == {"weight"}
    assert names(facet.verify(Ggx(sampler_alpha=ALPHA * 1.1), isotropic=True)) <= {"chi-square", "pdf-normalisation"}
    assert names(facet.verify(Ggx(scale=1.2), isotropic=True, n_samples=10000)) == {"furnace"}


def lambert(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    return np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), wi[:, 2] / np.pi, 0)


def test_functions_alone_and_their_claims() -> None:
    v = facet.verify(lambert, lossless=True, isotropic=True)
    assert v and v["chi-square"].passed is None and v["weight"].verdict == "left out"
    assert names(facet.verify(lambda i, o: 0.99 * lambert(i, o), lossless=True)) == {"furnace"}
    # The cosine forgotten, and f alone, which is what one gets then.
    f = lambda i, o: np.where((i[:, 2] > 0) & (o[:, 2] > 0), 1 / np.pi, 0)  # noqa: E731
    assert "reciprocity" in names(facet.verify(f)) and facet.verify(f, includes_cosine=False)
    assert facet.verify(lambda i, o: lambert(i, o) * (1 + o[:, 2]) / 2, reciprocal=False)
    assert facet.verify(lambda i, o: 2 * lambert(i, o), passive=False)
    colour = lambda i, o: lambert(i, o)[:, None] * np.array([0.2, 0.5, 1.1])  # noqa: E731
    assert names(facet.verify(colour)) == {"furnace"}


@pytest.mark.parametrize("spec", ["lambert", "ggx alpha=.3", "ggx alpha=.001", "ggx alpha_x=.05 alpha_y=.5", "phong",
                                  "beckmann alpha=.1 g2=separable", "ward variant=gmd alpha_x=.2 alpha_y=.2", "ggx alpha=.6 energy=multi"])
def test_the_librarys_own_models_pass(spec: str) -> None:
    m = facet.material(spec)
    v = facet.verify(m, n_samples=10000, isotropic=m["alpha_x"] == m["alpha_y"] if "alpha_x" in m.values else True, lossless="energy=multi" in spec)
    assert v, str(v)


def test_what_cannot_be_looked_at_is_refused() -> None:
    with pytest.raises(NotImplementedError, match="glass transmits or mirrors: `facet verify 'glass"):
        facet.verify(facet.glass(ior=1.5))
    with pytest.raises(TypeError, match="a float has no eval"):
        facet.verify(1.0)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="pdf and sample go together"):
        facet.verify(lambert, pdf=lambert)
    with pytest.raises(ValueError, match=r"an array of shape \(\); give"):
        facet.verify(lambda i, o: 0.3)
    with pytest.raises(ValueError, match="sample: 2 results"):
        facet.verify(lambert, pdf=lambert, sample=lambda o, u: (o, u))
    with pytest.raises(ValueError, match="sample: of 2000 views, arrays of shapes"):
        facet.verify(lambert, pdf=lambert, sample=lambda o, u: (o, u, u))
    with pytest.raises(ValueError, match="pdf: of"):
        facet.verify(lambert, pdf=lambda i, o: i, sample=lambda o, u: (o, u, u))


def test_what_is_too_rough_to_integrate_is_said() -> None:
    """White noise has no integral: not a pass."""

    def noise(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        return lambert(wi, wo) * (0.98 + 0.04 * np.mod(np.abs(wi[:, 0] * 1e9), 1.0))

    v = facet.verify(noise, isotropic=True)
    assert v["furnace"].passed is None and "too rough" in v["furnace"].found


@pytest.mark.parametrize("a, x, q", [
    # Q(1, x) = exp(-x); Q(1/2, x) = erfc(sqrt x); Q(a, x) by summing exp(-x) x^k/k!, k < a.
    (1.0, 2.5, np.exp(-2.5)), (1.0, 0.0, 1.0), (0.5, 4.0, 0.004677734981047266), (0.5, 0.25, 0.4795001221869535),
    (3.0, 2.0, np.exp(-2.0) * 5), (50.0, 1000.0, 0.0),
])
def test_the_incomplete_gamma_function(a: float, x: float, q: float) -> None:
    assert abs(upper_gamma(a, x) - q) < 1e-14


def test_chi_square_is_level() -> None:
    """Of right counts, a share p of all tests is below p: 2000 tests, within five standard deviations."""
    rng = np.random.default_rng(4)
    expected = np.concatenate([np.full(30, 20.0), np.full(40, 0.7)])
    p = np.array([chi_square(rng.multinomial(628, expected / 628), expected)[0] for _ in range(2000)])
    for level in (0.05, 0.5, 0.9):
        assert abs((p < level).mean() - level) < 5 * np.sqrt(level * (1 - level) / 2000) + 0.01
    assert chi_square(np.array([10, 0]), np.array([10.0, 0.0]))[0] == 1
    assert chi_square(np.array([10, 10, 3]), np.array([10.0, 13.0, 0.0]), least=0)[0] == 0


@pytest.mark.parametrize("spec", ["lambert kd=.7", "ggx alpha=.001", "gtr alpha=.1 gamma=.8", "beckmann alpha=.5"])
@pytest.mark.parametrize("theta", [0.0, 0.7, 1.5])
def test_integrals_over_light_are_the_albedo(spec: str, theta: float) -> None:
    m: Callable[..., Any] = facet.material(spec)
    wo = facet.direction(np.float64(theta), 0.3)
    found = over_light(lambda wi: m.eval(wi, wo), wo, 1e-5)
    # Half of what the furnace check allows; the albedo's own error is below 1e-6.
    assert found.error < 5e-5
    np.testing.assert_allclose(found.values, m.albedo(wo[2]), rtol=0, atol=5e-5)
