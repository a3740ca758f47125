/* test_fit.c: a fit finds the parameters that made the values, and the way down stays in its box.
 * SPDX-License-Identifier: MIT */
#include "verify/fit.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/draws.h"
#include "verify/least_squares.h"

/* ---- Least squares -------------------------------------------------------------------------------------------- */

/* [rosenbrock60] The valley, with its end at (0.6, 0.6). */
static bool valley(void *user, const double *x, double *residuals)
{
    (void)user;
    const double u = x[0]/0.6, v = x[1]/0.6;
    residuals[0] = 1 - u;
    residuals[1] = 10*(v - u*u);
    return true;
}

/* Least at (2, -0.2) without bounds, and within them where x = 1 and y = 0; z has no say. */
static bool outside(void *user, const double *x, double *residuals)
{
    (void)user;
    residuals[0] = x[0] - 2;
    residuals[1] = x[1] + 0.2;
    return true;
}

/* Least on the bound x = 1 at y = 0.4: the way there turns with x. */
static bool leaning(void *user, const double *x, double *residuals)
{
    (void)user;
    residuals[0] = 3*(x[0] - 2);
    residuals[1] = 5*(x[1] - 0.8 + 0.4*x[0]);
    return true;
}

static bool nowhere(void *user, const double *x, double *residuals)
{
    (void)user;
    (void)x;
    (void)residuals;
    return false;
}

static double descend(least_squares_function *f, size_t n, double *x)
{
    double work[64];
    assert_true(least_squares_room(n, 2) <= sizeof work/sizeof *work);
    return least_squares_descend(&(least_squares){n, 2, f, NULL, work}, x);
}

static void the_least_sum_is_found_within_the_box(void **state)
{
    (void)state;
    for (int i = 0; i < 81; i++) {
        const double from[2] = {(i%9 + 0.5)/9, (i/9 + 0.5)/9};
        double a[2] = {from[0], from[1]}, b[3] = {from[0], from[1], 0.3}, c[2] = {from[0], from[1]};
        assert_true(descend(valley, 2, a) < 1e-12 && fabs(a[0] - 0.6) < 1e-6 && fabs(a[1] - 0.6) < 1e-6);
        assert_true(fabs(descend(outside, 3, b) - 1.04) < 1e-9 && b[0] == 1 && b[1] == 0 && b[2] == 0.3);
        assert_true(fabs(descend(leaning, 2, c) - 9) < 1e-9 && c[0] == 1 && fabs(c[1] - 0.4) < 1e-6);
    }
}

static void where_nothing_has_a_value_the_start_stays(void **state)
{
    (void)state;
    double x[2] = {0.25, 0.5};
    assert_true(isinf(descend(nowhere, 2, x)) && x[0] == 0.25 && x[1] == 0.5);
}

/* ---- Materials ------------------------------------------------------------------------------------------------ */

enum { POINTS = 240 };

static facet_material parse(const char *spec)
{
    facet_material m;
    assert_int_equal(facet_material_parse(spec, &m, NULL), FACET_OK);
    return m;
}

/* Half of the pairs near the mirror direction; noise: relative, uniform with this standard deviation. */
static fit_points measure(const char *spec, double noise, fit_point *points, uint64_t seed)
{
    const facet_material m = parse(spec);
    facet_bsdf64 bsdf;
    draws d = {seed};
    assert_int_equal(facet_bsdf64_prepare(&m, &bsdf, NULL), FACET_OK);
    for (int i = 0; i < POINTS; i++) {
        fit_point *p = &points[i];
        double length = 0;
        draw_direction(&d, p->wi);
        draw_direction(&d, p->wo);
        for (int k = 0; k < 3 && i%2; k++) p->wo[k] = (k < 2 ? -p->wi[k] : p->wi[k]) + draw_between(&d, -.2, .2);
        p->wo[2] = fabs(p->wo[2]);
        for (int k = 0; k < 3; k++) length += p->wo[k]*p->wo[k];
        for (int k = 0; k < 3; k++) p->wo[k] /= sqrt(length);
        facet_bsdf64_eval(&bsdf, p->wi, p->wo, p->value);
        for (int k = 0; k < 3; k++) p->value[k] *= 1 + draw_between(&d, -sqrt(3), sqrt(3))*noise;
    }
    return (fit_points){POINTS, points};
}

static fit_result fit(const char *start, fit_points points)
{
    facet_material m = parse(start);
    const fit_keys keys = fit_usual_keys(&m);
    fit_result result;
    facet_error why = {0};
    if (fit_material(&m, keys, points, NULL, NULL, &result, &why)) fail_msg("%s: %s", start, why.text);
    return result;
}

/* All parameters of the material of the spec, within a part of their range's end. */
static void assert_material(const facet_material *found, const char *spec, double part)
{
    const facet_material wanted = parse(spec);
    const facet_model_info *model = facet_model_get(wanted.model);
    assert_int_equal(found->model, wanted.model);
    for (size_t k = 0; k < model->n_parameters; k++)
        for (int c = 0; c < (model->parameters[k].kind == FACET_COLOUR ? 3 : 1); c++)
            if (!(fabs(found->values[k][c] - wanted.values[k][c]) <= part*fmax(fabs(wanted.values[k][c]), 0.1)))
                fail_msg("%s: %s is %g, not %g", spec, model->parameters[k].name, found->values[k][c],
                         wanted.values[k][c]);
}

