/* test_albedo_quadrature.c: facet_bsdf64_albedo and facet_bsdf64_average_albedo: their values and stated errors.
 *
 * Independent values: closed forms; one-dimensional integrals known to ten digits; energy tables of two renderers,
 * where they lie beside the source tree; other rules of quadrature (test_albedo.c has more of eval by itself).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"
#include "tests/any_bsdf.h"
#include "verify/quadrature.h"

#define PI 3.14159265358979324

typedef struct albedo {
    double reflected[3], transmitted[3], error;
} albedo;

static facet_bsdf64 prepared(const char *spec)
{
    return any_bsdf_of(spec, 1).twice;
}

/* At a cosine, negative from inside, and an azimuth; the error that is stated must be the one that is promised. */
static albedo albedo_of(const char *spec, double cos_o, double phi)
{
    const facet_bsdf64 bsdf = prepared(spec);
    double wo[3];
    albedo a;
    any_direction(cos_o, phi, wo);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, wo, a.reflected, a.transmitted, &a.error), FACET_OK);
    if (!(a.error >= 0 && a.error < 1e-6)) fail_msg("%s, cos_o %g: stated error %.2g", spec, cos_o, a.error);
    return a;
}

static void check(const char *spec, double cos_o, double got, double want, double bound)
{
    if (!(fabs(got - want) <= bound))
        fail_msg("%s, cos_o %g: %.12f, not %.12f: off by %.2g, bound %.2g", spec, cos_o, got, want, fabs(got - want),
                 bound);
}

/* Ten digits of one-dimensional integrals computed independently, and closed forms: the stated error suffices. */
static void albedo_is_as_good_as_it_says(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double value, digits;
    } known[] = {{"ggx alpha=.01", .9998985564, 6e-11},    {"ggx alpha=.04", .9982974663, 6e-11},
                 {"ggx alpha=.1", .9883040565, 6e-11},     {"ggx alpha=.3", .8773584158, 6e-11},
                 {"ggx alpha=.7", .5037174524, 6e-11},     {"ggx alpha=1", .30685281944005469, 1e-15},
                 {"beckmann alpha=.3", .999713154, 6e-10}, {"beckmann alpha=.5", .942998375, 6e-10},
                 {"beckmann alpha=1", .461588091, 6e-10}};
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++) {
        const albedo a = albedo_of(known[i].spec, 1, 0);
        for (int k = 0; k < 3; k++) {
            check(known[i].spec, 1, a.reflected[k], known[i].value, a.error + known[i].digits);
            assert_true(a.transmitted[k] == 0);
        }
    }
    static const double cosines[] = {1, .5, .01, 1e-4};
    for (int i = 0; i < 4; i++) {
        const albedo a = albedo_of("lambert kd=.25,.5,1", cosines[i], 2), b = albedo_of("lambert", -cosines[i], 2);
        const albedo shine = albedo_of("ggx alpha=.01", cosines[i], 2);
        const albedo both = albedo_of("ggx alpha=.01 kd=.5", cosines[i], 2);
        for (int k = 0; k < 3; k++) {
            check("lambert", cosines[i], a.reflected[k], .25*(1 << k), a.error + 1e-15);
            assert_true(b.reflected[k] == 0 && b.transmitted[k] == 0 && b.error == 0);
            check("ggx kd=.5", cosines[i], both.reflected[k], shine.reflected[k] + .5, both.error + shine.error);
        }
    }
}

/* The integral at normal incidence of an isotropic model, in r = tan(theta_m), by the tanh-sinh rule. */
static double at_normal_incidence(const char *spec)
{
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    const quadrature rule = unit_interval(1.0/64);
    double sum = 0;
    for (int i = 0; i < rule.n; i++) {
        const double r = rule.x[i], r2 = r*r;
        const double wi[3] = {2*r/(1 + r2), 0, (1 - r)*(1 + r)/(1 + r2)}, wo[3] = {0, 0, 1};
        double f[3];
        any_eval(&bsdf, wi, wo, f);
        sum += rule.w[i]*f[0]*8*PI*r/((1 + r2)*(1 + r2));
    }
    return sum;
}

