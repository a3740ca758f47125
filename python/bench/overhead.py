#!/usr/bin/env python3
"""How many times as long 10^6 pairs of directions take through the package as in C: the tables of docs/python.md.

    python3 python/bench/overhead.py [SPEC ...]

C is the batch function itself, without checks, on columns: arrays of all x, all y and all z.  The package gets columns,
which it checks or not, and rows, arrays (n, 3).  Both write to arrays that are there already: `fresh` is the same call that
makes new ones.  Calls take turns, so that what else runs disturbs all alike, each finds the caches full of something else, and the least time of
each counts.  One thread.

SPDX-License-Identifier: MIT
"""
import sys
import time

import numpy as np

import facet
from facet._library import ffi, lib

N, REPEATS = 1_000_000, 31
SPECS = ["lambert", "phong", "beckmann alpha=.3", "ggx alpha=.3", "ggx alpha_x=.1 alpha_y=.4", "ggx alpha=.3 energy=multi",
         "gtr alpha=.1 gamma=1.5", "glass alpha=.3", "metallic_roughness", "ward", "cs500", "disney", "vray"]


def directions(rng):
    """All x, then all y, then all z, as an array (N, 3)."""
    w = rng.standard_normal((3, N)).astype(np.float32)
    w[2] = np.abs(w[2])
    return (w / np.sqrt((w * w).sum(axis=0))).T


def best(calls):
    """The least time of each call [s]."""
    least, other = [np.inf] * len(calls), np.zeros(16 << 20, np.float32)
    for _ in range(REPEATS):
        for k, call in enumerate(calls):
            other += 1
            start = time.perf_counter()
            call()
            least[k] = min(least[k], time.perf_counter() - start)
    return least


def pointer(a):
    return ffi.cast("float *", a.__array_interface__["data"][0])


def columns_of(a):
    """Pointers to x, y and z."""
    return [pointer(a[:, k]) for k in range(3)]


def main():
    rng = np.random.default_rng(1)
    wi, wo, u = directions(rng), directions(rng), rng.random((3, N), np.float32).T
    rows_i, rows_o, rows_u = (np.ascontiguousarray(a) for a in (wi, wo, u))
    i, o, x = columns_of(wi), columns_of(wo), columns_of(u)
    f, p = np.zeros((3, N), np.float32).T, np.zeros(N, np.float32)
    rows_f = np.zeros((N, 3), np.float32)
    rgb = columns_of(f)
    drawn = np.zeros((7, N), np.float32)
    samples = ffi.new("facet_samples *", [pointer(row) for row in drawn])[0]
    kept = facet.Sample(drawn[0:3].T, drawn[3], drawn[4:7].T)
    rows_kept = facet.Sample(np.zeros((N, 3), np.float32), p, np.zeros((N, 3), np.float32))
    verbs = {
        "eval": (lambda m: lib.facet_bsdf_eval_batch(m._bsdf, N, i, o, rgb), lambda m: m.eval(wi, wo, out=f),
                 lambda m: m.eval(wi, wo, out=f, check_inputs=False), lambda m: m.eval(rows_i, rows_o, out=rows_f),
                 lambda m: m.eval(wi, wo)),
        "pdf": (lambda m: lib.facet_bsdf_pdf_batch(m._bsdf, N, i, o, pointer(p)), lambda m: m.pdf(wi, wo, out=p),
                lambda m: m.pdf(wi, wo, out=p, check_inputs=False), lambda m: m.pdf(rows_i, rows_o, out=p),
                lambda m: m.pdf(wi, wo)),
        "eval_pdf": (lambda m: lib.facet_bsdf_eval_pdf_batch(m._bsdf, N, i, o, rgb, pointer(p)),
                     lambda m: m.eval_pdf(wi, wo, out=(f, p)),
                     lambda m: m.eval_pdf(wi, wo, out=(f, p), check_inputs=False),
                     lambda m: m.eval_pdf(rows_i, rows_o, out=(rows_f, p)),
                     lambda m: m.eval_pdf(wi, wo)),
        "sample": (lambda m: lib.facet_bsdf_sample_batch(m._bsdf, N, o, x, samples), lambda m: m.sample(wo, u, out=kept),
                   lambda m: m.sample(wo, u, out=kept, check_inputs=False),
                   lambda m: m.sample(rows_o, rows_u, out=rows_kept), lambda m: m.sample(wo, u)),
    }
    print("| material | call | C [ns] | columns | unchecked | rows (n, 3) | fresh |\n|---|---|---|---|---|---|---|")
    for spec in sys.argv[1:] or SPECS:
        m = facet.material(spec)
        for verb, calls in verbs.items():
            c, columns, unchecked, rows, fresh = best([lambda call=call: call(m) for call in calls])
            print(f"| `{spec}` | {verb} | {1e9 * c / N:.2f} | {columns / c:.2f} | {unchecked / c:.2f} | {rows / c:.2f} | {fresh / c:.2f} |")


if __name__ == "__main__":
    main()
