/* kernels.c: nanoseconds per eval, pdf, both at once, and sample of each model, one call at a time and in batches.
 *
 *     kernels [--csv FILE | SPEC]      (SPEC: only the materials that begin with this)
 *
 * One core; n = 2048 directions that stay in cache, each figure the best and the median of 25 rounds of at
 * least a millisecond.  Batches are checked against single calls, bit for bit, before they are timed.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "facet/facet.h"

/* The arrays lie a whole number of cache lines, but no power of two, apart: at equal offsets in a page they would evict
 * each other. */
enum { N = 2048, STRIDE = N + 80, ROUNDS = 25 };

static float wi[3][STRIDE], wo[3][STRIDE], u[3][STRIDE], out[7][STRIDE];

static const char *const specs[] = {
    "lambert",
    "phong exponent=50",
    "phong exponent=50 masking=published",
    "beckmann alpha=.2",
    "beckmann alpha=.2 sampling=ndf",
    "ggx alpha=.2",
    "ggx alpha_x=.1 alpha_y=.4",
    "ggx alpha=.2 sampling=ndf",
    "ggx alpha=.2 sampling=bounded",
    "ggx alpha=.2 ior=1.5 kd=.5",
    "gtr alpha=.1 gamma=1.5",
    "gtr alpha=.3 gamma=.7",
    "gtr alpha=.3 gamma=8",
    "gtr alpha=.1 gamma=1.5 masking=published",
    "gtr alpha=.1 gamma=1.5 sampling=ndf",
    "metallic_roughness roughness=.4",
    "disney roughness=.4",
    "disney roughness=.4 clearcoat=1",
    "disney clearcoat=1 coat_masking=exact",
    "glass",
    "glass alpha=.2",
    "glass alpha=.2 wall=thin",
    "glass alpha=.2 ndf=beckmann",
    "ward alpha=.2",
};

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* Uniform numbers in [0,1) from a 64-bit congruential generator (Knuth's constants). */
static float uniform(uint64_t *state)
{
    *state = *state*6364136223846793005u + 1442695040888963407u;
    return (float)(*state >> 40)*0x1p-24f;
}

static void fill_direction(float (*to)[STRIDE], int i, uint64_t *state)
{
    const float z = 1 - uniform(state);
    const float phi = 6.2831853f*uniform(state);
    const float sin = sqrtf(1 - z*z);
    to[0][i] = sin*cosf(phi);
    to[1][i] = sin*sinf(phi);
    to[2][i] = z;
}

static facet_dirs dirs(float (*d)[STRIDE])
{
    return (facet_dirs){d[0], d[1], d[2]};
}

typedef enum verb { EVAL, PDF, EVAL_PDF, SAMPLE, VERBS } verb;
static const char *const verb_names[] = {"eval", "pdf", "eval_pdf", "sample"};

static void run_scalar(const facet_bsdf *bsdf, verb what)
{
    for (int i = 0; i < N; i++) {
        const float in[3] = {wi[0][i], wi[1][i], wi[2][i]}, to[3] = {wo[0][i], wo[1][i], wo[2][i]};
        if (what == EVAL) {
            float f[3];
            facet_bsdf_eval(bsdf, in, to, f);
            for (int k = 0; k < 3; k++) out[k][i] = f[k];
        } else if (what == PDF) {
            out[0][i] = facet_bsdf_pdf(bsdf, in, to);
        } else if (what == EVAL_PDF) {
            float f[3];
            out[3][i] = facet_bsdf_eval_pdf(bsdf, in, to, f);
            for (int k = 0; k < 3; k++) out[k][i] = f[k];
        } else {
            const float v[3] = {u[0][i], u[1][i], u[2][i]};
            const facet_sample s = facet_bsdf_sample(bsdf, to, v);
            for (int k = 0; k < 3; k++) {
                out[k][i] = s.wi[k];
                out[4 + k][i] = s.weight[k];
            }
            out[3][i] = s.pdf;
        }
    }
}

static void run_batch(const facet_bsdf *bsdf, verb what)
{
    if (what == EVAL) facet_bsdf_eval_batch(bsdf, N, dirs(wi), dirs(wo), (facet_rgb){out[0], out[1], out[2]});
    else if (what == PDF) facet_bsdf_pdf_batch(bsdf, N, dirs(wi), dirs(wo), out[0]);
    else if (what == EVAL_PDF)
        facet_bsdf_eval_pdf_batch(bsdf, N, dirs(wi), dirs(wo), (facet_rgb){out[0], out[1], out[2]}, out[3]);
    else
        facet_bsdf_sample_batch(bsdf, N, dirs(wo), dirs(u),
                                (facet_samples){out[0], out[1], out[2], out[3], out[4], out[5], out[6]});
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Nanoseconds per element over `repeats` runs; reading the clock costs as much as a short batch. */
static double run_ns(const facet_bsdf *bsdf, verb what, void (*run)(const facet_bsdf *, verb), int repeats)
{
    const double start = seconds();
    for (int i = 0; i < repeats; i++) run(bsdf, what);
    return (seconds() - start)*1e9/((double)repeats*N);
}

/* Best and median nanoseconds per element. */
static void measure(const facet_bsdf *bsdf, verb what, void (*run)(const facet_bsdf *, verb), double *best,
                    double *median)
{
    int repeats = 1;
    while (run_ns(bsdf, what, run, repeats)*repeats*N < 1e6) repeats *= 2;
    double ns[ROUNDS];
    for (int r = 0; r < ROUNDS; r++) ns[r] = run_ns(bsdf, what, run, repeats);
    qsort(ns, ROUNDS, sizeof ns[0], compare_doubles);
    *best = ns[0];
    *median = ns[ROUNDS/2];
}

static void report(FILE *csv, const char *spec, verb what, const char *variant, double best, double median)
{
    printf("%-38s %-7s %-8s %8.2f %8.2f\n", spec, verb_names[what], variant, best, median);
    if (csv)
        fprintf(csv, "\"%s\",%s,%s,%d,%.4g,%.4g,%s\n", spec, verb_names[what], variant, N, best, median, __VERSION__);
}

int main(int argc, char **argv)
{
    FILE *csv = argc == 3 && strcmp(argv[1], "--csv") == 0 ? fopen(argv[2], "w") : NULL;
    const char *only = argc == 2 ? argv[1] : "";
    if (argc > 2 && !csv) {
        fprintf(stderr, "usage: kernels [--csv FILE | SPEC]\n");
        return 2;
    }
    if (csv) fprintf(csv, "material,verb,variant,n,best_ns,median_ns,compiler\n");
    uint64_t state = 1;
    for (int i = 0; i < N; i++) {
        fill_direction(wi, i, &state);
        fill_direction(wo, i, &state);
        for (int k = 0; k < 3; k++) u[k][i] = uniform(&state);
    }
    printf("%-38s %-7s %-8s %8s %8s  [ns]\n", "material", "verb", "variant", "best", "median");
    for (size_t m = 0; m < sizeof specs/sizeof specs[0]; m++) {
        if (strncmp(specs[m], only, strlen(only)) != 0) continue;
        facet_material material;
        facet_bsdf bsdf;
        facet_error why;
        if (facet_material_parse(specs[m], &material, &why) || facet_bsdf_prepare(&material, &bsdf, &why)) {
            fprintf(stderr, "%s: %s: %s\n", specs[m], why.place, why.text);
            return 1;
        }
        for (int v = EVAL; v < VERBS; v++) {
            static float expected[7][STRIDE];
            double best, median;
            memset(out, 0, sizeof out);
            run_scalar(&bsdf, (verb)v);
            memcpy(expected, out, sizeof out);
            measure(&bsdf, (verb)v, run_scalar, &best, &median);
            report(csv, specs[m], (verb)v, "scalar", best, median);
            for (size_t i = 0; facet_isa_name(i); i++) {
                facet_isa_force(facet_isa_name(i));
                memset(out, 0, sizeof out);
                run_batch(&bsdf, (verb)v);
                if (memcmp(expected, out, sizeof out) != 0) {
                    fprintf(stderr, "%s: %s: batch %s differs from single calls\n", specs[m], verb_names[v],
                            facet_isa_name(i));
                    return 1;
                }
                measure(&bsdf, (verb)v, run_batch, &best, &median);
                report(csv, specs[m], (verb)v, facet_isa_name(i), best, median);
            }
        }
    }
    return csv && fclose(csv) != 0 ? 4 : 0;
}
