/* surface_loops_text.h: the loops that find plain surfaces (surface.h) as surface.c does, a part of loops_text.h.
 * SPDX-License-Identifier: MIT */

/* A row of the instance's map times d; the last column moves points. */
static inline float row_of(plain_block *b, int row, size_t i, real3 d)
{
    return b->to_world[row][0][i]*d.x + b->to_world[row][1][i]*d.y + b->to_world[row][2][i]*d.z;
}

static inline real3 column_of(plain_block *b, int column, size_t i)
{
    return make3(b->to_world[0][column][i], b->to_world[1][column][i], b->to_world[2][column][i]);
}

static inline real3 edge_of(plain_block *b, real3 from, real3 to, size_t i)
{
    const real3 d = sub3(to, from), mapped = make3(row_of(b, 0, i, d), row_of(b, 1, i, d), row_of(b, 2, i, d));
    return scale3(1/kmax(max_abs3(mapped), REAL_MIN), mapped); /* no squares leave the range of numbers */
}

/* At the hit's point of a triangle. */
static inline real3 mix_corners(plain_block *b, float values[3][3][BLOCK], size_t i)
{
    const float w0 = 1 - b->u[i] - b->v[i], w1 = b->u[i], w2 = b->v[i];
    return add3(add3(scale3(w0, take3(values[0], i)), scale3(w1, take3(values[1], i))),
                scale3(w2, take3(values[2], i)));
}

static inline float blend(uint32_t mask, float a, float b)
{
    return real_of((bits_of(a) & mask) | (bits_of(b) & ~mask));
}

static inline void blend3(vector_array *to, size_t k, uint32_t mask, real3 value)
{
    to->x[k] = blend(mask, value.x, to->x[k]);
    to->y[k] = blend(mask, value.y, to->y[k]);
    to->z[k] = blend(mask, value.z, to->z[k]);
}

/* -v where the sign bit is given. */
static inline real3 turn3(real3 v, uint32_t sign)
{
    return make3(real_of(bits_of(v.x) ^ sign), real_of(bits_of(v.y) ^ sign), real_of(bits_of(v.z) ^ sign));
}

/* The true surface: its point, normal and offset.  Frames are turned to the viewer where nothing goes through. */
static void meet_triangles(vertex_list *v, size_t first, plain_block *b)
{
    EACH_LANE(i)
    {
        const size_t k = first + i;
        const uint32_t mask = b->is_there[i];
        const real3 p0 = take3(b->corners[0], i), p1 = take3(b->corners[1], i), p2 = take3(b->corners[2], i);
        const real3 local = mix_corners(b, b->corners, i);
        const real3 mapped = make3(row_of(b, 0, i, local), row_of(b, 1, i, local), row_of(b, 2, i, local));
        const real3 position = add3(mapped, column_of(b, 3, i));
        const real3 cross = cross3(edge_of(b, p0, p1, i), edge_of(b, p0, p2, i));
        const float length2 = dot3(cross, cross);
        const real3 scaled = scale3(b->sign[i]/ksqrt(kmax(length2, REAL_MIN)), cross);
        const real3 normal = make3(scaled.x, scaled.y, scaled.z + keep_if(length2 == 0, b->sign[i])); /* no area */
        const float facing = dot3(normal, lane3(&v->wi, k));
        const float extent = kmax(max_abs3(p0), kmax(max_abs3(p1), max_abs3(p2)));
        const float largest = kmax(max_abs3(position), kmax(b->column[i]*extent, b->offset[i]));
        blend3(&v->position, k, mask, position);
        blend3(&v->normal, k, mask, normal);
        v->offset[k] = blend(mask, RELATIVE_OFFSET*largest, v->offset[k]);
        v->facing[k] = blend(mask, facing, v->facing[k]);
        put3(b->up, i, turn3(normal, bits_of(facing) & SIGN_BIT & ~v->transmits[k]));
    }
}

/* Interpolated normals, as usable_normal of surface.c has them. */
static void meet_normals(vertex_list *v, size_t first, plain_block *b)
{
    EACH_LANE(i)
    {
        const size_t k = first + i;
        const real3 given = mix_corners(b, b->normals, i);
        const real3 x = column_of(b, 0, i), y = column_of(b, 1, i), z = column_of(b, 2, i);
        const real3 mapped = add3(add3(scale3(given.x, cross3(y, z)), scale3(given.y, cross3(z, x))),
                                  scale3(given.z, cross3(x, y)));
        const float length2 = dot3(mapped, mapped);
        const real3 g = take3(b->up, i), wo = lane3(&v->wi, k);
        const real3 smooth = scale3(b->sign[i]/ksqrt(kmax(length2, REAL_MIN)), mapped);
        /* What reflects has its normal on the viewer's side; what transmits, where the mesh says. */
        const uint32_t turn = bits_of(dot3(smooth, g)) & SIGN_BIT & ~v->transmits[k];
        const real3 n = turn3(smooth, turn);
        const float lack = least_mirror_cosine(dot3(wo, g)) - mirror_cosine(n, g, wo);
        const uint32_t mask = b->is_there[i] & b->is_smooth[i] & (0 - (uint32_t)(length2 > 0));
        b->is_bent[i] = lack > 0 ? mask & ~v->transmits[k] : 0;
        put3(b->up, i, make3(blend(mask, n.x, g.x), blend(mask, n.y, g.y), blend(mask, n.z, g.z)));
    }
    for (size_t i = 0; i < BLOCK; i++)
        if (b->is_bent[i]) {
            const real3 normal = lane3(&v->normal, first + i), wo = lane3(&v->wi, first + i);
            const real3 g = turn3(normal, bits_of(v->facing[first + i]) & SIGN_BIT);
            put3(b->up, i, surface_bend_normal(take3(b->up, i), g, wo));
        }
}

/* frame_of_normal, and wo in it. */
static void meet_frames(vertex_list *v, size_t first, plain_block *b)
{
    EACH_LANE(i)
    {
        const size_t k = first + i;
        const uint32_t mask = b->is_there[i];
        const real3 n = take3(b->up, i), wo = lane3(&v->wi, k);
        const float sign = kcopysign(1, n.z), a = -1/(sign + n.z), c = n.x*n.y*a;
        const real3 t = make3(1 + sign*n.x*n.x*a, sign*c, -sign*n.x),
                    s = make3(c, sign + n.y*n.y*a, -n.y);
        blend3(&v->t, k, mask, t);
        blend3(&v->b, k, mask, s);
        blend3(&v->up, k, mask, n);
        blend3(&v->wo, k, mask, make3(dot3(wo, t), dot3(wo, s), dot3(wo, n)));
        b->is_there[i] = 0;
    }
}

static void meet(vertex_list *v, size_t first, plain_block *b)
{
    meet_triangles(v, first, b);
    if (b->has_smooth) meet_normals(v, first, b);
    meet_frames(v, first, b);
    b->has_smooth = false;
}
