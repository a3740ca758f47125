/* test_identities_grid.c: the identities of every distribution and sampler over a grid of extremes, both precisions.
 *
 * Distributions are those of extremes.h, views go from the normal to a cosine of 1e-4.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/extremes.h"
#include "tests/kernel_access.h"
#include "tests/weight_check.h"
#include "verify/quadrature.h"

#define PI 3.14159265358979323846
#define STEP 0.125

/* 1e-5 and 1e-10 are the demands. */
static double tolerance(int is_double)
{
    return is_double ? 1e-10 : 1e-5;
}

static const kernel_access *access_of(const any_bsdf *bsdf)
{
    return bsdf->is_double ? &kernel_access_f64 : &kernel_access_f32;
}

/* P22 = D cos^4 of the stretched slopes (p, q).  (The terms of gtr include a slow Lambda.) */
static double slope_density(const any_bsdf *bsdf, const extreme *s, double p, double q)
{
    const double x = s->x*p, y = s->y*q, z = 1/sqrt(1 + x*x + y*y), m[3] = {x*z, y*z, z};
    const double D = s->gamma > 0 ? access_of(bsdf)->gtr_D(s->x, s->y, s->gamma, 0, m) : any_terms(bsdf, m).D;
    return D*z*z*z*z*s->x*s->y;
}

/* Int D cos d omega = Int P22 r^2 dy d phi in y = ln r, in which P22 is analytic for |Im y| < pi/4 at least and falls
 * off at both ends like r^2 and 1/r^2: the trapezoidal rule leaves exp(-2 pi (pi/4)/STEP) = 1e-17.  Isotropic slopes
 * need one azimuth, and four show that they are. */
static double normalisation(const any_bsdf *bsdf, const extreme *s)
{
    enum { AZIMUTHS = 4 };
    double sum = 0;
    for (double y = -19; y < 30; y += STEP)
        for (int k = 0; k < AZIMUTHS; k++) {
            const double r = exp(y), phi = 0.3 + 2*PI*k/AZIMUTHS;
            sum += slope_density(bsdf, s, r*cos(phi), r*sin(phi))*r*r;
        }
    return sum*STEP*2*PI/AZIMUTHS;
}

static void distributions_are_normalised(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        double worst = 0;
        for (int i = 0; i < N_EXTREMES; i++) {
            const extreme s = extreme_shape(i);
            const any_bsdf bsdf = any_bsdf_of(s.spec, is_double);
            const double error = fabs(normalisation(&bsdf, &s) - 1);
            worst = fmax(worst, error);
            if (!(error <= tolerance(is_double)))
                fail_msg("%s, %s: Int D cos - 1 = %.3g\n", s.spec, is_double ? "double" : "float", error);
        }
        print_message("  %s: %.2g\n", is_double ? "double" : "float", worst);
    }
}

/* T = Int P22 (t - mu)+ over the slopes t away from a viewer of cotangent mu: with e = r sin(psi0) = mu e^y,
 * psi0 = arccos(mu/r), r dr = e^2 dy, and t - mu = r (cos psi - cos psi0) entire in psi, which 8 Gauss nodes integrate
 * to 1e-15.  The integrand falls like 1/r from slopes of 1 on, which leaves e^-27. */
static double slope_beyond(const any_bsdf *bsdf, const extreme *s, const double towards[2], double mu)
{
    const quadrature angle = gauss_legendre(8, -1, 1);
    double sum = 0;
    for (double y = -14; y < 27 - log(fmin(s->x, s->y)*fmin(mu, 1)); y += STEP) {
        const double e = mu*exp(y), r = hypot(mu, e), psi0 = atan2(e, mu);
        for (int k = 0; k < angle.n; k++) {
            const double psi = psi0*angle.x[k];
            const double beyond = 2*r*sin((psi0 + psi)/2)*sin((psi0 - psi)/2);
            const double p = -r*(cos(psi)*towards[0] - sin(psi)*towards[1]);
            const double q = -r*(cos(psi)*towards[1] + sin(psi)*towards[0]);
            sum += angle.w[k]*psi0*beyond*e*e*slope_density(bsdf, s, p, q);
        }
    }
    return sum*STEP;
}

