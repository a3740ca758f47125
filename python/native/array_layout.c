/* array_layout.c: how the elements of an array lie in memory.
 * SPDX-License-Identifier: MIT */
#include "array_layout.h"

array_layout array_layout_of(const array_cursor *start, int parts, size_t number)
{
    const ptrdiff_t stride = start->strides[0], size = (ptrdiff_t)number;
    if (start->n_axes > 1) return ARRAY_ANY;
    if (start->shape[0] == 1 || stride == size) return ARRAY_COLUMNS;
    if (stride == 0) return ARRAY_ONE;
    return parts == 3 && start->component == size && stride == 3*size ? ARRAY_ROWS : ARRAY_ANY;
}
