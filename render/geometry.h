/* geometry.h: vectors, affine maps and frames of the renderer, in float; directions and points are real3.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <math.h>

#define FACET_REAL_IS_DOUBLE 0
#include "core/kernel/kmath.h"
#include "core/kernel/real.h"

static inline real3 vector_of(const float v[3])
{
    return make3(v[0], v[1], v[2]);
}

/* M (p,1) and M (d,0) of a 3x4 map. */
static inline real3 map_point(const float m[3][4], real3 p)
{
    return make3(m[0][0]*p.x + m[0][1]*p.y + m[0][2]*p.z + m[0][3],
                 m[1][0]*p.x + m[1][1]*p.y + m[1][2]*p.z + m[1][3],
                 m[2][0]*p.x + m[2][1]*p.y + m[2][2]*p.z + m[2][3]);
}

static inline real3 map_vector(const float m[3][4], real3 d)
{
    return make3(m[0][0]*d.x + m[0][1]*d.y + m[0][2]*d.z, m[1][0]*d.x + m[1][1]*d.y + m[1][2]*d.z,
                 m[2][0]*d.x + m[2][1]*d.y + m[2][2]*d.z);
}

static inline real3 map_column(const float m[3][4], int column)
{
    return make3(m[0][column], m[1][column], m[2][column]);
}

static inline float map_determinant(const float m[3][4])
{
    return dot3(map_column(m, 0), cross3(map_column(m, 1), map_column(m, 2)));
}

/* A normal under the map: the cofactor matrix times n, turned to the side that the map puts the front on.  Not
 * of unit length. */
static inline real3 map_normal(const float m[3][4], float sign_of_determinant, real3 n)
{
    const real3 a = map_column(m, 0), b = map_column(m, 1), c = map_column(m, 2);
    const real3 bc = cross3(b, c), ca = cross3(c, a), ab = cross3(a, b);
    return scale3(sign_of_determinant, add3(add3(scale3(n.x, bc), scale3(n.y, ca)), scale3(n.z, ab)));
}

/* An orthonormal frame; to_local takes world directions into it. */
typedef struct frame {
    real3 t, b, n;
} frame;

static inline real3 to_local(const frame *f, real3 d)
{
    return make3(dot3(d, f->t), dot3(d, f->b), dot3(d, f->n));
}

static inline real3 to_world(const frame *f, real3 d)
{
    return add3(add3(scale3(d.x, f->t), scale3(d.y, f->b)), scale3(d.z, f->n));
}

/* A frame with normal n.  Duff et al., Building an orthonormal basis, revisited, JCGT 2017. */
static inline frame frame_of_normal(real3 n)
{
    const float sign = n.z < 0 ? -1.0f : 1.0f, a = -1/(sign + n.z), b = n.x*n.y*a;
    return (frame){
        .t = make3(1 + sign*n.x*n.x*a, sign*b, -sign*n.x), .b = make3(b, sign + n.y*n.y*a, -n.y), .n = n};
}

/* The frame with normal n and its tangent as near to `tangent` as can be (any tangent if that is 0 or
 * parallel to n).  handedness: sign of b relative to n x t. */
static inline frame frame_around(real3 n, real3 tangent, float handedness)
{
    const real3 t = sub3(tangent, scale3(dot3(tangent, n), n));
    if (!(dot3(t, t) > 1e-12f*dot3(tangent, tangent))) return frame_of_normal(n);
    const real3 unit = normalize3(t);
    return (frame){.t = unit, .b = scale3(handedness, cross3(n, unit)), .n = n};
}

static inline real3 min3(real3 a, real3 b)
{
    return make3(kmin(a.x, b.x), kmin(a.y, b.y), kmin(a.z, b.z));
}

static inline real3 max3(real3 a, real3 b)
{
    return make3(kmax(a.x, b.x), kmax(a.y, b.y), kmax(a.z, b.z));
}

/* The largest of |x|, |y|, |z|. */
static inline float max_abs3(real3 v)
{
    return kmax(kabs(v.x), kmax(kabs(v.y), kabs(v.z)));
}

/* The unit normal of a triangle with these edges, counter-clockwise seen from the front.  (0,0,1) for a triangle
 * without area.  Where squares of squares of lengths would leave the range of numbers, the edges are scaled first. */
static inline real3 normal_of_edges(real3 e1, real3 e2)
{
    const real3 cross = cross3(e1, e2);
    const float length2 = dot3(cross, cross);
    if (length2 > 1e-24f && length2 < 1e24f) return scale3(1/ksqrt(length2), cross);
    const float a = max_abs3(e1), b = max_abs3(e2);
    return normalize3(cross3(scale3(a > 0 ? 1/a : 0.0f, e1), scale3(b > 0 ? 1/b : 0.0f, e2)));
}

static inline float luminance(real3 c)
{
    return 0.2126f*c.x + 0.7152f*c.y + 0.0722f*c.z;
}
