/* fuzz_merl.c: libFuzzer's way into measured BRDFs of the MERL database.
 *
 * An input whose first byte is even is a file.  The others would need 35 MB: behind an odd first byte, six numbers are
 * two directions, and what follows are changes to a file of zeros: four bytes that say where, eight that are put there.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/merl.h"
#include "tests/fuzz/parts/harness.h"

enum { FILE_SIZE = 12 + 90*90*180*3*8, CHANGE = 12, MOST_CHANGES = 256, DIRECTIONS = 6*2 };

/* A unit vector from two numbers of 16 bits each and one that may point below. */
static void direction(const uint8_t *at, double w[3])
{
    const double theta = 3.2*(at[0] + at[1]*256)/65536, phi = 6.3*(at[2] + at[3]*256)/65536 + at[4];
    w[0] = sin(theta)*cos(phi);
    w[1] = sin(theta)*sin(phi);
    w[2] = cos(theta);
}

static void check_file(const uint8_t *file, size_t size, const uint8_t *directions)
{
    merl m;
    facet_error why = {0};
    if (merl_decode(file, size, &m, &why)) {
        require(!m.values && why.status && why.text[0]);
        return;
    }
    double wi[3], wo[3], f[3];
    direction(directions, wi);
    direction(directions + 6, wo);
    merl_eval(&m, wi, wo, f);
    for (int k = 0; k < 3; k++) require(f[k] >= 0 && !isnan(f[k]));
    require((wi[2] > 0 && wo[2] > 0) || f[0] + f[1] + f[2] == 0);
    merl_free(&m);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const uint8_t header[12] = {90, 0, 0, 0, 90, 0, 0, 0, 180};
    static uint8_t *whole;
    if (!size || bytes[0]%2 == 0 || size < 1 + DIRECTIONS) {
        uint8_t *copy = copy_bytes(bytes, size);
        merl m;
        facet_error why = {0};
        require(merl_decode(copy + (size > 0), size ? size - 1 : 0, &m, &why) != FACET_OK &&
                why.text[0]); /* too short */
        free(copy);
        return 0;
    }
    if (!whole) {
        whole = calloc(FILE_SIZE, 1);
        require(whole != NULL);
        memcpy(whole, header, sizeof header);
    }
    size_t places[MOST_CHANGES], n = 0;
    for (const uint8_t *at = bytes + 1 + DIRECTIONS; n < MOST_CHANGES && at + CHANGE <= bytes + size;
         at += CHANGE, n++) {
        const uint32_t place = at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
        places[n] = place%(FILE_SIZE - 8 + 1);
        memcpy(whole + places[n], at + 4, 8);
    }
    check_file(whole, bytes[0]%4 == 1 ? FILE_SIZE : FILE_SIZE - bytes[0], bytes + 1);
    while (n--) memset(whole + places[n], 0, 8);
    memcpy(whole, header, sizeof header);
    return 0;
}
