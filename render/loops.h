/* loops.h: the renderer's loops over many rays or samples, one table of them per instruction set.
 *
 * All give the same bits.  Arrays hold whole vectors: n is rounded up to a multiple of LOOP_LANES.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "render/linear.h"
#include "render/rays.h"
#include "render/sampler.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { LOOP_LANES = 64 };

typedef struct render_loops {
    const char *name;
    void (*nearest)(const linear_scene *s, size_t n, rays r, hits h);
    /* blocked[i]: whether anything lies on ray i. */
    void (*blocked)(const linear_scene *s, size_t n, rays r, uint32_t *blocked);
    /* The group's three numbers for n streams, as 32-bit fractions. */
    void (*points)(const sampler *s, size_t n, const uint32_t *pixel, const uint32_t *index, uint32_t group,
                   uint32_t *const u[3]);
} render_loops;

/* Those of the instruction set that libfacet's batches use. */
const render_loops *render_loops_chosen(void);

extern const render_loops render_loops_base;
#if defined(__x86_64__)
extern const render_loops render_loops_avx2;
extern const render_loops render_loops_avx512;
#endif

#ifdef __cplusplus
}
#endif
