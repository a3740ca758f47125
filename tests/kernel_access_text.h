/* kernel_access_text.h: a table of kernel_access.h, written once for both precisions.  Included by
 * kernel_access_f32.c and kernel_access_f64.c, which define FACET_REAL_IS_DOUBLE and ACCESS, the table's symbol.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "tests/kernel_access.h"

#include "core/kernel/bsdf.h"
#include "core/kernel/distribution.h"
#include "core/kernel/fresnel.h"
#include "core/kernel/microfacet.h"
#define FACET_PREPARE
#include "core/model/model_gtr.h"

static double density(kernel_distribution which, double shape_x, double shape_y, const double m[3])
{
    const real x = (real)shape_x, y = (real)shape_y;
    const real3 n = make3((real)m[0], (real)m[1], (real)m[2]);
    switch (which) {
    case KERNEL_COSINE: return (double)(n.z > 0 ? INV_PI : 0);
    case KERNEL_PHONG: return (double)phong_D(n, (phong_shape){.exponent = x}, 1, 1);
    case KERNEL_BECKMANN: return (double)beckmann_D(n, x, y);
    case KERNEL_GGX: return (double)ggx_D(n, x, y);
    }
    return 0;
}

static void sample_ndf(kernel_distribution which, double shape_x, double shape_y, double ux, double uy, double m[3])
{
    const real x = (real)shape_x, y = (real)shape_y, u = (real)ux, v = (real)uy;
    real3 n = make3(0, 0, 0);
    switch (which) {
    case KERNEL_COSINE: n = sample_cosine(u, v); break;
    case KERNEL_PHONG: n = phong_sample_ndf(u, v, (phong_shape){.exponent = x}, 1, 1); break;
    case KERNEL_BECKMANN: n = beckmann_sample_ndf(u, v, x, y); break;
    case KERNEL_GGX: n = ggx_sample_ndf(u, v, x, y); break;
    }
    n = normalize3(n);
    m[0] = (double)n.x;
    m[1] = (double)n.y;
    m[2] = (double)n.z;
}

static student slopes_along(double exponent)
{
    return student_of((real)exponent/2 + 1);
}

static double slope_tail(double exponent, double q)
{
    const student s = slopes_along(exponent);
    return (double)student_tail(s, student_at(s, (real)q));
}

static double slope_Lambda(double exponent, double q)
{
    const student s = slopes_along(exponent);
    return (double)student_Lambda(s, student_at(s, (real)q));
}

static double phong_slope_along(double exponent, double mu, double u)
{
    return (double)student_visible_slope(slopes_along(exponent), (real)mu, (real)u);
}

static double phong_slope_across(double exponent, double u)
{
    const student along = slopes_along(exponent);
    const phong_shape shape = {.exponent = (real)exponent, .beta_inverse = along.beta_inverse};
    return (double)student_quantile(phong_slopes_across(shape), (real)u);
}

static double beckmann_slope_along(double mu, double u)
{
    return (double)beckmann_visible_slope((real)mu, (real)u);
}

static double joint_G2(double alpha_x, double alpha_y, const double wi[3], const double wo[3])
{
    const real x = (real)alpha_x, y = (real)alpha_y;
    const real3 i = make3((real)wi[0], (real)wi[1], (real)wi[2]), o = make3((real)wo[0], (real)wo[1], (real)wo[2]);
    const distribution d = {.kind = NDF_GGX, .masking = MASKING_EXACT, .alpha_x = x, .alpha_y = y};
    return (double)(i.z*o.z/
                    smith_rest(i.z, o.z, distribution_sigma(d, i), distribution_sigma(d, o), G2_CORRELATED));
}

/* Prepared anew for another shape only. */
static const gtr_shape *gtr_of(double alpha_x, double alpha_y, double gamma, int is_disney)
{
    static double last[3];
    static gtr_shape g;
    if (alpha_x != last[0] || alpha_y != last[1] || gamma != last[2] || g.anisotropy != is_disney) {
        g = gtr_shape_of((real)alpha_x, (real)alpha_y, (real)gamma, is_disney ? GTR_DISNEY : GTR_STRETCHED);
        last[0] = alpha_x;
        last[1] = alpha_y;
        last[2] = gamma;
    }
    return &g;
}

static double gtr_density(double alpha_x, double alpha_y, double gamma, int is_disney, const double m[3])
{
    const gtr_shape *g = gtr_of(alpha_x, alpha_y, gamma, is_disney);
    const real3 n = make3((real)m[0], (real)m[1], (real)m[2]);
    return (double)(is_disney ? gtr_disney_D(n, *g) : gtr_D(n, *g));
}

