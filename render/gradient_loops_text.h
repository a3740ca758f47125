/* gradient_loops_text.h: the loops over neighbouring pixels (stage_gradients.c), a part of loops_text.h.
 * SPDX-License-Identifier: MIT */

typedef struct read_vectors {
    const float *x, *y, *z;
} read_vectors;

/* Those of the pixels a step before. */
static inline read_vectors before(const framed_array *a, ptrdiff_t step)
{
    const read_vectors v = {a->x + MARGIN - step, a->y + MARGIN - step, a->z + MARGIN - step};
    return v;
}

static inline real3 at3(read_vectors v, size_t k)
{
    return make3(v.x[k], v.y[k], v.z[k]);
}

/* The second vertices as lights of radiance 1: no more than aim and connect ask of one. */
static void reach(vertex_list *v, gradient_list *g, const sight_list *to)
{
    const ptrdiff_t step = to->step;
    const uint32_t *is_beside = to->is_beside;
    const read_vectors position = before(&g->position, step), target = before(&g->target, step),
                       normals = before(&g->normal, step), shading = before(&g->shading, step),
                       own = before(&g->own, step);
    const float *density = g->density + MARGIN - step;
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real3 d = sub3(at3(position, k), lane3(&v->position, k));
            const float d2 = dot3(d, d);
            const real3 direction = scale3(1/ksqrt(kmax(d2, REAL_MIN)), d), wo = neg3(direction);
            const real3 normal = at3(normals, k);
            const float cos = dot3(normal, wo);
            const float lack = least_mirror_cosine(cos) - mirror_cosine(at3(shading, k), normal, wo);
            const int is_shared = (is_beside[k] != 0) & (density[k] > 0) & (max_of3(at3(own, k)) > 0);
            v->light.pdf[k] = keep_if(is_shared & (cos > 0) & (lack <= 0), 1);
            put_lane3(&v->light.direction, k, direction);
            put_lane3(&v->light.target, k, at3(target, k));
            v->light.radiance.x[k] = v->light.radiance.y[k] = v->light.radiance.z[k] = 1;
            v->light.is_infinite[k] = v->light.is_delta[k] = 0;
            g->distance2[k] = d2;
            g->cosine[k] = cos;
        }
}

/* One channel: (own a_q + seen f/throughput)/(a_p + a_q). */
static inline float passed_on(float own, float seen, float throughput, float f, float density, float other)
{
    const float m = (own*other + seen*(f/throughput))/(density + other);
    return keep_if((f > 0) & (throughput > 0) & (m < MOST_PASSED), m); /* nor what is not a number */
}

static void rate_seconds(const vertex_list *v, const gradient_list *g, sight_list *to)
{
    const ptrdiff_t step = to->step;
    const read_vectors own = before(&g->own, step), seen = before(&g->seen, step),
                       weight = before(&g->throughput, step);
    const vectors worth = frame_of(&to->worth);
    const float *densities = g->density + MARGIN - step;
    const uint32_t *is_open = to->is_open + MARGIN;
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const float cos = keep_if(is_open[k] != 0, g->cosine[k]), other = v->pdf[k]*cos;
            const float density = densities[k]*g->distance2[k];
            const real3 f = scale3(cos, lane3(&v->f, k));
            worth.x[k] = passed_on(own.x[k], seen.x[k], weight.x[k], f.x, density, other);
            worth.y[k] = passed_on(own.y[k], seen.y[k], weight.y[k], f.y, density, other);
            worth.z[k] = passed_on(own.z[k], seen.z[k], weight.z[k], f.z, density, other);
        }
}

/* One channel: C C'/(C + C'). */
static inline float lamp_passed_on(float own, float seen)
{
    return keep_if((own > 0) & (seen > 0) & (seen < MOST_PASSED), own*(seen/(own + seen)));
}

static void take_lamps(vertex_list *v, const gradient_list *g, const sight_list *to)
{
    const ptrdiff_t step = to->step;
    const uint32_t *is_beside = to->is_beside, *lamp = g->lamp + MARGIN - step, *x = g->lamp_u[0] + MARGIN - step,
                   *y = g->lamp_u[1] + MARGIN - step;
    const float *probability = g->lamp_probability + MARGIN - step;
    const double *rest = g->lamp_rest + MARGIN - step;
    for (size_t first = 0; first < v->n; first += BLOCK) {
        EACH_LANE(i)
        {
            const size_t k = first + i;
            v->light.which[k] = is_beside[k] ? lamp[k] : 0;
            v->light.probability[k] = keep_if(is_beside[k] != 0, probability[k]);
            v->u[1][k] = x[k];
            v->u[2][k] = y[k];
        }
        EACH_LANE(i) v->light.rest[first + i] = rest[first + i];
    }
}

