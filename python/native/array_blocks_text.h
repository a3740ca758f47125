/* array_blocks_text.h: blocks of an array in or out, for one type of number.
 *
 * Included by array_loops_text.h with REAL, the type; NAME(x), a name with its suffix; and EACH_ISA, what compiles a
 * function for several instruction sets.
 * SPDX-License-Identifier: MIT */

/* A block of n elements of 1 or 3 parts: part[k] points to n numbers, in the array itself where they lie one after
 * another, else in `copy`. */
typedef struct NAME(block) {
    REAL *part[3];
    REAL copy[3][ARRAY_LARGEST_BLOCK];
} NAME(block);

/* Whether the next n elements can be used where they are. */
static int NAME(lies_straight)(const array_cursor *c, size_t n)
{
    const ptrdiff_t stride = c->strides[c->n_axes - 1];
    return array_cursor_run(c, n) == n && (stride == (ptrdiff_t)sizeof(REAL) || n == 1);
}

static void NAME(point)(NAME(block)*b, const array_cursor *c, size_t n, int parts)
{
    const int is_straight = NAME(lies_straight)(c, n);
    for (int k = 0; k < parts; k++) b->part[k] = is_straight ? (REAL *)(void *)(c->at + k*c->component) : b->copy[k];
}

/* A run of triples, x, y, z after one another, or of anything. */
EACH_ISA static void NAME(gather)(const array_cursor *c, size_t n, int parts, REAL copy[3][ARRAY_LARGEST_BLOCK],
                                  size_t first)
{
    const ptrdiff_t stride = c->strides[c->n_axes - 1], size = (ptrdiff_t)sizeof(REAL);
    if (parts == 3 && c->component == size && stride == 3*size) {
        const REAL *from = (const REAL *)(const void *)c->at;
        REAL *const x = copy[0] + first, *const y = copy[1] + first, *const z = copy[2] + first;
        for (size_t i = 0; i < n; i++) {
            x[i] = from[3*i];
            y[i] = from[3*i + 1];
            z[i] = from[3*i + 2];
        }
    } else {
        for (int k = 0; k < parts; k++)
            for (size_t i = 0; i < n; i++)
                copy[k][first + i] = *(const REAL *)(const void *)(c->at + k*c->component + (ptrdiff_t)i*stride);
    }
}

EACH_ISA static void NAME(scatter)(const array_cursor *c, size_t n, int parts, REAL copy[3][ARRAY_LARGEST_BLOCK],
                                   size_t first)
{
    const ptrdiff_t stride = c->strides[c->n_axes - 1], size = (ptrdiff_t)sizeof(REAL);
    if (parts == 3 && c->component == size && stride == 3*size) {
        REAL *to = (REAL *)(void *)c->at;
        const REAL *const x = copy[0] + first, *const y = copy[1] + first, *const z = copy[2] + first;
        for (size_t i = 0; i < n; i++) {
            to[3*i] = x[i];
            to[3*i + 1] = y[i];
            to[3*i + 2] = z[i];
        }
    } else {
        for (int k = 0; k < parts; k++)
            for (size_t i = 0; i < n; i++)
                *(REAL *)(void *)(c->at + k*c->component + (ptrdiff_t)i*stride) = copy[k][first + i];
    }
}

/* The next n elements, to be read. */
static void NAME(read_block)(NAME(block)*b, array_cursor *c, size_t n, int parts)
{
    NAME(point)(b, c, n, parts);
    const int is_straight = NAME(lies_straight)(c, n);
    for (size_t done = 0; done < n;) {
        const size_t some = array_cursor_run(c, n - done);
        if (!is_straight) NAME(gather)(c, some, parts, b->copy, done);
        array_cursor_advance(c, some);
        done += some;
    }
}

/* Asks for the next n elements, at most one run of them, while something else is computed. */
static void NAME(expect_block)(const array_cursor *c, size_t n)
{
    const size_t bytes = array_cursor_run(c, n)*sizeof(REAL), line = 64;
    const ptrdiff_t stride = c->strides[c->n_axes - 1], size = (ptrdiff_t)sizeof(REAL);
    const int are_rows = c->component == size && stride == 3*size;
    for (int k = 0; k < 3 && (are_rows || stride == size); k++) {
        const char *const part = c->at + (are_rows ? k*(ptrdiff_t)bytes : k*c->component);
        for (size_t at = 0; at < bytes; at += line) __builtin_prefetch(part + at);
    }
}

/* What was written to part[] since NAME(point) goes where it belongs. */
static void NAME(write_block)(NAME(block)*b, array_cursor *c, size_t n, int parts)
{
    const int is_straight = NAME(lies_straight)(c, n);
    for (size_t done = 0; done < n;) {
        const size_t some = array_cursor_run(c, n - done);
        if (!is_straight) NAME(scatter)(c, some, parts, b->copy, done);
        array_cursor_advance(c, some);
        done += some;
    }
}

static int NAME(is_unit)(REAL x, REAL y, REAL z)
{
    const REAL excess = x*x + y*y + z*z - 1;
    const REAL size = excess < 0 ? -excess : excess;
    return size <= (REAL)FACET_PYTHON_UNIT; /* false for NaN, too */
}

static int NAME(is_in_cube)(REAL x, REAL y, REAL z)
{
    return (x >= 0) & (x < 1) & (y >= 0) & (y < 1) & (z >= 0) & (z < 1);
}

/* Whether all are unit vectors; of two arrays at once, since each start of a loop costs. */
EACH_ISA static int NAME(are_units)(const NAME(block)*a, const NAME(block)*b, size_t n)
{
    const REAL *const x = a->part[0], *const y = a->part[1], *const z = a->part[2];
    const REAL *const u = b->part[0], *const v = b->part[1], *const w = b->part[2];
    int are_units = 1;
#pragma omp simd reduction(& : are_units)
    for (size_t i = 0; i < n; i++) are_units &= NAME(is_unit)(x[i], y[i], z[i]) & NAME(is_unit)(u[i], v[i], w[i]);
    return are_units;
}

/* Whether those of `a` are unit vectors, and those of `b` in the unit cube. */
EACH_ISA static int NAME(are_units_and_in_cube)(const NAME(block)*a, const NAME(block)*b, size_t n)
{
    const REAL *const x = a->part[0], *const y = a->part[1], *const z = a->part[2];
    const REAL *const u = b->part[0], *const v = b->part[1], *const w = b->part[2];
    int are_right = 1;
#pragma omp simd reduction(& : are_right)
    for (size_t i = 0; i < n; i++) are_right &= NAME(is_unit)(x[i], y[i], z[i]) & NAME(is_in_cube)(u[i], v[i], w[i]);
    return are_right;
}

/* Names the first element that is not what is_right wants, of those at elements first, first + 1, ...; false if there
 * is one. */
static int NAME(tell)(const NAME(block)*b, int (*is_right)(REAL, REAL, REAL), size_t n, size_t first, int argument,
                      facet_python_fault *fault)
{
    for (size_t i = 0; i < n; i++) {
        const REAL x = b->part[0][i], y = b->part[1][i], z = b->part[2][i];
        if (is_right(x, y, z)) continue;
        *fault = (facet_python_fault){argument, first + i, {x, y, z}};
        return 0;
    }
    return 1;
}