static double gtr_G1(kernel_masking which, double alpha, double gamma, double mu)
{
    const gtr_shape *g = gtr_of(alpha, alpha, gamma, 0);
    const double inverse = 1/hypot(mu, 1);
    const real3 v = make3((real)inverse, 0, (real)(mu*inverse));
    const gtr_view view = gtr_view_of(v, *g, gtr_A(*g, gtr_variable_at(v, *g)));
    switch (which) {
    case KERNEL_PREPARED: return (double)(v.z/gtr_sigma(v, *g));
    case KERNEL_DRAWN: return (double)(view.mu/(view.mu + view.T));
    case KERNEL_DIRECT: return 1/(1 + (double)gtr_Lambda_direct((real)alpha, (real)gamma, (real)mu));
    case KERNEL_PUBLISHED: return (double)gtr_published_G1(v, *g, gtr_spline_at((real)gamma));
    }
    return 0;
}

static double gtr_Lambda_of(double alpha, double gamma, double mu)
{
    return (double)gtr_Lambda_exact((real)alpha, (real)gamma, (real)mu);
}

static void sample_gtr(double alpha, double gamma, double ux, double uy, double m[3])
{
    const real3 n = normalize3(gtr_sample_ndf((real)ux, (real)uy, *gtr_of(alpha, alpha, gamma, 0)));
    m[0] = (double)n.x;
    m[1] = (double)n.y;
    m[2] = (double)n.z;
}

static double gtr_tail_line(double alpha, double gamma, double mu, double u)
{
    const gtr_shape *g = gtr_of(alpha, alpha, gamma, 0);
    const double inverse = 1/hypot(mu, 1);
    const real3 v = make3((real)inverse, 0, (real)(mu*inverse));
    const gtr_view view = gtr_view_of(v, *g, gtr_A(*g, gtr_variable_at(v, *g)));
    return (double)gtr_draw_line(*g, view.mu, gtr_tail_mass(view, (real)u));
}

static double dielectric(double c, double eta)
{
    return (double)fresnel_dielectric((real)c, (real)eta);
}

static double schlick(double c, double eta)
{
    const real3 F0 = splat3(fresnel_normal_incidence((real)eta));
    return (double)fresnel_schlick(F0, splat3(1), (real)c).x;
}

static double conductor(double c, double eta, double k)
{
    return (double)fresnel_conductor3((real)c, splat3((real)eta), splat3((real)k)).y;
}

static real3 strength_of(double F0, double tint)
{
    return fresnel_f82_strength(splat3((real)F0), splat3((real)tint));
}

static double f82(double c, double F0, double tint)
{
    return (double)fresnel_f82(splat3((real)F0), strength_of(F0, tint), (real)c).z;
}

static double schlick_average(double F0, double F90)
{
    return (double)fresnel_schlick_average(splat3((real)F0), splat3((real)F90)).y;
}

static double dielectric_average(double eta)
{
    return (double)fresnel_dielectric_average((real)eta);
}

static double conductor_average(double eta, double k)
{
    return (double)fresnel_conductor_average((real)eta, (real)k);
}

static double f82_average(double F0, double tint)
{
    return (double)fresnel_f82_average(splat3((real)F0), strength_of(F0, tint)).x;
}

const kernel_access ACCESS = {
    .name = FACET_REAL_IS_DOUBLE ? "double" : "float",
    .epsilon = (double)REAL_EPSILON,
    .D = density,
    .sample_ndf = sample_ndf,
    .slope_tail = slope_tail,
    .slope_Lambda = slope_Lambda,
    .phong_slope_along = phong_slope_along,
    .phong_slope_across = phong_slope_across,
    .beckmann_slope_along = beckmann_slope_along,
    .ggx_G2 = joint_G2,
    .gtr_D = gtr_density,
    .gtr_G1 = gtr_G1,
    .gtr_Lambda = gtr_Lambda_of,
    .gtr_sample_ndf = sample_gtr,
    .gtr_tail_line = gtr_tail_line,
    .fresnel_dielectric = dielectric,
    .fresnel_schlick = schlick,
    .fresnel_conductor = conductor,
    .fresnel_f82 = f82,
    .schlick_average = schlick_average,
    .dielectric_average = dielectric_average,
    .conductor_average = conductor_average,
    .f82_average = f82_average,
};