static void rate_lamps(const vertex_list *v, const gradient_list *g, sight_list *to)
{
    const ptrdiff_t step = to->step;
    const read_vectors own = before(&g->brought, step);
    const vectors worth = frame_of(&to->worth);
    const float *probabilities = g->lamp_probability + MARGIN - step;
    const uint32_t *is_beside = to->is_beside;
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const float probability = keep_if(is_beside[k] != 0, probabilities[k]);
            const float ratio = keep_if(probability > 0, v->light.probability[k]/probability);
            worth.x[k] = lamp_passed_on(own.x[k], ratio*v->f.x[k]);
            worth.y[k] = lamp_passed_on(own.y[k], ratio*v->f.y[k]);
            worth.z[k] = lamp_passed_on(own.z[k], ratio*v->f.z[k]);
        }
}

static bool drop_dark(gradient_list *g, vector_array *far)
{
    uint32_t is_any[BLOCK] = {0}, is_left = 0;
    float *density = g->density + MARGIN;
    for (size_t first = 0; first < PATHS; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real3 a = lane3(&g->near, k), b = lane3(far, k), light = add3(a, b), apart = lane3(&g->apart, k);
            const int holds = is_held(light), is_shared = holds & (max_of3(light) > 0) & (density[k] > 0);
            put_lane3(&g->apart, k,
                      make3(apart.x + keep_if(!holds, light.x), apart.y + keep_if(!holds, light.y),
                            apart.z + keep_if(!holds, light.z)));
            put_lane3(&g->near, k, make3(keep_if(holds, a.x), keep_if(holds, a.y), keep_if(holds, a.z)));
            put_lane3(far, k, make3(keep_if(holds, b.x), keep_if(holds, b.y), keep_if(holds, b.z)));
            density[k] = keep_if(is_shared, density[k]);
            is_any[i] |= (uint32_t)is_shared;
        }
    for (int i = 0; i < BLOCK; i++) is_left |= is_any[i];
    return is_left;
}

static void gather(const gradient_list *g, vector_array *light)
{
    for (size_t first = 0; first < PATHS; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            put_lane3(light, k, add3(lane3(light, k), add3(lane3(&g->near, k), lane3(&g->apart, k))));
        }
}

static void look_back(vertex_list *v, const vertex_list *neighbours, ptrdiff_t step)
{
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i, j = (v->slot[k] + (uint32_t)step)%PATHS; /* any where there is none */
            const real3 d = sub3(lane3(&neighbours->position, j), lane3(&v->position, k));
            const real3 wo = lane_to_local(v, k, scale3(1/ksqrt(kmax(dot3(d, d), REAL_MIN)), d));
            put_lane3(&v->wo, k, wo);
        }
}

/* 0 beyond MOST_CONTRAST either way. */
static inline float contrast_of(float f, float own)
{
    const float ratio = f/own;
    return keep_if((ratio <= MOST_CONTRAST) & (ratio >= 1/MOST_CONTRAST), ratio);
}

static void contrast(const vertex_list *v, const vector_array *own_f, const vector_array *light, gradient_list *g)
{
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const float red = contrast_of(v->f.x[k], own_f->x[k]), green = contrast_of(v->f.y[k], own_f->y[k]),
                        blue = contrast_of(v->f.z[k], own_f->z[k]);
            const real3 part = lane3(light, k);
            const real3 shared = make3(keep_if(red > 0, part.x), keep_if(green > 0, part.y), keep_if(blue > 0, part.z));
            put_lane3(&g->own_light, k, add3(lane3(&g->own_light, k), shared));
            put_lane3(&g->seen_light, k, add3(lane3(&g->seen_light, k), mul3(make3(red, green, blue), part)));
        }
}

