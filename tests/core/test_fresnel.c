/* test_fresnel.c: conductors, F82 and the averages of every Fresnel term.
 *
 * Independent values: the textbook formula in the compiler's complex arithmetic, in long double; the 25-digit table of
 * the dielectric; quadrature by another rule; measured indices of gold.  (fresnel_agrees_with_25_digits of
 * test_reference_tables.c has the dielectric and Schlick.)
 * SPDX-License-Identifier: MIT */
#include <complex.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/metals.h"
#include "tests/any_bsdf.h"
#include "tests/kernel_access.h"
#include "tests/table_file.h"
#include "verify/quadrature.h"

static const kernel_access *const builds[] = {&kernel_access_f32, &kernel_access_f64};

/* Cosines from grazing to normal; those that float holds, so that both builds see the same. */
static const double cosines[] = {0,    0x1p-100, 0x1p-40, 0x1p-20, 0x1p-10, .03125,     .125,          .25, .5,
                                 .625, .75,      .875,    .9375,   .984375, 0x1.ffep-1, 0x1.fffffep-1, 1};
enum { N_COSINES = sizeof cosines/sizeof cosines[0] };

static void check(const char *what, const kernel_access *build, double x, double y, double z, double got, double want,
                  double bound)
{
    if (!(fabs(got - want) <= bound))
        fail_msg("%s(%a, %a, %a), %s: got %a, want %a: off by %.3g, bound %.3g", what, x, y, z, build->name, got, want,
                 fabs(got - want), bound);
}

/* Fresnel's equations as printed, in complex long double. */
static double textbook_conductor(double c, double eta, double k)
{
    const long double complex n = (long double)eta + (long double)k*I, n2 = n*n;
    const long double cosine = c;
    const long double complex w = csqrtl((n - 1)*(n + 1) + cosine*cosine);
    const long double complex s = (cosine - w)/(cosine + w), p = (n2*cosine - w)/(n2*cosine + w);
    return (double)((creall(s*conjl(s)) + creall(p*conjl(p)))/2);
}

/* Some ten roundings of terms that do not cancel: 16 eps; what is below 1e-30 counts as 0.  Float holds the indices. */
static void conductor_agrees_with_complex_arithmetic(void **state)
{
    (void)state;
    static const double indices[] = {0x1.47ae14p-7, 0x1.99999ap-4, .25, .5,  .75, .9375, 0x1.fcp-1, 1,
                                     1.015625,      1.25,          1.5, 2.5, 4,   20},
                        losses[] = {0x1p-66, 0x1p-30, 0x1p-12, 0x1p-7, .0625, .25, .5,  .75,
                                    1,       1.5,     2.5,     4,      7,     20,  1e3, 1e6};
    for (size_t i = 0; i < sizeof indices/sizeof indices[0]; i++)
        for (size_t j = 0; j < sizeof losses/sizeof losses[0]; j++)
            for (int n = 0; n < N_COSINES; n++) {
                const double c = cosines[n], eta = indices[i], k = losses[j], want = textbook_conductor(c, eta, k);
                for (int b = 0; b < 2; b++) {
                    const double F = builds[b]->fresnel_conductor(c, eta, k);
                    check("conductor", builds[b], c, eta, k, F, want, 16*builds[b]->epsilon*want + 1e-36);
                    if (!(F >= 0 && F <= 1)) fail_msg("conductor(%a, %a, %a) = %a", c, eta, k, F);
                }
            }
}

/* ... and lossless it is the dielectric, total reflection included: against the 25-digit table in double, and against
 * fresnel_dielectric in both.  They may differ in how they round near the critical angle, where F is as steep as a
 * square root: 2 sqrt(eps). */
