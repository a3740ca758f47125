"""Pearson's test of counts against what is expected of them.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import math

import numpy as np

from ._arrays import Array


def upper_gamma(a: float, x: float) -> float:
    """Q(a, x) = Gamma(a, x)/Gamma(a), the regularised upper incomplete gamma function; a > 0, x >= 0.

    The series of P below x = a + 1, Legendre's continued fraction by Lentz's method above; within 1e-12 of Q.
    """
    if x <= 0:
        return 1.0
    if math.isinf(x):
        return 0.0
    front = math.exp(a * math.log(x) - x - math.lgamma(a))
    if x < a + 1:
        term = total = 1 / a
        k = a
        while term > total * 1e-17:
            k += 1
            term *= x / k
            total += term
        return 1 - front * total
    b = x + 1 - a
    c, d = 1e300, 1 / b
    h = d
    for i in range(1, 100000):
        b += 2
        d = 1 / (b - i * (i - a) * d)
        c = b - i * (i - a) / c
        h *= c * d
        if abs(c * d - 1) < 1e-15:
            break
    return front * h


def chi_square(counts: Array, expected: Array, least: float = 5.0) -> tuple[float, float, int]:
    """(p, statistic, degrees of freedom); cells that expect less than `least` are pooled, smallest first."""
    groups: list[list[float]] = [[0.0, 0.0]]
    for k in np.argsort(expected, kind="stable"):
        if groups[-1][1] >= least:
            groups.append([0.0, 0.0])
        groups[-1][0] += float(counts[k])
        groups[-1][1] += float(expected[k])
    statistic = 0.0
    for counted, awaited in groups:
        if awaited > 0:
            statistic += (counted - awaited) ** 2 / awaited
        elif counted:
            statistic = math.inf  # where none can be
    freedom = len(groups) - 1
    return (upper_gamma(freedom / 2, statistic / 2) if freedom else 1.0), statistic, freedom
