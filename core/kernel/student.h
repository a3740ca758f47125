/* student.h: Student's distribution of slopes along one axis, P2(q) = (1 + q^2)^(-p-1/2)/B(1/2, p), p >= 1.
 *
 * It is the marginal of Phong's slopes, P22(r) = p/pi (1 + r^2)^(-p-1), and, scaled by sqrt(1 + q^2) and with p + 1/2
 * for p, their distribution across the slope q.  With x = 1/(1 + q^2), z = 1 - x, L = -ln x, its two-sided tail is the
 * incomplete beta function I_x(p, 1/2).  Here it is raised to P = p + SHIFT by the recurrence
 *     I_x(p, 1/2) = I_x(p + 1, 1/2) + x^p sqrt(z)/(p B(1/2, p)),
 * all terms positive, where with P' = P - 1/4 the series of sqrt(y/2/sinh(y/2)) = 1 - y^2/48 + ... gives
 *     I_x(P, 1/2) ~ Int_L^inf exp(-P' y) y^(-1/2) (1 - y^2/48 + ...) dy,
 * incomplete gamma functions: erfc(sqrt(P' L)) and a correction of order 1/P'^2.  Derivation: docs/models/phong.md.
 *
 * [wallace59] Wallace, Bounds on normal approximations to Student's and the chi-square distributions, 1959.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "real.h"
#include "slopes.h"

/* With so many steps of the recurrence, the series, cut after 1 + TERMS terms, is exact to rounding for all p >= 1. */
#if FACET_REAL_IS_DOUBLE
#define STUDENT_SHIFT        20
#define STUDENT_STEPS_ALONG  5
#define STUDENT_STEPS_ACROSS 2
#else
#define STUDENT_SHIFT        5
#define STUDENT_STEPS_ALONG  2
#define STUDENT_STEPS_ACROSS 1
#endif

/* The series of sqrt(y/2/sinh(y/2)) in y^2. */
#define SINH_SERIES_1 ((real)-0.020833333333333333333333) /* -1/48 */
#define SINH_SERIES_2 ((real)0.000390625)                 /* 1/2560 */
#define SINH_SERIES_3 ((real)-7.8796709656084656084656e-6)
#define SINH_SERIES_4 ((real)1.6967665791721781305115e-7)
#define WALLACE_96    96.0f

typedef struct student {
    real p;            /* half of the degrees of freedom */
    real beta_inverse; /* 1/B(1/2, p) */
} student;

KERNEL student student_of(real p)
{
    student s;
    s.p            = p;
    s.beta_inverse = p*kgamma_half_ratio(p)*INV_SQRT_PI;
    return s;
}

/* What the functions of a slope q have in common; q^2 in [2^-120, 2^120]. */
typedef struct student_point {
    real x, root_x, root_z; /* z = q^2/(1 + q^2) */
    real x_p;               /* x^p */
    real w, root_w, e;      /* w = P' L, e^-w */
    real norm;              /* what the series gives at w = 0: A0 */
    real tail;              /* the correction of the tail over sqrt(w) */
    real lambda;            /* ... and of Lambda, times sqrt(w) */
} student_point;

/* One term of the corrections, from the last one to the first: A_j = c_j + A_(j+1) v (2j + 3/2)(2j + 1/2), c_j the
 * series' coefficient and v = 1/P'^2; tail = sum of A_(j+1) L^2j (2j + 3/2 + w), lambda = sum of
 * A_(j+1) L^2j (2j + 3/2)(2j + 1/2 + w). */
KERNEL student_point student_term(student_point a, int j, real c, real v, real L2)
{
    student_point b = a;
    b.tail          = a.tail*L2 + a.norm*((2*j + 1.5f) + a.w);
    b.lambda        = a.lambda*L2 + a.norm*(2*j + 1.5f)*((2*j + 0.5f) + a.w);
    b.norm          = c + a.norm*(v*((2*j + 1.5f)*(2*j + 0.5f)));
    return b;
}

KERNEL student_point student_at(student s, real q)
{
    real q2 = q*q;
    real L  = klog1p(q2);
    real L2 = L*L;
    real P  = s.p + (STUDENT_SHIFT - 0.25f);
    real v  = 1/(P*P);
    real x  = 1/(1 + q2);
    real x4 = x*x*x*x;
    student_point a;
    a.x      = x;
    a.root_x = ksqrt(x);
    a.root_z = kabs(q)*a.root_x;
    a.x_p    = kexp(-s.p*L);
    a.w      = P*L;
    a.root_w = ksqrt(a.w);
    /* x^(SHIFT - 1/4) */
    a.e      = a.x_p*((STUDENT_SHIFT == 20 ? x4*(x4*x4*x4*x4) : x*x4)/ksqrt(a.root_x));
    a.tail   = 0;
    a.lambda = 0;
#if FACET_REAL_IS_DOUBLE
    a.norm = SINH_SERIES_4;
    a      = student_term(a, 3, SINH_SERIES_3, v, L2);
    a      = student_term(a, 2, SINH_SERIES_2, v, L2);
#else
    a.norm = SINH_SERIES_2;
#endif
    a        = student_term(a, 1, SINH_SERIES_1, v, L2);
    a        = student_term(a, 0, 1, v, L2);
    a.tail   = a.tail*v;
    a.lambda = a.lambda*v;
    return a;
}

/* The sum over j < SHIFT of the product of x (p + i + shift)/(p + i + 1) over i < j. */
LARGE_KERNEL real student_sum(real p, real x, real shift)
{
    real sum = 1;
    UNROLL
    for (int j = STUDENT_SHIFT - 1; j > 0; j--) sum = 1 + sum*x*((p + (j - 1) + shift)/(p + j));
    return sum;
}

