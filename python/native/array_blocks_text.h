/* array_blocks_text.h: an array, block by block, for one type of number.
 *
 * Included by array_loops_text.h with REAL, the type; BITS, the unsigned integer of its size; NAME(x), a name with its
 * suffix; and EACH_ISA, what compiles a function for several instruction sets.
 * SPDX-License-Identifier: MIT */

/* An array of elements of 1 or 3 parts.  Of its block at hand, part[k] points to the numbers of part k, one after
 * another: in the array itself where they lie so, else in `copy`. */
typedef struct NAME(window) {
    array_layout layout;
    int parts;
    array_cursor at;
    REAL *part[3], *next[3]; /* next: of ARRAY_COLUMNS */
    REAL copy[3][ARRAY_LARGEST_COPY];
} NAME(window);

/* An output that is not wanted has no layout: nobody asks for its blocks. */
static void NAME(open_output)(NAME(window)*w, const facet_python_array *array, int parts)
{
    w->at = array_cursor_start(array);
    w->parts = parts;
    w->layout = array->data ? array_layout_of(&w->at, parts, sizeof(REAL)) : ARRAY_ANY;
    if (w->layout == ARRAY_ONE) w->layout = ARRAY_ANY; /* the last one written counts */
    for (int k = 0; k < parts; k++) {
        w->part[k] = w->copy[k];
        w->next[k] = w->layout == ARRAY_COLUMNS ? (REAL *)(void *)(w->at.at + k*w->at.component) : NULL;
    }
}

static void NAME(open_input)(NAME(window)*w, const facet_python_array *array)
{
    NAME(open_output)(w, array, 3);
    w->layout = array_layout_of(&w->at, 3, sizeof(REAL));
    if (w->layout != ARRAY_ONE) return;
    const size_t n = w->at.shape[0] < ARRAY_LARGEST_COPY ? w->at.shape[0] : ARRAY_LARGEST_COPY;
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < n; i++) w->copy[k][i] = *(const REAL *)(const void *)(w->at.at + k*w->at.component);
}

/* A run of any strides, from and to a copy. */
static void NAME(gather)(const array_cursor *c, size_t n, int parts, REAL copy[3][ARRAY_LARGEST_COPY], size_t first)
{
    const ptrdiff_t stride = c->strides[c->n_axes - 1];
    for (int k = 0; k < parts; k++) {
        const char *const from = c->at + k*c->component;
        if (stride == (ptrdiff_t)sizeof(REAL)) memcpy(copy[k] + first, from, n*sizeof(REAL));
        else
            for (size_t i = 0; i < n; i++)
                copy[k][first + i] = *(const REAL *)(const void *)(from + (ptrdiff_t)i*stride);
    }
}

static void NAME(scatter)(const array_cursor *c, size_t n, int parts, REAL copy[3][ARRAY_LARGEST_COPY], size_t first)
{
    const ptrdiff_t stride = c->strides[c->n_axes - 1];
    for (int k = 0; k < parts; k++) {
        char *const to = c->at + k*c->component;
        for (size_t i = 0; i < n; i++) *(REAL *)(void *)(to + (ptrdiff_t)i*stride) = copy[k][first + i];
    }
}

/* Triples x, y, z after one another, from and to a copy. */
EACH_ISA static void NAME(gather_rows)(const REAL *from, size_t n, REAL copy[3][ARRAY_LARGEST_COPY])
{
    REAL *const x = copy[0], *const y = copy[1], *const z = copy[2];
    for (size_t i = 0; i < n; i++) {
        x[i] = from[3*i];
        y[i] = from[3*i + 1];
        z[i] = from[3*i + 2];
    }
}

EACH_ISA static void NAME(scatter_rows)(REAL *to, size_t n, REAL copy[3][ARRAY_LARGEST_COPY])
{
    const REAL *const x = copy[0], *const y = copy[1], *const z = copy[2];
    for (size_t i = 0; i < n; i++) {
        to[3*i] = x[i];
        to[3*i + 1] = y[i];
        to[3*i + 2] = z[i];
    }
}

/* Goes on to the next n elements of columns. */
static inline void NAME(go_on)(NAME(window)*w, size_t n)
{
    for (int k = 0; k < w->parts && w->layout == ARRAY_COLUMNS; k++) {
        w->part[k] = w->next[k];
        w->next[k] += n;
    }
}

/* Asks for the n rows after the next n while something is computed; what lies beyond the end does no harm.  Columns
 * come by themselves: processors foresee what one loop reads, but not what takes turns. */
#define EXPECT_ROWS(w, n, is_write)                                                                                    \
    for (size_t line = 0; line < 3*(n)*sizeof(REAL); line += 64)                                                       \
    __builtin_prefetch((const void *)((uintptr_t)(w)->at.at + 3*(n)*sizeof(REAL) + line), is_write)

