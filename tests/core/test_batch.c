/* test_batch.c: batches give the bits of single calls on every instruction set, and every build gives the same bits.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"

enum { MOST = 65536, PADDING = 16, OUTPUTS = 7 };

/* The recorded hashes: FNV-1a over the bits of eval, pdf and sample of 65536 elements each.  They hold for every
 * compiler and optimisation, and change with the arithmetic of the kernels alone. */
typedef struct recorded {
    const char *spec;
    uint64_t hash;
} recorded;

static const recorded materials[] = {
    {"lambert kd=.1,.5,.9", UINT64_C(0x231d5bf2350ebc83)},
    {"phong exponent=50 kd=.2", UINT64_C(0x9b1c9914af746df5)},
    {"phong alpha_x=.1 alpha_y=.7 masking=published g2=separable", UINT64_C(0x2849fcfd5aa8e743)},
    {"beckmann alpha=.2", UINT64_C(0x2cc7062aa0c0d878)},
    {"phong exponent=50 sampling=ndf", UINT64_C(0x807d15f5c9dc7ad9)},
    {"beckmann alpha_x=.6 alpha_y=.1 kd=.3 sampling=ndf", UINT64_C(0x77f27814501be272)},
    {"ggx alpha=.2", UINT64_C(0x8766851b8837618b)},
    {"ggx alpha_x=.1 alpha_y=.4 ior=1.5 kd=.5", UINT64_C(0xd0474854ac18495d)},
    {"ggx alpha_x=.7 alpha_y=.3 sampling=bounded", UINT64_C(0x71efe01a7078b76d)},
    {"ggx alpha=.2 metal=Au kd=.1", UINT64_C(0x581865c0e748db92)},
    {"beckmann alpha=.3 eta=.2,.9,1.1 k=3.9,2.4,2.2 sampling=ndf", UINT64_C(0x76fecd60d42f40fa)},
    {"ggx alpha=.4 ks=.9,.6,.3 f82=.7,.8,1", UINT64_C(0x6d0b6e340a661546)},
    {"glass tint=.9,.8,.7", UINT64_C(0x35848d99a3d22cd5)},
    {"glass alpha=.3 tint=.9,.8,.7", UINT64_C(0x4d79e7241b9fcf1c)},
    {"glass alpha_x=.1 alpha_y=.4 ior=.7 wall=thin", UINT64_C(0x311785a8c1917121)},
    {"glass alpha=.2 ndf=beckmann", UINT64_C(0xde183876e5e63c47)},
    {"glass alpha=.3 ndf=gtr gamma=1.5", UINT64_C(0x0a99d99c73be4cd2)},
    {"glass exponent=30 ndf=phong", UINT64_C(0xd46cbc8ae979d857)},
    {"glass alpha=.2 ndf=beckmann masking=published g2=separable sampling=ndf", UINT64_C(0x03fa5592b4634b72)},
    {"metallic_roughness roughness=.6 diffuse=burley", UINT64_C(0xe625a1c88e200ed8)},
    {"metallic_roughness roughness=.4 metallic=.3", UINT64_C(0x27d28c6d9f7ca90f)},
    {"gtr alpha=.1 gamma=1.5", UINT64_C(0xd1864355fe52a8c6)},
    {"gtr alpha_x=.2 alpha_y=.6 gamma=.7 kd=.3 ks=.5", UINT64_C(0xc914f7f247645ea3)},
    {"gtr alpha=.3 gamma=6 sampling=ndf", UINT64_C(0x21638a9bf7ef4ad0)},
    {"gtr alpha=.3 gamma=2.5 masking=published", UINT64_C(0x67537d644f0cbaad)},
    {"gtr alpha_x=.1 alpha_y=.5 gamma=3 anisotropy=disney", UINT64_C(0x667df8f51784b4e2)},
    {"ward alpha=.3 kd=.2 ks=.5", UINT64_C(0xe6c6e1eb355fc7cf)},
    {"ward alpha_x=.1 alpha_y=.5 variant=duer", UINT64_C(0x55ac4bcaa2a85fb5)},
    {"ward alpha=.2 variant=ward92 sampling=ndf", UINT64_C(0x54a79edf0f9e6dcf)},
    {"cs500 ndf=phong kd=.3 ks=.1", UINT64_C(0x924d37ad5814a465)},
    {"disney base_color=.8,.3,.1 roughness=.4 subsurface=.3 sheen=.5", UINT64_C(0xaa9cf5c38e155918)},
    {"disney metallic=.5 anisotropic=.7 g2=correlated", UINT64_C(0x4357340db4badee5)},
    {"disney base_color=.8,.3,.1 roughness=.4 clearcoat=1", UINT64_C(0xf64014faf415b8fb)},
    {"disney metallic=.5 anisotropic=.7 clearcoat=.5 coat_masking=exact g2=correlated", UINT64_C(0x5cb47639e3174c79)},
};
enum { N_MATERIALS = sizeof materials/sizeof materials[0] };