/* P2(q) */
KERNEL real student_density(student s, student_point a) { return s.beta_inverse*a.x_p*a.root_x; }

/* P(|slope| > |q|), absolute error 5e-7 / 4e-15. */
KERNEL real student_tail(student s, student_point a)
{
    real raised = a.e*(kerfcx(a.root_w) + INV_SQRT_PI*a.root_w*a.tail/a.norm);
    return raised + s.beta_inverse*a.x_p*a.root_z/s.p*student_sum(s.p, a.x, 0.5f);
}

/* The integral of q' P2(q') over q' > q. */
KERNEL real student_moment(student s, student_point a)
{
    return 0.5f*s.beta_inverse*a.x_p/(a.root_x*(s.p - 0.5f));
}

/* Lambda(q) = (x^p/(b sqrt(z) B) - I_x(p, 1/2))/2, b = p - 1/2, q > 0 the cotangent.  The same recurrence and series,
 * with what cancels taken out by hand, so that its terms are positive or small. */
LARGE_KERNEL real student_Lambda(student s, student_point a)
{
    real P      = s.p + (STUDENT_SHIFT - 0.25f);
    real excess = 0.25f/((P - 0.25f)*ksqrt(P))*ksqrt(a.root_x)/a.root_z;
    real raised = a.e*INV_SQRT_PI*((kmills_w(a.root_w) - a.lambda/a.norm)/a.root_w + excess/a.norm);
    real sum    = s.beta_inverse*a.x_p/(2*(s.p - 0.5f)*s.p*a.root_z)*student_sum(s.p, a.x, -0.5f);
    return 0.5f*(raised + sum);
}

/* A slope whose tail P(slope > q) is nearly that of the Gaussian number g, P(N > sqrt(2) g): the root of
 * I_x(p, 1/2) = erfc(g) to two orders in 1/p [after wallace59], with the right limit for large g. */
KERNEL real student_of_gaussian(student s, real g)
{
    real P      = s.p - 0.25f;
    real second = (1.5f + g*g)/(WALLACE_96*P*P);
    real root_w = g*(1 - second/(1 + 8*s.p*second));
    return kcopysign(ksqrt(kexpm1(root_w*root_w/P)), g);
}

/* The slope q with P(slope > q) = u.  Error of u: 4e-7 / 1e-15. */
LARGE_KERNEL real student_quantile(student s, real u)
{
    real tail = kclamp(2*kmin(u, 1 - u), 0.5f*REAL_EPSILON, 1);
    real q    = student_of_gaussian(s, kerfcinv(tail));
    UNROLL
    for (int i = 0; i < STUDENT_STEPS_ACROSS; i++) {
        student_point a = student_at(s, q);
        real curvature  = -(2*s.p + 1)*q*a.x;
        q += halley_step(0.5f*(student_tail(s, a) - tail), student_density(s, a), curvature);
    }
    return u > 0.5f ? -q : q;
}

/* tan(2 arcsin(y) - atan(mu)): the slope below which a multiple of (1 + q^2)^(-3/2) leaves a visible share of y^2. */
KERNEL real student_bound(real mu, real y)
{
    real bounded = kmin(y, 1);
    real sin     = 2*bounded*ksqrt((1 - bounded)*(1 + bounded));
    real cos     = 1 - 2*bounded*bounded;
    real below   = cos + mu*sin;
    return below > 0 ? kmax((sin - mu*cos)/kmax(below, REAL_MIN), -mu) : REAL_MAX;
}

/* The slope q towards a viewer of cotangent mu, of a visible normal: its density is proportional to (mu + q)+ P2(q), so
 * that with F(q) = mu P(slope > q) + Int_q^inf q' P2 dq' it solves F(q) = u F(-mu).  The start lies between the
 * solutions for mu = 0, (1 + q^2)^(1/2 - p) = u, and for large mu, the quantile of u times the tail above -mu, and
 * between the bounds that P2(mu) <= P2 <= P2(0) gives for q near -mu. */
LARGE_KERNEL real student_visible_slope(student s, real mu, real u)
{
    student_point a_mu = student_at(s, mu);
    real above         = 1 - 0.5f*student_tail(s, a_mu);
    real total         = mu*above + student_moment(s, a_mu);
    real up            = kclamp(u, 0.5f*REAL_EPSILON, 1 - 0.5f*REAL_EPSILON);
    real missing       = ksqrt(0.5f*(1 - up)*total*a_mu.root_x);
    real density       = student_density(s, a_mu);
    real low           = kmin(student_bound(mu, missing/ksqrt(s.beta_inverse)), 0);
    real high          = student_bound(mu, missing*ksqrt(a_mu.root_x)*a_mu.root_x/ksqrt(kmax(density, REAL_MIN)));
    int is_bounded     = (density > REAL_MIN) & (high < mu);
    real grazing       = ksqrt(kexpm1(-klog(up)/(s.p - 0.5f)));
    real steep         = student_of_gaussian(s, kerfcinv(2*up*above));
    real near          = 0.5f/(mu*ksqrt(s.p) + 0.5f);
    real start         = steep + near*(grazing - steep);
    real q             = kmax(is_bounded ? kmin(start, high) : start, low);
    UNROLL
    for (int i = 0; i < STUDENT_STEPS_ALONG; i++) {
        student_point a = student_at(s, q);
        real beyond     = 0.5f*student_tail(s, a);
        real excess     = mu*(q < 0 ? 1 - beyond : beyond) + student_moment(s, a) - up*total;
        real seen       = kmax(mu + q, REAL_MIN);
        real curvature  = 1/seen - (2*s.p + 1)*q*a.x;
        q               = kmax(q + halley_step(excess, seen*student_density(s, a), curvature), low);
    }
    return q;
}
