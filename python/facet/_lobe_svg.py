"""A material's lobe as a small drawing, for notebooks: no plotting package is needed.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import html
from typing import TYPE_CHECKING

import numpy as np

from ._arrays import Array, direction
from ._library import lib

if TYPE_CHECKING:
    from ._material import Material

_VIEWS = ((20, "#3b6fd4"), (50, "#d4703b"), (75, "#2f9e6e"))  # [degree]
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_WIDTH, _RADIUS, _TOP = 420, 150, 24


def _angles(view: float, is_whole: bool) -> Array:
    """Angles from the normal in the plane of incidence, closer together around the mirror direction and what refracts."""
    near = np.geomspace(1e-4, 1, 120)
    mirror = view + np.concatenate([-near[::-1], [0.0], near])
    most = np.pi if is_whole else np.pi / 2
    theta = np.concatenate([np.linspace(-most, most, 721 if is_whole else 361), mirror])
    result: Array = np.unique(np.clip(theta, -most, most))
    return result


def _delta_lines(material: Material, wo: Array, x0: float, y0: float, colour: str) -> list[str]:
    """A line towards each of the finitely many directions of mirrors and smooth glass, as long as it is probable."""
    u = np.stack([np.full(64, 0.5), np.full(64, 0.5), (np.arange(64) + 0.5) / 64], axis=1)
    s = material.sample_lobes(wo, u)
    is_delta = ((s.lobe & lib.FACET_DELTA) != 0) & (s.pdf > 0)
    ends = {(round(float(w[0]), 6), round(float(w[2]), 6)): float(p) for w, p in zip(s.wi[is_delta], s.pdf[is_delta])}
    return [f'<path d="M{x0} {y0}l{_RADIUS * np.sqrt(p) * x:.1f} {-_RADIUS * np.sqrt(p) * z:.1f}" stroke="{colour}" '
            f'stroke-width="2"/>' for (x, z), p in ends.items()]


def lobe_svg(material: Material) -> str:
    """f |cos theta_i| over the plane of incidence, for three views; the radius is its square root over the largest."""
    lobes = material.lobes
    is_whole = bool(lobes & lib.FACET_TRANSMISSION)
    x0, y0 = _WIDTH / 2, _TOP + _RADIUS
    height = y0 + (_RADIUS if is_whole else 8) + 40
    shapes = [f'<path d="M{x0 - _RADIUS} {y0}H{x0 + _RADIUS}" stroke="#888"/>',
              f'<path d="M{x0} {y0}V{_TOP}" stroke="#888" stroke-dasharray="2 3"/>']
    for part in (0.5, 1.0):
        r = _RADIUS * part
        end = f"A{r} {r} 0 0 1 {x0 + r} {y0}" + (f"A{r} {r} 0 0 1 {x0 - r} {y0}" if is_whole else "")
        shapes.append(f'<path d="M{x0 - r} {y0}{end}" fill="none" stroke="#ccc"/>')
    for i, (degrees, colour) in enumerate(_VIEWS):
        view = np.deg2rad(degrees)
        wo, theta = direction(np.float64(view), np.pi), _angles(view, is_whole)
        f = material.eval(direction(theta), wo) @ _LUMINANCE
        most = float(f.max())
        words = f"{degrees}°: at most {most:.3g}/sr"
        if most > 0:
            r = _RADIUS * np.sqrt(f / most)
            points = " ".join(f"{x0 + a:.1f},{y0 - b:.1f}" for a, b in zip(r * np.sin(theta), r * np.cos(theta)))
            shapes.append(f'<polygon points="{x0},{y0} {points}" fill="{colour}" fill-opacity=".18" stroke="{colour}"/>')
        if lobes & lib.FACET_DELTA:
            words = f"{degrees}°: delta lobes"
            shapes += _delta_lines(material, wo, x0, y0, colour)
        ex, ey = x0 - 1.06 * _RADIUS * np.sin(view), y0 - 1.06 * _RADIUS * np.cos(view)
        shapes.append(f'<path d="M{ex:.1f} {ey:.1f}L{x0} {y0}" stroke="{colour}" stroke-dasharray="5 4"/>')
        shapes.append(f'<text x="{8 + 138 * i}" y="{height - 8}" fill="{colour}">{words}</text>')
    title = html.escape(material.spec)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" height="{height:g}" viewBox="0 0 {_WIDTH} '
            f'{height:g}" font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>'
            f'<text x="{x0}" y="15" text-anchor="middle" fill="#222">{title}</text>{"".join(shapes)}</svg>')