static float wi[3][MOST + PADDING], wo[3][MOST + PADDING], u[3][MOST + PADDING];
static float single[OUTPUTS][MOST + PADDING], batch[OUTPUTS][MOST + PADDING];

/* A unit vector over the whole sphere made of exact arithmetic and square roots, so that no libm is involved. */
static void fill_direction(draws *d, float (*to)[MOST + PADDING], int i)
{
    double x, y, s;
    do {
        x = 2*draw(d) - 1;
        y = 2*draw(d) - 1;
        s = x*x + y*y;
    } while (s >= 1);
    const double root = sqrt(1 - s);
    to[0][i] = (float)(2*x*root);
    to[1][i] = (float)(2*y*root);
    to[2][i] = (float)(1 - 2*s);
    if (i%8) to[2][i] = fabsf(to[2][i]); /* most above the horizon */
}

static void fill_inputs(void)
{
    draws d = {2024};
    for (int i = 0; i < MOST + PADDING; i++) {
        fill_direction(&d, wi, i);
        fill_direction(&d, wo, i);
        for (int k = 0; k < 3; k++) u[k][i] = (float)draw(&d);
    }
}

typedef enum verb { EVAL, PDF, SAMPLE, EVAL_PDF, VERBS } verb;
static const char *const verb_names[VERBS] = {"eval", "pdf", "sample", "eval_pdf"};
static const int verb_outputs[VERBS] = {3, 1, 7, 4};

static void run_single(const facet_bsdf *bsdf, verb what, int n)
{
    for (int i = 0; i < n; i++) {
        const float in[3] = {wi[0][i], wi[1][i], wi[2][i]}, out[3] = {wo[0][i], wo[1][i], wo[2][i]};
        if (what == EVAL) {
            float f[3];
            facet_bsdf_eval(bsdf, in, out, f);
            for (int k = 0; k < 3; k++) single[k][i] = f[k];
        } else if (what == PDF) {
            single[0][i] = facet_bsdf_pdf(bsdf, in, out);
        } else if (what == EVAL_PDF) {
            float f[3];
            single[3][i] = facet_bsdf_eval_pdf(bsdf, in, out, f);
            for (int k = 0; k < 3; k++) single[k][i] = f[k];
        } else {
            const facet_sample s = facet_bsdf_sample(bsdf, out, (float[3]){u[0][i], u[1][i], u[2][i]});
            for (int k = 0; k < 3; k++) {
                single[k][i] = s.wi[k];
                single[4 + k][i] = s.weight[k];
            }
            single[3][i] = s.pdf;
        }
    }
}

/* n elements from element `first` on, so that pointers are aligned to 4 bytes only. */
static void run_batch(const facet_bsdf *bsdf, verb what, int first, int n)
{
    const facet_dirs in = {wi[0] + first, wi[1] + first, wi[2] + first};
    const facet_dirs out = {wo[0] + first, wo[1] + first, wo[2] + first};
    const facet_dirs numbers = {u[0] + first, u[1] + first, u[2] + first};
    float *to[OUTPUTS];
    for (int k = 0; k < OUTPUTS; k++) to[k] = batch[k] + first;
    if (what == EVAL) facet_bsdf_eval_batch(bsdf, (size_t)n, in, out, (facet_rgb){to[0], to[1], to[2]});
    else if (what == PDF) facet_bsdf_pdf_batch(bsdf, (size_t)n, in, out, to[0]);
    else if (what == EVAL_PDF)
        facet_bsdf_eval_pdf_batch(bsdf, (size_t)n, in, out, (facet_rgb){to[0], to[1], to[2]}, to[3]);
    else
        facet_bsdf_sample_batch(bsdf, (size_t)n, out, numbers,
                                (facet_samples){to[0], to[1], to[2], to[3], to[4], to[5], to[6]});
}

/* Bits equal inside [first, first + n), and the pattern 0xff untouched outside. */
static void compare(const char *spec, const char *isa, verb what, int first, int n, int limit)
{
    static const unsigned char untouched[sizeof(float)] = {0xff, 0xff, 0xff, 0xff};
    for (int k = 0; k < verb_outputs[what]; k++)
        for (int i = 0; i < limit; i++) {
            const int is_inside = i >= first && i < first + n;
            const void *want = is_inside ? (const void *)&single[k][i] : untouched;
            if (memcmp(&batch[k][i], want, sizeof(float)) != 0)
                fail_msg("%s, %s on %s, n %d from %d, output %d of element %d: %a, single call %a", spec,
                         verb_names[what], isa, n, first, k, i, (double)batch[k][i], (double)single[k][i]);
        }
}