/* Int G1 D (v.m)+ / v.z = G1 (Int P22 + T/mu), P22 being even. */
static void weak_white_furnace_is_closed(void **state)
{
    (void)state;
    static const double cosines[] = {1, .9, .3, .01, 1e-4};
    for (int is_double = 0; is_double < 2; is_double++) {
        double worst = 0;
        for (int i = 0; i < N_EXTREMES; i++) {
            const extreme s = extreme_shape(i);
            const any_bsdf bsdf = any_bsdf_of(s.spec, is_double);
            const double whole = normalisation(&bsdf, &s);
            for (int c = 0; c < 5; c++) {
                double v[3];
                any_direction(cosines[c], 0.7, v);
                for (int k = 0; k < 3 && !is_double; k++) v[k] = (double)(float)v[k];
                const double S = hypot(s.x*v[0], s.y*v[1]), mu = v[2]/S;
                const double towards[2] = {s.x*v[0]/S, s.y*v[1]/S};
                const double behind = S > 0 ? slope_beyond(&bsdf, &s, towards, mu)/mu : 0;
                const double seen = whole + behind, alpha = sqrt(s.x*s.y);
                double error = fabs(any_terms(&bsdf, v).G1*seen - 1);
                if (s.gamma > 0 && S > 0) { /* what materials use, besides */
                    const double G1 = access_of(&bsdf)->gtr_G1(KERNEL_PREPARED, alpha, s.gamma, mu*alpha);
                    error = fmax(error, fabs(G1*seen - 1));
                }
                worst = fmax(worst, error);
                if (!(error <= tolerance(is_double)))
                    fail_msg("%s, %s, cos %g: Int G1 D (v.m)+ / cos - 1 = %.3g\n", s.spec,
                             is_double ? "double" : "float", cosines[c], error);
            }
        }
        print_message("  %s: %.2g\n", is_double ? "double" : "float", worst);
    }
}

/* ---- Densities ------------------------------------------------------------------------------------------------- */

/* A material, and the unit of the slopes of its lobe. */
typedef struct lobe {
    const char *spec;
    double x, y;
} lobe;

static const lobe lobes[] = {
    {"lambert", 1, 1},
    {"phong alpha_x=1e-3 alpha_y=1e-3", 1e-3, 1e-3},
    {"phong alpha_x=1 alpha_y=.1 sampling=ndf", 1, .1},
    {"phong exponent=0", 1, 1},
    {"beckmann alpha=1e-4", 1e-4, 1e-4},
    {"beckmann alpha=1 sampling=ndf kd=.5", 1, 1},
    {"beckmann alpha_x=1 alpha_y=.1", 1, .1},
    {"ggx alpha=1e-4", 1e-4, 1e-4},
    {"ggx alpha=1 sampling=ndf", 1, 1},
    {"ggx alpha_x=1 alpha_y=.1", 1, .1},
    {"ggx alpha=.3 kd=.5 ior=1.5", .3, .3},
    {"ggx alpha=1 energy=multi", 1, 1},
    {"gtr alpha=1e-4 gamma=.05", 1, 1},
    {"gtr alpha=1e-4 gamma=1", .01, .01},
    {"gtr alpha=1e-4 gamma=20", 2e-5, 2e-5},
    {"gtr alpha=1 gamma=4.5", 1, 1},
    {"gtr alpha_x=1 alpha_y=.1 gamma=.999", 1, .1},
    {"gtr alpha_x=1 alpha_y=.1 gamma=20 sampling=ndf", .3, .03},
    {"ward alpha=1e-4", 1e-4, 1e-4},
    {"ward alpha=1", 1, 1},
    {"ward alpha_x=1 alpha_y=.1 sampling=ndf kd=.3 ks=.6", 1, .1},
    {"ward alpha=.3 variant=duer", .3, .3},
    {"cs500 alpha=1 kd=.5 ks=.5", 1, 1},
    {"cs500 ndf=phong exponent=20", .3, .3},
    {"vray sharpness=.7 gamma=2", .09, .09},
    {"vray sharpness=0 gamma=1 sampling=vndf", 1, 1},
    {"metallic_roughness roughness=.3", .09, .09},
    {"metallic_roughness roughness=1 metallic=1", 1, 1},
    {"disney roughness=1 sheen=1 subsurface=.5", 1, 1},
    {"disney metallic=.5 roughness=.4 clearcoat=1 clearcoat_gloss=0", .16, .16},
};
enum { N_LOBES = sizeof lobes/sizeof lobes[0] };

