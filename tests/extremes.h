/* extremes.h: distributions of normals at the ends of their ranges.
 *
 * Roughness 1e-4 and 1 (phong: 1e-3 and 1), 10:1 in either, gamma from .05 to 20 with both sides of 1.
 * SPDX-License-Identifier: MIT */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/* A material, and the stretch of its slopes: divided by these they are isotropic. */
typedef struct extreme {
    char spec[100];
    double x, y, gamma; /* gamma 0: not gtr */
} extreme;

enum { EXTREME_GAMMAS = 7, EXTREME_ROUGHNESSES = 4, N_EXTREMES = EXTREME_ROUGHNESSES*(3 + EXTREME_GAMMAS) };

extreme extreme_shape(int i);

#ifdef __cplusplus
}
#endif
