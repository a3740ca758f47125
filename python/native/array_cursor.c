/* array_cursor.c: a place in an array of any shape and strides.
 * SPDX-License-Identifier: MIT */
#include "array_cursor.h"

array_cursor array_cursor_start(const facet_python_array *array)
{
    array_cursor c = {.at = array->data, .component = array->component};
    for (int i = 0; i < array->n_axes; i++) {
        const size_t length = array->shape[i];
        const ptrdiff_t stride = array->strides[i];
        if (length == 1) continue;
        const int last = c.n_axes - 1;
        if (c.n_axes && c.strides[last] == stride*(ptrdiff_t)length) {
            c.shape[last] *= length;
            c.strides[last] = stride;
        } else {
            c.shape[c.n_axes] = length;
            c.strides[c.n_axes++] = stride;
        }
    }
    if (!c.n_axes) { /* one element; its stride is that of a block of one */
        c.shape[0] = 1;
        c.n_axes = 1;
    }
    return c;
}

size_t array_cursor_run(const array_cursor *c, size_t n)
{
    const size_t left = c->shape[c->n_axes - 1] - c->index[c->n_axes - 1];
    return left < n ? left : n;
}

void array_cursor_advance(array_cursor *c, size_t n)
{
    int axis = c->n_axes - 1;
    c->at += c->strides[axis]*(ptrdiff_t)n;
    c->index[axis] += n;
    while (axis > 0 && c->index[axis] == c->shape[axis]) {
        c->at += c->strides[axis - 1] - c->strides[axis]*(ptrdiff_t)c->shape[axis];
        c->index[axis] = 0;
        c->index[--axis]++;
    }
}
