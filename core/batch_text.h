/* batch_text.h: the loops over batches, written once for every instruction set.
 *
 * Included by batch_base.c, batch_avx2.c and batch_avx512.c, which define BATCH_LOOPS, the table's symbol, and
 * BATCH_NAME, the name that users give.  Each loop copies its parameters to a local, so that the compiler
 * knows that the outputs do not change them.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 0
#include "batch.h"
#include "model_table.h"
#include "prepared.h"

_Static_assert((int)MODEL_COUNT <= BATCH_MODELS, "batch.h has room for every model");

static inline real3 gather(facet_dirs d, size_t i)
{
    return make3(d.x[i], d.y[i], d.z[i]);
}

#define LOOP_ROWS(name, summary, source)                                                                               \
    static void name##_eval_loop(const void *params, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f)              \
    {                                                                                                                  \
        const name##_params p = *(const name##_params *)params;                                                        \
        float *restrict const r = f.r, *restrict const g = f.g, *restrict const b = f.b;                               \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++)                                                             \
        {                                                                                                              \
            const real3 value = name##_eval(p, gather(wi, i), gather(wo, i));                                          \
            r[i] = value.x;                                                                                            \
            g[i] = value.y;                                                                                            \
            b[i] = value.z;                                                                                            \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_pdf_loop(const void *params, size_t n, facet_dirs wi, facet_dirs wo, float *pdf)                \
    {                                                                                                                  \
        const name##_params p = *(const name##_params *)params;                                                        \
        float *restrict const out = pdf;                                                                               \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++) out[i] = name##_pdf(p, gather(wi, i), gather(wo, i));       \
    }                                                                                                                  \
    static void name##_sample_loop(const void *params, size_t n, facet_dirs wo, facet_dirs u, facet_samples s)         \
    {                                                                                                                  \
        const name##_params p = *(const name##_params *)params;                                                        \
        const facet_samples to = s;                                                                                    \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++)                                                             \
        {                                                                                                              \
            const bsdf_sample drawn = name##_sample(p, gather(wo, i), gather(u, i));                                   \
            to.wi_x[i] = drawn.wi.x;                                                                                   \
            to.wi_y[i] = drawn.wi.y;                                                                                   \
            to.wi_z[i] = drawn.wi.z;                                                                                   \
            to.pdf[i] = drawn.pdf;                                                                                     \
            to.weight_r[i] = drawn.weight.x;                                                                           \
            to.weight_g[i] = drawn.weight.y;                                                                           \
            to.weight_b[i] = drawn.weight.z;                                                                           \
        }                                                                                                              \
    }
FACET_MODELS(LOOP_ROWS)

#define EVAL_ENTRY(name, summary, source) name##_eval_loop,
#define PDF_ENTRY(name, summary, source) name##_pdf_loop,
#define SAMPLE_ENTRY(name, summary, source) name##_sample_loop,
const batch_loops BATCH_LOOPS = {
    .name = BATCH_NAME,
    .eval = {FACET_MODELS(EVAL_ENTRY)},
    .pdf = {FACET_MODELS(PDF_ENTRY)},
    .sample = {FACET_MODELS(SAMPLE_ENTRY)},
};
