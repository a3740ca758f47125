/* energy.h: the light that single scattering on microfacets loses, and two ways of giving it back.
 *
 * E(w) is the directional albedo of the specular term with F = 1, and C(w) = 1 - E(w) what it loses.
 *     multi:   f + F_ms C(wi) C(wo)/(pi C_avg), reciprocal; with F = 1 the albedo is exactly 1       [kulla17]
 *              F_ms = F_avg^2 E_avg/(1 - F_avg (1 - E_avg)) per channel
 *     scaled:  f (1 + F0 C(wo)/E(wo)), not reciprocal                                               [turquin19]
 * where X_avg = 2 Int_0^1 X c dc, averaged over the azimuth.
 *
 * C is a polynomial of each material (core/energy_fit.c fits it; docs/energy.md has its errors), written as
 *     C(w) = (a/(c + a))^power sum_k t^k p_k(2 x - 1),  x = z or sqrt(z),  z = (1 + a_n) c/(c + a),
 * with c = w.z, a(w)^2 = reach^2 (alpha_x^2 w.x^2 + alpha_y^2 w.y^2 + alpha_x alpha_y w.z^2), a_n = a(n), and
 * t = (w.x^2 - skew w.y^2)/(w.x^2 + skew w.y^2).  Möbius' map c/(c + a) resolves the dip of E near c = a however small
 * the roughness; the stretched a and t leave little for the azimuth to say.
 *
 * [kulla17]   Kulla and Conty, Revisiting physically based shading at Imageworks, 2017; F_ms with the colour of the
 *             first facet, which their slides leave out: C goes on to a second facet, dimmed by F_avg at the first; a
 *             facet reflects F_avg, of which E_avg leaves and the rest goes on:
 *             F_avg (F_avg E_avg)(1 + F_avg (1 - E_avg) + ...).
 * [turquin19] Turquin, Practical multiple scattering compensation for microfacet models, 2019.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "real.h"

/* In the order of the choices in the parameter tables. */
#define ENERGY_SINGLE 0
#define ENERGY_MULTI  1
#define ENERGY_SCALED 2

/* Coefficients of p_0, ..., p_5, one after the other; of the highest power first. */
#define ENERGY_MODES        6
#define ENERGY_TERMS        16 /* p_0: all that an isotropic material has */
#define ENERGY_COEFFICIENTS 56 /* 16 + 12 + 10 + 8 + 6 + 4 */

typedef struct energy {
    int kind;
    int is_isotropic;
    int is_root;                       /* x = sqrt(z) */
    int power;                         /* 0, 1 or 2 */
    real reach2_x, reach2_y, reach2_z; /* (reach alpha_x)^2, (reach alpha_y)^2 and their geometric mean */
    real a_n;
    real skew;
    real3 added;  /* F_ms/(pi C_avg); 0 with ENERGY_SCALED */
    real share;   /* F_ms/F_avg, mean of the channels; the lobe is chosen in proportion to it */
    real3 scale;  /* F0; 0 with ENERGY_MULTI */
    real inv_log; /* 1/(2 pi ln((1 + a_n)/a_n)) */
    real coefficients[ENERGY_COEFFICIENTS];
} energy;

KERNEL real energy_p4(energy e, int k, real u)
{
    return ((e.coefficients[k]*u + e.coefficients[k + 1])*u + e.coefficients[k + 2])*u + e.coefficients[k + 3];
}

/* sum_k t^k p_k(u) */
KERNEL real energy_polynomial(energy e, real u, real t)
{
    real u2 = u*u;
    real u4 = u2*u2;
    real p0 = ((energy_p4(e, 0, u)*u4 + energy_p4(e, 4, u))*u4 + energy_p4(e, 8, u))*u4 + energy_p4(e, 12, u);
    real p1 = (energy_p4(e, 16, u)*u4 + energy_p4(e, 20, u))*u4 + energy_p4(e, 24, u);
    real p2 = ((e.coefficients[28]*u + e.coefficients[29])*u4 + energy_p4(e, 30, u))*u4 + energy_p4(e, 34, u);
    real p3 = energy_p4(e, 38, u)*u4 + energy_p4(e, 42, u);
    real p4 = (e.coefficients[46]*u + e.coefficients[47])*u4 + energy_p4(e, 48, u);
    real p5 = energy_p4(e, 52, u);
    real p  = p0 + t*(p1 + t*(p2 + t*(p3 + t*(p4 + t*p5))));
    return e.is_isotropic ? p0 : p;
}

/* C(w) = 1 - E(w), w.z > 0. */
KERNEL real energy_loss(energy e, real3 w)
{
    real x2     = w.x*w.x;
    real y2     = w.y*w.y*e.skew;
    real t      = (x2 - y2)/kmax(x2 + y2, REAL_MIN);
    real a      = ksqrt(e.reach2_x*(w.x*w.x) + e.reach2_y*(w.y*w.y) + e.reach2_z*(w.z*w.z));
    real inv    = 1/(w.z + a);
    real z      = kmin((1 + e.a_n)*(w.z*inv), 1);
    real x      = e.is_root ? ksqrt(z) : z;
    real weight = a*inv;
    real tail   = e.power == 2 ? weight*weight : (e.power == 1 ? weight : (real)1);
    return ksaturate(tail*energy_polynomial(e, 2*x - 1, t));
}

/* The directional albedo of single scattering with F = 1. */
KERNEL real energy_E(energy e, real3 w) { return 1 - energy_loss(e, w); }

/* The specular f cos_i with the light of several bounces; not for ENERGY_SINGLE.  ENERGY_SCALED takes the numbers of
 * either kind. */
KERNEL real3 energy_complete(energy e, real3 single, real3 wi, real3 wo)
{
    real loss_o  = energy_loss(e, wo);
    real ratio   = loss_o/kmax(1 - loss_o, REAL_EPSILON);
    real3 scaled = mul3(single, madd3(splat3(1), ratio, e.scale));
    real3 first  = select3(e.kind == ENERGY_SCALED, scaled, single);
    return madd3(first, energy_loss(e, wi)*loss_o*wi.z, e.added);
}

/* The part of specular samples that the added lobe gets; 0 for ENERGY_SCALED. */
KERNEL real energy_probability(energy e, real3 wo)
{
    real loss_o = energy_loss(e, wo);
    real lobe   = e.share*loss_o;
    return lobe/kmax(lobe + (1 - loss_o), REAL_EPSILON);
}

/* A direction of the added lobe: c + a_n is log-uniform, because c C(c) falls like 1/c from c = a on. */
KERNEL real3 energy_sample(energy e, real ux, real uy)
{
    real2 azimuth = kcossin_turn(uy);
    real c        = kmin(e.a_n*kexpm1(ux*(INV_TWO_PI/e.inv_log)), 1);
    real sin      = ksqrt((1 - c)*(1 + c));
    return make3(sin*azimuth.x, sin*azimuth.y, c);
}

/* Its density. */
KERNEL real energy_pdf(energy e, real3 wi) { return e.inv_log/(wi.z + e.a_n); }
