/* test_lanes.c: batches whose parameters vary give, element by element, what materials prepared with them give.
 *
 * The same bits for ggx, beckmann and phong, on every instruction set.  gtr masks without its polynomials there,
 * both to 5e-7 of G1, and is compared with the double build.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"

enum { N = 1100 }; /* two blocks and a part */
enum { F, PDF = 3, SAMPLE, OUTPUTS = 11 };

static float wi[3][N], wo[3][N], u[3][N], alpha_x[N], alpha_y[N], gamma_of[N], kd[3][N], ks[3][N];
static float results[OUTPUTS][N];

static const facet_dirs in = {wi[0], wi[1], wi[2]}, out = {wo[0], wo[1], wo[2]}, numbers = {u[0], u[1], u[2]};
static const facet_rgb f = {results[0], results[1], results[2]};
static const facet_samples samples = {results[4], results[5], results[6], results[7],
                                      results[8], results[9], results[10]};

static int fill_inputs(void **state)
{
    (void)state;
    draws d = {31};
    for (int i = 0; i < N; i++) {
        double a[3], b[3];
        draw_direction(&d, a);
        draw_direction(&d, b);
        if (i%9 == 4) a[2] = -a[2];
        alpha_x[i] = (float)draw_log(&d, 1e-3, 1);
        alpha_y[i] = i%3 ? alpha_x[i] : (float)draw_log(&d, 1e-3, 1);
        gamma_of[i] = (float)draw_log(&d, .2, 10);
        for (int k = 0; k < 3; k++) {
            wi[k][i] = (float)a[k];
            wo[k][i] = (float)b[k];
            u[k][i] = (float)draw(&d);
            kd[k][i] = (float)draw_between(&d, .1, 1);
            ks[k][i] = (float)draw(&d);
        }
    }
    return 0;
}

static facet_lanes all_lanes(void)
{
    return (facet_lanes){.struct_size = sizeof(facet_lanes),
                         .alpha_x = alpha_x,
                         .alpha_y = alpha_y,
                         .kd = {kd[0], kd[1], kd[2]},
                         .ks = {ks[0], ks[1], ks[2]}};
}

/* Everything at once into `results`; the separate functions give the same bits. */
static void run(const facet_bsdf *bsdf, const facet_lanes *lanes)
{
    facet_error why;
    static float again[4][N];
    assert_int_equal(facet_bsdf_eval_pdf_lanes(bsdf, lanes, N, in, out, f, results[PDF], &why), FACET_OK);
    assert_int_equal(facet_bsdf_sample_lanes(bsdf, lanes, N, out, numbers, samples, &why), FACET_OK);
    const facet_rgb apart = {again[0], again[1], again[2]};
    assert_int_equal(facet_bsdf_eval_lanes(bsdf, lanes, N, in, out, apart, &why), FACET_OK);
    assert_int_equal(facet_bsdf_pdf_lanes(bsdf, lanes, N, in, out, again[3], &why), FACET_OK);
    assert_memory_equal(again, results, sizeof again);
}

/* The spec of element i, exact to the bit. */
static void spec_of(const char *model, int i, char spec[160])
{
    snprintf(spec, 160, "%s alpha_x=%.9g alpha_y=%.9g kd=%.9g,%.9g,%.9g ks=%.9g,%.9g,%.9g", model, (double)alpha_x[i],
             (double)alpha_y[i], (double)kd[0][i], (double)kd[1][i], (double)kd[2][i], (double)ks[0][i],
             (double)ks[1][i], (double)ks[2][i]);
}