/* The next n elements, to be read. */
static inline void NAME(read)(NAME(window)*w, size_t n)
{
    NAME(go_on)(w, n);
    if (w->layout == ARRAY_ROWS) {
        EXPECT_ROWS(w, n, 0);
        NAME(gather_rows)((const REAL *)(const void *)w->at.at, n, w->copy);
        w->at.at += 3*n*sizeof(REAL);
    } else if (w->layout == ARRAY_ANY) {
        for (size_t done = 0, some; done < n; done += some) {
            some = array_cursor_run(&w->at, n - done);
            NAME(gather)(&w->at, some, w->parts, w->copy, done);
            array_cursor_advance(&w->at, some);
        }
    }
}

/* Room for the next n elements. */
static inline void NAME(make_room)(NAME(window)*w, size_t n)
{
    NAME(go_on)(w, n);
    if (w->layout == ARRAY_ROWS) EXPECT_ROWS(w, n, 1);
}

/* What is in that room now goes where it belongs. */
static inline void NAME(write)(NAME(window)*w, size_t n)
{
    if (w->layout == ARRAY_ROWS) {
        NAME(scatter_rows)((REAL *)(void *)w->at.at, n, w->copy);
        w->at.at += 3*n*sizeof(REAL);
    } else if (w->layout == ARRAY_ANY) {
        for (size_t done = 0, some; done < n; done += some) {
            some = array_cursor_run(&w->at, n - done);
            NAME(scatter)(&w->at, some, w->parts, w->copy, done);
            array_cursor_advance(&w->at, some);
        }
    }
}
#undef EXPECT_ROWS

/* ---- Whether inputs are what they must be ------------------------------------------------------ */

static inline BITS NAME(bits)(REAL x)
{
    const union {
        REAL x;
        BITS bits;
    } u = {x};
    return u.bits;
}

/* How far |w|^2 is above the least that is taken for 1, as integers: positive numbers have the order of their bits, and
 * what is below wraps round to above all, where NaN is. */
static inline BITS NAME(excess)(REAL x, REAL y, REAL z)
{
    return NAME(bits)(x*x + y*y + z*z) - NAME(bits)((REAL)(1 - FACET_PYTHON_UNIT));
}

/* That of the largest that is taken for 1. */
static inline BITS NAME(largest_unit)(void)
{
    return NAME(bits)((REAL)(1 + FACET_PYTHON_UNIT)) - NAME(bits)((REAL)(1 - FACET_PYTHON_UNIT));
}

static int NAME(is_unit)(REAL x, REAL y, REAL z)
{
    return NAME(excess)(x, y, z) <= NAME(largest_unit)();
}

static int NAME(is_in_cube)(REAL x, REAL y, REAL z)
{
    return (x >= 0) & (x < 1) & (y >= 0) & (y < 1) & (z >= 0) & (z < 1);
}

/* The largest excess of two blocks of directions; of two at once, since each start of a loop costs. */
EACH_ISA static BITS NAME(largest_excess)(const NAME(window)*a, const NAME(window)*b, size_t n)
{
    const REAL *const x = a->part[0], *const y = a->part[1], *const z = a->part[2];
    const REAL *const u = b->part[0], *const v = b->part[1], *const w = b->part[2];
    BITS largest = 0;
#pragma omp simd reduction(max : largest)
    for (size_t i = 0; i < n; i++) {
        const BITS p = NAME(excess)(x[i], y[i], z[i]), q = NAME(excess)(u[i], v[i], w[i]);
        const BITS larger = p > q ? p : q;
        largest = larger > largest ? larger : largest;
    }
    return largest;
}

static int NAME(are_units)(const NAME(window)*a, const NAME(window)*b, size_t n)
{
    return NAME(largest_excess)(a, b, n) <= NAME(largest_unit)();
}

/* Whether those of `a` are unit vectors, and those of `b` in the unit cube: numbers from 0 up have the order of their
 * bits, and those of negative ones and of NaN are above 1's.  -0 thus looks wrong, and tell() finds that it is not. */
EACH_ISA static int NAME(are_units_and_in_cube)(const NAME(window)*a, const NAME(window)*b, size_t n)
{
    const REAL *const x = a->part[0], *const y = a->part[1], *const z = a->part[2];
    const REAL *const u = b->part[0], *const v = b->part[1], *const w = b->part[2];
    BITS distance = 0, number = 0;
#pragma omp simd reduction(max : distance, number)
    for (size_t i = 0; i < n; i++) {
        const BITS d = NAME(excess)(x[i], y[i], z[i]), p = NAME(bits)(u[i]), q = NAME(bits)(v[i]), r = NAME(bits)(w[i]);
        const BITS larger = p > q ? p : q, largest = larger > r ? larger : r;
        distance = d > distance ? d : distance;
        number = largest > number ? largest : number;
    }
    return distance <= NAME(largest_unit)() && number < NAME(bits)(1);
}

/* Names the first element that is not what is_right wants, of those at elements first, first + 1, ...; false if there
 * is one. */
static int NAME(tell)(const NAME(window)*w, int (*is_right)(REAL, REAL, REAL), size_t n, size_t first, int argument,
                      facet_python_fault *fault)
{
    for (size_t i = 0; i < n; i++) {
        const REAL x = w->part[0][i], y = w->part[1][i], z = w->part[2][i];
        if (is_right(x, y, z)) continue;
        *fault = (facet_python_fault){argument, first + i, {x, y, z}};
        return 0;
    }
    return 1;
}
