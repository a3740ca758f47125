#!/usr/bin/env python3
"""Writes the polynomials of core/kernel/kmath.h: core/kernel/kmath_f32.h and kmath_f64.h.

    tools/make_kmath.py            write both headers
    tools/make_kmath.py --check    compute them again and compare with the headers; exit status 1 if they differ
    tools/make_kmath.py --errors   print the error of every fit, nothing else

Every polynomial is the weighted minimax approximation of a function given here by its definition: Remez's exchange
algorithm in 60 digits on a grid of Chebyshev points, then the coefficients rounded to the precision of the header.
The error printed beside each is that of the rounded polynomial, evaluated exactly, in the units of its weight: the
error that it causes in the result, relative to the result.  Needs mpmath, nothing else.
SPDX-License-Identifier: MIT
"""

import struct
import sys
from pathlib import Path

import mpmath
from mpmath import mp, mpf

mp.dps = 60
KERNEL = Path(__file__).resolve().parent.parent/"core"/"kernel"


def solve_remez(f, weight, nodes, degree):
    """Coefficients of the polynomial of least maximal weight*|p - f| over the nodes (ascending)."""
    n = degree + 2
    values = [f(x) for x in nodes]
    weights = [weight(x) for x in nodes]
    last = len(nodes) - 1
    picks = [round(float(last*(1 - mp.cos(mp.pi*i/(n - 1)))/2)) for i in range(n)]
    for _ in range(30):
        rows = mp.matrix(n, n)
        right = mp.matrix(n, 1)
        for i, k in enumerate(picks):
            for j in range(degree + 1):
                rows[i, j] = nodes[k]**j
            rows[i, degree + 1] = (-1)**i/weights[k]
            right[i] = values[k]
        solution = mp.lu_solve(rows, right)
        coefficients = [solution[j] for j in range(degree + 1)]
        level = abs(solution[degree + 1])
        errors = [(mp.polyval(coefficients[::-1], x) - v)*w for x, v, w in zip(nodes, values, weights)]
        worst = max(abs(e) for e in errors)
        if worst <= level*mpf("1.01"):
            return coefficients
        picks = alternate(errors, n)
    return coefficients


def alternate(errors, n):
    """Indices of n extrema of alternating sign: the largest of each run of one sign, ends dropped until n remain."""
    runs = []
    for k, e in enumerate(errors):
        if runs and (errors[runs[-1]] > 0) == (e > 0):
            if abs(e) > abs(errors[runs[-1]]):
                runs[-1] = k
        else:
            runs.append(k)
    while len(runs) > n:
        runs.pop(0 if abs(errors[runs[0]]) < abs(errors[runs[-1]]) else -1)
    if len(runs) < n:
        raise ArithmeticError(f"{len(runs)} alternations where {n} are needed")
    return runs


def chebyshev_nodes(low, high, count):
    middle, half = (mpf(high) + low)/2, (mpf(high) - low)/2
    return [middle - half*mp.cos(mp.pi*(i + mpf(1)/2)/count) for i in range(count)]


def round_to(x, bits):
    """x rounded to nearest in `bits` bits (no exponent range)."""
    m, e = mp.frexp(mpf(x))
    return mp.ldexp(mp.nint(m*mpf(2)**bits), int(e) - bits)


# --- the functions, by definition ------------------------------------------------------------------------------------

def erfcx(x):
    return mp.exp(x*x)*mp.erfc(x)


def mills_w(x):
    """1 - sqrt(pi) x erfcx(x); the guard digits cover the cancellation, 2 x^2."""
    with mp.workdps(mp.dps + 2*max(0, int(mp.log10(1 + x))) + 10):
        return 1 - mp.sqrt(mp.pi)*x*erfcx(x)


def erfcx_scaled(x):
    return (1 + 2*x)*erfcx(x)


def mills_scaled(x):
    return (1 + 2*x*x)*mills_w(x)