/* pdf d omega_i/dp at the half vector of slopes p. */
static double density_at(const any_bsdf *bsdf, const double wo[3], double px, double py)
{
    const double wo_p = wo[0]*px + wo[1]*py + wo[2], p2 = px*px + py*py, inv2 = 1/(1 + p2);
    const double wi[3] = {2*wo_p*px*inv2 - wo[0], 2*wo_p*py*inv2 - wo[1],
                          (2*(wo[0]*px + wo[1]*py) + wo[2]*(1 - p2))*inv2};
    return wi[2] > 0 && wo_p > 0 ? any_pdf(bsdf, wi, wo)*4*wo_p*inv2*inv2 : 0;
}

/* Int pdf d omega_i over the disc of half vectors whose wi is above the horizon: along each azimuth from 0 to a knee,
 * and on to the end in 1/r. */
static double whole_density(const any_bsdf *bsdf, const lobe *l, const double wo[3])
{
    const quadrature radius = unit_interval(1.0/10), angle = unit_interval(1.0/8);
    double sum = 0;
    for (int j = 0; j < angle.n; j++)
        for (int quadrant = 0; quadrant < 4; quadrant++) {
            /* Gathered across the view's plane, where the disc is narrow at grazing views. */
            const double forward = atan2(l->y*wo[1], l->x*wo[0]), across = PI/2*angle.x[j];
            const double psi = forward + PI/2*(quadrant%2 ? 1 : -1) + (quadrant/2 ? across : -across);
            const double dx = l->x*cos(psi), dy = l->y*sin(psi);
            const double b = (dx*wo[0] + dy*wo[1])/wo[2], d2 = dx*dx + dy*dy, root = sqrt(b*b + d2);
            const double end = b > 0 ? (b + root)/d2 : 1/(root - b), cut = fmin(end, 4);
            double line = 0;
            for (int i = 0; i < radius.n; i++) {
                const double near = cut*radius.x[i], far = 1/((1 - radius.x[i])/cut + radius.x[i]/end);
                line += radius.w[i]*
                        (cut*near*density_at(bsdf, wo, near*dx, near*dy) +
                         (1/cut - 1/end)*far*far*far*density_at(bsdf, wo, far*dx, far*dy));
            }
            sum += PI/2*angle.w[j]*line*l->x*l->y;
        }
    return sum;
}

/* The density lacks what the sampler loses: the share of its draws that give no sample, over a lattice of three numbers
 * (of the plastic number's kind).  The quadrature is good to 1e-4.  The further trials of gtr's tails are as random as
 * scrambled numbers: of 100000 draws a sixth at most, whose loss has a standard deviation of 0.5/sqrt(17000)/6 =
 * 6e-4. */
static void densities_lack_what_samplers_lose(void **state)
{
    (void)state;
    enum { N = 100000 };
    static const double cosines[] = {1, .4, .02};
    double worst = 0;
    for (int i = 0; i < N_LOBES; i++)
        for (int c = 0; c < 3; c++) {
            const any_bsdf bsdf = any_bsdf_of(lobes[i].spec, 1), single = any_bsdf_of(lobes[i].spec, 0);
            double wo[3];
            any_direction(cosines[c], 0.7, wo);
            int lost = 0, lost_single = 0;
            for (int k = 0; k < N; k++) {
                const double u[3] = {(k + .5)/N, fmod((k + .5)*0.7548776662466927, 1),
                                     fmod((k + .5)*0.5698402909980532, 1)};
                lost += any_sample(&bsdf, wo, u).pdf == 0;
                lost_single += any_sample(&single, wo, u).pdf == 0;
            }
            const double mass = whole_density(&bsdf, &lobes[i], wo), loss = lost/(double)N;
            const double error = fmax(fabs(1 - mass - loss), fabs(loss - lost_single/(double)N));
            worst = fmax(worst, error);
            if (!(error <= 2e-3))
                fail_msg("%s, cos %g: density %.6f, lost %.6f and (float) %.6f\n", lobes[i].spec, cosines[c], mass,
                         loss, lost_single/(double)N);
        }
    print_message("  largest deviation: %.2g\n", worst);
}

/* ---- Samples, reciprocity -------------------------------------------------------------------------------------- */

/* A direction above, half of them grazing. */
static void draw_view(draws *d, double v[3])
{
    const double c = draw(d) < 0.5 ? draw_log(d, 1e-4, 1) : draw_between(d, 0.01, 1);
    any_direction(c, draw_between(d, 0, 2*PI), v);
    for (int k = 0; k < 3; k++) v[k] = (double)(float)v[k];
}

