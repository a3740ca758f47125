/* test_material.c: materials as text: what is accepted, what is refused and where, and the table of parameters.
 * SPDX-License-Identifier: MIT */
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

static int index_of(const facet_material *m, const char *name)
{
    const facet_model_info *model = facet_model_get(m->model);
    for (size_t i = 0; i < model->n_parameters; i++)
        if (strcmp(model->parameters[i].name, name) == 0) return (int)i;
    fail_msg("%s has no parameter %s", model->name, name);
    return -1;
}

static facet_material parsed(const char *text)
{
    facet_material m;
    facet_error why = {0};
    if (facet_material_parse(text, &m, &why)) fail_msg("'%s': %s: %s", text, why.place, why.text);
    return m;
}

static void check_values(const char *text, const char *name, double r, double g, double b)
{
    const facet_material m = parsed(text);
    const int i = index_of(&m, name);
    const double want[3] = {r, g, b};
    const int n = facet_model_get(m.model)->parameters[i].kind == FACET_COLOUR ? 3 : 1;
    assert_true(m.given >> i & 1);
    for (int k = 0; k < n; k++)
        if (m.values[i][k] != want[k]) fail_msg("'%s': %s[%d] is %a, not %a", text, name, k, m.values[i][k], want[k]);
}

static void values_are_read(void **state)
{
    (void)state;
    check_values("ggx alpha=.25", "alpha", .25, 0, 0);
    check_values("ggx alpha=0.25", "alpha", .25, 0, 0);
    check_values("ggx alpha=+25e-2", "alpha", .25, 0, 0);
    check_values("ggx alpha=2.5E-1", "alpha", .25, 0, 0);
    check_values("ggx alpha=1.", "alpha", 1, 0, 0);
    check_values("\t ggx\r\n  alpha=4 \n", "alpha", 4, 0, 0);
    check_values("ggx kd=.1,.2,.3", "kd", .1, .2, .3);
    check_values("ggx kd=.5", "kd", .5, .5, .5);
    check_values("ggx kd=-0", "kd", 0, 0, 0);
    check_values("ggx g2=separable", "g2", 1, 0, 0);
    check_values("ggx g2=correlated", "g2", 0, 0, 0);
    check_values("glass wall=thin", "wall", 1, 0, 0);
    check_values("phong exponent=1e6", "exponent", 1e6, 0, 0);
    check_values("ggx alpha_y=.2 alpha_x=.4", "alpha_x", .4, 0, 0);
    check_values("ggx metal=Ag", "metal", 0, 0, 0);
    check_values("beckmann kd=.1 metal=Ti", "metal", 8, 0, 0);
    check_values("ggx k=2,3,4 eta=.1,.2,.3", "k", 2, 3, 4);
    check_values("ggx k=2,3,4 eta=.1,.2,.3", "eta", .1, .2, .3);
    check_values("phong ks=.5 f82=.9,.8,.7", "f82", .9, .8, .7);
}

typedef struct refusal {
    const char *text;
    facet_status status;
    const char *place, *words; /* words: what the message must contain */
} refusal;

