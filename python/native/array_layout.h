/* array_layout.h: how the elements of an array lie in memory, and how many are handled at a time.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "array_cursor.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { ARRAY_LARGEST_COPY = 256 }; /* elements */

typedef enum array_layout {
    ARRAY_COLUMNS, /* all x one after another, all y, all z: used where they are */
    ARRAY_ROWS,    /* x, y, z of the first element, then of the second, ... */
    ARRAY_ONE,     /* the same element again and again */
    ARRAY_ANY      /* anything else */
} array_layout;

/* Of an array whose cursor is at its start, with 1 or 3 parts to an element, numbers of so many bytes. */
array_layout array_layout_of(const array_cursor *start, int parts, size_t number);

/* How many elements are handled at a time, so that a block stays in the cache from one step to the next, and reading,
 * computing and writing overlap. */
typedef enum array_work { ARRAY_VALUES, ARRAY_DENSITIES, ARRAY_DRAWS } array_work;

/* ... of columns, of which nothing is copied.  All at once if none are checked, as a program in C would. */
size_t array_columns_block(array_work work, int is_checked);

/* ... of what is copied, at least in part. */
size_t array_copies_block(array_work work);

#ifdef __cplusplus
}
#endif
