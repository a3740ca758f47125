/* test_external_truths.c: values that other renderers and programs computed, each by its own convention of masking.
 *
 * Mitsuba's expected values lie in tests/data; the energy tables of Cycles and OpenPBR are used where they lie beside
 * the source tree.  (test_albedo_quadrature.c has the tables of metals, test_fresnel.c the averages of Fresnel.)
 *
 * Cycles     G2 = 1/(1 + Lambda_i + Lambda_o), for what is refracted too; power (no square of the index).
 * OpenPBR    G2 = G1 G1 on both sides; complements of the power, in 16 bits.
 * Mitsuba    D, G1 and samples of all normals, in single precision.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"
#include "tests/any_bsdf.h"
#include "tests/kernel_access.h"
#include "tests/table_file.h"
#include "verify/quadrature.h"

#define TWO_PI 6.283185307179586

/* ---- Mitsuba --------------------------------------------------------------------------------------------------- */

static void open_mitsuba(table_file *row, const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/tests/data/mitsuba/%s", FACET_SOURCE_DIR, name);
    if (!table_file_open(row, path)) fail_msg("%s is missing", path);
}

/* The angle has a rounding of float, which D's exponent x^2 takes twice (as tan^2) and times theta/(sin cos) < 2, and
 * G1 over cos(theta); eight roundings for the rest, on either side. */
static void terms_are_mitsubas(void **state)
{
    (void)state;
    double worst = 0;
    int n = 0;
    table_file row;
    open_mitsuba(&row, "terms.csv");
    for (; table_file_next(&row); n++) {
        const double theta = table_file_number(&row, "theta"), phi = table_file_number(&row, "phi");
        const double alpha_x = table_file_number(&row, "alpha_x"), alpha_y = table_file_number(&row, "alpha_y");
        const double want = table_file_number(&row, "value");
        const char *which = table_file_text(&row, "distribution"), *quantity = table_file_text(&row, "quantity");
        const int is_G1 = !strcmp(quantity, "G1"), is_beckmann = !strcmp(which, "beckmann");
        char spec[160];
        snprintf(spec, sizeof spec, "%s alpha_x=%g alpha_y=%g %s", which, alpha_x, alpha_y,
                 is_beckmann ? "masking=published" : "");
        double m[3];
        any_direction(cos(theta), phi, m);
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(spec, is_double);
            const facet_terms64 t = any_terms(&bsdf, m);
            const double got = is_G1 ? t.G1 : !strcmp(quantity, "pdf") ? t.D*m[2] : t.D;
            const double x = tan(theta)*cos(phi)/alpha_x, y = tan(theta)*sin(phi)/alpha_y;
            const double condition = is_G1 ? 1/cos(theta) : 4*(x*x + y*y);
            const double error = fabs(got - want), bound = 0x1p-24*(16 + 2*condition)*want + 1e-30;
            if (want > 0) worst = fmax(worst, error/bound);
            if (!(error <= bound || (want == 0 && got < 1e-15)))
                fail_msg("line %d, %s, %s: %.9g, not %.9g", row.line, is_double ? "double" : "float", quantity, got,
                         want);
        }
    }
    assert_int_equal(n, 247);
    print_message("  largest deviation: %.2g of the bound\n", worst);
}

static void samples_are_mitsubas(void **state)
{
    (void)state;
    int n = 0;
    table_file row;
    open_mitsuba(&row, "samples.csv");
    for (; table_file_next(&row); n++) {
        const int is_beckmann = !strcmp(table_file_text(&row, "distribution"), "beckmann");
        const kernel_distribution which = is_beckmann ? KERNEL_BECKMANN : KERNEL_GGX;
        const double alpha_x = table_file_number(&row, "alpha_x"), alpha_y = table_file_number(&row, "alpha_y");
        const double u1 = table_file_number(&row, "u1"), u2 = table_file_number(&row, "u2");
        const double want[3] = {table_file_number(&row, "m_x"), table_file_number(&row, "m_y"),
                                table_file_number(&row, "m_z")};
        const kernel_access *const builds[] = {&kernel_access_f32, &kernel_access_f64};
        for (int k = 0; k < 2; k++) {
            double m[3];
            builds[k]->sample_ndf(which, alpha_x, alpha_y, u1, u2, m);
            /* Mitsuba takes the sine from the cosine. */
            const double sine = hypot(m[0], m[1]), bound = 0x1p-24*(4 + (sine > 0 ? 1/sine : 0));
            for (int axis = 0; axis < 3; axis++)
                if (!(fabs(m[axis] - want[axis]) <= bound))
                    fail_msg("line %d, %s: axis %d is %.9g, not %.9g", row.line, builds[k]->name, axis, m[axis],
                             want[axis]);
            /* u1 = 5/6 has an exponent of 1.8, or a fourth power of D. */
            const double density = builds[k]->D(which, alpha_x, alpha_y, m)*m[2],
                         pdf = table_file_number(&row, "pdf");
            if (!(fabs(density - pdf) <= 32*0x1p-24*pdf))
                fail_msg("line %d, %s: density %.9g, not %.9g", row.line, builds[k]->name, density, pdf);
        }
    }
    assert_int_equal(n, 72);
}

