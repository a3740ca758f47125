/* test_energy.c: with the light of several bounces a white surface reflects all light, and nothing else changes.
 *
 * The albedo of single scattering is integrated here over the slopes of the half vector, by double-exponential rules on
 * both sides of every place where the integrand is not smooth; the library fits its polynomials to another rule.
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
#include "verify/quadrature.h"

#define PI 3.14159265358979323846

/* A material, and the roughness that scales the slopes of the rule. */
typedef struct surface {
    const char *spec;
    double alpha_x, alpha_y;
} surface;

typedef struct view {
    double wo[3];
    double cosine, sine, azimuth;
} view;

static view view_of(double cosine, double azimuth)
{
    view v = {.cosine = cosine, .sine = sqrt((1 - cosine)*(1 + cosine)), .azimuth = azimuth};
    any_direction(cosine, azimuth, v.wo);
    return v;
}

static any_bsdf with_energy(const char *spec, const char *energy, int is_double)
{
    char text[160];
    snprintf(text, sizeof text, "%s energy=%s", spec, energy);
    return any_bsdf_of(text, is_double);
}

/* f cos_i times d omega_i/dp at the half vector with slopes p. */
static double at_slopes(const any_bsdf *bsdf, const view *v, double px, double py)
{
    const double wo_p = v->wo[0]*px + v->wo[1]*py + v->cosine, p2 = px*px + py*py, inv2 = 1/(1 + p2);
    const double wi[3] = {2*wo_p*px*inv2 - v->wo[0], 2*wo_p*py*inv2 - v->wo[1],
                          (2*(v->wo[0]*px + v->wo[1]*py) + v->cosine*(1 - p2))*inv2};
    if (wi[2] <= 0 || wo_p <= 0) return 0;
    double f[3];
    any_eval(bsdf, wi, v->wo, f);
    return f[0]*4*wo_p*inv2*inv2;
}

/* Along one azimuth of the stretched slopes to the radius where wi reaches the horizon, cut at `knee`. */
static double along(const any_bsdf *bsdf, const surface *s, const view *v, const quadrature *rule, double ex, double ey)
{
    const double dx = s->alpha_x*ex, dy = s->alpha_y*ey, knee = 4;
    const double b = (dx*v->wo[0] + dy*v->wo[1])/v->cosine, d2 = dx*dx + dy*dy, root = sqrt(b*b + d2);
    const double end = b > 0 ? (b + root)/d2 : 1/(root - b), cut = fmin(end, knee);
    double sum = 0;
    for (int i = 0; i < rule->n; i++) {
        const double near = cut*rule->x[i];
        sum += rule->w[i]*cut*near*at_slopes(bsdf, v, near*dx, near*dy);
        /* Towards the end in 1/r, in which the tail is short. */
        const double inv = (1 - rule->x[i])/cut + rule->x[i]/end, far = 1/inv;
        sum += rule->w[i]*(1/cut - 1/end)*far*far*far*at_slopes(bsdf, v, far*dx, far*dy);
    }
    return sum*s->alpha_x*s->alpha_y;
}

/* The albedo of a specular lobe alone. */
static double lobe_albedo(const any_bsdf *bsdf, const surface *s, const view *v)
{
    const quadrature radius = unit_interval(1.0/14), angle = unit_interval(1.0/8);
    const double x = s->alpha_x*v->wo[0], y = s->alpha_y*v->wo[1], forward = x*x + y*y > 0 ? atan2(y, x) : 0;
    double sum = 0;
    for (int j = 0; j < angle.n; j++)
        for (int quadrant = 0; quadrant < 4; quadrant++) {
            const double across = 0.5*PI*angle.x[j], turned = quadrant & 1 ? PI - across : across;
            const double psi = forward + 0.5*PI - (quadrant & 2 ? PI - turned + PI : turned);
            sum += 0.5*PI*angle.w[j]*along(bsdf, s, v, &radius, cos(psi), sin(psi));
        }
    return sum;
}

/* What the lobe of several bounces adds: smooth, but steep near the horizon. */
static double added_albedo(const any_bsdf *multi, const any_bsdf *single, const view *v)
{
    const quadrature cosine = unit_interval(1.0/12);
    enum { AZIMUTHS = 48 };
    double sum = 0;
    for (int i = 0; i < cosine.n; i++)
        for (int j = 0; j < AZIMUTHS; j++) {
            /* Off the plane of the view by 0.01, where the specular lobe may be too high to be taken off. */
            const double phi = v->azimuth + PI + 0.01 + 2*PI*j/AZIMUTHS;
            double wi[3], with[3], without[3];
            any_direction(cosine.x[i], phi, wi);
            any_eval(multi, wi, v->wo, with);
            any_eval(single, wi, v->wo, without);
            sum += cosine.w[i]*2*PI/AZIMUTHS*(with[0] - without[0]);
        }
    return sum;
}

