/* loops.c: choosing a table of loops.
 * SPDX-License-Identifier: MIT */
#include "render/loops.h"

#include <string.h>

#include "core/batch.h"

const render_loops *render_loops_chosen(void)
{
#if defined(__x86_64__)
    const char *name = facet_batch_loops()->name;
    if (strcmp(name, render_loops_avx512.name) == 0) return &render_loops_avx512;
    if (strcmp(name, render_loops_avx2.name) == 0) return &render_loops_avx2;
#endif
    return &render_loops_base;
}