/* Lobes of any width: at normal incidence by the other rule, which is good to 1e-9. */
static void narrow_lobes_are_not_missed(void **state)
{
    (void)state;
    static const char *const specs[] = {"ggx alpha=1e-4",      "ggx alpha=1e-3",        "ggx alpha=4",
                                        "beckmann alpha=1e-4", "beckmann alpha=.02",    "phong exponent=1e6",
                                        "phong exponent=1",    "ggx alpha=.1 metal=Cu", "ggx alpha=.02 g2=separable"};
    for (size_t i = 0; i < sizeof specs/sizeof specs[0]; i++) {
        const albedo a = albedo_of(specs[i], 1, 0);
        check(specs[i], 1, a.reflected[0], at_normal_incidence(specs[i]), a.error + 1e-9);
    }
}

/* Mean weights of samples from a lattice of numbers.  The integrand has a kink at the horizon: 2e-4 with 300 x 300. */
static void mean_weight(const char *spec, double cos_o, double phi, double *reflected, double *transmitted)
{
    enum { SIDE = 300 };
    const facet_bsdf64 bsdf = prepared(spec);
    double wo[3];
    any_direction(cos_o, phi, wo);
    *reflected = *transmitted = 0;
    for (int i = 0; i < SIDE*SIDE; i++) {
        const double u[3] = {(i%SIDE + .5)/SIDE, (i + .5)/(SIDE*SIDE), fmod(i*0.6180339887498949, 1)};
        const facet_sample64 s = facet_bsdf64_sample(&bsdf, wo, u);
        *(s.wi[2]*cos_o > 0 ? reflected : transmitted) += s.pdf > 0 ? s.weight[0]/(SIDE*SIDE) : 0;
    }
}

static void albedo_is_the_mean_weight_of_samples(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double cos_o, phi;
    } cases[] = {{"ggx alpha_x=1e-4 alpha_y=1", .7, .3},
                 {"ggx alpha_x=1e-4 alpha_y=1", .01, 1},
                 {"ggx alpha_x=.5 alpha_y=.01", .1, 0},
                 {"ggx alpha=.3", 1e-3, 0},
                 {"ggx alpha=1e-4", 1e-4, 0},
                 {"beckmann alpha=.05", .05, 0},
                 {"ggx alpha=.5 g2=separable", .2, 2},
                 {"metallic_roughness metallic=1 roughness=.5", .2, 3}};
    for (size_t i = 0; i < sizeof cases/sizeof cases[0]; i++) {
        double reflected, transmitted;
        const albedo a = albedo_of(cases[i].spec, cases[i].cos_o, cases[i].phi);
        mean_weight(cases[i].spec, cases[i].cos_o, cases[i].phi, &reflected, &transmitted);
        check(cases[i].spec, cases[i].cos_o, a.reflected[0], reflected, 2e-4);
        check(cases[i].spec, cases[i].cos_o, a.transmitted[0], transmitted, 2e-4);
    }
}

/* The same for rough glass, bent or straight; three numbers, weights to 2.25, edges of total reflection: 1e-3. */
static void rough_glass_refracts_what_its_samples_weigh(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double cos_o;
    } cases[] = {{"glass alpha=.3", .7},           {"glass alpha=.3", -.9},        {"glass alpha=.05", -.74},
                 {"glass alpha=1 ior=1.2", .3},    {"glass alpha=1 ior=1.2", -.5}, {"glass alpha=.2 wall=thin", .5},
                 {"glass alpha=.2 wall=thin", -.5}};
    facet_material m;
    if (facet_material_parse(cases[0].spec, &m, NULL)) {
        print_message("  glass is smooth only\n");
        skip();
    }
    for (size_t i = 0; i < sizeof cases/sizeof cases[0]; i++) {
        double reflected, transmitted;
        const albedo a = albedo_of(cases[i].spec, cases[i].cos_o, .3);
        mean_weight(cases[i].spec, cases[i].cos_o, .3, &reflected, &transmitted);
        check(cases[i].spec, cases[i].cos_o, a.reflected[0], reflected, 1e-3);
        check(cases[i].spec, cases[i].cos_o, a.transmitted[0], transmitted, 1e-3);
    }
}

/* A material that is turned by a quarter looks the same from a view that is. */
static void anisotropy_turns_with_the_tangent(void **state)
{
    (void)state;
    const albedo a = albedo_of("ggx alpha_x=.02 alpha_y=.4", .3, .5),
                 b = albedo_of("ggx alpha_x=.4 alpha_y=.02", .3, .5 + PI/2);
    check("ggx alpha_x=.02 alpha_y=.4", .3, a.reflected[1], b.reflected[1], a.error + b.error);
    assert_true(fabs(a.reflected[1] - albedo_of("ggx alpha_x=.4 alpha_y=.02", .3, .5).reflected[1]) > 1e-3);
}