/* ---- Programs of one-dimensional integrals --------------------------------------------------------------------- */

static double reflected(const char *spec, double cos_o)
{
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    double wo[3], r[3], t[3], error;
    any_direction(cos_o, 0, wo);
    assert_int_equal(facet_bsdf64_albedo(&bsdf.twice, wo, r, t, &error), FACET_OK);
    return r[0];
}

/* Ten and nine digits; those that other tests have are left out. */
static void albedos_at_normal_incidence(void **state)
{
    (void)state;
    static const double known[][2] = {{.0666, .995071411}, {.25, .9158124302}, {.75, .4639165109}};
    for (int i = 0; i < 3; i++)
        for (int is_separable = 0; is_separable < 2; is_separable++) { /* the same at the normal */
            char spec[64];
            snprintf(spec, sizeof spec, "ggx alpha=%g%s", known[i][0], is_separable ? " g2=separable" : "");
            const double got = reflected(spec, 1);
            if (!(fabs(got - known[i][1]) <= 6e-10)) fail_msg("%s: %.12f, not %.10f", spec, got, known[i][1]);
        }
}

/* The share of visible normals whose reflection is below the horizon, sampled to about 4 digits (the first is 1/17): by
 * the integral of the density, and by the samples of a Fibonacci lattice, whose discrepancy ln(N)/N is 5e-4. */
static void visible_normals_are_lost_as_known(void **state)
{
    (void)state;
    static const double cosines[] = {1, .75, .5, .25, .1}, alphas[] = {.25, .5, .75};
    static const double known[3][5] = {
        {.0587, .0639, .0700, .0632, .0310}, {.2000, .1883, .1607, .1024, .0465}, {.3600, .3143, .2479, .1500, .0682}};
    enum { COUNT = 17711, BEFORE = 10946 };
    const quadrature rule = unit_interval(1.0/
                                          16); /* towards the horizon, and the azimuth of the mirrored direction */
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 5; c++)
            for (int is_double = 0; is_double < 2; is_double++) {
                char spec[64];
                snprintf(spec, sizeof spec, "ggx alpha=%g", alphas[a]);
                const any_bsdf bsdf = any_bsdf_of(spec, is_double);
                double wo[3], sum = 0;
                any_direction(cosines[c], 0, wo);
                for (int i = 0; i < rule.n; i++)
                    for (int j = 0; j < rule.n; j++) {
                        double wi[3];
                        any_direction(rule.x[i], TWO_PI/2*(1 - rule.x[j]), wi);
                        sum += rule.w[i]*rule.w[j]*TWO_PI*any_pdf(&bsdf, wi, wo);
                    }
                int lost = 0;
                for (int k = 0; k < COUNT; k++) {
                    const double u[3] = {(k + .5)/COUNT, ((double)((int64_t)k*BEFORE%COUNT) + .5)/COUNT, .5};
                    lost += any_sample(&bsdf, wo, u).pdf == 0;
                }
                const double drawn = lost/(double)COUNT;
                if (!(fabs(1 - sum - known[a][c]) <= 3e-4 && fabs(1 - sum - drawn) <= 5e-4))
                    fail_msg("%s, cos_o %g: %.5f and %.5f are lost, not %.4f", spec, cosines[c], 1 - sum, drawn,
                             known[a][c]);
            }
}

/* ---- Energy tables --------------------------------------------------------------------------------------------- */

/* All n numbers of a file beside the source tree, separated by commas or lines; 0 if it is not there. */
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

typedef struct average {
    double reflected, transmitted;
} average;

static average average_of(const char *spec)
{
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    double r[3], t[3], error;
    assert_int_equal(facet_bsdf64_average_albedo(&bsdf.twice, 0, r, t, &error), FACET_OK);
    return (average){.reflected = r[0], .transmitted = t[0]};
}

/* The correlated masking, 2^26 points of a Sobol sequence, six digits. */
static void averages_are_cycles(void **state)
{
    (void)state;
    static double table[32];
    if (!read_numbers("cycles_tables/ggx_Eavg_32.csv", table, 32)) skip();
    double worst = 0;
    for (int j = 6; j < 32; j += 5) {
        char spec[64];
        snprintf(spec, sizeof spec, "ggx alpha=%.17g", j*j/961.0);
        const double error = fabs(average_of(spec).reflected - table[j]);
        worst = fmax(worst, error);
        if (!(error <= 2e-6)) fail_msg("%s: off by %.2g", spec, error);
    }
    print_message("  largest deviation: %.2g\n", worst);
}

