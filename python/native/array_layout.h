/* array_layout.h: how the elements of an array lie in memory, and how many are handled at a time.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "array_cursor.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Elements that are handled at a time, so that a block stays in the first cache from one step to the next, and
 * reading, computing and writing overlap: with 64 ggx takes a tenth longer, with 512 rows half as long again.  A
 * density alone, which writes little, takes as many as a copy has room for.  Samples take several loops each, which
 * overlap little, and 13 columns: where nothing is copied, blocks for the second cache, of 104 KiB, save ggx and gtr a
 * tenth. */
enum { ARRAY_BLOCK = 128, ARRAY_LARGEST_COPY = 256, ARRAY_SAMPLES = 2048 };

typedef enum array_layout {
    ARRAY_COLUMNS, /* all x one after another, all y, all z: used where they are */
    ARRAY_ROWS,    /* x, y, z of the first element, then of the second, ... */
    ARRAY_ONE,     /* the same element again and again */
    ARRAY_ANY      /* anything else */
} array_layout;

/* Of an array whose cursor is at its start, with 1 or 3 parts to an element, numbers of so many bytes. */
array_layout array_layout_of(const array_cursor *start, int parts, size_t number);

#ifdef __cplusplus
}
#endif
