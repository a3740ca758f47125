/* light_triangle.h: triangles that emit the same radiance everywhere: how they are chosen, and points on them, for one
 * point that is lit and for loops over many.
 *
 * [shirley96] Shirley, Wang and Zimmerman, Monte Carlo techniques for direct lighting calculations, 1996.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "render/geometry.h"
#include "render/light_receiver.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Up to this many emitters are weighed one by one for each point that is lit; a tree leads to one of more. */
#define MOST_WEIGHED 32

/* Up to this many are chosen without regard to the surface: the two of a quad look alike from anywhere. */
#define MOST_ALIKE 2

typedef struct light_triangle {
    real3 origin, edge1, edge2; /* world space */
    real3 center;               /* of its corners */
    real3 normal;               /* unit, on the front side */
    real3 radiance;             /* [W/(m^2 sr)] */
    float area;                 /* [m^2] */
    float offset;               /* how far shadow rays stop from the surface [m] */
    float lowest;               /* it shines on points above this height: 0, -INFINITY if it is double-sided */
    float strength;             /* mean radiance, luminance */
    float radius;               /* of a sphere around the centre [m] */
} light_triangle;

/* About what is taken up of its light at a point: what it is chosen by.  0 only where that is nothing. */
static inline float light_triangle_importance(light_triangle e, light_receiver to)
{
    const real3 away = sub3(to.position, e.center);
    const float d2 = kmax(dot3(away, away), REAL_MIN), height = dot3(away, e.normal), d = ksqrt(d2);
    /* The area in the denominator bounds the weight near the light; a tenth more cosine, its range. */
    const float irradiance = e.strength*e.area*(0.1f*d + kabs(height))/(d*(d2 + e.area));
    return keep_if(height > e.lowest, irradiance*light_received(to, away, d, e.radius));
}

/* Density of a direction to a point of an area sampled uniformly: d^2/(|cos| area). */
static inline float area_pdf(real3 to_point, real3 normal, float area)
{
    const float d2 = dot3(to_point, to_point), d = ksqrt(kmax(d2, REAL_MIN));
    const float cos_area = kabs(dot3(to_point, normal))/d*area;
    return keep_if(cos_area > 0, d2/cos_area);
}

typedef struct light_triangle_point {
    real3 direction, target; /* lights.h */
    float pdf;               /* [1/sr], of this triangle's points alone; 0: it does not shine on `from` */
} light_triangle_point;

/* The weights of the second and third corner of a uniform point: [shirley96], the square folded onto the triangle by a
 * square root. */
static inline real2 light_triangle_weights(float u, float v)
{
    const float root = ksqrt(u);
    return make2(1 - root, v*root);
}

static inline light_triangle_point light_triangle_sample(light_triangle e, real3 from, real2 weights)
{
    const real3 point = madd3(madd3(e.origin, weights.x, e.edge1), weights.y, e.edge2), to_point = sub3(point, from);
    const float height = -dot3(to_point, e.normal), d2 = dot3(to_point, to_point);
    light_triangle_point at;
    at.direction = scale3(1/ksqrt(kmax(d2, REAL_MIN)), to_point);
    at.target = madd3(point, kcopysign(e.offset, height), e.normal);
    at.pdf = keep_if(height > e.lowest, keep_if(d2 > REAL_MIN, area_pdf(to_point, e.normal, e.area)));
    return at;
}

#ifdef __cplusplus
}
#endif