/* Of n pixels: what each is passed by the one a step before, less what it passes on to the next, both weighted. */
static void give(gradient_list *g, size_t n, const sight_list *from, bool is_of_lamps)
{
    const ptrdiff_t step = from->step;
    const uint32_t asks = is_of_lamps ? ~0u : 0;
    const uint32_t *is_open = from->is_open + MARGIN, *is_lit = g->is_lit + MARGIN - step;
    const read_vectors worth = before(&from->worth, 0);
    float *const passed_on[3] = {g->passed[0] + MARGIN, g->passed[1] + MARGIN, g->passed[2] + MARGIN};
    for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const float lit = (float)(int32_t)(is_open[k] + (is_lit[k] & asks)); /* V_q, or V_p + V_q */
            passed_on[0][k] = lit*worth.x[k];
            passed_on[1][k] = lit*worth.y[k];
            passed_on[2][k] = lit*worth.z[k];
        }
    const float *weights = MARGIN + (step == 1 || step == -1 ? g->right : g->below);
    const float *before = weights + (step > 0 ? -step : 0), *after = weights + (step > 0 ? 0 : step);
    for (int c = 0; c < 3; c++) {
        const float *passed = g->passed[c] + MARGIN, *passed_next = passed + step;
        float *given = g->given[c] + MARGIN;
        for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
            {
                const size_t k = first + i;
                given[k] += before[k]*passed[k] - after[k]*passed_next[k];
            }
    }
}

/* How much is made of the difference of two pixels. */
static inline float alikeness(real3 a, real3 b)
{
    const float cos = kmax(dot3(a, b), 0);
    return keep_if(dot3(a, a)*dot3(b, b) > 0.5f, (cos*cos + LEAST_ALIKENESS)/LIGHT_WEIGHT);
}

static void liken(gradient_list *g, size_t width, size_t height)
{
    float *right = g->right + MARGIN, *below = g->below + MARGIN;
    const float *self = g->self + MARGIN;
    const float *x = g->up[0], *y = g->up[1], *z = g->up[2];
    for (size_t first = 0; first < width*height; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i, r = k + 1, b = k + width;
            const real3 up = make3(x[k], y[k], z[k]);
            right[k] = kmin(self[k], self[r])*alikeness(up, make3(x[r], y[r], z[r]));
            below[k] = kmin(self[k], self[b])*alikeness(up, make3(x[b], y[b], z[b]));
        }
    for (size_t row = 1; row <= height; row++) right[row*width - 1] = 0;
}

/* Y. Saad, Iterative Methods for Sparse Linear Systems, 2003, algorithm 12.1: Chebyshev acceleration, of Jacobi's
 * iteration.  A fixed linear map of what is left, whose mean is 0: so is that of what is found, after any number of
 * steps. */
static void approach(gradient_list *g, size_t n, ptrdiff_t width, float *rest)
{
    const float *right = g->right + MARGIN, *below = g->below + MARGIN, *scale = g->scale + MARGIN,
                *self = g->self + MARGIN;
    float *step = g->step + MARGIN, *found = g->found + MARGIN;
    const float *left = right - 1, *above = below - width;
    const float *step_right = step + 1, *step_left = step - 1, *step_below = step + width, *step_above = step - width;
    const float middle = 0.5f*(MOST_EIGENVALUE + LEAST_EIGENVALUE),
                half = 0.5f*(MOST_EIGENVALUE - LEAST_EIGENVALUE);
    float ratio = half/middle, forth = 1/middle, on = 0;
    for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i) step[first + i] = found[first + i] = 0;
    for (int times = 0; times < GRADIENT_STEPS; times++) {
        for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
            {
                const size_t k = first + i;
                step[k] = on*step[k] + forth*scale[k]*rest[k];
                found[k] += step[k];
            }
        for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
            {
                const size_t k = first + i;
                const float s = step[k];
                rest[k] -= self[k]*s + (right[k]*(s - step_right[k]) + left[k]*(s - step_left[k])) +
                           (below[k]*(s - step_below[k]) + above[k]*(s - step_above[k]));
            }
        const float next = 1/(2*middle/half - ratio);
        on = next*ratio;
        forth = 2*next/half;
        ratio = next;
    }
}

static void fit(gradient_list *g, size_t width, size_t height, vector_array *light)
{
    const size_t n = width*height;
    const float *right = g->right + MARGIN, *left = right - 1, *below = g->below + MARGIN, *above = below - width;
    const float *found = g->found + MARGIN, *self = g->self + MARGIN;
    float *scale = g->scale + MARGIN, *const channels[] = {light->x, light->y, light->z};
    for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            scale[k] = 1/(self[k] + (right[k] + left[k]) + (below[k] + above[k]));
        }
    for (int c = 0; c < 3; c++) {
        float *channel = channels[c];
        approach(g, n, (ptrdiff_t)width, g->given[c] + MARGIN);
        for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i) channel[first + i] += found[first + i];
    }
}
