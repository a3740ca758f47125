#!/usr/bin/env python3
"""Writes core/metals.h: indices of refraction of nine metals for the three channels of linear sRGB.

    tools/make_metals.py            write the header
    tools/make_metals.py --check    compute it again and compare; exit status 1 if it differs
    tools/make_metals.py --report   print what docs/models/metals.md quotes: colours, residuals, clamped channels

The measured spectra n(wavelength), k(wavelength) lie in tools/data/refractiveindex, from refractiveindex.info (CC0 1.0):
Johnson and Christy 1972 and 1974, McPeak et al. 2015.  What the metal should look like is the colour that its
spectrum has: at each cosine c the exact reflectance R(wavelength, c), under CIE illuminant D65, seen by the CIE 1931
2-degree observer (the fits of Wyman, Sloan and Shirley, Simple analytic approximations to the CIE XYZ color matching
functions, JCGT 2(2), 2013), as linear sRGB, each channel scaled so that R = 1 is exactly (1, 1, 1).  Then, for each
channel, one pair (eta, k) whose reflectance is that channel: exactly at normal incidence, which leaves a family
with one free parameter, and of that family the least square error over c.

A channel outside [0, HIGHEST] is a colour that sRGB cannot show, or no passive conductor; it is held there first.
Needs nothing but Python.
SPDX-License-Identifier: MIT
"""

import math
import sys
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
DATA = TREE/"tools"/"data"/"refractiveindex"
HEADER = TREE/"core"/"metals.h"

# name in the text form, file, words
METALS = [
    ("Ag", "Ag_Johnson1972.yml", "silver"), ("Al", "Al_McPeak2015.yml", "aluminium"),
    ("Au", "Au_Johnson1972.yml", "gold"), ("Co", "Co_Johnson1974.yml", "cobalt"),
    ("Cr", "Cr_Johnson1974.yml", "chromium"), ("Cu", "Cu_Johnson1972.yml", "copper"),
    ("Fe", "Fe_Johnson1974.yml", "iron"), ("Ni", "Ni_Johnson1974.yml", "nickel"),
    ("Ti", "Ti_Johnson1974.yml", "titanium"),
]
HIGHEST = 0.999                # of a channel at normal incidence: below 1, which takes eta = 0
ETA_RANGE, K_MAX = (0.01, 20.0), 20.0   # of the parameters `eta` and `k`
COSINES = [(i + 0.5)/64 for i in range(64)]
DIGITS = 6                     # significant ones of the table

# CIE standard illuminant D65, 380 to 780 nm in steps of 10 (CIE 15:2004, table T.1).
D65 = [49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811,
       109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991,
       87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856,
       75.0870, 63.5927, 46.4182, 66.8054, 63.3828]
FIRST, STEP, LAST = 380, 5, 780     # wavelengths of the sums [nm]

# IEC 61966-2-1: XYZ to linear sRGB.
TO_SRGB = [(3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570)]


def lobe(x, centre, below, above):
    t = (x - centre)/(below if x < centre else above)
    return math.exp(-0.5*t*t)


def observer(nm):
    """x, y, z of the CIE 1931 2-degree observer, Wyman et al. 2013, table 1 (multi-lobe fit)."""
    return (1.056*lobe(nm, 599.8, 37.9, 31.0) + 0.362*lobe(nm, 442.0, 16.0, 26.7) - 0.065*lobe(nm, 501.1, 20.4, 26.2),
            0.821*lobe(nm, 568.8, 46.9, 40.5) + 0.286*lobe(nm, 530.9, 16.3, 31.1),
            1.217*lobe(nm, 437.0, 11.8, 36.0) + 0.681*lobe(nm, 459.0, 26.0, 13.8))


def interpolate(x, rows, column):
    for a, b in zip(rows, rows[1:]):
        if a[0] <= x <= b[0]:
            return a[column] + (b[column] - a[column])*(x - a[0])/(b[0] - a[0])
    raise ValueError(f"{x} nm is outside the measurement")


def read_spectrum(path):
    """[(wavelength in nm, n, k)]"""
    rows = []
    for line in path.read_text(encoding="utf-8").split("data: |")[1].splitlines():
        fields = line.split()
        if len(fields) == 3:
            rows.append((1000*float(fields[0]), float(fields[1]), float(fields[2])))
    return rows


def conductor(c, eta, k):
    """Unpolarised reflectance, Fresnel's equations in complex arithmetic."""
    n2 = complex(eta, k)**2
    w = (n2 - (1 - c)*(1 + c))**0.5
    s, p = abs((c - w)/(c + w))**2, abs((n2*c - w)/(n2*c + w))**2
    return 0.5*(s + p)


def channel_weights():
    """[(wavelength, the three weights)]: sums of weight times R are linear sRGB, and R = 1 is (1, 1, 1)."""
    rows = [(FIRST + 10*i, power) for i, power in enumerate(D65)]
    weights = []
    for nm in range(FIRST, LAST + 1, STEP):
        power, xyz = interpolate(nm, rows, 1), observer(nm)
        weights.append((nm, [power*sum(m*v for m, v in zip(row, xyz)) for row in TO_SRGB]))
    totals = [sum(w[channel] for _, w in weights) for channel in range(3)]
    return [(nm, [w[channel]/totals[channel] for channel in range(3)]) for nm, w in weights]


def colour_at(c, spectrum, weights):
    colour = [0.0, 0.0, 0.0]
    for (nm, w), (n, k) in zip(weights, spectrum):
        reflectance = conductor(c, n, k)
        for channel in range(3):
            colour[channel] += w[channel]*reflectance
    return colour


