/* gtr.h: generalised Trowbridge-Reitz (GTR) normals of any gamma in (0, 20], alpha in [1e-4, 1]: D, and Smith's
 * masking exactly, from polynomials prepared once per material.
 *
 * [disney] Burley, Physically based shading at Disney, 2012, appendix B: D, its normalisation and sampling.
 * [vray]   Dimov, Deriving the Smith shadowing function G1 for gamma in (0, 4], 2015.
 * Derivations, errors and timings: docs/models/gtr.md.
 *
 * With s(t) = (t + alpha^2)/(t + 1), t = tan^2(theta), the density of slopes is a power of s.  Masking has the form of
 * GGX's with an effective roughness A that varies slowly with the direction v: with mu = cot(theta_v),
 *     cos (1 + Lambda) = (cos + sqrt(cos^2 + A sin^2))/2,   A = 4 T (T + mu),   T = mu Lambda,
 * and sqrt(A) is a polynomial of ln s(mu^2), or A one of 1/s where gamma is large; A = alpha^2 for gamma = 2.
 * Anisotropy stretches the slopes of an isotropic GTR of alpha = sqrt(alpha_x alpha_y) by (alpha_x, alpha_y)/alpha, for
 * which everything stays exact; it is [disney, 10] for gamma = 2.  Disney's own anisotropic D for other gammas can be
 * chosen instead: its tails are not stretched, and its masking is not known, so that the stretched one stands in, for
 * sampling too.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "gtr_terms.h"
#include "kmath.h"
#include "slopes.h"

/* What the normals do where alpha_x and alpha_y differ; the order of the choices in the parameter table. */
#define GTR_STRETCHED 0
#define GTR_DISNEY    1

/* A power e^x of more than this is only ever used in ln(1 + u e^x), where u is a uniform number. */
#define GTR_LARGEST_POWER 80.0f

/* gamma - 1 in place of 0: (e^((gamma - 1) x) - 1)/(gamma - 1) is x then, without a choice.  And alpha in place of 1,
 * where 1 - alpha^2 cancels from everything. */
#define GTR_LEAST_EXCESS ((real)1e-16)
#define GTR_ROUGHEST     (1 - REAL_EPSILON)

typedef struct gtr_shape {
    int form;                  /* GTR_LOGARITHM, GTR_QUOTIENT */
    int count;                 /* terms that are not 0; a multiple of 4 */
    int anisotropy;            /* GTR_STRETCHED, GTR_DISNEY */
    int is_isotropic;          /* whether nothing is stretched */
    real alpha, gamma;         /* of the isotropic GTR before the stretch */
    real stretch_x, stretch_y; /* their product is 1 */
    real excess;               /* gamma - 1, but not 0 */
    real log_range;            /* L = -ln(alpha^2) */
    real k0;                   /* 1 - alpha^2 */
    real survival;             /* 1/(e^(-excess L) - 1) */
    real peak;                 /* D at the normal */
    real disney_peak;          /* ... where the anisotropy is Disney's */
    real T0;                   /* T at grazing: the mean of |slope|/2 */
    real scale, offset;        /* the variable of the polynomial is scale v + offset, v by the form */
#if FACET_REAL_IS_DOUBLE
    real terms[GTR_PIECES][GTR_TERMS]; /* A in GTR_PIECES equal parts of ln s */
#else
    real terms[GTR_TERMS]; /* sqrt(A) or A by the form */
#endif
    real guess_scale;      /* the polynomial guess[] has the variable guess_scale ln(T0/T) - 1 in [-1, 1] */
    real guess_slope;      /* ... and goes on with this slope by ln(T0/T) */
    real guess[GTR_GUESS]; /* ln((T + mu)/T0), from which the inverse of T(mu) is found */
} gtr_shape;

/* x, y of the direction v in the space where the normals are isotropic; z stays. */
KERNEL real3 gtr_unstretch_direction(gtr_shape g, real3 v) { return make3(g.stretch_x*v.x, g.stretch_y*v.y, v.z); }

/* 1 + k0/alpha^2 sin^2 after the unstretch, and the square of cos_unstretched/cos over the squared length of m. */
KERNEL real2 gtr_base(real3 m, gtr_shape g)
{
    real x    = m.x*g.stretch_y;
    real y    = m.y*g.stretch_x;
    real sin2 = g.is_isotropic ? m.x*m.x + m.y*m.y : x*x + y*y;
    real inv  = 1/kmax(sin2 + m.z*m.z, REAL_MIN);
    return make2(1 + g.k0/(g.alpha*g.alpha)*(sin2*inv), g.is_isotropic ? (real)1 : dot3(m, m)*inv);
}

/* D at the direction of m, 1/sr; m need not be a unit vector.  [disney, 1, 4, 8]:
 *     D = c/(1 + (alpha^2 - 1) cos^2)^gamma.
 * Departure: D = D(n) (1 + k0/alpha^2 sin^2)^-gamma with sin^2 from the vector, which neither overflows nor cancels.
 * The stretch divides the slopes and multiplies D by (cos_unstretched/cos)^4.  ratio: the second part of gtr_base;
 * exponent: gamma times the logarithm of the first. */
KERNEL real gtr_D_of(real cos, gtr_shape g, real ratio, real exponent)
{
    return cos > 0 ? kexp_fall(g.peak*ratio*ratio, exponent) : (real)0;
}

KERNEL real gtr_D(real3 m, gtr_shape g)
{
    real2 base = gtr_base(m, g);
    return gtr_D_of(m.z, g, base.y, g.gamma*klog_quick(base.x));
}

