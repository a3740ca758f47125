/* test_glsl.c: the kernels as GLSL, run by Mesa's software renderer, give what libfacet gives in float, within the
 * rounding of float; for every model, its defaults and each parameter changed, in GLSL ES 3.00 and GLSL 4.50.
 *
 * The bound.  A float evaluation is the exact function of slightly wrong inputs times a factor near 1: with at most
 * ROUNDINGS roundings of half an ulp in a row on the way of any input to the result, inputs are wrong by ROUNDINGS/2^24
 * and so is the factor.  What that does to a result comes from the double build, evaluated at inputs that are off by
 * that much: its changes, summed over the inputs, are the bound for one evaluation.  Two of them, both in float, differ
 * by at most twice that.  Where an input is that close to a choice (of a lobe, of the horizon), either side is right,
 * and the double build sees both.
 * SPDX-License-Identifier: MIT */
#include <float.h>
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

#include "core/model_table.h"
#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/shaders/offscreen.h"

/* The kernels' longest way: 28 levels of Phong's fraction do not add up, since each level divides what the earlier ones
 * got wrong; the logarithm, the exponential and the polynomials of the inverse error function do. */
#define ROUNDINGS 32.0

/* Below it results count as 0: shaders may take subnormal numbers for 0, also inside, where they are then divided by
 * alpha^2, cos^4 and the like. */
#define TINY 0x1p-96

enum { HEIGHT = 8, N_PAIRS = HEIGHT*OFFSCREEN_WIDTH, MOST_VARIATIONS = 1024 };
enum { WI, WO, U, N_INPUTS = 9 };
enum { N_RESULTS = 13 }; /* f, pdf; the sample's wi, pdf, weight, eta, lobe */
static const char *const result_names[N_RESULTS] = {"f.r",      "f.g",  "f.b",        "pdf",      "wi.x",
                                                    "wi.y",     "wi.z", "sample.pdf", "weight.r", "weight.g",
                                                    "weight.b", "eta",  "lobe"};

typedef struct variation {
    char name[128];
    size_t model;
    facet_bsdf single;
    double bounds[N_PAIRS][N_RESULTS];
} variation;

static variation *variations[MOST_VARIATIONS];
static int n_variations;
static float texels[OFFSCREEN_INPUTS][N_PAIRS][4], drawn[OFFSCREEN_OUTPUTS][N_PAIRS][4];

/* ---- Inputs ------------------------------------------------------------------------------------ */

/* Pairs all over the hemisphere, near mirror directions, and with one of the two below the horizon. */
static void fill_inputs(void)
{
    draws d = {7};
    for (int i = 0; i < N_PAIRS; i++) {
        double wi[3], wo[3];
        draw_direction(&d, wi);
        draw_direction(&d, wo);
        if (i%4 == 1) {
            const double spread = draw_log(&d, 1e-3, 0.3);
            for (int k = 0; k < 3; k++) wi[k] = (k == 2 ? wo[k] : -wo[k]) + spread*(wi[k] - 0.5);
            const double length = sqrt(wi[0]*wi[0] + wi[1]*wi[1] + wi[2]*wi[2]);
            for (int k = 0; k < 3; k++) wi[k] /= length;
        }
        if (i%16 == 2) wi[2] = -wi[2];
        if (i%16 == 6) wo[2] = -wo[2];
        for (int k = 0; k < 3; k++) {
            texels[WI][i][k] = (float)wi[k];
            texels[WO][i][k] = (float)wo[k];
            texels[U][i][k] = (float)draw(&d);
        }
    }
}

/* ---- The bound --------------------------------------------------------------------------------- */

static void results_in_double(const facet_bsdf64 *bsdf, const double x[N_INPUTS], double r[N_RESULTS])
{
    facet_bsdf64_eval(bsdf, x, x + 3, r);
    r[3] = facet_bsdf64_pdf(bsdf, x, x + 3);
    const facet_sample64 s = facet_bsdf64_sample(bsdf, x + 3, x + 6);
    for (int k = 0; k < 3; k++) {
        r[4 + k] = s.wi[k];
        r[8 + k] = s.weight[k];
    }
    r[7] = s.pdf;
    r[11] = s.eta;
    r[12] = s.lobe;
}

