/* real.h: the number type of the kernels, small vectors of it, and named constants.
 *
 * A translation unit is built in one precision: float, or double when it says
 * `#define FACET_REAL_IS_DOUBLE 1` before its first include.  Everything here is a pure function of
 * values without branches, so that a loop over it vectorises.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <float.h>
#include <stdint.h>

#ifndef FACET_REAL_IS_DOUBLE
#define FACET_REAL_IS_DOUBLE 0
#endif

/* Not every translation unit calls every kernel; an unused one is no mistake.  Always inlined where anything is,
 * because a call that is left in a loop keeps the loop from vectorising. */
#ifdef __OPTIMIZE__
#define KERNEL static inline __attribute__((unused, always_inline))
#else
#define KERNEL static inline __attribute__((unused))
#endif

/* In files of loops over batches (batch_text.h sets FACET_LOOPS) a large kernel is inlined too; elsewhere one copy will
 * do. */
#ifdef FACET_LOOPS
#define LARGE_KERNEL KERNEL
#else
#define LARGE_KERNEL static __attribute__((unused, noinline))
#endif

/* Before a loop of constant length, which is unrolled: left as a loop, it keeps the one around from vectorising, and
 * the arrays that it reads from registers. */
#if !defined(__OPTIMIZE__)
#define UNROLL
#elif defined(__clang__)
#define UNROLL _Pragma("clang loop unroll(full)")
#else
#define UNROLL _Pragma("GCC unroll 127")
#endif

#if FACET_REAL_IS_DOUBLE
typedef double real;
typedef uint64_t real_bits; /* unsigned integer of the same width */
#define REAL_MAX     DBL_MAX
#define REAL_MIN     DBL_MIN /* smallest positive normal number */
#define REAL_EPSILON DBL_EPSILON
#else
typedef float real;
typedef uint32_t real_bits;
#define REAL_MAX     FLT_MAX
#define REAL_MIN     FLT_MIN
#define REAL_EPSILON FLT_EPSILON
#endif

typedef struct {
    real x, y;
} real2;
typedef struct {
    real x, y, z;
} real3;

/* Constants that binary cannot hold; the cast rounds each once to the precision of the build. */
#define PI           ((real)3.14159265358979323846264338328)
#define TWO_PI       ((real)6.28318530717958647692528676656)
#define FOUR_PI      ((real)12.5663706143591729538505735331)
#define HALF_PI      ((real)1.57079632679489661923132169164)
#define QUARTER_PI   ((real)0.785398163397448309615660845820)
#define INV_PI       ((real)0.318309886183790671537767526745)
#define INV_TWO_PI   ((real)0.159154943091895335768883763373)
#define INV_FOUR_PI  ((real)0.0795774715459476678844418816863)
#define SQRT_PI      ((real)1.77245385090551602729816748334)
#define HALF_SQRT_PI ((real)0.886226925452758013649083741671)
#define INV_SQRT_PI  ((real)0.564189583547756286948079451561)
#define SQRT_TWO     ((real)1.41421356237309504880168872421)
#define INV_SQRT_TWO ((real)0.707106781186547524400844362105)
#define LN_TWO       ((real)0.693147180559945309417232121458)
#define INV_LN_TWO   ((real)1.44269504088896340735992468100)

KERNEL real2 make2(real x, real y)
{
    real2 v;
    v.x = x;
    v.y = y;
    return v;
}

KERNEL real3 make3(real x, real y, real z)
{
    real3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

KERNEL real3 splat3(real s) { return make3(s, s, s); }

KERNEL real3 add3(real3 a, real3 b) { return make3(a.x + b.x, a.y + b.y, a.z + b.z); }
KERNEL real3 sub3(real3 a, real3 b) { return make3(a.x - b.x, a.y - b.y, a.z - b.z); }
KERNEL real3 mul3(real3 a, real3 b) { return make3(a.x*b.x, a.y*b.y, a.z*b.z); }
KERNEL real3 scale3(real s, real3 a) { return make3(s*a.x, s*a.y, s*a.z); }
KERNEL real3 neg3(real3 a) { return make3(-a.x, -a.y, -a.z); }

/* a + s b */
KERNEL real3 madd3(real3 a, real s, real3 b) { return make3(a.x + s*b.x, a.y + s*b.y, a.z + s*b.z); }

KERNEL real dot3(real3 a, real3 b) { return a.x*b.x + a.y*b.y + a.z*b.z; }

KERNEL real3 cross3(real3 a, real3 b)
{
    return make3(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}

/* Square root, rounded correctly by IEEE 754; NaN below zero. */
KERNEL real ksqrt(real x)
{
#if FACET_REAL_IS_DOUBLE
    return __builtin_sqrt(x);
#else
    return __builtin_sqrtf(x);
#endif
}

/* |a|, without care for overflow: components below 1e19 (float), 1e154 (double) */
KERNEL real length3(real3 a) { return ksqrt(dot3(a, a)); }

/* a/|a|; the zero vector gives (0,0,1), the shading normal, so that no NaN arises */
KERNEL real3 normalize3(real3 a)
{
    real n2   = dot3(a, a);
    real s    = 1.0f/ksqrt(n2 > 0.0f ? n2 : 1.0f);
    real3 v   = scale3(s, a);
    real zero = n2 > 0.0f ? v.z : 1.0f;
    return make3(v.x, v.y, zero);
}

/* a (1-t) + b t; exactly a at t = 0 and b at t = 1 */
KERNEL real mix(real a, real b, real t) { return a*(1.0f - t) + b*t; }
KERNEL real3 mix3(real3 a, real3 b, real t) { return make3(mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)); }

/* Componentwise choice: a where `first` is true, else b */
KERNEL real3 select3(int first, real3 a, real3 b)
{
    return make3(first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z);
}

/* Largest component, and the mean (the average over a colour's channels) */
KERNEL real max_of3(real3 a)
{
    real m = a.x > a.y ? a.x : a.y;
    return m > a.z ? m : a.z;
}

KERNEL real mean3(real3 a) { return (a.x + a.y + a.z)*(real)0.333333333333333333333333333333; }