/* Fresnel's reflectance, by its two polarisations. */
static double glass_reflectance(double c, double eta)
{
    const double sin2 = (1 - c*c)/(eta*eta), t = sqrt(fmax(1 - sin2, 0));
    const double s = (c - eta*t)/(c + eta*t), p = (eta*c - t)/(eta*c + t);
    return sin2 < 1 ? (s*s + p*p)/2 : 1;
}

/* Mirrors have no integrand: F, and (1 - F) tint/eta^2 through a solid body, 2F/(1 + F) at a thin wall. */
static void smooth_glass_is_exact(void **state)
{
    (void)state;
    static const double cosines[] = {1, .9, .5, .1, .01, 1e-4};
    for (int i = 0; i < 6; i++)
        for (int inside = 0; inside < 2; inside++) {
            const double c = cosines[i], side = inside ? -c : c;
            const struct {
                const char *spec;
                double ior, tint;
            } cases[] = {{"glass tint=.5", 1.5, .5}, {"glass ior=1.01", 1.01, 1}, {"glass ior=.7", .7, 1}};
            for (int j = 0; j < 3; j++) {
                const double eta = inside ? 1/cases[j].ior : cases[j].ior, F = glass_reflectance(c, eta);
                const albedo a = albedo_of(cases[j].spec, side, 1);
                check(cases[j].spec, side, a.reflected[2], F, 1e-13);
                check(cases[j].spec, side, a.transmitted[2], (1 - F)*cases[j].tint/(eta*eta), 1e-13);
            }
            const double F = glass_reflectance(c, 2), both = 2*F/(1 + F);
            const albedo a = albedo_of("glass ior=2 wall=thin", side, 1);
            check("glass wall=thin", side, a.reflected[0], both, 1e-13);
            check("glass wall=thin", side, a.transmitted[0], 1 - both, 1e-13);
        }
}

static albedo average_of(const char *spec, int is_inside)
{
    const facet_bsdf64 bsdf = prepared(spec);
    albedo a;
    assert_int_equal(facet_bsdf64_average_albedo(&bsdf, is_inside, a.reflected, a.transmitted, &a.error), FACET_OK);
    if (!(a.error >= 0 && a.error < 1e-6)) fail_msg("%s, average: stated error %.2g", spec, a.error);
    return a;
}

/* Six and nine digits of independent programs. */
static void averages_are_known(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double value, digits;
    } known[] = {{"ggx alpha=1", .409137, 6e-7},
                 {"ggx alpha=1 g2=separable", .376635, 6e-7},
                 {"ggx alpha=.599375650364204", .631068, 6e-7}, /* (24/31)^2 */
                 {"ggx alpha=.599375650364204 g2=separable", .616010, 6e-7},
                 {"ggx alpha=.266389177939646", .870874, 6e-7}, /* (16/31)^2 */
                 {"ggx alpha=.266389177939646 g2=separable", .867632, 6e-7},
                 {"lambert kd=.5", .5, 0}};
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++) {
        const albedo a = average_of(known[i].spec, 0);
        check(known[i].spec, 0, a.reflected[0], known[i].value, a.error + known[i].digits);
        assert_true(a.transmitted[0] == 0);
    }
    const double outside = .091777959, inside = .596345760; /* of 1.5 */
    const albedo out = average_of("glass", 0), in = average_of("glass", 1);
    check("glass", 1, out.reflected[0], outside, out.error + 6e-10);
    check("glass", 1, out.transmitted[0], (1 - outside)/2.25, out.error + 6e-10);
    check("glass", -1, in.reflected[0], inside, in.error + 6e-10);
    check("glass", -1, in.transmitted[0], (1 - inside)*2.25, in.error + 2e-9);
}

/* Anisotropic: the albedo itself, averaged by another rule, 10 cosines by 6 azimuths of a quarter. */
static void average_is_over_azimuths_too(void **state)
{
    (void)state;
    const char *const spec = "ggx alpha_x=.5 alpha_y=1";
    const quadrature cosine = gauss_legendre(10, 0, 1), azimuth = periodic_rule(6, 0, PI/2);
    double sum = 0;
    for (int i = 0; i < cosine.n; i++)
        for (int j = 0; j < azimuth.n; j++)
            sum += cosine.w[i]*2*cosine.x[i]*albedo_of(spec, cosine.x[i], azimuth.x[j]).reflected[0]/6;
    check(spec, 0, average_of(spec, 0).reflected[0], sum, 2e-6);
}