/* The sampled direction is itself rounded before its density and f are evaluated: adds what that does to both. */
static void add_rounded_direction(const facet_bsdf64 *bsdf, const double wo[3], const double r[N_RESULTS],
                                  double bounds[N_RESULTS])
{
    if (!(r[7] > 0) || !isfinite(r[7])) return;
    for (int k = 0; k < 3; k++) {
        double change = 0;
        for (int side = -1; side <= 1; side += 2) {
            double wi[3] = {r[4], r[5], r[6]};
            wi[k] *= 1 + side*ROUNDINGS*0.5*(double)FLT_EPSILON;
            change = fmax(change, fabs(facet_bsdf64_pdf(bsdf, wi, wo) - r[7]));
        }
        bounds[7] += change;
        for (int j = 8; j <= 10; j++) bounds[j] += 2*change/r[7]*fabs(r[j]); /* f/pdf: f changes as much */
    }
}

static void find_bounds(const facet_bsdf64 *bsdf, int i, double bounds[N_RESULTS])
{
    const double unit = ROUNDINGS*0.5*(double)FLT_EPSILON;
    double x[N_INPUTS], r[N_RESULTS];
    for (int k = 0; k < N_INPUTS; k++) x[k] = (double)texels[k/3][i][k%3];
    results_in_double(bsdf, x, r);
    for (int j = 0; j < N_RESULTS; j++) bounds[j] = j == 12 ? 0 : unit*fabs(r[j]) + TINY;
    for (int k = 0; k < N_INPUTS; k++) {
        const double step = k < 3*U ? unit*fabs(x[k]) : unit; /* numbers in [0,1) count from both ends */
        double changes[N_RESULTS] = {0}, at = x[k];
        for (int side = -1; side <= 1; side += 2) {
            double moved[N_RESULTS];
            x[k] = k < 3*U ? at + side*step : fmin(fmax(at + side*step, 0), 1 - 0.5*(double)FLT_EPSILON);
            results_in_double(bsdf, x, moved);
            for (int j = 0; j < N_RESULTS; j++) changes[j] = fmax(changes[j], fabs(moved[j] - r[j]));
        }
        x[k] = at;
        for (int j = 0; j < N_RESULTS; j++) bounds[j] += changes[j];
    }
    add_rounded_direction(bsdf, x + 3, r, bounds);
}

/* ---- Materials --------------------------------------------------------------------------------- */

static void add_variation(const facet_material *material, const char *what, double value)
{
    assert_true(n_variations < MOST_VARIATIONS);
    variation *v = variations[n_variations++] = malloc(sizeof *v);
    assert_non_null(v);
    v->model = material->model;
    snprintf(v->name, sizeof v->name, "%s %s=%g", facet_model_get(v->model)->name, what, value);
    facet_bsdf64 twice;
    facet_error why;
    if (facet_bsdf_prepare(material, &v->single, &why) || facet_bsdf64_prepare(material, &twice, &why))
        fail_msg("%s: %s: %s", v->name, why.place, why.text);
    for (int i = 0; i < N_PAIRS; i++) find_bounds(&twice, i, v->bounds[i]);
}

/* The other number of a conductor whose eta or k is given. */
static void set_conductor(facet_material *material, const char *given, const double *values)
{
    const char *const other = strcmp(given, "k") == 0 ? "eta" : "k";
    if (facet_material_set(material, other, values, 1, NULL)) fail_msg("%s cannot be set", other);
}

/* The defaults; every other choice; every number at a quarter and three quarters of its range (in its logarithm where
 * that is wide); every colour at one that is no grey. */
