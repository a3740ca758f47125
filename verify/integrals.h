/* integrals.h: integrals over normals and over directions that find lobes of any width.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A function of a direction; context: the caller's. */
typedef double (*sphere_function)(const void *context, const double v[3]);

/* Int g(m) dm over the hemisphere above. */
double over_normals(sphere_function g, const void *context, double tolerance);

/* Int g(wi) d omega_i over the hemisphere above, by way of the normals m that mirror wo (above) to wi: lobes are narrow
 * around the surface normal in m, and smooth in the logarithm of the angle. */
double over_mirrored(sphere_function g, const void *context, const double wo[3], double tolerance);

/* The same over the whole sphere of wi, around the axis that the light of a mirror would take: another way, for what is
 * known to be spread around it. */
double over_sphere(sphere_function g, const void *context, const double axis[3], double tolerance);

#ifdef __cplusplus
}
#endif