static const refusal refusals[] = {
    {"", FACET_BAD_SYNTAX, "", "no model"},
    {" \t\n", FACET_BAD_SYNTAX, "", "no model"},
    {"gxx alpha=.3", FACET_UNKNOWN_NAME, "", "'gxx'"},
    {"gg", FACET_UNKNOWN_NAME, "", "ggx"},
    {"GGX", FACET_UNKNOWN_NAME, "", "'GGX'"},
    {"ggx,alpha=.3", FACET_UNKNOWN_NAME, "", "'ggx,alpha=.3'"},
    {"ggx alpha", FACET_BAD_SYNTAX, "alpha", "key=value"},
    {"ggx =3", FACET_BAD_SYNTAX, "=3", "key=value"},
    {"ggx alpha = .3", FACET_BAD_SYNTAX, "alpha", "key=value"},
    {"ggx alpha=", FACET_BAD_SYNTAX, "alpha", "not a number"},
    {"ggx alpha=x", FACET_BAD_SYNTAX, "alpha", "'x'"},
    {"ggx alpha=.3x", FACET_BAD_SYNTAX, "alpha", "'.3x'"},
    {"ggx alpha=.", FACET_BAD_SYNTAX, "alpha", "not a number"},
    {"ggx alpha=--1", FACET_BAD_SYNTAX, "alpha", "not a number"},
    {"ggx alpha=1e", FACET_BAD_SYNTAX, "alpha", "'1e'"},
    {"ggx alpha=nan", FACET_BAD_SYNTAX, "alpha", "'nan'"},
    {"ggx alpha=inf", FACET_BAD_SYNTAX, "alpha", "'inf'"},
    {"ggx alpha=0x1p-2", FACET_BAD_SYNTAX, "alpha", "'0x1p-2'"},
    {"ggx alpha=1e999", FACET_BAD_VALUE, "alpha", "[0.0001, 4]"},
    {"ggx alpha=.3,", FACET_BAD_SYNTAX, "alpha", "not a number"},
    {"ggx alpha=.3,.4,.5", FACET_BAD_SYNTAX, "alpha", "3 values"},
    {"ggx kd=.3,.4", FACET_BAD_SYNTAX, "kd", "2 values"},
    {"ggx kd=.1,.2,.3,.4", FACET_BAD_SYNTAX, "kd", "not a number or r,g,b"},
    {"ggx kd=,,", FACET_BAD_SYNTAX, "kd", "not a number"},
    {"ggx alpha=9.9e-5", FACET_BAD_VALUE, "alpha", "[0.0001, 4]"},
    {"ggx alpha=4.0001", FACET_BAD_VALUE, "alpha", "[0.0001, 4]"},
    {"ggx alpha=-1", FACET_BAD_VALUE, "alpha", "-1"},
    {"ggx kd=.5,1.1,.5", FACET_BAD_VALUE, "kd", "1.1"},
    {"phong exponent=-1", FACET_BAD_VALUE, "exponent", "[0, 1e+06]"},
    {"glass ior=.09", FACET_BAD_VALUE, "ior", "[0.1, 10]"},
    {"ggx colour=1", FACET_UNKNOWN_NAME, "colour", "alpha_x"},
    {"lambert alpha=1", FACET_UNKNOWN_NAME, "alpha", "kd"},
    {"ggx g2=both", FACET_UNKNOWN_NAME, "g2", "correlated|separable"},
    {"ggx g2=1", FACET_UNKNOWN_NAME, "g2", "correlated|separable"},
    {"ggx g2=", FACET_UNKNOWN_NAME, "g2", "correlated|separable"},
    {"ggx g2=separ", FACET_UNKNOWN_NAME, "g2", "separable"},
    {"phong sampling=all", FACET_UNKNOWN_NAME, "sampling", "vndf|ndf"},
    {"ggx alpha=.3 alpha=.3", FACET_BAD_SYNTAX, "alpha", "twice"},
    {"ggx alpha=.3 alpha_x=.3", FACET_BAD_VALUE, "alpha_x", "'alpha'"},
    {"ggx alpha_y=.3 alpha=.3", FACET_BAD_VALUE, "alpha", "'alpha_y'"},
    {"phong exponent=3 alpha_x=.3", FACET_BAD_VALUE, "alpha_x", "'exponent'"},
    {"glass exponent=3 alpha=.3", FACET_BAD_VALUE, "alpha", "'exponent'"},
    {"ggx ks=.5 ior=1.5", FACET_BAD_VALUE, "ior", "'ks'"},
    {"beckmann ior=1.5 ks=.5", FACET_BAD_VALUE, "ks", "'ior'"},
    {"ggx metal=Pb", FACET_UNKNOWN_NAME, "metal", "Ag|Al|Au|Co|Cr|Cu|Fe|Ni|Ti"},
    {"ggx metal=au", FACET_UNKNOWN_NAME, "metal", "'au' is not a choice"},
    {"ggx metal=Au ks=.5", FACET_BAD_VALUE, "ks", "'metal' is given as well"},
    {"ggx ior=1.5 metal=Au", FACET_BAD_VALUE, "metal", "'ior'"},
    {"ggx metal=Au f82=.5", FACET_BAD_VALUE, "f82", "'metal'"},
    {"ggx metal=Au eta=.2 k=3", FACET_BAD_VALUE, "eta", "'metal'"},
    {"ggx k=3 metal=Au", FACET_BAD_VALUE, "metal", "'k'"},
    {"phong eta=.2 k=3 ks=.5", FACET_BAD_VALUE, "ks", "'eta'"},
    {"ggx eta=.2 ior=1.5 k=3", FACET_BAD_VALUE, "ior", "'eta'"},
    {"ggx f82=.5 eta=.2 k=3", FACET_BAD_VALUE, "eta", "'f82'"},
    {"ggx f82=.5 k=3", FACET_BAD_VALUE, "k", "'f82'"},
    {"ggx ior=2 f82=.5", FACET_BAD_VALUE, "f82", "'ior'"},
    {"ggx ks=.5 k=3", FACET_BAD_VALUE, "k", "'ks'"},
    {"ggx ior=2 k=3", FACET_BAD_VALUE, "k", "'ior'"},
    {"ggx eta=.2,.3,.4", FACET_BAD_VALUE, "eta", "'k' is missing; give both"},
    {"beckmann k=3", FACET_BAD_VALUE, "k", "'eta' is missing; give both"},
    {"ggx eta=.009 k=3", FACET_BAD_VALUE, "eta", "[0.01, 20]"},
    {"ggx eta=1 k=20.1", FACET_BAD_VALUE, "k", "[0, 20]"},
    {"ggx ks=.5 f82=1.5", FACET_BAD_VALUE, "f82", "[0, 1]"},
};

