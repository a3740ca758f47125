/* batch.h: the loops over batches, one table of them per instruction set.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* At least the number of rows of model_table.h (checked by batch_text.h). */
#define BATCH_KERNELS 16

enum { BATCH_LANE_KINDS = 4, LANES_BLOCK = 512 };

/* The parameters of at most LANES_BLOCK elements. */
typedef struct lane_block {
    size_t n;
    float alpha_x[LANES_BLOCK], alpha_y[LANES_BLOCK], gamma[LANES_BLOCK], kd[3][LANES_BLOCK], ks[3][LANES_BLOCK];
} lane_block;

/* Loops by kernel, in the order of model_table.h. */
struct prepared;
struct gtr_fit_loops;
typedef struct batch_loops {
    const char *name;
    void (*eval[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f);
    void (*pdf[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wi, facet_dirs wo, float *pdf);
    void (*eval_pdf[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f,
                                    float *pdf);
    void (*sample[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wo, facet_dirs u,
                                  facet_samples samples);
    /* With parameters that vary, by the order of LANE_KINDS (batch_lanes_text.h). */
    void (*lanes_eval[BATCH_LANE_KINDS])(const struct prepared *p, const lane_block *lanes, facet_dirs wi,
                                         facet_dirs wo, facet_rgb f);
    void (*lanes_pdf[BATCH_LANE_KINDS])(const struct prepared *p, const lane_block *lanes, facet_dirs wi, facet_dirs wo,
                                        float *pdf);
    void (*lanes_eval_pdf[BATCH_LANE_KINDS])(const struct prepared *p, const lane_block *lanes, facet_dirs wi,
                                             facet_dirs wo, facet_rgb f, float *pdf);
    void (*lanes_sample[BATCH_LANE_KINDS])(const struct prepared *p, const lane_block *lanes, facet_dirs wo,
                                           facet_dirs u, facet_samples samples);
    /* For preparing gtr (gtr_fit.h). */
    const struct gtr_fit_loops *gtr_fit;
} batch_loops;

/* The table in use. */
const batch_loops *facet_batch_loops(void);

extern const batch_loops facet_batch_base;
#if defined(__x86_64__)
extern const batch_loops facet_batch_avx2;
extern const batch_loops facet_batch_avx512;
#endif

#ifdef __cplusplus
}
#endif
