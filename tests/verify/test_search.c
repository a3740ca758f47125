/* test_search.c: the hunt for the largest errors of single precision, and what it finds.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "verify/search.h"

static search_result worst(const char *spec, const search_parameter *parameters, int n, search_term term)
{
    facet_material material;
    assert_int_equal(facet_material_parse(spec, &material, NULL), FACET_OK);
    const search_result r = search_worst(&material, parameters, n, term, 1000, 1);
    if (n == 1 && term != SEARCH_ALBEDO) { /* others take long */
        const search_result again = search_worst(&material, parameters, n, term, 1000, 1);
        assert_memory_equal(&r.error, &again.error, sizeof r.error);
    }
    /* what it says can be computed again */
    for (int i = 0; i < n; i++)
        assert_int_equal(facet_material_set(&material, parameters[i].name, &r.values[i], 1, NULL), FACET_OK);
    facet_bsdf64 bsdf;
    assert_int_equal(facet_bsdf64_prepare(&material, &bsdf, NULL), FACET_OK);
    const double m[3] = {(double)r.m[0], (double)r.m[1], (double)r.m[2]};
    const facet_terms64 truth = facet_bsdf64_terms(&bsdf, m);
    if (term != SEARCH_ALBEDO)
        assert_true(r.truth == (term == SEARCH_D ? truth.D : term == SEARCH_LAMBDA ? truth.Lambda : truth.G1));
    print_message("  %s %s: %.2g\n", spec, search_names[term], r.error);
    return r;
}

/* Bounds as docs/verification.md states them; each is reached to a tenth at least, or the hunt has lost its way. */
static void errors_are_those_that_are_stated(void **state)
{
    (void)state;
    static const search_parameter alpha[] = {{"alpha", 1e-4, 4}}, exponent[] = {{"exponent", 1e-2, 1e6}};
    static const search_parameter gtr[] = {{"alpha", 1e-4, 1}, {"gamma", 1e-3, 20}};
    static const struct {
        const char *spec;
        const search_parameter *parameters;
        int n;
        double bounds[SEARCH_ALBEDO];
    } cases[] = {{"ggx", alpha, 1, {1.5e-6, 1e-6, 2e-7}},
                 {"beckmann", alpha, 1, {4e-5, 3e-5, 3e-7}},
                 {"phong", exponent, 1, {5e-5, 4e-5, 4e-7}},
                 {"gtr", gtr, 2, {3e-5, 2e-5, 1e-6}}};
    for (size_t i = 0; i < sizeof cases/sizeof cases[0]; i++)
        for (int term = 0; term < SEARCH_ALBEDO; term++) {
            const double error = worst(cases[i].spec, cases[i].parameters, cases[i].n, (search_term)term).error;
            if (!(error <= cases[i].bounds[term] && error > 0.1*cases[i].bounds[term]))
                fail_msg("%s %s: %g is not near %g", cases[i].spec, search_names[term], error, cases[i].bounds[term]);
        }
}

/* Climbing from few points gets nearly as far as many points do: Beckmann's D is worst in one corner, where 50 points
 * alone find a fifth of it. */
static void the_climb_reaches_the_top(void **state)
{
    (void)state;
    static const search_parameter alpha[] = {{"alpha", 1e-4, 4}};
    facet_material material;
    assert_int_equal(facet_material_parse("beckmann", &material, NULL), FACET_OK);
    const double few = search_worst(&material, alpha, 1, SEARCH_D, 50, 3).error;
    const double many = search_worst(&material, alpha, 1, SEARCH_D, 20000, 3).error;
    assert_true(few >= 0.7*many);
}

/* facet_bsdf64_albedo promises some 1e-8, and 1e-6 at worst. */
static void albedos_agree_with_another_quadrature(void **state)
{
    (void)state;
    static const search_parameter alpha[] = {{"alpha", 1e-4, 4}};
    assert_true(worst("ggx", alpha, 1, SEARCH_ALBEDO).error < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_those_that_are_stated),
        cmocka_unit_test(the_climb_reaches_the_top),
        cmocka_unit_test(albedos_agree_with_another_quadrature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