static void check_batches(const char *spec, const char *isa)
{
    static const int counts[] = {0, 1, 3, 7, 15, 16, 17, 33, 1021};
    const facet_bsdf bsdf = single_bsdf_of(spec);
    for (int what = EVAL; what < VERBS; what++) {
        run_single(&bsdf, (verb)what, 1100);
        for (size_t c = 0; c < sizeof counts/sizeof counts[0]; c++)
            for (int first = 0; first < 4; first += 3) {
                memset(batch, 0xff, sizeof batch);
                run_batch(&bsdf, (verb)what, first, counts[c]);
                compare(spec, isa, (verb)what, first, counts[c], 1100);
            }
    }
}

static void batches_equal_single_calls(void **state)
{
    (void)state;
    fill_inputs();
    int n_sets = 0;
    for (size_t i = 0; facet_isa_name(i); i++, n_sets++) {
        assert_int_equal(facet_isa_force(facet_isa_name(i)), FACET_OK);
        for (int m = 0; m < N_MATERIALS; m++) check_batches(materials[m].spec, facet_isa_name(i));
        print_message("  %s: %d materials\n", facet_isa_name(i), (int)N_MATERIALS);
    }
    assert_true(n_sets >= 1);
    assert_int_equal(facet_isa_force(NULL), FACET_OK);
}

static void unknown_instruction_sets_are_refused(void **state)
{
    (void)state;
    assert_int_equal(facet_isa_force("abacus"), FACET_UNKNOWN_NAME);
    assert_int_equal(facet_isa_force(""), FACET_UNKNOWN_NAME);
    size_t n = 0;
    while (facet_isa_name(n)) n++;
    assert_string_equal(facet_isa_name(n - 1), "base");
    assert_null(facet_isa_name(n + 100));
}

static uint64_t hash_outputs(uint64_t hash, int n_outputs)
{
    for (int k = 0; k < n_outputs; k++)
        for (int i = 0; i < MOST; i++) {
            uint32_t bits;
            memcpy(&bits, &batch[k][i], sizeof bits);
            for (int byte = 0; byte < 4; byte++) hash = (hash ^ (bits >> 8*byte & 255))*UINT64_C(0x100000001b3);
        }
    return hash;
}

/* Asking for both at once changes nothing. */
static void eval_pdf_is_eval_and_pdf(void **state)
{
    (void)state;
    fill_inputs();
    for (int m = 0; m < N_MATERIALS; m++) {
        const facet_bsdf bsdf = single_bsdf_of(materials[m].spec);
        for (int i = 0; i < 1100; i++) {
            const float in[3] = {wi[0][i], wi[1][i], wi[2][i]}, out[3] = {wo[0][i], wo[1][i], wo[2][i]};
            float f[3], both[3];
            facet_bsdf_eval(&bsdf, in, out, f);
            const float pdf = facet_bsdf_pdf(&bsdf, in, out), pdf_of_both = facet_bsdf_eval_pdf(&bsdf, in, out, both);
            if (memcmp(f, both, sizeof f) != 0 || memcmp(&pdf, &pdf_of_both, sizeof pdf) != 0)
                fail_msg("%s, element %d: eval %a pdf %a, at once %a %a", materials[m].spec, i, (double)f[0],
                         (double)pdf, (double)both[0], (double)pdf_of_both);
        }
    }
}

/* Every compiler and instruction set: a model's results are part of its interface. */
static void results_have_the_recorded_bits(void **state)
{
    (void)state;
    fill_inputs();
    int n_wrong = 0;
    for (int m = 0; m < N_MATERIALS; m++) {
        const facet_bsdf bsdf = single_bsdf_of(materials[m].spec);
        uint64_t hash = UINT64_C(0xcbf29ce484222325);
        for (int what = EVAL; what <= SAMPLE; what++) {
            run_batch(&bsdf, (verb)what, 0, MOST);
            hash = hash_outputs(hash, verb_outputs[what]);
        }
        if (hash == materials[m].hash) continue;
        print_message("  {\"%s\", UINT64_C(0x%016llx)},\n", materials[m].spec, (unsigned long long)hash);
        n_wrong++;
    }
    if (n_wrong) fail_msg("%d materials have the hashes above instead of the recorded ones", n_wrong);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_equal_single_calls),
        cmocka_unit_test(eval_pdf_is_eval_and_pdf),
        cmocka_unit_test(unknown_instruction_sets_are_refused),
        cmocka_unit_test(results_have_the_recorded_bits),
    };
    return cmocka_run_group_tests_name("batch", tests, NULL, NULL);
}