static void add_variations(const facet_model_info *model)
{
    facet_material defaults;
    facet_error why;
    assert_int_equal(facet_material_defaults(model->name, &defaults, &why), FACET_OK);
    add_variation(&defaults, "defaults", 0);
    for (size_t i = 0; i < model->n_parameters; i++) {
        const facet_parameter *p = &model->parameters[i];
        const int is_wide = p->low > 0 && p->high/p->low > 100;
        const int n = p->kind == FACET_CHOICE ? (int)p->high + 1 : (p->kind == FACET_COLOUR ? 1 : 2);
        for (int k = 0; k < n; k++) {
            const double part = 0.25 + 0.5*k;
            double values[3] = {is_wide ? p->low*pow(p->high/p->low, part) : p->low + part*(p->high - p->low), 0,
                                0};
            if (p->kind == FACET_CHOICE) values[0] = k;
            if (p->kind == FACET_COLOUR) {
                const double parts[3] = {0.75, 0.5, 0.125};
                for (int c = 0; c < 3; c++) values[c] = p->low + parts[c]*(fmin(p->high, 1 + p->low) - p->low);
            }
            facet_material material = defaults;
            const size_t n_values = p->kind == FACET_COLOUR ? 3 : 1;
            if (facet_material_set(&material, p->name, values, n_values, &why))
                fail_msg("%s %s=%g: %s", model->name, p->name, values[0], why.text);
            if (strcmp(p->name, "eta") == 0 || strcmp(p->name, "k") == 0) /* only given together */
                set_conductor(&material, p->name, values);
            add_variation(&material, p->name, values[0]);
        }
    }
}

static int find_all_bounds(void **state)
{
    (void)state;
    fill_inputs();
    for (size_t m = 0; m < facet_model_count(); m++) add_variations(facet_model_get(m));
    return 0;
}

static int free_all(void **state)
{
    (void)state;
    for (int k = 0; k < n_variations; k++) free(variations[k]);
    return 0;
}

/* ---- Running ----------------------------------------------------------------------------------- */

static char *read_text(const char *folder, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.glsl", folder, name);
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("%s cannot be read", path);
    static char text[1 << 20];
    char *start = strcmp(name, "any_model") == 0 ? text + sizeof text/2 : text;
    const size_t n = fread(start, 1, sizeof text/2 - 1, file);
    fclose(file);
    assert_true(n > 0 && n < sizeof text/2 - 1);
    start[n] = 0;
    return start;
}

/* `prefix` is the name that the functions of FILE.glsl begin with. */
static void compile(shader_language language, const char *file, const char *prefix)
{
    char macros[1024], upper[64], log[4096] = "";
    size_t length = 0;
    for (; prefix[length]; length++)
        upper[length] = (char)(prefix[length] >= 'a' && prefix[length] <= 'z' ? prefix[length] - 32 : prefix[length]);
    upper[length] = 0;
    snprintf(macros, sizeof macros,
             "#define MODEL_params %s_params\n#define MODEL_load %s_load\n#define MODEL_eval %s_eval\n"
             "#define MODEL_pdf %s_pdf\n#define MODEL_sample %s_sample\n#define MODEL_WORDS %s_WORDS\n",
             prefix, prefix, prefix, prefix, prefix, upper);
    const char *const pieces[] = {language == GLSL_ES_300 ? "#version 300 es\n" : "#version 450\n",
                                  read_text(FACET_GLSL_DIR, file), macros,
                                  read_text(FACET_SOURCE_DIR "/tests/shaders", "any_model")};
    if (!offscreen_compile(pieces, 4, log, sizeof log)) fail_msg("%s.glsl: %s", file, log);
    const char *const names[] = {"wi_map", "wo_map", "u_map"};
    const float *const inputs[] = {texels[0][0], texels[1][0], texels[2][0]};
    offscreen_inputs(names, inputs, HEIGHT);
}

static void results_in_float(const facet_bsdf *bsdf, int i, float r[N_RESULTS])
{
    facet_bsdf_eval(bsdf, texels[WI][i], texels[WO][i], r);
    r[3] = facet_bsdf_pdf(bsdf, texels[WI][i], texels[WO][i]);
    const facet_sample s = facet_bsdf_sample(bsdf, texels[WO][i], texels[U][i]);
    for (int k = 0; k < 3; k++) {
        r[4 + k] = s.wi[k];
        r[8 + k] = s.weight[k];
    }
    r[7] = s.pdf;
    r[11] = s.eta;
    r[12] = (float)s.lobe;
}