static void faults_are_refused_where_they_are(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof refusals/sizeof refusals[0]; i++) {
        const refusal *r = &refusals[i];
        facet_material m, before;
        memset(&m, 0x5a, sizeof m);
        before = m;
        facet_error why = {0};
        const facet_status status = facet_material_parse(r->text, &m, &why);
        if (status != r->status || why.status != r->status || strcmp(why.place, r->place) != 0 ||
            !strstr(why.text, r->words))
            fail_msg("'%s': status %d (%d expected), place '%s' ('%s'), text '%s' (with '%s')", r->text, status,
                     r->status, why.place, r->place, why.text, r->words);
        assert_memory_equal(&m, &before, sizeof m);
        assert_int_equal(facet_material_parse(r->text, &m, NULL), r->status);
    }
}

/* Words and messages longer than their buffers are cut, not overrun. */
static void long_words_are_refused(void **state)
{
    (void)state;
    static char text[5000];
    facet_material m;
    facet_error why;
    memset(text, 'x', sizeof text - 1);
    assert_int_equal(facet_material_parse(text, &m, &why), FACET_UNKNOWN_NAME);
    assert_true(strlen(why.text) < sizeof why.text);
    memcpy(text, "ggx ", 4);
    assert_int_equal(facet_material_parse(text, &m, &why), FACET_BAD_SYNTAX);
    memcpy(text, "ggx alpha=", 10);
    assert_int_equal(facet_material_parse(text, &m, &why), FACET_BAD_SYNTAX);
    for (size_t length = 100; length < 200; length++) {
        memset(text, 'x', length);
        memcpy(text, "ggx ", 4);
        text[length - 2] = '=';
        text[length - 1] = '1';
        text[length] = 0;
        const facet_status status = facet_material_parse(text, &m, &why);
        assert_true(status == FACET_UNKNOWN_NAME || status == FACET_BAD_SYNTAX);
    }
}

/* A locale whose decimal point is a comma changes nothing.  Skipped where no such locale is installed. */
static void locale_does_not_matter(void **state)
{
    (void)state;
    if (!setlocale(LC_ALL, "de_DE.UTF-8") && !setlocale(LC_ALL, "de_DE.utf8") && !setlocale(LC_ALL, "fr_FR.UTF-8")) {
        print_message("  no locale with a decimal comma is installed\n");
        skip();
    }
    check_values("ggx alpha=.25 kd=.1,.2,.3", "alpha", .25, 0, 0);
    check_values("ggx alpha=.25 kd=.1,.2,.3", "kd", .1, .2, .3);
    setlocale(LC_ALL, "C");
}

