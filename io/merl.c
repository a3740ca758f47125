/* merl.c: see merl.h.
 *
 * A file is three 32-bit integers, 90, 90 and 180, and as many 64-bit numbers for red, then for green, then for blue,
 * all with the least significant byte first.  A channel's numbers are f times 1500, 1500/1.15 and 1500/1.66.  The half
 * angle has the index 90 sqrt(theta_h/90 degrees), the difference angle theta_d one by degree, and its azimuth phi_d
 * one by degree, modulo 180 because f is reciprocal.
 * SPDX-License-Identifier: MIT */
#include "io/merl.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"

#define PI 3.14159265358979323846

enum { HALF = 90, DIFFERENCE = 90, AZIMUTH = 180, COUNT = HALF*DIFFERENCE*AZIMUTH, HEADER = 12 };

static uint64_t little_endian(const unsigned char *bytes, int n)
{
    uint64_t word = 0;
    for (int i = n - 1; i >= 0; i--) word = word << 8 | bytes[i];
    return word;
}

static double number_at(const unsigned char *bytes)
{
    const uint64_t word = little_endian(bytes, 8);
    double x;
    memcpy(&x, &word, sizeof x);
    return x;
}

static facet_status check(const unsigned char *bytes, size_t size, facet_error *why)
{
    static const char form[] = "a MERL file is 90 x 90 x 180 x 3 numbers, 34992012 bytes";
    if (size < HEADER) return facet_error_set(why, FACET_BAD_FILE, "", "has %zu bytes; %s", size, form);
    const unsigned long n[3] = {(unsigned long)little_endian(bytes, 4), (unsigned long)little_endian(bytes + 4, 4),
                                (unsigned long)little_endian(bytes + 8, 4)};
    if (n[0] != HALF || n[1] != DIFFERENCE || n[2] != AZIMUTH)
        return facet_error_set(why, FACET_BAD_FILE, "byte 0", "its sizes are %lu, %lu, %lu; %s", n[0], n[1], n[2],
                               form);
    if (size != HEADER + (size_t)3*COUNT*8)
        return facet_error_set(why, FACET_BAD_FILE, "", "has %zu bytes; %s", size, form);
    return FACET_OK;
}

facet_status merl_decode(const unsigned char *bytes, size_t size, merl *m, facet_error *why)
{
    static const double scale[3] = {1.0/1500, 1.15/1500, 1.66/1500};
    m->values = NULL;
    const facet_status status = check(bytes, size, why);
    if (status) return status;
    m->values = malloc((size_t)3*COUNT*sizeof *m->values);
    if (!m->values) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for 35 MB of measurements");
    for (size_t i = 0; i < (size_t)3*COUNT; i++) {
        const double x = number_at(bytes + HEADER + 8*i);
        if (!isfinite(x)) {
            char place[32];
            snprintf(place, sizeof place, "byte %zu", HEADER + 8*i);
            merl_free(m);
            return facet_error_set(why, FACET_BAD_FILE, place, "the number is not finite");
        }
        m->values[i] = fmax(x, 0)*scale[i/COUNT];
    }
    return FACET_OK;
}

facet_status merl_read(const char *path, merl *m, facet_error *why)
{
    unsigned char *bytes;
    size_t size;
    m->values = NULL;
    facet_status status = file_read(path, &bytes, &size, why);
    if (status) return status;
    status = merl_decode(bytes, size, m, why);
    free(bytes);
    return status;
}

void merl_free(merl *m)
{
    free(m->values);
    m->values = NULL;
}

/* A place between two indices. */
typedef struct between {
    int low, high;
    double part; /* of the way from low to high */
} between;

static between place_of(double x, int n)
{
    const double clamped = fmin(fmax(x, 0), n - 1);
    const int low = (int)clamped;
    return (between){low, low + 1 < n ? low + 1 : low, clamped - low};
}

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

void merl_eval(const merl *m, const double wi[3], const double wo[3], double f[3])
{
    f[0] = f[1] = f[2] = 0;
    if (!(wi[2] > 0 && wo[2] > 0)) return;
    double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    const double length = sqrt(dot(h, h));
    for (int k = 0; k < 3; k++) h[k] /= length;
    /* wi turned so that h is the pole: its components along the meridian of h, across it, and along h */
    const double sine = hypot(h[0], h[1]), c = sine > 0 ? h[0]/sine : 1, s = sine > 0 ? h[1]/sine : 0;
    const double along[3] = {c*h[2], s*h[2], -sine}, across[3] = {-s, c, 0};
    const double x = dot(wi, along), y = dot(wi, across);
    const double theta_h = atan2(sine, h[2]), theta_d = atan2(hypot(x, y), dot(wi, h));
    double phi_d = atan2(y, x);
    if (phi_d < 0) phi_d += PI;
    const between half = place_of(HALF*sqrt(theta_h/(PI/2)), HALF);
    const between difference = place_of(DIFFERENCE*theta_d/(PI/2), DIFFERENCE);
    between azimuth = place_of(fmin(AZIMUTH*phi_d/PI, AZIMUTH), AZIMUTH + 1);
    azimuth.low %= AZIMUTH;
    azimuth.high %= AZIMUTH;
    for (int corner = 0; corner < 8; corner++) {
        const int i = corner & 1 ? half.high : half.low, j = corner & 2 ? difference.high : difference.low;
        const int k = corner & 4 ? azimuth.high : azimuth.low;
        const double weight = (corner & 1 ? half.part : 1 - half.part)*
                              (corner & 2 ? difference.part : 1 - difference.part)*
                              (corner & 4 ? azimuth.part : 1 - azimuth.part);
        for (int channel = 0; channel < 3; channel++)
            f[channel] += weight*wi[2]*
                          m->values[(size_t)channel*COUNT + (size_t)((i*DIFFERENCE + j)*AZIMUTH + k)];
    }
}