def k_of(eta, F0):
    """The k with which eta has the reflectance F0 at normal incidence; NaN if there is none."""
    k2 = (F0*(eta + 1)**2 - (eta - 1)**2)/(1 - F0)
    return math.sqrt(k2) if k2 >= 0 else math.nan


def misfit(log_eta, F0, curve):
    eta = math.exp(log_eta)
    k = k_of(eta, F0)
    if not k <= K_MAX:
        return math.inf
    return sum((conductor(c, eta, k) - want)**2 for c, want in zip(COSINES, curve))/len(curve)


def fit_channel(F0, curve):
    """(eta, k): F0 exactly, the curve over COSINES in the least square sense.  Scan, then golden section."""
    root = math.sqrt(F0)
    low = max(math.log((1 - root)/(1 + root)), math.log(ETA_RANGE[0]))
    high = min(math.log((1 + root)/(1 - root)), math.log(ETA_RANGE[1]))
    grid = [low + (high - low)*i/200 for i in range(201)]
    best = min(range(201), key=lambda i: misfit(grid[i], F0, curve))
    a, b = grid[max(best - 1, 0)], grid[min(best + 1, 200)]
    ratio = (math.sqrt(5) - 1)/2
    for _ in range(60):
        x, y = b - ratio*(b - a), a + ratio*(b - a)
        if misfit(x, F0, curve) <= misfit(y, F0, curve):
            b = y
        else:
            a = x
    eta = math.exp(0.5*(a + b))
    return eta, k_of(eta, F0)


class Metal:
    def __init__(self, name, file, words, weights):
        rows = read_spectrum(DATA/file)
        spectrum = [(interpolate(nm, rows, 1), interpolate(nm, rows, 2)) for nm, _ in weights]
        self.name, self.words, self.source = name, words, file.removesuffix(".yml").replace("_", ", ")
        self.F0 = colour_at(1, spectrum, weights)
        self.curves = list(zip(*(colour_at(c, spectrum, weights) for c in COSINES)))
        self.held = [min(max(F, 0.0), HIGHEST) for F in self.F0]
        self.fits = []
        for F0, curve in zip(self.held, self.curves):
            eta, k = fit_channel(F0, [min(max(F, 0.0), 1.0) for F in curve])
            self.fits.append((float(f"{eta:.{DIGITS}g}"), float(f"{k:.{DIGITS}g}")))

    def errors(self, channel):
        """Of the table's pair against the colour: root mean square, largest, of the average, at 82 degrees."""
        eta, k = self.fits[channel]
        curve = self.curves[channel]
        off = [conductor(c, eta, k) - want for c, want in zip(COSINES, curve)]
        average = sum(2*c*e for c, e in zip(COSINES, off))/len(off)
        at_82 = min(zip(COSINES, off), key=lambda pair: abs(pair[0] - math.cos(math.radians(82))))[1]
        return math.sqrt(sum(e*e for e in off)/len(off)), max(off, key=abs), average, at_82


def header_text(metals):
    out = ["/* metals.h: indices of refraction of metals, effective ones for the channels of linear sRGB.\n"
           " *\n"
           " * Written by tools/make_metals.py, which has the method and the sources: change that, not this.\n"
           " * SPDX-License-Identifier: MIT */\n"
           "#pragma once\n\n"
           "typedef struct metal {\n"
           "    double eta[3], k[3]; /* index of refraction eta + i k for red, green, blue */\n"
           "} metal;\n\n"
           "/* The names in the order of the table, as the choices of a parameter. */\n"
           f"#define METAL_NAMES \"{'|'.join(m.name for m in metals)}\"\n"
           f"#define METALS      {len(metals)}\n\n"
           "static const metal metals[METALS] = {\n"]
    for m in metals:
        eta, k = (", ".join(f"{pair[i]:.{DIGITS}g}" for pair in m.fits) for i in (0, 1))
        out.append(f"    {{{{{eta}}}, {{{k}}}}}, /* {m.name}, {m.words} */\n")
    out.append("};\n")
    return "".join(out)


def print_report(metals):
    colour = lambda values, digits: ", ".join(f"{v:.{digits}f}" for v in values)
    print("| metal | data | F0, linear sRGB | eta | k | rms | largest | average | 82 deg |\n|---|---|---|---|---|---|---|---|---|")
    for m in metals:
        errors = [m.errors(channel) for channel in range(3)]
        worst = [max((e[i] for e in errors), key=abs) for i in range(4)]
        eta, k = (", ".join(f"{pair[i]:.4g}" for pair in m.fits) for i in (0, 1))
        print(f"| {m.name} {m.words} | {m.source} | {colour(m.F0, 4)} | {eta} | {k} | "
              + " | ".join(f"{w:.4f}" for w in worst) + " |")
    print()
    for m in metals:
        for name, F0, held in zip(("red", "green", "blue"), m.F0, m.held):
            if F0 != held:
                print(f"{m.name}: {name} {F0:.4f} is outside the range of sRGB and is held at {held}")


def check(path, metals):
    """Problems of a written header; only line ends and blanks may differ, which a formatter moves."""
    if path.read_text(encoding="utf-8").split() == header_text(metals).split():
        return []
    return [f"{path.name}: not what tools/make_metals.py writes; run it"]


def all_metals():
    weights = channel_weights()
    return [Metal(name, file, words, weights) for name, file, words in METALS]


def main(arguments):
    if arguments not in ([], ["--check"], ["--report"]):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    metals = all_metals()
    if arguments == ["--report"]:
        print_report(metals)
    elif arguments == ["--check"]:
        problems = check(HEADER, metals)
        for problem in problems:
            print(problem, file=sys.stderr)
        return 1 if problems else 0
    else:
        HEADER.write_text(header_text(metals), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
