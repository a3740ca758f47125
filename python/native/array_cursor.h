/* array_cursor.h: a place in an array of any shape and strides, which goes from its first element to its last.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "array_loops.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct array_cursor {
    char *at; /* the next element */
    ptrdiff_t component;
    int n_axes; /* those left when axes of length 1 are dropped and neighbours joined where strides allow; at least 1 */
    size_t shape[FACET_PYTHON_AXES], index[FACET_PYTHON_AXES];
    ptrdiff_t strides[FACET_PYTHON_AXES];
} array_cursor;

array_cursor array_cursor_start(const facet_python_array *array);

/* How many elements come one stride after another from here, at most n. */
size_t array_cursor_run(const array_cursor *c, size_t n);

/* Goes on by n elements, not beyond the end of the run. */
void array_cursor_advance(array_cursor *c, size_t n);

#ifdef __cplusplus
}
#endif