/* What a rough interface sends on as power, with the masking of one side for both.  The sampler's first two numbers,
 * from a Fibonacci lattice, give a visible normal; the third, from below or above F, makes it reflect or refract with
 * the weight G2/G1(wo); refractions are changed from G1 G1 to Cycles' G2. */
static double cycles_glass(const any_bsdf *bsdf, double ior, double cos_o)
{
    enum { COUNT = 28657, BEFORE = 17711 };
    double wo[3], sum = 0;
    any_direction(cos_o, 0, wo);
    const double Lambda_o = any_terms(bsdf, wo).Lambda;
    for (int k = 0; k < COUNT; k++)
        for (int way = 0; way < 2; way++) {
            const double u[3] = {(k + .5)/COUNT, ((double)((int64_t)k*BEFORE%COUNT) + .5)/COUNT,
                                 way ? 0x1.fffffep-1 : 0};
            const facet_sample64 s = any_sample(bsdf, wo, u);
            if (s.pdf == 0 || (s.wi[2] < 0) != way) continue;
            const double eta = way ? ior : 1; /* the half vector, and F */
            const double h[3] = {wo[0] + eta*s.wi[0], wo[1] + eta*s.wi[1], wo[2] + eta*s.wi[2]};
            const double length = sqrt(h[0]*h[0] + h[1]*h[1] + h[2]*h[2]);
            const double c = fabs(wo[0]*h[0] + wo[1]*h[1] + wo[2]*h[2])/length;
            const double F = kernel_access_f64.fresnel_dielectric(c, ior);
            const double above[3] = {s.wi[0], s.wi[1], fabs(s.wi[2])}, Lambda_i = any_terms(bsdf, above).Lambda;
            const double change = (1 + Lambda_i)*(1 + Lambda_o)/(1 + Lambda_i + Lambda_o);
            sum += (way ? 1 - F : F)*s.weight[0]*eta*eta*change;
        }
    return sum/COUNT;
}

/* Index (1 + z^2)/(1 - z^2) or its inverse, z = k/15; cosine i/15, roughness j/15.  At the normal the conventions are
 * one and the library's quadrature is compared, with 2^23 points and six digits: 1e-5.  Elsewhere the lattice above is
 * off by as much again, 3e-5 with the kinks of the horizon.  From inside Cycles also counts facets that refract back to
 * the viewer's side (a program of its own finds the table's values with them, and the library's without): the table is
 * an upper bound there. */
static void rough_glass_is_cycles(void **state)
{
    (void)state;
    static double tables[2][4096];
    static const char *const names[] = {"cycles_tables/ggx_glass_E_4096.csv", "cycles_tables/ggx_glass_inv_E_4096.csv"};
    if (!read_numbers(names[0], tables[0], 4096) || !read_numbers(names[1], tables[1], 4096)) skip();
    double worst[2] = {0};
    for (int k = 3; k < 15; k += 5)
        for (int j = 4; j < 16; j += 11)
            for (int is_inverse = 0; is_inverse < 2; is_inverse++) {
                const double z2 = k*k/225.0, above = (1 + z2)/(1 - z2), ior = is_inverse ? 1/above : above;
                char spec[120];
                snprintf(spec, sizeof spec, "glass alpha=%.17g ior=%.17g g2=separable", j*j/225.0, ior);
                const any_bsdf bsdf = any_bsdf_of(spec, 1);
                for (int i = 1; i < 16; i += 7) {
                    const double want = tables[is_inverse][256*k + 16*i + j];
                    double r[3], t[3], error;
                    const double wo[3] = {0, 0, 1};
                    if (i == 15) assert_int_equal(facet_bsdf64_albedo(&bsdf.twice, wo, r, t, &error), FACET_OK);
                    const double got = i == 15 ? r[0] + ior*ior*t[0] : cycles_glass(&bsdf, ior, i/15.0);
                    if (is_inverse && i < 15 && got < want) continue;
                    worst[i == 15] = fmax(worst[i == 15], fabs(got - want));
                    if (!(fabs(got - want) <= (i == 15 ? 1e-5 : 3e-5)))
                        fail_msg("%s, cosine %d/15: %.6f, not %.6f", spec, i, got, want);
                }
            }
    print_message("  largest deviation: %.2g, at the normal %.2g\n", worst[0], worst[1]);
}

/* Index 1 + (k - 16)/10 from k = 16 on, its inverse before: 1 + (15 - k)/10; roughness j/31, cosine i/31. */
static double openpbr_index(int k)
{
    return k < 16 ? 1/(1 + (15 - k)/10.0) : 1 + (k - 16)/10.0;
}