static void weight_is_eval_over_pdf(void **state)
{
    (void)state;
    enum { N = 300 };
    for (int i = 0; i < N_EXTREMES + N_LOBES; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const extreme s = i < N_EXTREMES ? extreme_shape(i) : (extreme){.x = 0};
            const any_bsdf bsdf = any_bsdf_of(i < N_EXTREMES ? s.spec : lobes[i - N_EXTREMES].spec, is_double);
            const double least = i < N_EXTREMES ? fmin(s.x, s.y)
                                                : fmin(lobes[i - N_EXTREMES].x, lobes[i - N_EXTREMES].y);
            draws random = {(uint64_t)i};
            int n = 0;
            for (int k = 0; k < N; k++) {
                double wo[3];
                draw_view(&random, wo);
                const double u[3] = {draw(&random), draw(&random), draw(&random)};
                const facet_sample64 drawn = any_sample(&bsdf, wo, u);
                /* Where the rounding of wi moves the slope of the half vector by a tenth of the roughness or more, the
                 * density of the rounded direction is another. */
                const double turn = 3*any_epsilon(&bsdf)/((wo[2] + drawn.wi[2])*least);
                n += drawn.pdf > 0;
                if (drawn.pdf == 0 || turn < 0.1) weight_check(&bsdf, wo, u, 3);
            }
            assert_true(n > N/5);
        }
}

static double asymmetry(const any_bsdf *bsdf, const double wi[3], const double wo[3])
{
    double forth[3], back[3];
    any_eval(bsdf, wi, wo, forth);
    any_eval(bsdf, wo, wi, back);
    double worst = 0;
    for (int k = 0; k < 3; k++) {
        const double a = forth[k]*wo[2], b = back[k]*wi[2];
        if (fmax(a, b) > 0x1p-120) worst = fmax(worst, fabs(a - b)/(fmax(a, b)*any_epsilon(bsdf)));
    }
    return worst;
}

static void reciprocal_models_are(void **state)
{
    (void)state;
    enum { N = 500 };
    double worst[2] = {0};
    for (int i = 0; i < N_EXTREMES + N_LOBES; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const extreme s = i < N_EXTREMES ? extreme_shape(i) : (extreme){.x = 0};
            const any_bsdf bsdf = any_bsdf_of(i < N_EXTREMES ? s.spec : lobes[i - N_EXTREMES].spec, is_double);
            draws random = {(uint64_t)(100 + i)};
            for (int k = 0; k < N; k++) {
                double wi[3], wo[3];
                draw_view(&random, wi);
                draw_view(&random, wo);
                const double eps = asymmetry(&bsdf, wi, wo);
                worst[is_double] = fmax(worst[is_double], eps);
                if (!(eps <= 64))
                    fail_msg("%s, wi (%a, %a, %a), wo (%a, %a, %a): off by %g eps\n", bsdf.spec, wi[0], wi[1], wi[2],
                             wo[0], wo[1], wo[2], eps);
            }
        }
    print_message("  largest asymmetry: %.1f and %.1f eps\n", worst[0], worst[1]);
}

/* By construction: a factor of the viewer's direction alone. */
static void scaled_energy_is_not_reciprocal(void **state)
{
    (void)state;
    static const char *const specs[] = {"ggx alpha=1 energy=scaled", "beckmann alpha=1 energy=scaled",
                                        "phong exponent=0 energy=scaled", "gtr alpha=.5 gamma=1 energy=scaled"};
    const double wi[3] = {.8, 0, .6}, wo[3] = {-.28, 0, .96};
    for (int i = 0; i < 4; i++) {
        const any_bsdf bsdf = any_bsdf_of(specs[i], 1);
        if (!(asymmetry(&bsdf, wi, wo)*0x1p-52 > 0.01)) fail_msg("%s is reciprocal", specs[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distributions_are_normalised),
        cmocka_unit_test(weak_white_furnace_is_closed),
        cmocka_unit_test(densities_lack_what_samplers_lose),
        cmocka_unit_test(weight_is_eval_over_pdf),
        cmocka_unit_test(reciprocal_models_are),
        cmocka_unit_test(scaled_energy_is_not_reciprocal),
    };
    return cmocka_run_group_tests_name("identities_grid", tests, NULL, NULL);
}