static const surface surfaces[] = {
    {"ggx alpha=1", 1, 1},
    {"ggx alpha=.3", .3, .3},
    {"ggx alpha=.1 g2=separable", .1, .1},
    {"ggx alpha=.01", .01, .01},
    {"ggx alpha=1e-4", 1e-4, 1e-4},
    {"ggx alpha_x=1 alpha_y=.1", 1, .1},
    {"ggx alpha_x=.05 alpha_y=.5 g2=separable", .05, .5},
    {"ggx alpha_x=.001 alpha_y=.0001", 1e-3, 1e-4},
    {"beckmann alpha=1", 1, 1},
    {"beckmann alpha=.2 g2=separable", .2, .2},
    {"beckmann alpha=.05 masking=published", .05, .05},
    {"beckmann alpha=1e-4", 1e-4, 1e-4},
    {"beckmann alpha_x=1 alpha_y=.1", 1, .1},
    {"gtr alpha=.1 gamma=1", .1, .1},
    {"gtr alpha=.001 gamma=.3", .1, .1},
    {"gtr alpha=1e-4 gamma=1.2", 1e-4, 1e-4},
    {"gtr alpha=.3 gamma=20 g2=separable", .07, .07},
    {"gtr alpha_x=.859 alpha_y=.111 gamma=1.001 g2=separable", .859, .111},
    {"gtr alpha=.5 gamma=4.5", .3, .3},
    {"phong exponent=0", 1, 1},
    {"phong exponent=30 g2=separable", .25, .25},
    {"phong exponent=1e6", 1.4142e-3, 1.4142e-3},
    {"phong alpha_x=.1 alpha_y=.5", .1, .5},
};
enum { N_SURFACES = sizeof surfaces/sizeof surfaces[0] };

static const double cosines[] = {1, .7, .2, .03, .003, 1e-4};
enum { N_COSINES = sizeof cosines/sizeof cosines[0] };

/* 1e-3 is the promise; E itself is known to 1e-5 here. */
static void white_furnace_is_white(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < N_SURFACES; i++) {
        const surface *s = &surfaces[i];
        const any_bsdf single = any_bsdf_of(s->spec, 1);
        const any_bsdf multi = with_energy(s->spec, "multi", 1), scaled = with_energy(s->spec, "scaled", 1);
        for (int k = 0; k < N_COSINES; k++) {
            const view v = view_of(cosines[k], 0.3 + k);
            const double E = lobe_albedo(&single, s, &v), added = added_albedo(&multi, &single, &v);
            if (!(E > 0 && E <= 1 + 1e-4)) fail_msg("%s, cos %g: single scattering gives %.6f", s->spec, v.cosine, E);
            if (!(fabs(E + added - 1) <= 1e-3)) fail_msg("%s, cos %g: %.6f + %.6f", s->spec, v.cosine, E, added);
            double f[3], g[3];
            const double wi[3] = {-.36, .48, .8};
            any_eval(&single, wi, v.wo, f);
            any_eval(&scaled, wi, v.wo, g);
            const double total = f[0] > 1e-200 ? E*g[0]/f[0] : 1;
            if (!(fabs(total - 1) <= 2e-3)) fail_msg("%s, cos %g: scaled %.6f", s->spec, v.cosine, total);
            worst = fmax(worst, fmax(fabs(E + added - 1), fabs(total - 1)));
        }
    }
    print_message("white furnace: largest error %.1e\n", worst);
}

/* 1 - E of GGX at alpha 1 and normal incidence is ln 2; its averages are Cycles' and those of a one-dimensional
 * integral, to 6 digits.  The lobe at wi = wo = n is C(n)^2/(pi C_avg). */
static void averages_are_the_known_ones(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double alpha, loss, average;
    } known[] = {
        {"ggx alpha=1", 1, .69314718, 1 - .409137},
        {"ggx alpha=1 g2=separable", 1, .69314718, 1 - .376635},
        {"ggx alpha=.599375650", .599375650, 0, 1 - .631068}, /* (24/31)^2 */
        {"ggx alpha=.599375650 g2=separable", .599375650, 0, 1 - .616010},
        {"ggx alpha=.266389178", .266389178, 0, 1 - .870874}, /* (16/31)^2 */
        {"phong exponent=0", 1, .69314718, 1 - .409137},
    };
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++) {
        const any_bsdf single = any_bsdf_of(known[i].spec, 1), multi = with_energy(known[i].spec, "multi", 1);
        const surface s = {known[i].spec, known[i].alpha, known[i].alpha};
        const view normal = view_of(1, 0);
        const double loss = 1 - lobe_albedo(&single, &s, &normal);
        if (known[i].loss > 0 && !(fabs(loss - known[i].loss) <= 1e-8)) fail_msg("%s: 1 - E = %.9f", s.spec, loss);
        double with[3], without[3];
        any_eval(&multi, normal.wo, normal.wo, with);
        any_eval(&single, normal.wo, normal.wo, without);
        const double average = loss*loss/(PI*(with[0] - without[0]));
        if (!(fabs(average/known[i].average - 1) <= 2e-4)) fail_msg("%s: C_avg %.6f", s.spec, average);
    }
}