static void lossless_conductor_is_the_dielectric(void **state)
{
    (void)state;
    table_file row;
    char path[512];
    int n_rows = 0;
    snprintf(path, sizeof path, "%s/tests/data/reference/fresnel.csv", FACET_SOURCE_DIR);
    assert_true(table_file_open(&row, path));
    for (; table_file_next(&row); n_rows++) {
        const double eta = table_file_number(&row, "eta_t_over_eta_i"), c = table_file_number(&row, "cos");
        const double want = table_file_number(&row, "F");
        check("conductor", builds[1], c, eta, 0, builds[1]->fresnel_conductor(c, eta, 0), want, 1e-13*want);
    }
    assert_true(n_rows > 40);
    static const double indices[] = {.125, .5, .75, .9375, 1.0625, 1.5, 4, 16};
    for (size_t i = 0; i < sizeof indices/sizeof indices[0]; i++)
        for (int n = 0; n < N_COSINES; n++)
            for (int b = 0; b < 2; b++) {
                const double c = cosines[n], eta = indices[i], critical = (1 - eta)*(1 + eta) - c*c;
                const double want = builds[b]->fresnel_dielectric(c, eta), eps = builds[b]->epsilon;
                const double F = builds[b]->fresnel_conductor(c, eta, 0);
                check("conductor", builds[b], c, eta, 0, F, want,
                      fabs(critical) < 1e-3 ? 2*sqrt(eps) : 64*eps*want);
                if (critical > 1e-3 && F != 1) fail_msg("total reflection: F(%a, %a) = %a", c, eta, F);
            }
    for (int b = 0; b < 2; b++) { /* no interface: nothing, and at grazing incidence the limit of all others */
        check("conductor", builds[b], .5, 1, 0, builds[b]->fresnel_conductor(.5, 1, 0), 0, 0);
        check("conductor", builds[b], 0, 1, 0, builds[b]->fresnel_conductor(0, 1, 0), 1, 0);
    }
}

/* Gold's index by Johnson and Christy, interpolated at 650, 550 and 450 nm: F0 to the four digits that are known. */
static void gold_is_golden(void **state)
{
    (void)state;
    static const double gold[3][3] = {
        {.1555737705, 3.602444965, .9565}, {.4241492537, 2.472050746, .7916}, {1.383088235, 1.9155, .4082}};
    for (int i = 0; i < 3; i++)
        for (int b = 0; b < 2; b++)
            check("gold", builds[b], 1, gold[i][0], gold[i][1], builds[b]->fresnel_conductor(1, gold[i][0], gold[i][1]),
                  gold[i][2], 5e-5);
}

/* The definition of the tint: F(1/7) = tint Schlick(1/7); ends F0 and 1; tint 1 is Schlick; nowhere outside [0,1].
 * 1/7 is rounded, and the result is a difference of two numbers below 2: 8 eps. */
static void f82_tints_schlick_at_one_seventh(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++)
        for (int i = 0; i <= 8; i++)
            for (int j = 0; j <= 8; j++) {
                const double F0 = i/8.0, tint = j/8.0, eps = builds[b]->epsilon;
                const double schlick = F0 + (1 - F0)*pow(6.0/7, 5);
                check("f82", builds[b], 1/7., F0, tint, builds[b]->fresnel_f82(1/7., F0, tint), tint*schlick,
                      8*eps);
                check("f82", builds[b], 1, F0, tint, builds[b]->fresnel_f82(1, F0, tint), F0, 0);
                check("f82", builds[b], 0, F0, tint, builds[b]->fresnel_f82(0, F0, tint), 1, eps);
                for (int n = 0; n < N_COSINES; n++) {
                    const double c = cosines[n], F = builds[b]->fresnel_f82(c, F0, tint), d = 1 - c;
                    if (!(F >= 0 && F <= 1 + eps)) fail_msg("f82(%a, %a, %a) = %a", c, F0, tint, F);
                    if (tint == 1) check("f82", builds[b], c, F0, 1, F, F0 + (1 - F0)*d*d*d*d*d, 4*eps);
                }
            }
}

typedef enum term { SCHLICK, DIELECTRIC, CONDUCTOR, F82 } term;

static double double_term(term which, double c, double x, double y)
{
    switch (which) {
    case SCHLICK: return x + (y - x)*pow(1 - c, 5);
    case DIELECTRIC: return kernel_access_f64.fresnel_dielectric(c, x);
    case CONDUCTOR: return kernel_access_f64.fresnel_conductor(c, x, y);
    case F82: return kernel_access_f64.fresnel_f82(c, x, y);
    }
    return 0;
}

/* 2 Int F(c) c dc between two cosines by 48 Gauss points; at both ends crowded as c ~ u^3, where F may start like a
 * root. */
static double average_between(term which, double x, double y, double low, double high)
{
    const quadrature rule = gauss_legendre(48, 0, 1);
    double sum = 0;
    for (int i = 0; i < rule.n; i++) {
        const double u = rule.x[i], c = low + (high - low)*u*u*u*(10 + u*(6*u - 15));
        const double dc = (high - low)*30*u*u*(1 - u)*(1 - u);
        sum += rule.w[i]*dc*2*c*double_term(which, c, x, y);
    }
    return sum;
}