static void parameters_that_made_the_values_are_found(void **state)
{
    (void)state;
    static const char *const specs[] = {"lambert kd=.3,.2,.1",
                                        "ggx alpha=.2 ks=.6,.4,.3 kd=.1,.2,.05",
                                        "ggx alpha=.02 ks=.9",
                                        "beckmann alpha=.15 ks=.5",
                                        "gtr alpha=.05 gamma=.7 ks=.9,.7,.3 kd=.02",
                                        "ward alpha=.2 ks=.3 kd=.5",
                                        "metallic_roughness base_color=.8,.2,.1 roughness=.3 metallic=.7"};
    static fit_point points[POINTS];
    for (size_t i = 0; i < sizeof specs/sizeof *specs; i++) {
        char model[32];
        const fit_points measured = measure(specs[i], 0, points, i);
        memcpy(model, specs[i], strcspn(specs[i], " "));
        model[strcspn(specs[i], " ")] = 0;
        const fit_result r = fit(model, measured);
        assert_true(r.error < 1e-7); /* the way down ends where the sum of squares changes by 1e-9 of itself */
        assert_material(&r.material, specs[i], 1e-4);
        assert_true(r.n_least >= 1 && r.n_least <= FIT_STARTS);
    }
}

/* 1 % in each value; twenty seeds have moved a parameter by 5.4 % at most. */
static void noise_moves_parameters_little(void **state)
{
    (void)state;
    static fit_point points[POINTS];
    static const char spec[] = "gtr alpha=.2 gamma=1.5 ks=.6 kd=.1";
    const fit_points measured = measure(spec, 0.01, points, 3);
    const fit_result right = fit("gtr", measured), wrong = fit("beckmann", measured);
    assert_material(&right.material, spec, 0.08);
    assert_true(right.error > 1e-4 && right.error < 0.01);
    assert_true(wrong.error > 3*right.error);
}

static void what_is_given_stays_and_what_is_idle_is_not_given(void **state)
{
    (void)state;
    static fit_point points[POINTS];
    const fit_points measured = measure("ggx alpha=.2 ks=.5", 0, points, 4);
    const fit_result held = fit("ggx alpha=.3 g2=separable", measured);
    assert_material(&held.material, "ggx alpha=.3 g2=separable", 2); /* what is found may be anything */
    assert_true(held.material.values[0][0] == 0.3 && held.error > 1e-3);
    const fit_result r = fit("ggx", measured);
    assert_material(&r.material, "ggx alpha=.2 ks=.5", 1e-4);
    assert_int_equal(r.material.given, parse("ggx alpha=.2 ks=.5").given); /* kd = 0 is the default */
}

static void usual_keys_exclude_none_of_the_given(void **state)
{
    (void)state;
    for (size_t i = 0; i < facet_model_count(); i++) {
        facet_material m = parse(facet_model_get(i)->name);
        const fit_keys keys = fit_usual_keys(&m);
        facet_bsdf64 bsdf;
        assert_true(keys != 0);
        assert_int_equal(facet_bsdf64_prepare(&m, &bsdf, NULL), FACET_OK);
    }
    facet_material m = parse("ggx ior=1.7 alpha_x=.1 alpha_y=.2");
    const facet_model_info *model = facet_model_get(m.model);
    const fit_keys keys = fit_usual_keys(&m);
    for (size_t k = 0; k < model->n_parameters; k++)
        assert_int_equal(keys >> k & 1, strcmp(model->parameters[k].name, "kd") == 0);
}

static void too_little_is_refused(void **state)
{
    (void)state;
    static fit_point points[POINTS];
    fit_points measured = measure("ggx", 0, points, 5);
    facet_material m = parse("ggx");
    fit_result r;
    facet_error why = {0};
    assert_int_equal(fit_material(&m, 0, measured, NULL, NULL, &r, &why), FACET_BAD_VALUE);
    assert_non_null(strstr(why.text, "nothing is left"));
    const fit_keys keys = fit_usual_keys(&m);
    measured.n = 2;
    assert_int_equal(fit_material(&m, keys, measured, NULL, NULL, &r, &why), FACET_BAD_VALUE);
    assert_non_null(strstr(why.text, "6 values are too few for 7 unknowns"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_least_sum_is_found_within_the_box),
        cmocka_unit_test(where_nothing_has_a_value_the_start_stays),
        cmocka_unit_test(parameters_that_made_the_values_are_found),
        cmocka_unit_test(noise_moves_parameters_little),
        cmocka_unit_test(what_is_given_stays_and_what_is_idle_is_not_given),
        cmocka_unit_test(usual_keys_exclude_none_of_the_given),
        cmocka_unit_test(too_little_is_refused),
    };
    return cmocka_run_group_tests_name("fit", tests, NULL, NULL);
}
