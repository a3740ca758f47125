/* kmath.h: the elementary and special functions of the kernels, the same names in float and double.
 *
 * Pure, branch free (`?:` only) and without libm, so that gcc and clang vectorise a loop over them at any
 * width.  Only + - * / sqrt, comparisons and integer operations are used, each rounded once: results are the
 * same bits on every instruction set, provided that the build says -ffp-contract=off and no -ffast-math.
 *
 * Errors are the largest found by tests/core/test_kmath*.c and tools/make_kmath.py, in ulp of the exact
 * result: (float / double).  They hold for results that are normal numbers.  Subnormal results may be 0.
 * No argument gives a trap or undefined behaviour; a NaN argument gives NaN or an unspecified number, except where
 * stated.  The polynomials are in kmath_f32.h and kmath_f64.h, written by tools/make_kmath.py.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <string.h>

#include "real.h"

#if FACET_REAL_IS_DOUBLE
#include "kmath_f64.h"
#else
#include "kmath_f32.h"
#endif

#include "kmath_basic.h"
#include "kmath_beta.h"
#include "kmath_erf.h"
#include "kmath_exp.h"
#include "kmath_trig.h"