static void set_takes_numbers(void **state)
{
    (void)state;
    facet_material m;
    facet_error why;
    assert_int_equal(facet_material_defaults("ggx", &m, &why), FACET_OK);
    assert_int_equal(m.given, 0);
    assert_int_equal(facet_material_set(&m, "alpha", (double[]){.7}, 1, &why), FACET_OK);
    assert_int_equal(facet_material_set(&m, "kd", (double[]){.1, .2, .3}, 3, &why), FACET_OK);
    assert_int_equal(facet_material_set(&m, "ks", (double[]){.4}, 1, &why), FACET_OK);
    assert_int_equal(facet_material_set(&m, "g2", (double[]){1}, 1, &why), FACET_OK);
    const facet_material same = parsed("ggx alpha=.7 kd=.1,.2,.3 ks=.4 g2=separable");
    assert_memory_equal(&m, &same, sizeof m);

    const facet_material before = m;
    assert_int_equal(facet_material_set(&m, "alpha", (double[]){NAN}, 1, &why), FACET_BAD_VALUE);
    assert_int_equal(facet_material_set(&m, "alpha", (double[]){INFINITY}, 1, &why), FACET_BAD_VALUE);
    assert_int_equal(facet_material_set(&m, "kd", (double[]){.1, .2, NAN}, 3, &why), FACET_BAD_VALUE);
    assert_string_equal(why.place, "kd");
    assert_int_equal(facet_material_set(&m, "kd", (double[]){.1, .2}, 2, &why), FACET_BAD_SYNTAX);
    assert_int_equal(facet_material_set(&m, "alpha", (double[]){.1, .1, .1}, 3, &why), FACET_BAD_SYNTAX);
    assert_int_equal(facet_material_set(&m, "alpha", (double[]){.1}, 0, &why), FACET_BAD_SYNTAX);
    assert_int_equal(facet_material_set(&m, "g2", (double[]){.5}, 1, &why), FACET_BAD_VALUE);
    assert_int_equal(facet_material_set(&m, "g2", (double[]){2}, 1, &why), FACET_BAD_VALUE);
    assert_int_equal(facet_material_set(&m, "ior", (double[]){1.5}, 1, &why), FACET_BAD_VALUE);
    assert_int_equal(facet_material_set(&m, "alpha_x", (double[]){.5}, 1, &why), FACET_BAD_VALUE);
    assert_int_equal(facet_material_set(&m, "beta", (double[]){.5}, 1, &why), FACET_UNKNOWN_NAME);
    assert_string_equal(why.place, "beta");
    assert_int_equal(facet_material_set(&m, NULL, (double[]){.5}, 1, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_material_set(&m, "alpha", NULL, 1, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_material_set(NULL, "alpha", (double[]){.5}, 1, NULL), FACET_BAD_ARGUMENT);
    assert_memory_equal(&m, &before, sizeof m);
}

static void foreign_structs_are_refused(void **state)
{
    (void)state;
    facet_error why;
    facet_bsdf bsdf, untouched;
    facet_bsdf64 bsdf64;
    memset(&bsdf, 0x5a, sizeof bsdf);
    untouched = bsdf;
    facet_material m = parsed("ggx");
    m.struct_size--;
    assert_int_equal(facet_bsdf_prepare(&m, &bsdf, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_bsdf64_prepare(&m, &bsdf64, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_material_set(&m, "alpha", (double[]){.5}, 1, &why), FACET_BAD_ARGUMENT);
    m = parsed("ggx");
    m.model = facet_model_count();
    assert_int_equal(facet_bsdf_prepare(&m, &bsdf, &why), FACET_BAD_ARGUMENT);
    m = parsed("ggx");
    m.values[0][0] = NAN;
    assert_int_equal(facet_bsdf_prepare(&m, &bsdf, &why), FACET_BAD_VALUE);
    assert_string_equal(why.place, facet_model_get(m.model)->parameters[0].name);
    m = parsed("ggx"); /* half of a conductor's index, set without the text form */
    assert_int_equal(facet_material_set(&m, "eta", (double[]){.2, .4, 1.4}, 3, &why), FACET_OK);
    assert_int_equal(facet_bsdf_prepare(&m, &bsdf, &why), FACET_BAD_VALUE);
    assert_string_equal(why.place, "eta");
    assert_int_equal(facet_bsdf_prepare(NULL, &bsdf, &why), FACET_BAD_ARGUMENT);
    m = parsed("ggx");
    assert_int_equal(facet_bsdf_prepare(&m, NULL, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_material_parse(NULL, &m, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_material_parse("ggx", NULL, NULL), FACET_BAD_ARGUMENT);
    assert_int_equal(facet_material_defaults("gg", &m, &why), FACET_UNKNOWN_NAME);
    assert_int_equal(facet_material_defaults(NULL, &m, &why), FACET_BAD_ARGUMENT);
    assert_memory_equal(&bsdf, &untouched, sizeof bsdf);
}

static size_t count_choices(const char *choices)
{
    size_t n = 1;
    for (const char *c = choices; *c; c++) n += *c == '|';
    return n;
}

static void check_parameter(const facet_model_info *model, size_t i)
{
    const facet_parameter *p = &model->parameters[i];
    const int n = p->kind == FACET_COLOUR ? 3 : 1;
    assert_true(strlen(p->name) > 0 && strlen(p->name) < 32 && strlen(p->unit) > 0 && strlen(p->description) > 0);
    assert_true(p->low <= p->high);
    for (int k = 0; k < n; k++)
        if (!(p->initial[k] >= p->low && p->initial[k] <= p->high))
            fail_msg("%s %s: default %a", model->name, p->name, p->initial[k]);
    if (p->kind == FACET_CHOICE) {
        assert_true(p->low == 0 && p->high == (double)count_choices(p->choices) - 1);
    } else {
        assert_string_equal(p->choices, "");
    }
    for (size_t j = 0; j < i; j++) assert_string_not_equal(p->name, model->parameters[j].name);
    /* Both ends of the range are accepted and prepare a material. */
    for (int end = 0; end < 2; end++) {
        facet_material m;
        facet_bsdf bsdf;
        facet_error why = {0};
        assert_int_equal(facet_material_defaults(model->name, &m, &why), FACET_OK);
        const double value = end ? p->high : p->low;
        const char *const partner = strcmp(p->name, "eta") == 0 ? "k" : strcmp(p->name, "k") == 0 ? "eta" : NULL;
        if (partner) assert_int_equal(facet_material_set(&m, partner, (double[]){1}, 1, &why), FACET_OK);
        if (facet_material_set(&m, p->name, &value, 1, &why) || facet_bsdf_prepare(&m, &bsdf, &why))
            fail_msg("%s %s=%g: %s", model->name, p->name, value, why.text);
    }
}

static void the_table_of_parameters_is_consistent(void **state)
{
    (void)state;
    static const char *const expected[] = {"lambert", "phong", "beckmann", "ggx", "glass", "metallic_roughness"};
    for (size_t k = 0; k < sizeof expected/sizeof expected[0]; k++) parsed(expected[k]);
    assert_null(facet_model_get(facet_model_count()));
    for (size_t k = 0; k < facet_model_count(); k++) {
        const facet_model_info *model = facet_model_get(k);
        assert_true(strlen(model->name) > 0 && strlen(model->summary) > 0 && strlen(model->source) > 0);
        assert_in_range(model->n_parameters, 1, FACET_MAX_PARAMETERS);
        for (size_t j = 0; j < k; j++) assert_string_not_equal(model->name, facet_model_get(j)->name);
        for (size_t i = 0; i < model->n_parameters; i++) check_parameter(model, i);
        const facet_material m = parsed(model->name);
        assert_int_equal(m.given, 0);
        assert_int_equal(m.model, k);
        for (size_t i = 0; i < model->n_parameters; i++)
            assert_memory_equal(m.values[i], model->parameters[i].initial, sizeof m.values[i]);
    }
}

/* Parameters that say the same thing in two ways give the same bits. */
static void synonyms_prepare_the_same(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {{"ggx alpha=.4", "ggx alpha_x=.4 alpha_y=.4"},
                                           {"ggx ks=.5", "ggx ks=.5,.5,.5"},
                                           {"beckmann", "beckmann alpha=.3 kd=0 ks=1"},
                                           {"lambert", "lambert kd=.8"}};
    for (int i = 0; i < 4; i++) {
        facet_bsdf a, b;
        facet_material m = parsed(pairs[i][0]);
        assert_int_equal(facet_bsdf_prepare(&m, &a, NULL), FACET_OK);
        m = parsed(pairs[i][1]);
        assert_int_equal(facet_bsdf_prepare(&m, &b, NULL), FACET_OK);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_read),
        cmocka_unit_test(faults_are_refused_where_they_are),
        cmocka_unit_test(long_words_are_refused),
        cmocka_unit_test(locale_does_not_matter),
        cmocka_unit_test(set_takes_numbers),
        cmocka_unit_test(foreign_structs_are_refused),
        cmocka_unit_test(the_table_of_parameters_is_consistent),
        cmocka_unit_test(synonyms_prepare_the_same),
    };
    return cmocka_run_group_tests_name("material", tests, NULL, NULL);
}
