/* cmd_sample.c: `facet sample`, directions as a renderer would draw them.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/report.h"

enum { BATCH = 1024 };

typedef struct settings {
    option_vector wo;
    uint64_t n, seed;
    bool is_double;
} settings;

/* SplitMix64 (Steele, Lea, Flood 2014): one 64-bit number per step from a counter. */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30)*0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27)*0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Arrays of one batch of samples. */
typedef struct block {
    float wo[3][BATCH], u[3][BATCH], wi[3][BATCH], pdf[BATCH], weight[3][BATCH];
} block;

static void print_float(block *b, size_t n, const facet_bsdf *bsdf, uint64_t *state)
{
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) b->u[k][i] = (float)(next_random(state) >> 40)*0x1p-24f;
    facet_bsdf_sample_batch(
        bsdf, n, (facet_dirs){b->wo[0], b->wo[1], b->wo[2]}, (facet_dirs){b->u[0], b->u[1], b->u[2]},
        (facet_samples){b->wi[0], b->wi[1], b->wi[2], b->pdf, b->weight[0], b->weight[1], b->weight[2]});
    for (size_t i = 0; i < n; i++)
        printf("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", (double)b->u[0][i], (double)b->u[1][i],
               (double)b->u[2][i], (double)b->wi[0][i], (double)b->wi[1][i], (double)b->wi[2][i], (double)b->pdf[i],
               (double)b->weight[0][i], (double)b->weight[1][i], (double)b->weight[2][i]);
}

static void print_double(size_t n, const facet_bsdf64 *bsdf, const double wo[3], uint64_t *state)
{
    for (size_t i = 0; i < n; i++) {
        double u[3];
        for (int k = 0; k < 3; k++) u[k] = (double)(next_random(state) >> 11)*0x1p-53;
        const facet_sample64 s = facet_bsdf64_sample(bsdf, wo, u);
        printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", u[0], u[1], u[2], s.wi[0], s.wi[1],
               s.wi[2], s.pdf, s.weight[0], s.weight[1], s.weight[2]);
    }
}

static int run(int argc, char **argv)
{
    settings s = {.n = 1};
    const char *text;
    int status = options_parse(&sample_command, argc, argv, &s, &text);
    if (status != PARSE_GO) return status;
    if (!s.wo.is_given) return fail(EXIT_USAGE, NULL, NULL, "sample needs a direction of view: --wo X,Y,Z");
    if (!make_unit(s.wo.v))
        return fail(EXIT_USAGE, NULL, "--wo", "is not a unit vector; its length has to be 1 within 1e-3");
    facet_bsdf bsdf;
    facet_bsdf64 bsdf64;
    if ((status = prepare_bsdf(text, "SPEC", &bsdf)) || (status = prepare_bsdf64(text, "SPEC", &bsdf64))) return status;
    block *b = malloc(sizeof *b);
    if (!b) return fail_memory();
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < BATCH; i++) b->wo[k][i] = (float)s.wo.v[k];
    printf("u1,u2,u3,wi_x,wi_y,wi_z,pdf,w_r,w_g,w_b\n");
    uint64_t state = s.seed;
    for (uint64_t done = 0; done < s.n && stdout_is_good(); done += BATCH) {
        const size_t n = s.n - done < BATCH ? (size_t)(s.n - done) : BATCH;
        if (s.is_double) print_double(n, &bsdf64, s.wo.v, &state);
        else print_float(b, n, &bsdf, &state);
    }
    free(b);
    return finish_stdout(0);
}

static const option options[] = {
    {"wo", 0, OPTION_VECTOR, offsetof(settings, wo), "X,Y,Z", "direction to the viewer; it is required", 0, 0, NULL},
    {"count", 'n', OPTION_INTEGER, offsetof(settings, n), "N", "number of samples (default 1)", 1, 1e12, NULL},
    {"seed", 0, OPTION_INTEGER, offsetof(settings, seed), "N", "seed of the random numbers (default 0)", 0, 0x1p53,
     NULL},
    {"double", 0, OPTION_FLAG, offsetof(settings, is_double), NULL,
     "compute in double precision and print 17 digits (default: float, 9 digits)", 0, 0, NULL},
};

const command sample_command = {
    .name = "sample",
    .summary = "draw directions of light from a material",
    .operands = "SPEC",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Prints CSV with the columns u1,u2,u3 (the random numbers used), wi_x,wi_y,wi_z, pdf [1/sr] and w_r,w_g,w_b\n"
        "(the weight: BRDF times |cos theta_i| over pdf).  pdf 0 means that there is no sample.  For mirrors and\n"
        "smooth glass the pdf is the probability of the direction.\n"
        "The random numbers are SplitMix64's, started at the seed, three per row in order: the top 24 bits times\n"
        "2^-24, with --double the top 53 bits times 2^-53.\n",
    .examples = "  facet sample 'ggx alpha=.3' --wo 0,0.6,0.8 -n 5\n"
                "  facet sample 'glass ior=1.5' --wo 0,0.6,0.8 -n 1000 --seed 7 --double > samples.csv\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
