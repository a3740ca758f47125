/* batch_text.h: the loops over batches, written once for every instruction set.
 *
 * Included by batch_base.c, batch_avx2.c and batch_avx512.c, which define BATCH_LOOPS, the table's symbol,
 * BATCH_NAME, the name that users give, and BATCH_GTR_FIT.  Each loop copies its parameters to a local, so that the
 * compiler knows that the outputs do not change them.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 0
#define FACET_LOOPS
#include "batch.h"
#include "batch_terms_text.h"
#include "gtr_fit.h"
#include "model_table.h"
#include "prepared.h"

_Static_assert((int)KERNEL_COUNT <= BATCH_KERNELS, "batch.h has room for every kernel");

/* One loop per variant; a variant's constants are known where the loop is compiled. */
#define EACH_ROWS(name)                                                                                                \
    KERNEL void name##_eval_each(const name##_params *given, int variant, size_t n, facet_dirs wi, facet_dirs wo,      \
                                 facet_rgb f)                                                                          \
    {                                                                                                                  \
        const name##_params p = name##_fix(*given, variant);                                                           \
        float *restrict const r = f.r, *restrict const g = f.g, *restrict const b = f.b;                               \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++)                                                             \
        {                                                                                                              \
            const real3 value = name##_eval(p, gather(wi, i), gather(wo, i));                                          \
            r[i] = value.x;                                                                                            \
            g[i] = value.y;                                                                                            \
            b[i] = value.z;                                                                                            \
        }                                                                                                              \
    }                                                                                                                  \
    KERNEL void name##_pdf_each(const name##_params *given, int variant, size_t n, facet_dirs wi, facet_dirs wo,       \
                                float *pdf)                                                                            \
    {                                                                                                                  \
        const name##_params p = name##_fix(*given, variant);                                                           \
        float *restrict const out = pdf;                                                                               \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++) out[i] = name##_pdf(p, gather(wi, i), gather(wo, i));       \
    }                                                                                                                  \
    KERNEL void name##_eval_pdf_each(const name##_params *given, int variant, size_t n, facet_dirs wi, facet_dirs wo,  \
                                     facet_rgb f, float *pdf)                                                          \
    {                                                                                                                  \
        const name##_params p = name##_fix(*given, variant);                                                           \
        float *restrict const r = f.r, *restrict const g = f.g, *restrict const b = f.b, *restrict const out = pdf;    \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++)                                                             \
        {                                                                                                              \
            const bsdf_value both = name##_eval_pdf(p, gather(wi, i), gather(wo, i));                                  \
            r[i] = both.f.x;                                                                                           \
            g[i] = both.f.y;                                                                                           \
            b[i] = both.f.z;                                                                                           \
            out[i] = both.pdf;                                                                                         \
        }                                                                                                              \
    }                                                                                                                  \
    KERNEL void name##_sample_each(const name##_params *given, int variant, size_t n, facet_dirs wo, facet_dirs u,     \
                                   facet_samples s)                                                                    \
    {                                                                                                                  \
        const name##_params p = name##_fix(*given, variant);                                                           \
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
#define LOOP_ROWS(name)                                                                                                \
    EACH_VARIANT_##name(VARIANT_LOOPS, name) static void name##_eval_loop(const prepared *p, size_t n, facet_dirs wi,  \
                                                                          facet_dirs wo, facet_rgb f)                  \
    {                                                                                                                  \
        switch (p->variant) {                                                                                          \
            EACH_VARIANT_##name(EVAL_CASE, name)                                                                       \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_pdf_loop(const prepared *p, size_t n, facet_dirs wi, facet_dirs wo, float *pdf)                 \
    {                                                                                                                  \
        switch (p->variant) {                                                                                          \
            EACH_VARIANT_##name(PDF_CASE, name)                                                                        \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_eval_pdf_loop(const prepared *p, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f,           \
                                     float *pdf)                                                                       \
    {                                                                                                                  \
        switch (p->variant) {                                                                                          \
            EACH_VARIANT_##name(EVAL_PDF_CASE, name)                                                                   \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_sample_loop(const prepared *p, size_t n, facet_dirs wo, facet_dirs u, facet_samples s)          \
    {                                                                                                                  \
        switch (p->variant) {                                                                                          \
            EACH_VARIANT_##name(SAMPLE_CASE, name)                                                                     \
        }                                                                                                              \
    }
/* The loops of one variant.  A function each: gcc gives up on the records of parameters where many share one.  The
 * kernel microfacet has loops of its own (batch_microfacet_text.h). */
#define OWN_LOOP(name, verb)                                                                                           \
    _Generic(p->of.name, microfacet_params : microfacet_##verb##_staged, default : name##_##verb##_each)
#define VARIANT_LOOPS(name, v)                                                                                         \
    static __attribute__((noinline)) void name##_eval_##v(const prepared *p, size_t n, facet_dirs wi, facet_dirs wo,   \
                                                          facet_rgb f)                                                 \
    {                                                                                                                  \
        OWN_LOOP(name, eval)(&p->of.name, v, n, wi, wo, f);                                                            \
    }                                                                                                                  \
    static __attribute__((noinline)) void name##_pdf_##v(const prepared *p, size_t n, facet_dirs wi, facet_dirs wo,    \
                                                         float *pdf)                                                   \
    {                                                                                                                  \
        OWN_LOOP(name, pdf)(&p->of.name, v, n, wi, wo, pdf);                                                           \
    }                                                                                                                  \
    static __attribute__((noinline)) void name##_eval_pdf_##v(const prepared *p, size_t n, facet_dirs wi,              \
                                                              facet_dirs wo, facet_rgb f, float *pdf)                  \
    {                                                                                                                  \
        OWN_LOOP(name, eval_pdf)(&p->of.name, v, n, wi, wo, f, pdf);                                                   \
    }                                                                                                                  \
    static __attribute__((noinline)) void name##_sample_##v(const prepared *p, size_t n, facet_dirs wo, facet_dirs u,  \
                                                            facet_samples s)                                           \
    {                                                                                                                  \
        OWN_LOOP(name, sample)(&p->of.name, v, n, wo, u, s);                                                           \
    }
#define EVAL_CASE(name, v)                                                                                             \
    case v:                                                                                                            \
        name##_eval_##v(p, n, wi, wo, f);                                                                              \
        break;
#define PDF_CASE(name, v)                                                                                              \
    case v:                                                                                                            \
        name##_pdf_##v(p, n, wi, wo, pdf);                                                                             \
        break;
#define EVAL_PDF_CASE(name, v)                                                                                         \
    case v:                                                                                                            \
        name##_eval_pdf_##v(p, n, wi, wo, f, pdf);                                                                     \
        break;
#define SAMPLE_CASE(name, v)                                                                                           \
    case v: name##_sample_##v(p, n, wo, u, s); break;
FACET_KERNELS(EACH_ROWS)
#include "batch_microfacet_text.h"
FACET_KERNELS(LOOP_ROWS)

#include "batch_lanes_text.h"

#define EVAL_ENTRY(name) name##_eval_loop,
#define PDF_ENTRY(name) name##_pdf_loop,
#define EVAL_PDF_ENTRY(name) name##_eval_pdf_loop,
#define SAMPLE_ENTRY(name) name##_sample_loop,
const batch_loops BATCH_LOOPS = {
    .name = BATCH_NAME,
    .eval = {FACET_KERNELS(EVAL_ENTRY)},
    .pdf = {FACET_KERNELS(PDF_ENTRY)},
    .eval_pdf = {FACET_KERNELS(EVAL_PDF_ENTRY)},
    .sample = {FACET_KERNELS(SAMPLE_ENTRY)},
    .lanes_eval = {LANE_KINDS(LANES_EVAL_ENTRY)},
    .lanes_pdf = {LANE_KINDS(LANES_PDF_ENTRY)},
    .lanes_eval_pdf = {LANE_KINDS(LANES_EVAL_PDF_ENTRY)},
    .lanes_sample = {LANE_KINDS(LANES_SAMPLE_ENTRY)},
    .gtr_fit = &BATCH_GTR_FIT,
};