/* Number k of a file beside the source tree, numbers separated by commas or lines; all n of them, or none. */
static int read_numbers(const char *name, double *to, int n)
{
    char path[512];
    snprintf(path, sizeof path, "%s/../shared/external/%s", FACET_SOURCE_DIR, name);
    FILE *file = fopen(path, "r");
    if (!file) {
        print_message("  %s is not beside the source tree\n", name);
        return 0;
    }
    int read = 0;
    while (read < n && fscanf(file, "%lf%*[, \n]", &to[read]) >= 1) read++;
    fclose(file);
    assert_int_equal(read, n);
    return 1;
}

/* Every fifth entry.  Of Cycles, G2 height-correlated: cosine i/31, roughness j/31 = sqrt(alpha), sums that are
 * good to 1e-5 and 2e-6; of OpenPBR, G2 = G1 G1: roughness by cosine, 1 - E in 16 bits, sampled. */
static void tables_of_renderers_agree(void **state)
{
    (void)state;
    static double table[1024];
    char spec[64];
    if (read_numbers("cycles_tables/ggx_E_32x32.csv", table, 1024))
        for (int i = 1; i < 32; i += 5)
            for (int j = 6; j < 32; j += 5) {
                snprintf(spec, sizeof spec, "ggx alpha=%.17g", j*j/961.0);
                check(spec, i/31.0, albedo_of(spec, i/31.0, 0).reflected[0], table[32*i + j],
                      i == 31 ? 2e-6 : 1e-5);
            }
    if (read_numbers("openpbr_energy_tables/ideal_metal_energy_complement.csv", table, 1024))
        for (int j = 6; j < 32; j += 5)
            for (int i = 1; i < 32; i += 5) {
                snprintf(spec, sizeof spec, "ggx alpha=%.17g g2=separable", j*j/961.0);
                check(spec, i/31.0, albedo_of(spec, i/31.0, 0).reflected[0], 1 - table[32*j + i]/65535,
                      j >= 16 ? 5e-5 : 3e-3);
            }
}

static void bad_arguments_leave_the_outputs(void **state)
{
    (void)state;
    const facet_bsdf64 bsdf = prepared("ggx");
    const double wo[3] = {0, 0, 1}, long_one[3] = {0, .6, .9}, none[3] = {NAN, 0, 1};
    double r[3] = {7, 7, 7}, t[3] = {7, 7, 7}, error = 7;
    assert_int_equal(facet_bsdf64_albedo(NULL, wo, r, t, &error), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, NULL, r, t, &error), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, wo, NULL, t, &error), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, wo, r, NULL, &error), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, long_one, r, t, &error), FACET_BAD_VALUE);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, none, r, t, &error), FACET_BAD_VALUE);
    assert_int_equal(facet_bsdf64_average_albedo(NULL, 0, r, t, &error), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_average_albedo(&bsdf, 0, NULL, t, &error), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_average_albedo(&bsdf, 0, r, NULL, &error), FACET_BAD_ARGUMENT);
    for (int k = 0; k < 3; k++) assert_true(r[k] == 7 && t[k] == 7 && error == 7);
    const double horizon[3] = {1, 0, 0};
    assert_int_equal(facet_bsdf64_albedo(&bsdf, horizon, r, t, NULL), FACET_OK);
    for (int k = 0; k < 3; k++) assert_true(r[k] == 0 && t[k] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedo_is_as_good_as_it_says),
        cmocka_unit_test(narrow_lobes_are_not_missed),
        cmocka_unit_test(albedo_is_the_mean_weight_of_samples),
        cmocka_unit_test(rough_glass_refracts_what_its_samples_weigh),
        cmocka_unit_test(anisotropy_turns_with_the_tangent),
        cmocka_unit_test(smooth_glass_is_exact),
        cmocka_unit_test(averages_are_known),
        cmocka_unit_test(average_is_over_azimuths_too),
        cmocka_unit_test(tables_of_renderers_agree),
        cmocka_unit_test(bad_arguments_leave_the_outputs),
    };
    return cmocka_run_group_tests_name("albedo_quadrature", tests, NULL, NULL);
}