def from_centre(t, c):
    """The x in [0, inf) with t = (x - c)/(x + c)."""
    return c*(1 + t)/(1 - t)


def gamma_ratio(s):
    return mp.exp(mp.loggamma(s + mpf(1)/2) - mp.loggamma(s + 1))


def stirling_ratio(x):
    """Gamma(1 + x) over its leading term sqrt(2 pi) (p/e)^p, p = x + 1/2"""
    p = x + mpf(1)/2
    return mp.exp(mp.loggamma(1 + x) - p*mp.log(p) + p)/mp.sqrt(2*mp.pi)


def erf_inverse_of(w):
    """z >= 0 with 1 - erf(z)^2 = e^-w, by Newton's method in ln erfc(z)."""
    q = mp.exp(-w)/(1 + mp.sqrt(-mp.expm1(-w)))  # 1 - erf z, without cancellation
    z = mp.sqrt(w) if w > 1 else mp.sqrt(mp.pi*w)/2
    for _ in range(60):
        step = (mp.log(mp.erfc(z)) - mp.log(q))*mp.sqrt(mp.pi)/2*erfcx(z)
        z += step
        if abs(step) < mpf(10)**-45*z:
            return z
    raise ArithmeticError(f"no convergence at w = {w}")


SMALL = mpf(10)**-12   # keeps the nodes off removable singularities


class Fit:
    def __init__(self, name, text, f, weight, low, high, degrees):
        self.name, self.text, self.f, self.weight = name, text, f, weight
        self.low, self.high, self.degrees = mpf(low), mpf(high), degrees