/* [disney, 10] with any exponent: the same core, tails not stretched. */
KERNEL real gtr_disney_D(real3 m, gtr_shape g)
{
    real2 base    = gtr_base(m, g);
    real exponent = g.gamma*klog(base.x/base.y);
    return m.z > 0 ? kexp_fall(g.disney_peak, exponent) : (real)0;
}

/* 1/s at a direction with these squares of the cosine and the sine, of any common scale. */
KERNEL real gtr_inverse_s(gtr_shape g, real cos2, real sin2)
{
    return (cos2 + sin2)/(cos2 + g.alpha*g.alpha*sin2);
}

/* The polynomial's variable at 1/s; A there, and with its derivative by the variable.  count: at least g.count; the
 * further terms are 0. */
#if FACET_REAL_IS_DOUBLE
/* In double A takes several polynomials; it is not evaluated in vectors, where looking one up would cost. */
KERNEL real gtr_variable(gtr_shape g, real inverse)
{
    return kclamp(g.scale*klog(inverse) + g.offset, 0, GTR_PIECES);
}

KERNEL real2 gtr_A_and_slope(gtr_shape g, real x)
{
    int piece  = (int)kmin(kfloor(x), GTR_PIECES - 1);
    real local = 2*(x - piece) - 1;
    real A     = 0;
    real slope = 0;
    for (int k = GTR_TERMS - 1; k >= 0; k--) {
        slope = A + local*slope;
        A     = g.terms[piece][k] + local*A;
    }
    return make2(kmax(A, 0), 2*slope);
}

KERNEL real gtr_A(gtr_shape g, real x) { return gtr_A_and_slope(g, x).x; }
#else
KERNEL real gtr_variable(gtr_shape g, real inverse)
{
    return kclamp(g.scale*(g.form == GTR_LOGARITHM ? klog_quick(inverse) : inverse) + g.offset, -1, 1);
}

/* Every fourth term, as a polynomial of x^4. */
KERNEL real gtr_fourths(real t0, real t4, real t8, real t12, real t16, real x4, int count)
{
    real p12 = count > 16 ? t12 + x4*t16 : t12;
    real p8 = count > 12 ? t8 + x4*p12 : t8;
    real p4 = count > 8 ? t4 + x4*p8 : t4;
    return t0 + x4*p4;
}

/* sqrt(A) or A, by the form. */
KERNEL real gtr_polynomial(gtr_shape g, real x, int count)
{
    real x2 = x*x;
    real x4 = x2*x2;
    real p0 = gtr_fourths(g.terms[0], g.terms[4], g.terms[8], g.terms[12], g.terms[16], x4, count);
    real p1 = gtr_fourths(g.terms[1], g.terms[5], g.terms[9], g.terms[13], g.terms[17], x4, count);
    real p2 = gtr_fourths(g.terms[2], g.terms[6], g.terms[10], g.terms[14], g.terms[18], x4, count);
    real p3 = gtr_fourths(g.terms[3], g.terms[7], g.terms[11], g.terms[15], g.terms[19], x4, count);
    return (p0 + x*p1) + x2*(p2 + x*p3);
}

KERNEL real gtr_A_by(gtr_shape g, real x, int count)
{
    real value = gtr_polynomial(g, x, count);
    return g.form == GTR_LOGARITHM ? value*value : kmax(value, 0);
}

KERNEL real gtr_A(gtr_shape g, real x) { return gtr_A_by(g, x, GTR_TERMS); }

KERNEL real2 gtr_A_and_slope(gtr_shape g, real x)
{
    real slope = 0;
    UNROLL
    for (int k = GTR_TERMS - 1; k > 0; k--) slope = k*g.terms[k] + x*slope;
    return make2(gtr_A(g, x), slope*(g.form == GTR_LOGARITHM ? 2*gtr_polynomial(g, x, GTR_TERMS) : (real)1));
}
#endif

/* dA/d(ln s) from dA/dx: x is linear in ln 1/s, or in 1/s. */
KERNEL real gtr_A_slope(gtr_shape g, real slope, real inverse)
{
    return -g.scale*slope*(g.form == GTR_LOGARITHM ? (real)1 : inverse);
}

/* The same at the direction v, a unit vector. */
KERNEL real gtr_inverse_s_towards(real3 v, gtr_shape g)
{
    real3 w          = gtr_unstretch_direction(g, v);
    real cos2        = v.z*v.z;
    real stretched   = gtr_inverse_s(g, cos2, w.x*w.x + w.y*w.y);
    real unstretched = 1/(g.alpha*g.alpha + g.k0*cos2);
    return g.is_isotropic ? unstretched : stretched;
}

/* The polynomial's variable there. */
KERNEL real gtr_variable_at(real3 v, gtr_shape g) { return gtr_variable(g, gtr_inverse_s_towards(v, g)); }

/* The projected area of the microfacets that face v, cos (1 + Lambda); v.z > 0. */
KERNEL real gtr_sigma_of(real3 v, gtr_shape g, real A)
{
    real3 w   = gtr_unstretch_direction(g, v);
    real cos2 = v.z*v.z;
    real sin2 = g.is_isotropic ? 1 - cos2 : w.x*w.x + w.y*w.y;
    return 0.5f*(v.z + ksqrt(cos2 + A*sin2));
}

KERNEL real gtr_sigma(real3 v, gtr_shape g) { return gtr_sigma_of(v, g, gtr_A(g, gtr_variable_at(v, g))); }
