/* distribution.h: one distribution of normals out of the several, by name.
 *
 * `kind` is the same for all elements of a batch; the loops are compiled once for each kind, so that the choice
 * costs nothing (model_table.h).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "beckmann.h"
#include "ggx.h"
#include "gtr.h"
#include "gtr_lambda.h"
#include "gtr_published.h"
#include "gtr_sample.h"
#include "phong.h"

/* In the order of the choices in the parameter tables. */
#define NDF_GGX           0
#define NDF_BECKMANN      1
#define NDF_PHONG         2
#define NDF_GTR           3
#define NDF_COUNT         4
#define NDF_GTR_DIRECT    4 /* gtr without prepared polynomials: Lambda is integrated, all normals are drawn */
#define MASKING_EXACT     0
#define MASKING_PUBLISHED 1

typedef struct distribution {
    int kind;
    int masking;
    real alpha_x, alpha_y; /* roughness along x and y; for phong the stretch of slopes, 1 when isotropic */
    phong_shape phong;
    gtr_shape gtr;
    gtr_spline spline; /* of the published masking of gtr */
} distribution;

/* The D at the direction of m, 1/sr, that normals are drawn with and whose Lambda is known; m need not be a unit
 * vector. */
KERNEL real distribution_drawn_D(distribution d, real3 m)
{
    return d.kind == NDF_GGX        ? ggx_D(m, d.alpha_x, d.alpha_y)
           : d.kind == NDF_BECKMANN ? beckmann_D(m, d.alpha_x, d.alpha_y)
           : d.kind >= NDF_GTR      ? gtr_D(m, d.gtr)
                                    : phong_D(m, d.phong, d.alpha_x, d.alpha_y);
}

/* Disney's anisotropic gtr, whose masking and sampling are borrowed from the stretched one. */
KERNEL int distribution_is_disney(distribution d) { return (d.kind == NDF_GTR) & (d.gtr.anisotropy == GTR_DISNEY); }

/* D at the direction of m: the same, but for Disney's anisotropic gtr. */
KERNEL real distribution_D(distribution d, real3 m)
{
    return distribution_is_disney(d) ? gtr_disney_D(m, d.gtr) : distribution_drawn_D(d, m);
}

/* Smith's Lambda of the distribution itself. */
KERNEL real distribution_exact_Lambda(distribution d, real3 v)
{
    return d.kind == NDF_GGX          ? ggx_Lambda(v, d.alpha_x, d.alpha_y)
           : d.kind == NDF_BECKMANN   ? beckmann_Lambda(v, d.alpha_x, d.alpha_y)
           : d.kind == NDF_GTR        ? gtr_Lambda(v, d.gtr)
           : d.kind == NDF_GTR_DIRECT ? gtr_Lambda_at(v, d.gtr)
                                      : phong_Lambda(v, d.phong, d.alpha_x, d.alpha_y);
}

/* What the paper prints in its place; GGX's is exact, and gtr's spline is held in (0, 1]. */
KERNEL real distribution_published_Lambda(distribution d, real3 v)
{
    real a = stretched_cot(v, d.alpha_x, d.alpha_y);
    return d.kind == NDF_GGX        ? ggx_Lambda(v, d.alpha_x, d.alpha_y)
           : d.kind == NDF_BECKMANN ? rational_fit_Lambda(a)
           : d.kind == NDF_GTR      ? 1/kclamp(gtr_published_G1(v, d.gtr, d.spline), GTR_LEAST_G1, 1) - 1
                                    : rational_fit_Lambda(a*phong_fit_scale(d.phong));
}

/* The Lambda that masks and shadows. */
KERNEL real distribution_Lambda(distribution d, real3 v)
{
    return d.masking == MASKING_PUBLISHED ? distribution_published_Lambda(d, v) : distribution_exact_Lambda(d, v);
}

/* The projected area of the microfacets that face v, sigma(v) = cos (1 + Lambda), cos = v.z > 0: exact, and with the
 * Lambda that masks. */
KERNEL real distribution_exact_sigma(distribution d, real3 v)
{
    return d.kind == NDF_GGX   ? ggx_sigma(v, d.alpha_x, d.alpha_y)
           : d.kind == NDF_GTR ? gtr_sigma(v, d.gtr)
                               : v.z*(1 + distribution_exact_Lambda(d, v));
}

KERNEL real distribution_sigma(distribution d, real3 v)
{
    return d.masking == MASKING_PUBLISHED ? v.z*(1 + distribution_published_Lambda(d, v))
                                          : distribution_exact_sigma(d, v);
}

/* The share of the facets, by projected area, whose stretched tan^2 is above tan2, and the tan2 of a share;
 * rest = 1 - share. */
KERNEL real distribution_share_beyond(distribution d, real tan2)
{
    return d.kind == NDF_GGX        ? ggx_share_beyond(tan2)
           : d.kind == NDF_BECKMANN ? beckmann_share_beyond(tan2)
           : d.kind == NDF_GTR      ? gtr_share_beyond(tan2, d.gtr)
                                    : phong_share_beyond(tan2, d.phong);
}

KERNEL real distribution_tan2_beyond(distribution d, real share, real rest)
{
    return d.kind == NDF_GGX        ? ggx_tan2_beyond(share, rest)
           : d.kind == NDF_BECKMANN ? beckmann_tan2_beyond(share, rest)
           : d.kind == NDF_GTR      ? gtr_tan2_beyond(rest, d.gtr)
                                    : phong_tan2_beyond(share, rest, d.phong);
}

/* A normal with density D cos_m, of any length. */
KERNEL real3 distribution_sample_ndf(distribution d, real ux, real uy)
{
    return d.kind == NDF_GGX        ? ggx_sample_ndf(ux, uy, d.alpha_x, d.alpha_y)
           : d.kind == NDF_BECKMANN ? beckmann_sample_ndf(ux, uy, d.alpha_x, d.alpha_y)
           : d.kind >= NDF_GTR      ? gtr_sample_ndf(ux, uy, d.gtr)
                                    : phong_sample_ndf(ux, uy, d.phong, d.alpha_x, d.alpha_y);
}

/* A normal with density D (wo.wm)+/sigma(wo), of any length; gtr uses a third number. */
KERNEL real3 distribution_sample_vndf(distribution d, real3 wo, real ux, real uy, real uz)
{
    return d.kind == NDF_GGX        ? ggx_sample_vndf(wo, ux, uy, d.alpha_x, d.alpha_y)
           : d.kind == NDF_BECKMANN ? beckmann_sample_vndf(wo, ux, uy, d.alpha_x, d.alpha_y)
           : d.kind == NDF_GTR      ? gtr_sample_vndf(wo, ux, uy, uz, d.gtr)
                                    : phong_sample_vndf(wo, ux, uy, d.phong, d.alpha_x, d.alpha_y);
}