def make_fits(is_double):
    half_ln2 = mp.log(2)/2*(1 + mpf(2)**-10)
    s_max = (mp.sqrt(2) - 1)/(mp.sqrt(2) + 1)
    v_max = mp.tan(mp.pi/8)*(1 + mpf(2)**-20)
    r_max = mp.pi/4*(1 + mpf(2)**-10)
    erfcx_c, mills_c, inv_c, gamma_c, stirling_c = (
        round_to(CENTRES[name][is_double], 53 if is_double else 24)
        for name in ("erfcx", "mills", "erfinv", "gamma", "stirling"))
    border = mpf(ERFINV_BORDER)
    w_max = mpf("708.5" if is_double else "87.5")
    t_of = lambda s: (s - inv_c)/(s + inv_c)
    s_of = lambda t: inv_c*(1 + t)/(1 - t)
    near_start = SMALL - 1
    near_end = 1 - mpf(10)**-9   # t of x = 1e9 c: beyond, the fits are constant to all digits
    erf_near = lambda w: erf_inverse_of(w)/mp.sqrt(-mp.expm1(-w))
    return [
        Fit("exp", "(e^r - 1 - r)/r^2, |r| <= ln(2)/2", lambda r: (mp.expm1(r) - r)/r**2,
            lambda r: r**2/mp.exp(r), -half_ln2, half_ln2, (4, 10)),
        Fit("log", "(2 atanh(s) - 2 s)/s^3 of z = s^2, s <= (sqrt(2) - 1)/(sqrt(2) + 1)",
            lambda z: 2*(mp.atanh(mp.sqrt(z))/mp.sqrt(z) - 1)/z, lambda z: mp.sqrt(z)*z/(2*mp.atanh(mp.sqrt(z))),
            SMALL, s_max**2, (3, 7)),
        Fit("sin", "(sin(r) - r)/r^3 of z = r^2, r <= pi/4", lambda z: (mp.sin(mp.sqrt(z))/mp.sqrt(z) - 1)/z,
            lambda z: z*mp.sqrt(z)/mp.sin(mp.sqrt(z)), SMALL, r_max**2, (3, 6)),
        Fit("cos", "(cos(r) - 1 + r^2/2)/r^4 of z = r^2, r <= pi/4", lambda z: (mp.cos(mp.sqrt(z)) - 1 + z/2)/z**2,
            lambda z: z**2/mp.cos(mp.sqrt(z)), SMALL, r_max**2, (2, 6)),
        Fit("atan", "(atan(v) - v)/v^3 of z = v^2, v <= tan(pi/8)",
            lambda z: (mp.atan(mp.sqrt(z))/mp.sqrt(z) - 1)/z, lambda z: z*mp.sqrt(z)/mp.atan(mp.sqrt(z)),
            SMALL, v_max**2, (4, 10)),
        Fit("erf", "erf(x)/x - 1 of z = x^2, x <= 1", lambda z: mp.erf(mp.sqrt(z))/mp.sqrt(z) - 1,
            lambda z: mp.sqrt(z)/mp.erf(mp.sqrt(z)), SMALL, 1, (6, 12)),
        Fit("erfcx", "((1 + 2 x) erfcx(x) - 1)/v of t = 2 v - 1, v = x/(x + c)",
            lambda t: 2*(erfcx_scaled(from_centre(t, erfcx_c)) - 1)/(1 + t),
            lambda t: (1 + t)/2/erfcx_scaled(from_centre(t, erfcx_c)), near_start, near_end, DEGREES["erfcx"]),
        Fit("mills", "((1 + 2 x^2) W(x) - 1)/(v (1 - v)) of t = 2 v - 1, v = x/(x + c)",
            lambda t: 4*(mills_scaled(from_centre(t, mills_c)) - 1)/(1 - t*t),
            lambda t: (1 - t*t)/4/mills_scaled(from_centre(t, mills_c)), near_start, near_end, DEGREES["mills"]),
        Fit("erfinv_near", "z/erf(z) of w - ERFINV_BORDER/2, w = -ln(1 - erf(z)^2) <= ERFINV_BORDER",
            lambda x: erf_near(x + border/2), lambda x: 1/erf_near(x + border/2),
            SMALL - border/2, border/2, DEGREES["erfinv_near"]),
        Fit("erfinv_far", "z/sqrt(w) of t = (sqrt(w) - c)/(sqrt(w) + c), w >= ERFINV_BORDER",
            lambda t: erf_inverse_of(s_of(t)**2)/s_of(t), lambda t: s_of(t)/erf_inverse_of(s_of(t)**2),
            t_of(mp.sqrt(border)), t_of(mp.sqrt(w_max)), DEGREES["erfinv_far"]),
        Fit("gamma", "sqrt(s + 1/4) Gamma(s + 1/2)/Gamma(s + 1) of t = (s - c)/(s + c), s >= 1/2",
            lambda t: mp.sqrt(from_centre(t, gamma_c) + mpf(1)/4)*gamma_ratio(from_centre(t, gamma_c)),
            lambda t: 1/(mp.sqrt(from_centre(t, gamma_c) + mpf(1)/4)*gamma_ratio(from_centre(t, gamma_c))),
            (mpf(1)/2 - gamma_c)/(mpf(1)/2 + gamma_c), near_end, DEGREES["gamma"]),
        Fit("stirling", "Gamma(1 + x)/(sqrt(2 pi) (p/e)^p), p = x + 1/2, of t = (x - c)/(x + c), x >= 1",
            lambda t: stirling_ratio(from_centre(t, stirling_c)), lambda t: 1/stirling_ratio(from_centre(t, stirling_c)),
            (1 - stirling_c)/(1 + stirling_c), near_end, DEGREES["stirling"]),
    ]


# Centres c and degrees (float, double), chosen by trying: the smallest degree whose error is well below half an ulp of
# the result.  In double erfinv only starts an iteration, so that 5e-8 is enough.
ERFINV_BORDER = 5.0
CENTRES = {"erfcx": (3.0, 4.0), "mills": (2.5, 4.0), "erfinv": (3.0, 4.0), "gamma": (0.7, 0.9),
           "stirling": (0.8, 1.25)}