/* In parts, one border at the critical angle. */
static double average(term which, double x, double y)
{
    const double cos2 = (1 - x)*(1 + x) + (which == CONDUCTOR ? y*y : 0);
    const double critical = which == DIELECTRIC || which == CONDUCTOR ? sqrt(fmin(fmax(cos2, 0), 1)) : .5;
    return average_between(which, x, y, 0, .1*critical) + average_between(which, x, y, .1*critical, critical) +
           average_between(which, x, y, critical, critical + .1*(1 - critical)) +
           average_between(which, x, y, critical + .1*(1 - critical), 1);
}

static void schlick_and_f82_averages_are_exact(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++)
        for (int i = 0; i <= 8; i++)
            for (int j = 0; j <= 8; j++) {
                const double x = i/8.0, y = j/8.0, bound = 4*builds[b]->epsilon + 1e-14;
                check("schlick_average", builds[b], x, y, 0, builds[b]->schlick_average(x, y), average(SCHLICK, x, y),
                      bound);
                const double got = builds[b]->f82_average(x, y), want = average(F82, x, y);
                if (y > .51 || (x > .3 && y > .1)) check("f82_average", builds[b], x, y, 0, got, want, bound);
                else if (!(got <= want + 1e-3 && got >= want - .022 - 1e-3 && got >= 0)) /* kinks: 1e-3 */
                    fail_msg("f82_average(%a, %a) = %a, not %a", x, y, got, want);
            }
}

/* Nine digits of an independent program; both sides of one interface, 1 - F = (1 - F')/n^2; quadrature. */
static void dielectric_average_is_exact(void **state)
{
    (void)state;
    static const double known[][3] = {{1.33, .065930849, .471949149},
                                      {1.5, .091777959, .596345760},
                                      {1.6, .106245568, .650877175},
                                      {2, .160596637, .790149159},
                                      {2.5, .221866574, .875498652}};
    for (int b = 0; b < 2; b++) {
        const double eps = builds[b]->epsilon;
        for (int i = 0; i < 5; i++) {
            const double n = known[i][0];
            check("dielectric_average", builds[b], n, 0, 0, builds[b]->dielectric_average(n), known[i][1],
                  4*eps + 6e-10);
            check("dielectric_average", builds[b], 1/n, 0, 0, builds[b]->dielectric_average(1/n), known[i][2],
                  4*eps + 6e-10);
        }
        for (double n = 1 + 0x1p-20; n < 30; n = 1 + (n - 1)*1.25) {
            const double outside = builds[b]->dielectric_average(n), inside = builds[b]->dielectric_average(1/n);
            check("dielectric_average", builds[b], n, 0, 0, outside, average(DIELECTRIC, n, 0), 4*eps + 1e-10);
            check("dielectric_average", builds[b], 1/n, 0, 0, 1 - inside, (1 - outside)/(n*n), 4*eps);
        }
        check("dielectric_average", builds[b], 1, 0, 0, builds[b]->dielectric_average(1), 0, 0);
    }
}

/* The stated error of the rule; lossless, the closed form. */
static void conductor_average_keeps_its_error(void **state)
{
    (void)state;
    static const double losses[] = {0, 1e-4, .003, .02, .1, .3, .5, .7, 1, 2, 4, 8, 20};
    for (double eta = .01; eta < 20; eta *= 1.3)
        for (size_t j = 0; j < sizeof losses/sizeof losses[0]; j++) {
            const double k = losses[j], want = average(CONDUCTOR, eta, k), bound = k >= .5 ? 5e-8 : 2e-6;
            check("conductor_average", builds[1], eta, k, 0, builds[1]->conductor_average(eta, k), want, bound);
            check("conductor_average", builds[0], eta, k, 0, builds[0]->conductor_average(eta, k), want, bound + 1e-6);
            if (k == 0)
                check("conductor_average", builds[1], eta, 0, 0, builds[1]->conductor_average(eta, 0),
                      builds[1]->dielectric_average(eta), 2e-6);
        }
}

/* f of a material over that of the same one with F = 1 (ks = 1), at wi.wm = c. */
static void reflectance_in_material(const char *fresnel, int is_double, double c, double F[3])
{
    char spec[128];
    snprintf(spec, sizeof spec, "ggx alpha=.5 %s", fresnel);
    const any_bsdf bsdf = any_bsdf_of(spec, is_double), white = any_bsdf_of("ggx alpha=.5", is_double);
    const double s = sqrt((1 - c)*(1 + c)), wi[3] = {s, 0, c}, wo[3] = {-s, 0, c};
    double one[3];
    any_eval(&bsdf, wi, wo, F);
    any_eval(&white, wi, wo, one);
    for (int k = 0; k < 3; k++) F[k] /= one[k];
}

