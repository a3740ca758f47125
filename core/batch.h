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

/* Loops by kernel, in the order of model_table.h. */
struct prepared;
struct gtr_mixture;
struct gtr_directions;
typedef struct batch_loops {
    const char *name;
    void (*eval[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f);
    void (*pdf[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wi, facet_dirs wo, float *pdf);
    void (*eval_pdf[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f,
                                    float *pdf);
    void (*sample[BATCH_KERNELS])(const struct prepared *p, size_t n, facet_dirs wo, facet_dirs u,
                                  facet_samples samples);
    /* For preparing gtr: gtr_find_excess of gtr_mixture.h. */
    void (*gtr_excess)(const struct gtr_mixture *mixture, struct gtr_directions *directions);
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