/* The largest difference in units of its bound; above 1 the test fails. */
static double compare(const variation *v, const char *file)
{
    uint32_t words[256];
    const size_t n = facet_bsdf_words(&v->single, 256, words);
    assert_true(n > 0 && n <= 256);
    float *const outputs[] = {drawn[0][0], drawn[1][0], drawn[2][0], drawn[3][0]};
    assert_true(offscreen_draw("material", words, (int)((n + 3)/4), HEIGHT, outputs));
    double worst = 0;
    for (int i = 0; i < N_PAIRS; i++) {
        float want[N_RESULTS];
        results_in_float(&v->single, i, want);
        for (int j = 0; j < N_RESULTS; j++) {
            const double got = (double)drawn[j/4][i][j%4], bound = 2*v->bounds[i][j];
            const double difference = fabs(got - (double)want[j]);
            if (!(difference <= bound)) {
                const float *wi = texels[WI][i], *wo = texels[WO][i], *u = texels[U][i];
                fail_msg("%s.glsl, %s, %s: %a, libfacet %a, apart %g, bound %g; wi %a %a %a wo %a %a %a u %a %a %a",
                         file, v->name, result_names[j], got, (double)want[j], difference, bound, (double)wi[0],
                         (double)wi[1], (double)wi[2], (double)wo[0], (double)wo[1], (double)wo[2], (double)u[0],
                         (double)u[1], (double)u[2]);
            }
            if (bound > 0) worst = fmax(worst, difference/bound);
        }
    }
    return worst;
}

static const char *kernel_of(size_t model)
{
#define KERNEL_ROW(name, kernel, summary, source) #kernel,
    static const char *const kernels[] = {FACET_MODELS(KERNEL_ROW)};
    return kernels[model];
}

/* All variations of a model, by the files of its kernels or by facet.glsl. */
static void run_model(shader_language language, size_t model, int is_all)
{
    const char *name = facet_model_get(model)->name, *compiled = "";
    double worst = 0;
    for (int k = 0; k < n_variations; k++) {
        if (variations[k]->model != model) continue;
        const char *kernel = facet_bsdf_kernel(&variations[k]->single);
        const char *own = strcmp(kernel, kernel_of(model)) == 0 ? name : kernel;
        const char *file = is_all ? "facet" : own, *prefix = is_all ? kernel : own;
        if (strcmp(prefix, compiled) != 0) compile(language, file, prefix);
        compiled = prefix;
        worst = fmax(worst, compare(variations[k], file));
    }
    print_message("  %s%s: at most %.3f of the bound\n", name, is_all ? " by facet.glsl" : "", worst);
}

static void run_models(shader_language language)
{
    const char *why = offscreen_open(language);
    if (why) {
        print_message("skipped: %s\n", why);
        skip();
    }
    print_message("  %s\n", offscreen_renderer());
    for (size_t model = 0; model < facet_model_count(); model++)
        for (int is_all = 0; is_all <= (language == GLSL_ES_300); is_all++) run_model(language, model, is_all);
    offscreen_close();
}

static void shaders_of_glsl_es_300_agree_with_the_library(void **state)
{
    (void)state;
    run_models(GLSL_ES_300);
}

static void shaders_of_glsl_450_agree_with_the_library(void **state)
{
    (void)state;
    run_models(GLSL_450);
}

/* Words past the parameters are 0, and fewer may be asked for. */
static void words_are_the_prepared_parameters(void **state)
{
    (void)state;
    const facet_bsdf bsdf = single_bsdf_of("lambert kd=.25,.5,.75");
    const float kd[3] = {0.25f, 0.5f, 0.75f};
    uint32_t words[5] = {1, 1, 1, 1, 1};
    assert_int_equal(facet_bsdf_words(&bsdf, 0, NULL), 3);
    assert_int_equal(facet_bsdf_words(&bsdf, 2, words), 3);
    assert_memory_equal(words, kd, 8);
    assert_int_equal(words[2], 1);
    assert_int_equal(facet_bsdf_words(&bsdf, 5, words), 3);
    assert_memory_equal(words, kd, 12);
    assert_true(words[3] == 0 && words[4] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_the_prepared_parameters),
        cmocka_unit_test(shaders_of_glsl_es_300_agree_with_the_library),
        cmocka_unit_test(shaders_of_glsl_450_agree_with_the_library),
    };
    return cmocka_run_group_tests_name("glsl", tests, find_all_bounds, free_all);
}
