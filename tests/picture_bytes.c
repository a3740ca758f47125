/* picture_bytes.c: whether two picture files are the same.
 * SPDX-License-Identifier: MIT */
#include "tests/picture_bytes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/image_file.h"
#include "tests/run_program.h"

void assert_same_pixels(const char *folder, const char *a, const char *b)
{
    image x, y;
    facet_error why = {0};
    if (image_read(in_folder(folder, a), &x, &why)) fail_msg("%s: %s", a, why.text);
    if (image_read(in_folder(folder, b), &y, &why)) fail_msg("%s: %s", b, why.text);
    const size_t size = x.width*x.height*x.n_channels*(x.type == PIXEL_F32 ? 4 : x.type == PIXEL_U16 ? 2 : 1);
    if (x.width != y.width || x.height != y.height || x.n_channels != y.n_channels || x.type != y.type ||
        memcmp(x.pixels, y.pixels, size) != 0)
        fail_msg("%s and %s differ", a, b);
    image_destroy(&x);
    image_destroy(&y);
}

/* The file without the digits of its facet:time_seconds, whose number is kept. */
static char *read_without_time(const char *path, size_t *size)
{
    static const char key[] = "facet:time_seconds";
    char *bytes = read_bytes(path, size);
    assert_non_null(bytes);
    char *at = bytes;
    while (at + sizeof key < bytes + *size && memcmp(at, key, sizeof key) != 0) at++;
    for (at += sizeof key; at < bytes + *size && strncmp(at, "facet:", 6) != 0; at++)
        if (*at >= '0' && *at <= '9') *at = '0';
    return bytes;
}

void assert_same_but_for_time(const char *folder, const char *a, const char *b)
{
    size_t n_a, n_b;
    char *x = read_without_time(in_folder(folder, a), &n_a), *y = read_without_time(in_folder(folder, b), &n_b);
    assert_int_equal(n_a, n_b);
    assert_memory_equal(x, y, n_a);
    free(x);
    free(y);
}