/* F_ms is the same for all directions: F_avg^2 E_avg/(1 - F_avg (1 - E_avg)), F_avg = F0 + (1 - F0)/21 for Schlick's
 * term; E_avg of GGX at alpha 1 from above. */
static void colours_saturate(void **state)
{
    (void)state;
    const any_bsdf white = any_bsdf_of("ggx alpha=1 energy=multi", 1), none = any_bsdf_of("ggx alpha=1", 1);
    const any_bsdf tinted = any_bsdf_of("ggx alpha=1 ks=.9,.5,.05 energy=multi", 1);
    const any_bsdf plain = any_bsdf_of("ggx alpha=1 ks=.9,.5,.05", 1);
    static const double F0[3] = {.9, .5, .05};
    const double wi[3] = {.6, 0, .8}, wo[3] = {0, .8, .6};
    double f[4][3];
    any_eval(&white, wi, wo, f[0]);
    any_eval(&none, wi, wo, f[1]);
    any_eval(&tinted, wi, wo, f[2]);
    any_eval(&plain, wi, wo, f[3]);
    for (int k = 0; k < 3; k++) {
        const double F = F0[k] + (1 - F0[k])/21, E = .409137, want = F*F*E/(1 - F*(1 - E));
        const double got = (f[2][k] - f[3][k])/(f[0][k] - f[1][k]);
        if (!(fabs(got - want) <= 1e-4*want)) fail_msg("F0 = %g: F_ms %.7f, not %.7f", F0[k], got, want);
    }
}

static void random_direction(draws *d, double v[3])
{
    const double c = draw(d);
    any_direction(0.001 + 0.999*c*c, 2*PI*draw(d), v);
}

/* energy=multi is reciprocal to rounding errors, and energy=single is the model without the word, to the bit. */
static void several_bounces_are_reciprocal(void **state)
{
    (void)state;
    draws d = {11};
    for (int i = 0; i < N_SURFACES; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf plain = any_bsdf_of(surfaces[i].spec, is_double);
            const any_bsdf single = with_energy(surfaces[i].spec, "single", is_double);
            const any_bsdf multi = with_energy(surfaces[i].spec, "multi", is_double);
            for (int k = 0; k < 200; k++) {
                double wi[3], wo[3], f[3], g[3], p[3];
                random_direction(&d, wi);
                random_direction(&d, wo);
                any_eval(&plain, wi, wo, p);
                any_eval(&single, wi, wo, f);
                if (p[0] != f[0]) fail_msg("%s: energy=single differs", surfaces[i].spec);
                any_eval(&multi, wi, wo, f);
                any_eval(&multi, wo, wi, g);
                const double there = f[0]/wi[2], back = g[0]/wo[2];
                /* The half vector's rounding error is stretched by 1/alpha in D, as without the lobe. */
                const double alpha = fmin(surfaces[i].alpha_x, surfaces[i].alpha_y);
                const double bound = 64*any_epsilon(&multi)/(alpha*alpha)*fmax(there, back);
                if (alpha >= .1 && !(fabs(there - back) <= bound))
                    fail_msg("%s: %a there, %a back", surfaces[i].spec, there, back);
                if (!(f[0] >= p[0]) || !isfinite(f[0])) fail_msg("%s: %a below %a", surfaces[i].spec, f[0], p[0]);
            }
        }
}

/* The mean weight of samples of a white material is 1: in single precision, where the lobe of a smooth surface is a
 * quotient of small numbers.  6 sigma and 1e-3. */
static void samples_of_white_carry_all_light(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    for (int i = 0; i < N_SURFACES; i++)
        for (int k = 0; k < 3; k++) {
            const any_bsdf multi = with_energy(surfaces[i].spec, "multi", 0);
            const view v = view_of(fmin(1, surfaces[i].alpha_y*(k == 0 ? .5 : k == 1 ? 1 : 4)), 1);
            draws d = {100 + k};
            double sum = 0, squares = 0;
            for (int n = 0; n < COUNT; n++) {
                const double u[3] = {draw(&d), draw(&d), draw(&d)};
                const facet_sample64 s = any_sample(&multi, v.wo, u);
                sum += s.weight[0];
                squares += s.weight[0]*s.weight[0];
            }
            const double mean = sum/COUNT, sigma = sqrt((squares/COUNT - mean*mean)/COUNT);
            if (!(fabs(mean - 1) <= 1e-3 + 6*sigma))
                fail_msg("%s, cos %g: %.5f +- %.5f", surfaces[i].spec, v.cosine, mean, sigma);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_is_white),
        cmocka_unit_test(averages_are_the_known_ones),
        cmocka_unit_test(colours_saturate),
        cmocka_unit_test(several_bounces_are_reciprocal),
        cmocka_unit_test(samples_of_white_carry_all_light),
    };
    return cmocka_run_group_tests_name("energy", tests, NULL, NULL);
}
