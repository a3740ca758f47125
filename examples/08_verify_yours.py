"""A BRDF of one's own in NumPy, wrong at first: facet.verify says what, and where.

Ashikhmin and Shirley's idea of 2000: D of Phong over 4 (wi.h) max(cos_i, cos_o), here without their Fresnel term.
SPDX-License-Identifier: MIT
"""
import numpy as np
from svg_file import curves

import facet

N = 20.0


def half(wi, wo):
    h = wi + wo
    return h / np.maximum(np.linalg.norm(h, axis=-1, keepdims=True), 1e-12)


def brdf(wi, wo, norm):
    """f cos(theta_i); `norm` is the constant in front of cos^N."""
    h, ci, co = half(wi, wo), wi[..., 2], wo[..., 2]
    d = norm * np.maximum(h[..., 2], 0) ** N
    c = np.maximum((wi * h).sum(-1), 1e-9)
    return np.where((ci > 0) & (co > 0), d / (4 * c * np.maximum(np.maximum(ci, co), 1e-9)) * ci, 0)


def pdf(wi, wo):
    h = half(wi, wo)
    p = (N + 1) / (2 * np.pi) * np.maximum(h[..., 2], 0) ** N / (4 * np.maximum((wo * h).sum(-1), 1e-9))
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), p, 0)


def sample(wo, u):
    cos, phi = u[:, 0] ** (1 / (N + 1)), 2 * np.pi * u[:, 1]
    sine = np.sqrt(1 - cos**2)
    h = np.stack([sine * np.cos(phi), sine * np.sin(phi), cos], axis=1)
    wi = 2 * (wo * h).sum(1, keepdims=True) * h - wo
    p = np.where((wo * h).sum(1) > 0, pdf(wi, wo), 0)
    return wi, p, np.where(p > 0, right(wi, wo) / np.where(p > 0, p, 1), 0)


def right(wi, wo):
    return brdf(wi, wo, (N + 1) / (2 * np.pi))


def wrong(wi, wo):
    return brdf(wi, wo, (N + 8) / (2 * np.pi))  # the constant of another lobe


print("wrong:", *facet.verify(wrong, isotropic=True).failures[0].found.split("\n"))
print(facet.verify(right, pdf, sample, isotropic=True))

theta = np.linspace(-np.pi / 2, np.pi / 2, 400)
rows = [right(facet.direction(theta), facet.direction(np.full(400, -a))) for a in (0.2, 0.7, 1.2)]
curves("08_verify_yours.svg", np.rad2deg(theta), rows, ["view at 11 degrees", "40 degrees", "69 degrees"],
       "f cos of the right one", 2.4, "angle of the light [degree]")