DEGREES = {"erfcx": (11, 24), "mills": (12, 25), "erfinv_near": (9, 9), "erfinv_far": (9, 11), "gamma": (7, 18),
           "stirling": (5, 14)}


def memoized(f):
    known = {}
    def call(x):
        if x not in known:
            known[x] = f(x)
        return known[x]
    return call


def fit_all(is_double, names=None):
    """[(fit, rounded coefficients, their weighted error, that before rounding)]"""
    bits = 53 if is_double else 24
    results = []
    for fit in make_fits(is_double):
        if names and fit.name not in names:
            continue
        degree = fit.degrees[is_double]
        f, weight = memoized(fit.f), memoized(fit.weight)
        nodes = chebyshev_nodes(fit.low, fit.high, 12*(degree + 2))
        exact = solve_remez(f, weight, nodes, degree)
        rounded = [round_to(c, bits) for c in exact]
        error = max(abs((mp.polyval(rounded[::-1], x) - f(x))*weight(x)) for x in nodes)
        fit_error = max(abs((mp.polyval(exact[::-1], x) - f(x))*weight(x)) for x in nodes)
        results.append((fit, rounded, error, fit_error))
    return results


def literal(x, is_double):
    value = float(x)
    if not is_double:
        text = f"{value:.8e}"
        assert struct.pack("f", float(text)) == struct.pack("f", value)
        return text + "f"
    text = f"{value:.16e}"
    assert float(text) == value
    return text


def horner(names, x):
    """(definition of the square or None, the formula): Horner's rule up to degree 5; above, the constant term and
    x times two interleaved chains, even and odd, which halves the latency and keeps the last addition accurate."""
    if len(names) <= 6:
        text = names[-1]
        for name in reversed(names[:-1]):
            text = f"{name} + {x}*{text if text == names[-1] else '(' + text + ')'}"
        return None, text
    tail = names[1:]
    pairs = [f"({tail[i]} + {x}*{tail[i + 1]})" if i + 1 < len(tail) else tail[i] for i in range(0, len(tail), 2)]
    text = pairs[-1]
    for pair in reversed(pairs[:-1]):
        text = f"({pair} + {x}2*{text})"
    return f"    real {x}2 = {x}*{x};\n", f"{names[0]} + {x}*{text}"


def wrap(text, indent, width=110):
    lines, line = [], ""
    for word in text.split(" "):
        if line and len(line) + 1 + len(word) > width - indent:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}" if line else word
    lines.append(line)
    return ("\n" + " "*indent).join(lines)


def cut(x, bits):
    """x towards zero in `bits` bits."""
    m, e = mp.frexp(mpf(x))
    return mp.ldexp(mp.floor(m*mpf(2)**bits), int(e) - bits)


def constants(is_double):
    bits = 53 if is_double else 24
    high_bits = 41 if is_double else 15      # leaves room for an exponent: n*LN_TWO_HIGH is exact
    part_bits = 33 if is_double else 14      # leaves room for the quadrant
    ln2_high = cut(mp.log(2), high_bits)
    pio2_high = cut(mp.pi/2, part_bits)
    pio2_middle = cut(mp.pi/2 - pio2_high, part_bits)
    largest = (2 - mpf(2)**(1 - bits))*mpf(2)**(1023 if is_double else 127)
    smallest = mpf(2)**(-1022 if is_double else -126)
    down = lambda x: cut(x, bits)
    return [
        ("LN_TWO_HIGH", ln2_high, f"ln 2 in {high_bits} bits: n*LN_TWO_HIGH is exact for any exponent n"),
        ("LN_TWO_LOW", mp.log(2) - ln2_high, "ln 2 - LN_TWO_HIGH"),
        ("EXP_LOWEST", down(mp.log(smallest)), "the last x with e^x >= REAL_MIN"),
        ("EXP_HIGHEST", down(mp.log(largest)), "the last x with e^x <= REAL_MAX"),
        ("HALF_PI_HIGH", pio2_high, f"pi/2 in parts of {part_bits} bits, and the rest"),
        ("HALF_PI_MIDDLE", pio2_middle, None),
        ("HALF_PI_LOW", mp.pi/2 - pio2_high - pio2_middle, None),
        ("TWO_PI_TAIL", 2*mp.pi - round_to(2*mp.pi, bits), "2 pi - TWO_PI"),
        ("HALF_PI_TAIL", mp.pi/2 - round_to(mp.pi/2, bits), "pi/2 - HALF_PI"),
        ("TAN_PI_8", mp.tan(mp.pi/8), None),
        ("ERFCX_CENTRE", CENTRES["erfcx"][is_double], None),
        ("MILLS_CENTRE", CENTRES["mills"][is_double], None),
        ("GAMMA_CENTRE", CENTRES["gamma"][is_double], None),
        ("STIRLING_CENTRE", CENTRES["stirling"][is_double], None),
        ("SQRT_TWO_PI_OVER_E", mp.sqrt(2*mp.pi/mp.e), None),
        ("ERFINV_BORDER", ERFINV_BORDER, None),
        ("ERFINV_CENTRE", CENTRES["erfinv"][is_double], None),
    ]