static void elements_are_those_of_prepared_materials(void **state)
{
    (void)state;
    static const char *const models[] = {"ggx", "beckmann", "phong", "ggx g2=separable"};
    for (int m = 0; m < 4; m++)
        for (size_t isa = 0; facet_isa_name(isa); isa++) {
            assert_int_equal(facet_isa_force(facet_isa_name(isa)), FACET_OK);
            const facet_bsdf common = single_bsdf_of(models[m]);
            const facet_lanes lanes = all_lanes();
            run(&common, &lanes);
            for (int i = 0; i < N; i++) {
                char spec[160];
                spec_of(models[m], i, spec);
                const facet_bsdf own = single_bsdf_of(spec);
                const float a[3] = {wi[0][i], wi[1][i], wi[2][i]}, b[3] = {wo[0][i], wo[1][i], wo[2][i]};
                const float v[3] = {u[0][i], u[1][i], u[2][i]};
                float want[OUTPUTS];
                want[PDF] = facet_bsdf_eval_pdf(&own, a, b, want);
                const facet_sample s = facet_bsdf_sample(&own, b, v);
                memcpy(want + SAMPLE, s.wi, sizeof s.wi);
                want[SAMPLE + 3] = s.pdf;
                memcpy(want + SAMPLE + 4, s.weight, sizeof s.weight);
                for (int k = 0; k < OUTPUTS; k++)
                    if (memcmp(&want[k], &results[k][i], sizeof want[k]) != 0)
                        fail_msg("%s, %s, output %d: %a, not %a", spec, facet_isa_name(isa), k, (double)results[k][i],
                                 (double)want[k]);
            }
        }
    assert_int_equal(facet_isa_force(NULL), FACET_OK);
}

/* D and two G1 of 5e-7 in float: a tolerance of 2e-5, and of the rounding of wi + wo where D is steep. */
static void gtr_agrees_with_the_double_build(void **state)
{
    (void)state;
    const facet_bsdf common = single_bsdf_of("gtr");
    facet_lanes lanes = all_lanes();
    lanes.gamma = gamma_of;
    run(&common, &lanes);
    double worst = 0;
    for (int i = 0; i < N; i += 4) {
        char spec[160];
        spec_of("gtr sampling=ndf", i, spec);
        const size_t length = strlen(spec);
        snprintf(spec + length, sizeof spec - length, " gamma=%.9g", (double)gamma_of[i]);
        const any_bsdf own = any_bsdf_of(spec, 1);
        const double a[3] = {(double)wi[0][i], (double)wi[1][i], (double)wi[2][i]};
        const double b[3] = {(double)wo[0][i], (double)wo[1][i], (double)wo[2][i]};
        double want[4], near[4], spread[4] = {0};
        any_eval(&own, a, b, want);
        want[3] = any_pdf(&own, a, b);
        for (int axis = 0; axis < 3; axis++) {
            double moved[3] = {a[0], a[1], a[2]};
            moved[axis] += 0x1p-22;
            any_eval(&own, moved, b, near);
            near[3] = any_pdf(&own, moved, b);
            for (int k = 0; k < 4; k++) spread[k] += fabs(near[k] - want[k]);
        }
        for (int k = 0; k < 4; k++) {
            const double error = fabs((double)results[k][i] - want[k]), bound = 2e-5*want[k] + 2*spread[k];
            if (!(error <= bound)) fail_msg("%s, output %d: %a, not %a", spec, k, (double)results[k][i], want[k]);
            if (want[k] > 0) worst = fmax(worst, error/bound);
        }
    }
    print_message("  at most %.2g of the bound\n", worst);
}

/* A sample has the density and the weight of its direction. */
static void samples_are_weighted_by_their_density(void **state)
{
    (void)state;
    const facet_bsdf common = single_bsdf_of("gtr");
    facet_lanes lanes = all_lanes();
    lanes.gamma = gamma_of;
    facet_error why;
    static float at[4][N];
    assert_int_equal(facet_bsdf_sample_lanes(&common, &lanes, N, out, numbers, samples, &why), FACET_OK);
    const facet_dirs drawn = {samples.wi_x, samples.wi_y, samples.wi_z};
    assert_int_equal(
        facet_bsdf_eval_pdf_lanes(&common, &lanes, N, drawn, out, (facet_rgb){at[0], at[1], at[2]}, at[3], &why),
        FACET_OK);
    int n = 0;
    for (int i = 0; i < N; i++) {
        if (!(samples.pdf[i] > 0)) continue;
        assert_true(samples.pdf[i] == at[3][i]);
        assert_true(fabsf(samples.weight_g[i]*at[3][i] - at[1][i]) <= 4*0x1p-23f*at[1][i]);
        n++;
    }
    assert_true(n > N/2);
}

