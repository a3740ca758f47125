/* surface_loops_text.h: the loop that finds plain surfaces (surface.h), a part of loops_text.h; as find_on_triangle does.
 * SPDX-License-Identifier: MIT */

/* The corner's components times the map's row; the last column moves points. */
static inline float row_of(plain_block *b, int row, size_t i, real3 d)
{
    return b->to_world[row][0][i]*d.x + b->to_world[row][1][i]*d.y + b->to_world[row][2][i]*d.z;
}

static inline real3 corner_of(plain_block *b, int corner, size_t i)
{
    return make3(b->corners[corner][0][i], b->corners[corner][1][i], b->corners[corner][2][i]);
}

static inline real3 edge_of(plain_block *b, real3 from, real3 to, size_t i)
{
    const real3 d = sub3(to, from), mapped = make3(row_of(b, 0, i, d), row_of(b, 1, i, d), row_of(b, 2, i, d));
    return scale3(1/kmax(max_abs3(mapped), REAL_MIN), mapped); /* no squares leave the range of numbers */
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

static inline float flip(float x, uint32_t sign)
{
    return real_of(bits_of(x) ^ sign);
}

static void meet(vertex_list *v, size_t first, plain_block *b)
{
    EACH_LANE(i)
    {
        const size_t k = first + i;
        const uint32_t mask = b->is_there[i];
        const real3 p0 = corner_of(b, 0, i), p1 = corner_of(b, 1, i), p2 = corner_of(b, 2, i);
        const float w0 = 1 - b->u[i] - b->v[i];
        const real3 local = add3(add3(scale3(w0, p0), scale3(b->u[i], p1)), scale3(b->v[i], p2));
        const real3 position =
            make3(row_of(b, 0, i, local) + b->to_world[0][3][i], row_of(b, 1, i, local) + b->to_world[1][3][i],
                  row_of(b, 2, i, local) + b->to_world[2][3][i]);
        const real3 cross = cross3(edge_of(b, p0, p1, i), edge_of(b, p0, p2, i));
        const float length2 = dot3(cross, cross);
        const real3 scaled = scale3(b->sign[i]/ksqrt(kmax(length2, REAL_MIN)), cross);
        const real3 normal = make3(scaled.x, scaled.y, scaled.z + keep_if(length2 == 0, 1)); /* without area */
        const real3 wo = lane3(&v->wi, k);
        const float facing = dot3(normal, wo);
        const float extent = kmax(max_abs3(p0), kmax(max_abs3(p1), max_abs3(p2)));
        const float largest = kmax(max_abs3(position), kmax(b->column[i]*extent, b->offset[i]));
        /* The frame, turned to the viewer where nothing goes through. */
        const uint32_t turn = bits_of(facing) & SIGN_BIT & ~v->transmits[k];
        const real3 up = make3(flip(normal.x, turn), flip(normal.y, turn), flip(normal.z, turn));
        const float sign = kcopysign(1, up.z), a = -1/(sign + up.z), c = up.x*up.y*a;
        const real3 t = make3(1 + sign*up.x*up.x*a, sign*c, -sign*up.x), s = make3(c, sign + up.y*up.y*a, -up.y);
        blend3(&v->position, k, mask, position);
        blend3(&v->normal, k, mask, normal);
        v->offset[k] = blend(mask, RELATIVE_OFFSET*largest, v->offset[k]);
        v->facing[k] = blend(mask, facing, v->facing[k]);
        blend3(&v->t, k, mask, t);
        blend3(&v->b, k, mask, s);
        blend3(&v->up, k, mask, up);
        blend3(&v->wo, k, mask, make3(dot3(wo, t), dot3(wo, s), dot3(wo, up)));
        b->is_there[i] = 0;
    }
}
