/* fresnel.h: how much of the light a smooth interface reflects.
 *
 * [cs500]  CS500 Project 3, "F factor".
 * [schlick94] Schlick, An inexpensive BRDF model for physically-based rendering, 1994.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "real.h"

/* Schlick's approximation, F0 + (F90 - F0)(1 - c)^5, c = |wi.wm| in [0,1].  [cs500, F(d)], where F90 = 1. */
KERNEL real3 fresnel_schlick(real3 F0, real3 F90, real c)
{
    return add3(F0, scale3(kpow5(kmax(1 - c, 0)), sub3(F90, F0)));
}

/* Unpolarised reflectance of a dielectric interface; c = |w.wm| in [0,1] on the side of the light,
 * eta = n_t/n_i.  [cs500, "exact formulation"].  Departures: total internal reflection gives 1 where the
 * radicand is not positive, and g - c is written as (eta^2 - 1)/(g + c), which does not cancel. */
KERNEL real fresnel_dielectric(real c, real eta)
{
    real eta2_1   = (eta - 1)*(eta + 1);
    real radicand = eta2_1 + c*c;
    real g        = ksqrt(kmax(radicand, 0));
    real sum      = g + c;
    real diff     = eta2_1/kmax(sum, REAL_MIN);
    real ratio    = diff/kmax(sum, REAL_MIN);
    real quotient = (c*sum - 1)/(c*diff + 1);
    real F        = 0.5f*ratio*ratio*(1 + quotient*quotient);
    return radicand > 0 ? kmin(F, 1) : (real)1;
}

/* Reflectance at normal incidence, ((eta - 1)/(eta + 1))^2. */
KERNEL real fresnel_normal_incidence(real eta)
{
    real r = (eta - 1)/(eta + 1);
    return r*r;
}

/* Which interface, and its numbers. */
#define FRESNEL_SCHLICK    0
#define FRESNEL_DIELECTRIC 1

typedef struct fresnel {
    int kind;
    real3 F0; /* Schlick: reflectance at normal incidence */
    real eta; /* dielectric: n_t/n_i */
} fresnel;

/* Reflectance at c = |w.wm| in [0,1]. */
KERNEL real3 fresnel_reflectance(fresnel f, real c)
{
    return select3(f.kind == FRESNEL_DIELECTRIC, splat3(fresnel_dielectric(c, f.eta)),
                   fresnel_schlick(f.F0, splat3(1), c));
}
