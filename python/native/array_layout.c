/* array_layout.c: how the elements of an array lie in memory.
 * SPDX-License-Identifier: MIT */
#include "array_layout.h"

#include <stdint.h>
#include <string.h>

array_layout array_layout_of(const array_cursor *start, int parts, size_t number)
{
    const ptrdiff_t stride = start->strides[0], size = (ptrdiff_t)number;
    if (start->n_axes > 1) return ARRAY_ANY;
    if (start->shape[0] == 1 || stride == size) return ARRAY_COLUMNS;
    if (stride == 0) return ARRAY_ONE;
    return parts == 3 && start->component == size && stride == 3*size ? ARRAY_ROWS : ARRAY_ANY;
}

/* The wider the registers, the less time there is to compute while memory is on its way, and the more it counts that
 * checking one block overlaps with computing the next.  Narrow ones compute for longer than memory takes, so that it
 * counts how often a batch begins. */
static int has_wide_registers(void)
{
    return strcmp(facet_isa_name(0), "avx512") == 0;
}

/* A density alone writes little.  Samples take several loops each, which overlap little, and 13 columns: blocks for the
 * second cache, of 104 KiB, save ggx and gtr a tenth.  With narrow registers ggx takes 1.31 times as long as in C by
 * blocks of 128, 1.18 by 512. */
size_t array_columns_block(array_work work, int is_checked)
{
    if (!is_checked) return SIZE_MAX;
    if (work == ARRAY_DRAWS) return 2048;
    return !has_wide_registers() ? 512 : work == ARRAY_DENSITIES ? 256 : 128;
}

/* With 64, ggx takes a tenth longer, with 512 rows half as long again; with narrow registers, densities of 256 rows a
 * fifth. */
size_t array_copies_block(array_work work)
{
    return work == ARRAY_DENSITIES && has_wide_registers() ? ARRAY_LARGEST_COPY : 128;
}
