/* light_loops_text.h: the loop over points that few triangles light, a part of loops_text.h.
 * SPDX-License-Identifier: MIT */

/* The triangle that is chosen for each point of a block. */
typedef struct light_block {
    float x[BLOCK], y[BLOCK], z[BLOCK]; /* the points */
    float weights[MOST_WEIGHED][BLOCK], sum[BLOCK];
    double left[BLOCK]; /* of the number that chooses */
    uint32_t is_open[BLOCK], which[BLOCK];
    float weight[BLOCK];
    float origin[3][BLOCK], edge1[3][BLOCK], edge2[3][BLOCK], normal[3][BLOCK], radiance[3][BLOCK];
    float area[BLOCK], offset[BLOCK], lowest[BLOCK];
} light_block;

static void weigh_lights(light_block *b, uint32_t n_triangles, const light_triangle *triangles)
{
    EACH_LANE(i) b->sum[i] = 0;
    for (uint32_t k = 0; k < n_triangles; k++) {
        const light_triangle given = triangles[k];
        float *restrict const weights = b->weights[k];
        EACH_LANE(i)
        {
            const float weight = light_triangle_importance(given, make3(b->x[i], b->y[i], b->z[i]));
            weights[i] = weight;
            b->sum[i] += weight;
        }
    }
}

/* As draw_weighted draws; u: 32-bit fractions. */
static void draw_lights(light_block *b, uint32_t n_triangles, const uint32_t *u)
{
    EACH_LANE(i)
    {
        const double number = ((double)(int32_t)(u[i] ^ SIGN_BIT) + 0x1p31)*0x1p-32;
        b->left[i] = number*(double)b->sum[i];
        b->is_open[i] = 1;
        b->which[i] = 0;
        b->weight[i] = 0;
    }
    for (uint32_t k = 0; k < n_triangles; k++) {
        const float *restrict const weights = b->weights[k];
        EACH_LANE(i)
        {
            const uint32_t takes = weights[i] > 0 ? b->is_open[i] : 0;
            b->which[i] = takes ? k : b->which[i];
            b->weight[i] = takes ? weights[i] : b->weight[i];
            b->is_open[i] = b->left[i] < (double)weights[i] ? 0 : b->is_open[i];
            b->left[i] -= (double)weights[i];
        }
    }
}

static inline void put3(float to[3][BLOCK], size_t i, real3 v)
{
    to[0][i] = v.x;
    to[1][i] = v.y;
    to[2][i] = v.z;
}

static inline real3 take3(float from[3][BLOCK], size_t i)
{
    return make3(from[0][i], from[1][i], from[2][i]);
}

/* Copies what the points need of the triangles. */
static void load_lights(light_block *b, const light_triangle *triangles)
{
    for (size_t i = 0; i < BLOCK; i++) {
        const light_triangle *chosen = &triangles[b->which[i]];
        put3(b->origin, i, chosen->origin);
        put3(b->edge1, i, chosen->edge1);
        put3(b->edge2, i, chosen->edge2);
        put3(b->normal, i, chosen->normal);
        put3(b->radiance, i, chosen->radiance);
        b->area[i] = chosen->area;
        b->offset[i] = chosen->offset;
        b->lowest[i] = chosen->lowest;
    }
}

static void light(uint32_t n_triangles, const light_triangle *triangles, size_t n, vectors from, uint32_t *const u[3],
                  light_samples s)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        light_block b;
        EACH_LANE(i)
        {
            b.x[i] = from.x[first + i];
            b.y[i] = from.y[first + i];
            b.z[i] = from.z[first + i];
        }
        weigh_lights(&b, n_triangles, triangles);
        draw_lights(&b, n_triangles, u[0] + first);
        load_lights(&b, triangles);
        EACH_LANE(i)
        {
            const size_t k = first + i;
            const light_triangle e = {.origin = take3(b.origin, i),
                                      .edge1 = take3(b.edge1, i),
                                      .edge2 = take3(b.edge2, i),
                                      .normal = take3(b.normal, i),
                                      .area = b.area[i],
                                      .offset = b.offset[i],
                                      .lowest = b.lowest[i]};
            const real2 weights = light_triangle_weights(fraction(u[1][k]), fraction(u[2][k]));
            const light_triangle_point point = light_triangle_sample(e, make3(b.x[i], b.y[i], b.z[i]), weights);
            s.direction.x[k] = point.direction.x;
            s.direction.y[k] = point.direction.y;
            s.direction.z[k] = point.direction.z;
            s.target.x[k] = point.target.x;
            s.target.y[k] = point.target.y;
            s.target.z[k] = point.target.z;
            s.radiance.x[k] = b.radiance[0][i];
            s.radiance.y[k] = b.radiance[1][i];
            s.radiance.z[k] = b.radiance[2][i];
            s.pdf[k] = keep_if(b.sum[i] > 0, keep_if(b.sum[i] < INFINITY, point.pdf*(b.weight[i]/b.sum[i])));
            s.is_infinite[k] = s.is_delta[k] = 0;
        }
    }
}