/* Each way to say a Fresnel term gives that term: roundings of the mirror geometry and of f, 64 eps. */
static void materials_have_the_term_that_they_name(void **state)
{
    (void)state;
    static const char *const names[METALS] = {"metal=Ag", "metal=Al", "metal=Au", "metal=Co", "metal=Cr",
                                              "metal=Cu", "metal=Fe", "metal=Ni", "metal=Ti"};
    for (int b = 0; b < 2; b++)
        for (double c = .125; c <= 1; c += .125) {
            double F[3];
            const double bound = 64*builds[b]->epsilon;
            for (int i = 0; i < METALS; i++) {
                reflectance_in_material(names[i], b, c, F);
                for (int k = 0; k < 3; k++)
                    check(names[i], builds[b], c, k, 0, F[k], textbook_conductor(c, metals[i].eta[k], metals[i].k[k]),
                          bound);
            }
            reflectance_in_material("eta=.25,1,4 k=3,2,.5", b, c, F);
            for (int k = 0; k < 3; k++)
                check("eta k", builds[b], c, k, 0, F[k],
                      textbook_conductor(c,
                                         k == 0   ? .25
                                         : k == 1 ? 1
                                                  : 4,
                                         k == 0   ? 3
                                         : k == 1 ? 2
                                                  : .5),
                      bound);
            reflectance_in_material("ks=.25,.5,.75 f82=1,.75,.5", b, c, F);
            for (int k = 0; k < 3; k++)
                check("ks f82", builds[b], c, k, 0, F[k], kernel_access_f64.fresnel_f82(c, .25 + .25*k, 1 - .25*k),
                      bound);
            reflectance_in_material("ior=1.5", b, c, F);
            for (int k = 0; k < 3; k++) check("ior", builds[b], c, k, 0, F[k], textbook_conductor(c, 1.5, 0), bound);
        }
}

/* The probability of the diffuse lobe is |kd|/(|kd| + |F(1)|), with the F of the material, and 7/8 at most:
 * pdf = p cos/pi + (1 - p) pdf without kd. */
static void diffuse_lobe_has_its_share(void **state)
{
    (void)state;
    static const struct {
        const char *fresnel;
        double F1[3];
    } cases[] = {{"eta=.5 k=.5", {.2, .2, .2}}, /* (1/4 + 1/4)/(9/4 + 1/4) */
                 {"ks=.25 f82=.5", {.25, .25, .25}},
                 {"ks=.1,.2,.3", {.1, .2, .3}},
                 {"ior=3", {.25, .25, .25}},
                 {"ior=1.125", {1/289., 1/289., 1/289.}}};
    const double wi[3] = {.6, 0, .8}, wo[3] = {0, -.6, .8}, kd = .5*sqrt(3), pi = 3.14159265358979323846;
    for (size_t i = 0; i < sizeof cases/sizeof cases[0]; i++)
        for (int b = 0; b < 2; b++) {
            char spec[128];
            snprintf(spec, sizeof spec, "ggx alpha=.5 kd=.5 %s", cases[i].fresnel);
            const any_bsdf bsdf = any_bsdf_of(spec, b), bare = any_bsdf_of("ggx alpha=.5", b);
            const double *F1 = cases[i].F1, share = kd/(kd + sqrt(F1[0]*F1[0] + F1[1]*F1[1] + F1[2]*F1[2]));
            const double p = fmin(share, .875);
            check(cases[i].fresnel, builds[b], p, 0, 0, any_pdf(&bsdf, wi, wo),
                  p*.8/pi + (1 - p)*any_pdf(&bare, wi, wo), 16*builds[b]->epsilon);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conductor_agrees_with_complex_arithmetic),
        cmocka_unit_test(lossless_conductor_is_the_dielectric),
        cmocka_unit_test(gold_is_golden),
        cmocka_unit_test(f82_tints_schlick_at_one_seventh),
        cmocka_unit_test(schlick_and_f82_averages_are_exact),
        cmocka_unit_test(dielectric_average_is_exact),
        cmocka_unit_test(conductor_average_keeps_its_error),
        cmocka_unit_test(materials_have_the_term_that_they_name),
        cmocka_unit_test(diffuse_lobe_has_its_share),
    };
    return cmocka_run_group_tests_name("fresnel", tests, NULL, NULL);
}
