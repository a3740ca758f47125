/* views.h: the directions that every check looks at, and directions by angle.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A unit vector by its cosine with the normal and its azimuth. */
static inline void verify_direction(double cosine, double azimuth, double v[3])
{
    const double sine = __builtin_sqrt((1 - cosine)*(1 + cosine));
    v[0] = sine*__builtin_cos(azimuth);
    v[1] = sine*__builtin_sin(azimuth);
    v[2] = cosine;
}

/* The views of a subject, most of them above: normal incidence exactly, oblique and grazing ones, in several azimuths
 * unless the subject claims to be isotropic, and from below if it transmits. */
enum { VERIFY_MOST_VIEWS = 48 };
int verify_views(const verify_subject *s, double views[VERIFY_MOST_VIEWS][3]);

/* Pseudo-random numbers: 53 bits, uniform in [0, 1). */
typedef struct verify_random {
    uint64_t state;
} verify_random;
double verify_draw(verify_random *r);

#ifdef __cplusplus
}
#endif