def header_text(is_double):
    bits = 53 if is_double else 24
    kind = "double" if is_double else "float"
    out = [f"/* kmath_f{64 if is_double else 32}.h: constants and polynomials of kmath.h in {kind}; include that.\n"
           " *\n"
           " * Written by tools/make_kmath.py, which has the derivation: change that, not this.  Beside each\n"
           " * polynomial stands the function that it approximates and the error it causes in the result, relative,\n"
           f" * in units of 2^-{bits}.\n"
           " * SPDX-License-Identifier: MIT */\n"
           "#pragma once\n\n#include \"real.h\"\n\n"]
    for name, value, text in constants(is_double):
        comment = f" /* {text} */" if text else ""
        number = literal(round_to(value, bits), is_double)
        out.append(f"#define {name + ' ':<15}{'(' + number + ')' if number.startswith('-') else number}{comment}\n")
    for fit, rounded, error, _ in fit_all(is_double):
        x = fit.text.split(" of ")[1][0] if " of " in fit.text else "r"
        names = [f"c{k}" for k in range(len(rounded))]
        out.append(f"\n/* {fit.text}: {mp.nstr(error*mpf(2)**bits, 2)} */\n")
        out.append(f"KERNEL real poly_{fit.name}(real {x})\n{{\n")
        for name, c in zip(names, rounded):
            out.append(f"    real {name} = {literal(c, is_double)};\n")
        square, body = horner(names, x)
        if square:
            out.append(square)
        out.append(f"    return {wrap(body, 11)};\n}}\n")
    return "".join(out)


def main(arguments):
    if arguments == ["--errors"]:
        for is_double in (False, True):
            for fit, rounded, error, fit_error in fit_all(is_double):
                unit = mpf(2)**(53 if is_double else 24)
                terms = max(sum(abs(c*x**k) for k, c in enumerate(rounded))/abs(mp.polyval(rounded[::-1], x))
                            for x in chebyshev_nodes(fit.low, fit.high, 9))
                print(f"{'f64' if is_double else 'f32'} {fit.name:12} degree {len(rounded) - 1:2}  "
                      f"error {mp.nstr(fit_error, 3):>10} = {mp.nstr(fit_error*unit, 3):>8} units, "
                      f"rounded {mp.nstr(error*unit, 3):>8}, condition {mp.nstr(terms, 3)}", flush=True)
        return 0
    if arguments not in ([], ["--check"]):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    status = 0
    for is_double in (False, True):
        path = KERNEL/f"kmath_f{64 if is_double else 32}.h"
        text = header_text(is_double)
        if not arguments:
            path.write_text(text)
        elif path.read_text().split() != text.split():  # `make format` may move line ends
            print(f"{path.name} differs from what tools/make_kmath.py computes; run it", file=sys.stderr)
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