static void what_is_not_given_is_the_materials(void **state)
{
    (void)state;
    static const char *const specs[] = {"ggx alpha_x=.2 alpha_y=.5 kd=.3 ks=.5,.6,.7",
                                        "beckmann alpha=.4 kd=.1 ior=1.5", "ggx alpha=.3 kd=.2 metal=Au"};
    for (int s = 0; s < 3; s++) {
        const facet_bsdf own = single_bsdf_of(specs[s]);
        const facet_lanes none = {.struct_size = sizeof none};
        run(&own, &none);
        static float want[4][N];
        facet_bsdf_eval_pdf_batch(&own, N, in, out, (facet_rgb){want[0], want[1], want[2]}, want[3]);
        assert_memory_equal(want, results, sizeof want);
    }
}

static void values_beyond_the_range_count_as_its_ends(void **state)
{
    (void)state;
    static const float wrong[] = {NAN, -1, INFINITY, 1e30f}, right[] = {1e-4f, 1e-4f, 4, 4};
    const facet_bsdf common = single_bsdf_of("ggx kd=.5");
    float x[2][4], shown[2][4];
    for (int i = 0; i < 4; i++) {
        x[0][i] = wrong[i];
        x[1][i] = right[i];
    }
    for (int k = 0; k < 2; k++) {
        const facet_lanes lanes = {.struct_size = sizeof lanes, .alpha_x = x[k], .alpha_y = x[k]};
        assert_int_equal(facet_bsdf_pdf_lanes(&common, &lanes, 4, in, out, shown[k], NULL), FACET_OK);
    }
    assert_memory_equal(shown[0], shown[1], sizeof shown[0]);
}

static void faults_are_named(void **state)
{
    (void)state;
    const facet_lanes none = {.struct_size = sizeof none};
    facet_lanes lanes[5] = {none, none, none, none, none};
    lanes[0].struct_size = 8;
    lanes[1].alpha_x = alpha_x;
    lanes[2].gamma = gamma_of;
    lanes[3].kd[1] = kd[1];
    for (int k = 0; k < 3; k++) lanes[4].ks[k] = ks[k];
    const struct {
        const char *spec;
        const facet_lanes *lanes;
        facet_status status;
        const char *place;
    } faults[] = {
        {"ggx", NULL, FACET_BAD_ARGUMENT, ""},
        {"ggx", &lanes[0], FACET_BAD_ARGUMENT, ""},
        {"ggx", &lanes[1], FACET_BAD_ARGUMENT, "alpha_y"},
        {"ggx", &lanes[2], FACET_BAD_ARGUMENT, "gamma"},
        {"ggx", &lanes[3], FACET_BAD_ARGUMENT, "kd"},
        {"ggx metal=Au", &lanes[4], FACET_BAD_ARGUMENT, "ks"},
        {"lambert", &none, FACET_UNSUPPORTED, ""},
        {"beckmann masking=published", &none, FACET_UNSUPPORTED, "masking"},
        {"ggx energy=multi", &none, FACET_UNSUPPORTED, "energy"},
        {"gtr alpha_x=.1 alpha_y=.3 gamma=3 anisotropy=disney", &none, FACET_UNSUPPORTED, "anisotropy"},
    };
    for (size_t i = 0; i < sizeof faults/sizeof faults[0]; i++) {
        const facet_bsdf bsdf = single_bsdf_of(faults[i].spec);
        facet_error why;
        assert_int_equal(facet_bsdf_pdf_lanes(&bsdf, faults[i].lanes, N, in, out, results[PDF], &why),
                         faults[i].status);
        assert_string_equal(why.place, faults[i].place);
        assert_int_equal(facet_bsdf_eval_lanes(&bsdf, faults[i].lanes, N, in, out, f, NULL), faults[i].status);
        assert_int_equal(facet_bsdf_sample_lanes(&bsdf, faults[i].lanes, N, out, numbers, samples, NULL),
                         faults[i].status);
        assert_int_equal(facet_bsdf_eval_pdf_lanes(&bsdf, faults[i].lanes, N, in, out, f, results[PDF], NULL),
                         faults[i].status);
    }
    assert_int_equal(facet_bsdf_pdf_lanes(NULL, &none, N, in, out, results[PDF], NULL), FACET_BAD_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elements_are_those_of_prepared_materials),
        cmocka_unit_test(gtr_agrees_with_the_double_build),
        cmocka_unit_test(samples_are_weighted_by_their_density),
        cmocka_unit_test(what_is_not_given_is_the_materials),
        cmocka_unit_test(values_beyond_the_range_count_as_its_ends),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests_name("lanes", tests, fill_inputs, NULL);
}
