/* light_receiver.h: a point that is lit, and how its surface takes light up: what lights are chosen by.
 *
 * The surface is asked for its density of scattering in two directions alone, so that any material will do: towards the
 * mirror image of wo, and far from it.  What the second leaves of the first is a lobe like GGX's around the mirror
 * image.  A choice of lights needs no more; no estimate depends on it but by its noise.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/geometry.h"
#include "render/rays.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The density with which light from a direction w is taken up, about
 *     around + broad max(w.normal, 0) + peak/(1 + tan^2(theta/2)/width)^2,    theta from the mirror image,
 * on the side of the normal, if there is one. */
typedef struct light_receiver {
    real3 position;
    real3 normal, mirror; /* unit; both 0: light is taken up from all around alike */
    float around, broad, peak, width;
    float weight; /* sum of what lights with a place, or all of few, are chosen by here; 0: not yet known */
} light_receiver;

/* The least of `around`: what a light has where the surface seems to take up nothing. */
#define RECEIVED_AROUND 0.02f

/* The same for many points; all but the positions are of use to those who say so (lights.h). */
typedef struct light_receivers {
    vectors position, normal, mirror;
    float *around, *broad, *peak, *width, *weight;
} light_receivers;

static inline light_receiver receiver_anywhere(real3 position)
{
    const real3 none = splat3(0);
    const light_receiver to = {position, none, none, 1, 0, 0, 1, 0};
    return to;
}

static inline real3 position_at(light_receivers many, size_t i)
{
    return make3(many.position.x[i], many.position.y[i], many.position.z[i]);
}

static inline light_receiver receiver_at(light_receivers many, size_t i)
{
    const real3 normal = make3(many.normal.x[i], many.normal.y[i], many.normal.z[i]);
    const real3 mirror = make3(many.mirror.x[i], many.mirror.y[i], many.mirror.z[i]);
    const light_receiver to = {position_at(many, i), normal,       mirror,        many.around[i],
                               many.broad[i],        many.peak[i], many.width[i], many.weight[i]};
    return to;
}

static inline light_receivers receivers_from(light_receivers many, size_t first)
{
    const light_receivers rest = {vectors_from(many.position, first),
                                  vectors_from(many.normal, first),
                                  vectors_from(many.mirror, first),
                                  many.around + first,
                                  many.broad + first,
                                  many.peak + first,
                                  many.width + first,
                                  many.weight + first};
    return rest;
}

/* Rounding may take a cosine this far down, and no further. */
#define LIGHT_COSINE_ERROR 1e-5f

/* The share that is taken up of light from within a sphere; away: from its centre to the point, d > 0 long.  What
 * counts is its highest point above the horizon, and a lobe that is wider by how wide the sphere looks.  0 only below
 * the horizon. */
static inline float light_received(light_receiver at, real3 away, float d, float radius)
{
    const float inverse = 1/d, reach = radius - dot3(away, at.normal);
    const float size = kmin(radius*inverse, 1), width = at.width + 0.25f*size*size;
    const float near = 1 - dot3(away, at.mirror)*inverse; /* 1 + cos of the angle to the mirror image */
    const float lobe = near/(width*near + kmax(2 - near, 0));
    const float taken = at.around + at.broad*kmin(kmax(reach, 0)/(d + radius), 1) +
                        at.peak*at.width*width*lobe*lobe;
    return keep_if(reach >= -LIGHT_COSINE_ERROR*d, taken);
}

/* ... of light from all around. */
static inline float light_received_of_all(light_receiver at)
{
    return PI*(at.around + at.broad + 4*at.width*at.peak);
}

#ifdef __cplusplus
}
#endif
