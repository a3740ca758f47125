"""Integrals over directions, for facet.verify: adaptive, and many cells at once.

Light is integrated over the half vector h between wi and wo, in the azimuth of h and the logarithm s of its slope: a lobe
of any width is as smooth there as another.  dwi = 4 |wo.h| dh, and dh = e^2s/(1 + e^2s)^1.5 ds dphi.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Any, Callable, NamedTuple

import numpy as np

from ._arrays import Array

# Slopes from 4e-8 to 2e7: what lies outside is less than 1e-7 of the solid angle.
S_MOST = 17.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_MOST_POINTS = 1 << 22


class Integral(NamedTuple):
    """One value for each owner of cells, and an estimate of the error of their sum."""

    values: Array
    error: float


def half_vectors(phi: Array, s: Array) -> tuple[Array, Array]:
    """Unit vectors of azimuth phi and slope e^s, and their solid angle for d phi ds."""
    slope = np.exp(s)
    cos = 1 / np.sqrt(1 + slope * slope)
    sine = slope * cos
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cos], axis=-1), sine * sine * cos


def coordinates(wi: Array, wo: Array) -> tuple[Array, Array]:
    """Azimuth in [0, 2 pi) and log slope of the half vectors, clipped to the domain.  Those that point down are turned up."""
    h = wi + wo
    h = np.where(h[..., 2:] < 0, -h, h)
    slope = np.hypot(h[..., 0], h[..., 1]) / np.maximum(h[..., 2], 1e-300)
    s = np.log(np.maximum(slope, 1e-300))
    return np.mod(np.arctan2(h[..., 1], h[..., 0]), 2 * np.pi), np.clip(s, -S_MOST, S_MOST)


def whole_domain() -> Array:
    """Cells (phi from, to, s from, to) that cover all half vectors above the surface."""
    phi = np.linspace(0, 2 * np.pi, 5)
    return np.array([[a, b, -S_MOST, S_MOST] for a, b in zip(phi, phi[1:])])


def towards(g: Callable[[Array], Array], wo: Array) -> Callable[[Array, Array], Array]:
    """The integrand over (phi, s) of g(wi) d wi.  Half vectors that wo faces from behind mirror it from beyond: 0."""

    def integrand(phi: Array, s: Array) -> Array:
        h, area = half_vectors(phi, s)
        c = h @ wo
        wi = 2 * c[:, None] * h - wo
        wi /= np.linalg.norm(wi, axis=-1, keepdims=True)
        values = np.asarray(g(wi), dtype=np.float64)
        values = values[:, None] if values.ndim == 1 else values
        result: Array = values * np.where(c > 0, 4 * c * area, 0.0)[:, None]
        return result

    return integrand


def _rule(f: Callable[[Array, Array], Array], cells: Array) -> Array:
    """Gauss's rule of 8 x 8 points on each cell."""
    half = (cells[:, 1::2] - cells[:, 0::2]) / 2
    middle = (cells[:, 1::2] + cells[:, 0::2]) / 2
    phi = middle[:, 0, None, None] + half[:, 0, None, None] * _NODES[:, None]
    s = middle[:, 1, None, None] + half[:, 1, None, None] * _NODES[None, :]
    phi, s = np.broadcast_arrays(phi, s)
    values = f(phi.ravel(), s.ravel()).reshape(len(cells), 8, 8, -1)
    result: Array = np.einsum("nijc,i,j->nc", values, _WEIGHTS, _WEIGHTS) * (half[:, :1] * half[:, 1:])
    return result


def _quarters(cells: Array) -> Array:
    a, b, c, d = cells.T
    m, k = (a + b) / 2, (c + d) / 2
    parts = [(a, m, c, k), (m, b, c, k), (a, m, k, d), (m, b, k, d)]
    return np.stack([np.stack(p, axis=1) for p in parts], axis=1).reshape(-1, 4)


def _short(cells: Array, owners: Array) -> tuple[Array, Array]:
    """The same cells, cut where they are longer than 2 in s: a rule must not look past a lobe."""
    n = np.maximum(np.ceil((cells[:, 3] - cells[:, 2]) / 2).astype(int), 1)
    owners, which = np.repeat(owners, n), np.repeat(np.arange(len(cells)), n)
    k = np.arange(len(which)) - np.repeat(np.cumsum(n) - n, n)
    step = ((cells[:, 3] - cells[:, 2]) / n)[which]
    low = cells[which, 2] + k * step
    return np.stack([cells[which, 0], cells[which, 1], low, low + step], axis=1), owners


def integrate(f: Callable[[Array, Array], Array], cells: Array, owners: Array, tolerance: float) -> Integral:
    """The integrals of f(phi, s) over the cells, added up for each owner: shape (n owners, channels).

    A cell is done when its four quarters together differ from it by less than tolerance/10; what is kept is the sum of
    the quarters, whose own error is some 4^-8 of that where f is smooth.  `error` is the sum of all differences.
    """
    total: Any = None
    cells, owners = _short(cells, owners)
    values = _rule(f, cells)
    error, points = 0.0, 64 * len(cells)
    while len(cells):
        parts = _quarters(cells)
        finer = _rule(f, parts)
        points += 64 * len(parts)
        sums = finer.reshape(len(cells), 4, -1).sum(axis=1)
        difference = np.abs(sums - values).max(axis=1)
        is_open = ~(difference <= tolerance / 10) & (points < _MOST_POINTS)
        if total is None:
            total = np.zeros((int(owners.max()) + 1, sums.shape[1]))
        np.add.at(total, owners[~is_open], sums[~is_open])
        error += float(difference[~is_open].sum())
        again = np.repeat(is_open, 4)
        cells, values, owners = parts[again], finer[again], np.repeat(owners, 4)[again]
    return Integral(total, error)


def over_light(g: Callable[[Array], Array], wo: Array, tolerance: float) -> Integral:
    """Int g(wi) d wi over all directions that a half vector above the surface mirrors wo to, of each channel."""
    cells = whole_domain()
    found = integrate(towards(g, wo), cells, np.zeros(len(cells), int), tolerance)
    return Integral(found.values[0], found.error)
