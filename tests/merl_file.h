/* merl_file.h: a file of the MERL database made for a test.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
/* cmocka needs the headers above */
#include <cmocka.h>

/* One with this f everywhere [1/sr]. */
static inline void write_merl_of(const char *path, double f)
{
    static const int sizes[3] = {90, 90, 180};
    static const double scales[3] = {1/1500.0, 1.15/1500, 1.66/1500};
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fwrite(sizes, sizeof sizes, 1, stream);
    for (int channel = 0; channel < 3; channel++)
        for (int i = 0; i < 90*90*180; i++) {
            const double value = f/scales[channel];
            fwrite(&value, sizeof value, 1, stream);
        }
    assert_int_equal(fclose(stream), 0);
}

/* One with f = 1/pi, which reflects all light. */
static inline void write_merl(const char *path)
{
    write_merl_of(path, 0.31830988618379067);
}
