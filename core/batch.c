/* batch.c: batches: choosing an instruction set, and the public functions.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 0
#include "batch.h"

#include <stdatomic.h>
#include <string.h>

#include "facet/facet.h"

#include "error.h"
#include "prepared.h"

/* The loop tables that this processor can run, best first. */
static const batch_loops *available(size_t i)
{
    const batch_loops *found[3] = {0};
    size_t n = 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        found[n++] = &facet_batch_avx512;
    if (__builtin_cpu_supports("avx2")) found[n++] = &facet_batch_avx2;
#endif
    found[n++] = &facet_batch_base;
    return i < n ? found[i] : NULL;
}

/* Chosen on first use; every thread would choose the same. */
static _Atomic(const batch_loops *) chosen;

const batch_loops *facet_batch_loops(void)
{
    const batch_loops *table = atomic_load_explicit(&chosen, memory_order_relaxed);
    if (!table) {
        table = available(0);
        atomic_store_explicit(&chosen, table, memory_order_relaxed);
    }
    return table;
}

const char *facet_isa_name(size_t i)
{
    const batch_loops *table = available(i);
    return table ? table->name : NULL;
}

facet_status facet_isa_force(const char *name)
{
    for (size_t i = 0; available(i); i++)
        if (!name || strcmp(name, available(i)->name) == 0) {
            atomic_store_explicit(&chosen, available(i), memory_order_relaxed);
            return FACET_OK;
        }
    return FACET_UNKNOWN_NAME;
}

void facet_bsdf_eval_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f)
{
    const prepared *p = (const prepared *)(const void *)bsdf;
    facet_batch_loops()->eval[p->kernel](p, n, wi, wo, f);
}

void facet_bsdf_pdf_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wi, facet_dirs wo, float *pdf)
{
    const prepared *p = (const prepared *)(const void *)bsdf;
    facet_batch_loops()->pdf[p->kernel](p, n, wi, wo, pdf);
}

void facet_bsdf_eval_pdf_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f, float *pdf)
{
    const prepared *p = (const prepared *)(const void *)bsdf;
    facet_batch_loops()->eval_pdf[p->kernel](p, n, wi, wo, f, pdf);
}

void facet_bsdf_sample_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wo, facet_dirs u, facet_samples samples)
{
    const prepared *p = (const prepared *)(const void *)bsdf;
    facet_batch_loops()->sample[p->kernel](p, n, wo, u, samples);
}