/* Complements 1 - E of what is reflected (opaque) and of all that leaves (ideal).  Where both conventions are one, at
 * the normal, Cycles' table has the library's value to 1e-5, and OpenPBR's is up to 1.6e-3 off where light is refracted
 * and for roughness below 16/31; its reflections are good to 3e-5 (a step is 1.5e-5), from inside to 3e-4. */
static void dielectrics_are_openpbrs(void **state)
{
    (void)state;
    static double opaque[32768], ideal[32768];
    if (!read_numbers("openpbr_energy_tables/opaque_dielectric_energy_complement.csv", opaque, 32768) ||
        !read_numbers("openpbr_energy_tables/ideal_dielectric_energy_complement.csv", ideal, 32768))
        skip();
    static const int indices[] = {7, 17, 25, 31}, roughness[] = {6, 16, 24, 31}, cosines[] = {1, 6, 16, 31};
    double worst[3] = {0};
    for (int k = 0; k < 4; k++)
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++) {
                const int is_inside = indices[k] < 16;
                if (is_inside && (j%2 == 0 || i%2 == 0)) continue; /* total reflection takes time */
                const int at = 1024*indices[k] + 32*roughness[j] + cosines[i];
                const double ior = openpbr_index(indices[k]);
                char spec[120];
                snprintf(spec, sizeof spec, "glass alpha=%.17g ior=%.17g g2=separable",
                         roughness[j]*roughness[j]/961.0, ior);
                const any_bsdf bsdf = any_bsdf_of(spec, 1);
                double wo[3], r[3], t[3], error;
                any_direction(cosines[i]/31.0, 0, wo);
                assert_int_equal(facet_bsdf64_albedo(&bsdf.twice, wo, r, t, &error), FACET_OK);
                const double one = fabs(1 - r[0] - opaque[at]/65535);
                const double all = fabs(1 - r[0] - ior*ior*t[0] - ideal[at]/65535);
                const int kind = is_inside || roughness[j] < 16;
                worst[kind] = fmax(worst[kind], one);
                worst[2] = fmax(worst[2], all);
                if (!(one <= (kind ? 3e-4 : 3e-5) && all <= 2e-3))
                    fail_msg("%s, cosine %d/31: opaque off by %.2g, ideal by %.2g", spec, cosines[i], one, all);
            }
    print_message("  largest deviation: reflected %.2g, smooth or inside %.2g; of all %.2g\n", worst[0], worst[1],
                  worst[2]);
}

/* Averages over cosines, sampled more coarsely: that of a metal of alpha = 1 is 3e-4 off E_avg = .376635, six digits of
 * an independent program. */
static void averages_are_openpbrs(void **state)
{
    (void)state;
    static double metal[32], opaque[1024], ideal[1024];
    if (!read_numbers("openpbr_energy_tables/ideal_metal_avg_energy_complement.csv", metal, 32) ||
        !read_numbers("openpbr_energy_tables/opaque_dielectric_avg_energy_complement.csv", opaque, 1024) ||
        !read_numbers("openpbr_energy_tables/ideal_dielectric_avg_energy_complement.csv", ideal, 1024))
        skip();
    double worst = 0;
    for (int j = 11; j < 32; j += 10) {
        const double alpha = j*j/961.0;
        char spec[120];
        snprintf(spec, sizeof spec, "ggx alpha=%.17g g2=separable", alpha);
        double off = fabs(1 - average_of(spec).reflected - metal[j]/65535);
        for (int k = 17; k < 32 && j > 20; k += 14) {
            const double ior = openpbr_index(k);
            snprintf(spec, sizeof spec, "glass alpha=%.17g ior=%.17g g2=separable", alpha, ior);
            const average glass = average_of(spec);
            off = fmax(off, fabs(1 - glass.reflected - opaque[32*k + j]/65535));
            off = fmax(off, fabs(1 - glass.reflected - ior*ior*glass.transmitted - ideal[32*k + j]/65535));
        }
        worst = fmax(worst, off);
        if (!(off <= 5e-4)) fail_msg("roughness %d/31: off by %.2g", j, off);
    }
    print_message("  largest deviation: %.2g\n", worst);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(terms_are_mitsubas),          cmocka_unit_test(samples_are_mitsubas),
        cmocka_unit_test(albedos_at_normal_incidence), cmocka_unit_test(visible_normals_are_lost_as_known),
        cmocka_unit_test(averages_are_cycles),         cmocka_unit_test(rough_glass_is_cycles),
        cmocka_unit_test(dielectrics_are_openpbrs),    cmocka_unit_test(averages_are_openpbrs),
    };
    return cmocka_run_group_tests_name("external_truths", tests, NULL, NULL);
}
