/* light_loops_text.h: the loops over points that triangles light, a part of loops_text.h.
 * SPDX-License-Identifier: MIT */

/* ---- One of few ---------------------------------------------------------------------------------------------- */

/* The triangle that is chosen for each point of a block. */
typedef struct light_choice {
    float weights[MOST_WEIGHED][BLOCK], sum[BLOCK];
    double left[BLOCK]; /* of the number that chooses */
    uint32_t is_open[BLOCK], which[BLOCK];
    float weight[BLOCK];
} light_choice;

static void weigh_by_surface(light_triangle given, light_receivers to, float *restrict weights)
{
    EACH_LANE(i) weights[i] = light_triangle_importance(given, receiver_at(to, i));
}

static void weigh_by_place(light_triangle given, vectors from, float *restrict weights)
{
    EACH_LANE(i)
    weights[i] = light_triangle_importance(given, receiver_anywhere(make3(from.x[i], from.y[i], from.z[i])));
}

static void weigh_sky(float strength, light_receivers to, bool has_receivers, float *restrict weights)
{
    if (has_receivers) EACH_LANE(i) weights[i] = strength*light_received_of_all(receiver_at(to, i));
    else EACH_LANE(i) weights[i] = strength*light_received_of_all(receiver_anywhere(splat3(0)));
}

static void weigh_lights(light_choice *b, uint32_t n_triangles, const light_triangle *triangles, light_receivers to,
                         bool has_receivers)
{
    EACH_LANE(i) b->sum[i] = 0;
    for (uint32_t k = 0; k < n_triangles; k++) {
        float *restrict const weights = b->weights[k];
        if (has_receivers) weigh_by_surface(triangles[k], to, weights);
        else weigh_by_place(triangles[k], to.position, weights);
        EACH_LANE(i) b->sum[i] += weights[i];
    }
}

/* In proportion to the weights of the triangles, in what is left after them that of the sky, to which the rest of its
 * numbers goes. */
static void draw_lights(light_choice *b, uint32_t n_triangles, bool has_sky, double *number)
{
    EACH_LANE(i)
    {
        b->left[i] = number[i]*(double)b->sum[i];
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
    if (!has_sky) return;
    const float *restrict const weights = b->weights[n_triangles];
    EACH_LANE(i)
    {
        const uint32_t takes = weights[i] > 0 ? b->is_open[i] : 0;
        const double rest = b->left[i]/(double)(weights[i] > 0 ? weights[i] : 1);
        b->which[i] = takes ? n_triangles : b->which[i];
        b->weight[i] = takes ? weights[i] : b->weight[i];
        number[i] = rest < 1 ? rest : 0;
    }
}

static void choose_light(uint32_t n_triangles, const light_triangle *triangles, float sky_strength, size_t n,
                         light_receivers to, bool has_receivers, light_choices c)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        const light_receivers from = receivers_from(to, first);
        light_choice b;
        weigh_lights(&b, n_triangles, triangles, from, has_receivers);
        if (sky_strength > 0) {
            weigh_sky(sky_strength, from, has_receivers, b.weights[n_triangles]);
            EACH_LANE(i) b.sum[i] += b.weights[n_triangles][i];
        }
        draw_lights(&b, n_triangles, sky_strength > 0, c.rest + first);
        EACH_LANE(i)
        {
            from.weight[i] = b.sum[i];
            c.which[first + i] = b.which[i];
            c.probability[first + i] = keep_if(b.sum[i] > 0, keep_if(b.sum[i] < INFINITY, b.weight[i]/b.sum[i]));
        }
    }
}

static void rate_light(uint32_t n_triangles, const light_triangle *triangles, float sky_strength, size_t n,
                       light_receivers to, bool has_receivers, light_choices c)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        const light_receivers from = receivers_from(to, first);
        float weights[BLOCK], found[BLOCK] = {0};
        for (uint32_t k = 0; k <= n_triangles; k++) {
            if (k == n_triangles && !(sky_strength > 0)) break;
            if (k == n_triangles) weigh_sky(sky_strength, from, has_receivers, weights);
            else if (has_receivers) weigh_by_surface(triangles[k], from, weights);
            else weigh_by_place(triangles[k], from.position, weights);
            EACH_LANE(i) found[i] = c.which[first + i] == k ? weights[i] : found[i];
        }
        EACH_LANE(i)
        {
            const float sum = from.weight[i];
            const int is_chosen = (c.probability[first + i] > 0) & (sum > 0) & (sum < INFINITY);
            c.probability[first + i] = keep_if(is_chosen, found[i]/sum);
        }
    }
}

/* ---- One of many --------------------------------------------------------------------------------------------- */

/* What is drawn at the top for each point of a block. */
typedef struct light_top {
    float weights[LIGHT_TREE_TOP][BLOCK];
    double sum[BLOCK], at[BLOCK], end[BLOCK], begin[BLOCK]; /* sum: the distant weight included */
    float weight[BLOCK];
    uint32_t which[BLOCK];
} light_top;

/* As light_tree_draw does; what is distant comes last. */
static void draw_top(const light_tree *tree, light_receivers to, const float *distant, const double *u, light_top *b)
{
    EACH_LANE(i) b->sum[i] = 0;
    for (uint32_t k = 0; k < tree->n_top; k++) {
        const light_node *node = &tree->nodes[k/LIGHT_NODE_WIDTH];
        float *restrict const weights = b->weights[k];
        EACH_LANE(i) weights[i] = light_child_weight(node, k%LIGHT_NODE_WIDTH, receiver_at(to, i));
        EACH_LANE(i) b->sum[i] += (double)weights[i];
    }
    EACH_LANE(i)
    {
        to.weight[i] = (float)b->sum[i];
        b->sum[i] += (double)distant[i];
        b->at[i] = u[i]*b->sum[i];
        b->end[i] = b->begin[i] = 0;
        b->weight[i] = 0;
        b->which[i] = 0;
    }
    for (uint32_t k = 0; k < tree->n_top; k++) {
        const float *restrict const weights = b->weights[k];
        EACH_LANE(i)
        {
            const int takes = (b->at[i] >= b->end[i]) & (weights[i] > 0);
            b->which[i] = takes ? k : b->which[i];
            b->weight[i] = takes ? weights[i] : b->weight[i];
            b->begin[i] = takes ? b->end[i] : b->begin[i];
            b->end[i] += (double)weights[i];
        }
    }
    EACH_LANE(i)
    {
        const int takes = (b->at[i] >= b->end[i]) & (distant[i] > 0);
        b->which[i] = takes ? LIGHT_DISTANT : b->which[i];
        b->weight[i] = takes ? distant[i] : b->weight[i];
        b->begin[i] = takes ? b->end[i] : b->begin[i];
    }
}

/* All points of a block go down the tree together, so that the processor has other points to weigh for while it waits
 * for one's node. */
static void walk_light_tree(const light_tree *tree, size_t n, light_receivers to, const float *distant, light_choices c)
{
    double *const u = c.rest;

    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t some = n - first < BLOCK ? n - first : BLOCK;
        size_t open[BLOCK], n_open = 0;
        uint32_t next[BLOCK] = {0};
        double product[BLOCK] = {0};
        light_top top;
        draw_top(tree, receivers_from(to, first), distant + first, u + first, &top);
        for (size_t i = 0; i < some; i++) {
            const double weight = (double)top.weight[i], rest = (top.at[i] - top.begin[i])/weight;
            next[i] = LIGHT_NODE_LEAF;
            product[i] = weight > 0 ? weight/top.sum[i] : 0;
            if (!(weight > 0)) continue;
            u[first + i] = rest < 1 ? rest : 0;
            if (top.which[i] == LIGHT_DISTANT) {
                next[i] = LIGHT_DISTANT;
                continue;
            }
            next[i] = tree->nodes[top.which[i]/LIGHT_NODE_WIDTH].child[top.which[i]%LIGHT_NODE_WIDTH];
            if (next[i] & LIGHT_NODE_LEAF) continue;
            expect_light_node(&tree->nodes[next[i]]);
            open[n_open++] = i;
        }
        while (n_open > 0) {
            size_t n_kept = 0;
            for (size_t j = 0; j < n_open; j++) {
                const size_t i = open[j], k = first + i;
                const light_receiver receiver = receiver_at(to, k);
                product[i] *= light_node_draw(&tree->nodes[next[i]], &receiver, &u[k], &next[i]);
                if (!(product[i] > 0) || next[i] & LIGHT_NODE_LEAF) continue;
                expect_light_node(&tree->nodes[next[i]]);
                open[n_kept++] = i;
            }
            n_open = n_kept;
        }
        for (size_t i = 0; i < some; i++) {
            c.which[first + i] = next[i] == LIGHT_DISTANT ? next[i] : next[i] & ~LIGHT_NODE_LEAF;
            c.probability[first + i] = (float)product[i];
        }
    }
}

static inline int is_of_tree(light_choices c, size_t i, uint32_t n_lights)
{
    return (c.probability[i] > 0) & (c.which[i] < n_lights);
}

static void rate_light_tree(const light_tree *tree, uint32_t n_lights, size_t n, light_receivers to, light_choices c)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t end = n - first < BLOCK ? n : first + BLOCK;
        for (size_t i = first; i < end; i++)
            if (is_of_tree(c, i, n_lights)) expect_light(tree, c.which[i]);
        for (size_t i = first; i < end; i++) {
            if (!is_of_tree(c, i, n_lights)) continue;
            const light_receiver at = receiver_at(to, i);
            c.probability[i] = light_tree_rate(tree, &at, c.which[i]);
        }
    }
}

/* ---- A point on it ------------------------------------------------------------------------------------------- */

/* What the points need of their triangles. */
typedef struct light_block {
    float origin[3][BLOCK], edge1[3][BLOCK], edge2[3][BLOCK], normal[3][BLOCK], radiance[3][BLOCK];
    float area[BLOCK], offset[BLOCK], lowest[BLOCK];
} light_block;

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

static inline void load_light(light_block *b, size_t i, const light_triangle *given)
{
    put3(b->origin, i, given->origin);
    put3(b->edge1, i, given->edge1);
    put3(b->edge2, i, given->edge2);
    put3(b->normal, i, given->normal);
    put3(b->radiance, i, given->radiance);
    b->area[i] = given->area;
    b->offset[i] = given->offset;
    b->lowest[i] = given->lowest;
}

/* Of which a vector holds all: to[i] = from[which[i]]. */
static void spread(const float from[PACKED], const uint32_t *which, float to[BLOCK])
{
    for (size_t i = 0; i < BLOCK; i += PACKED) pick(from, which + i, to + i);
}

static void spread3(float from[3][BLOCK], const uint32_t *which, float to[3][BLOCK])
{
    for (int k = 0; k < 3; k++) spread(from[k], which, to[k]);
}

/* The triangles of a block by their places in a list of no more than PACKED. */
static void spread_lights(light_block *few, const uint32_t *which, light_block *b)
{
    spread3(few->origin, which, b->origin);
    spread3(few->edge1, which, b->edge1);
    spread3(few->edge2, which, b->edge2);
    spread3(few->normal, which, b->normal);
    spread3(few->radiance, which, b->radiance);
    spread(few->area, which, b->area);
    spread(few->offset, which, b->offset);
    spread(few->lowest, which, b->lowest);
}

/* Points on a block's triangles. */
static void light_points(light_block *b, size_t first, const float *probability, vectors from, uint32_t *const u[3],
                         light_samples s)
{
    EACH_LANE(i)
    {
        const size_t k = first + i;
        const light_triangle e = {.origin = take3(b->origin, i),
                                  .edge1 = take3(b->edge1, i),
                                  .edge2 = take3(b->edge2, i),
                                  .normal = take3(b->normal, i),
                                  .area = b->area[i],
                                  .offset = b->offset[i],
                                  .lowest = b->lowest[i]};
        const real2 weights = light_triangle_weights(fraction(u[1][k]), fraction(u[2][k]));
        const light_triangle_point point = light_triangle_sample(e, make3(from.x[k], from.y[k], from.z[k]), weights);
        s.direction.x[k] = point.direction.x;
        s.direction.y[k] = point.direction.y;
        s.direction.z[k] = point.direction.z;
        s.target.x[k] = point.target.x;
        s.target.y[k] = point.target.y;
        s.target.z[k] = point.target.z;
        s.radiance.x[k] = b->radiance[0][i];
        s.radiance.y[k] = b->radiance[1][i];
        s.radiance.z[k] = b->radiance[2][i];
        s.pdf[k] = point.pdf*probability[k];
        s.is_infinite[k] = s.is_delta[k] = 0;
    }
}

static void light(uint32_t n_triangles, const light_triangle *triangles, size_t n, vectors from, light_choices c,
                  uint32_t *const u[3], light_samples s)
{
    light_block few, b;
    for (size_t i = 0; i < n_triangles && i < PACKED; i++) load_light(&few, i, &triangles[i]);
    for (size_t first = 0; first < n; first += BLOCK) {
        const uint32_t *which = c.which + first;
        if (n_triangles <= PACKED) spread_lights(&few, which, &b);
        else
            for (size_t i = 0; i < BLOCK; i++) load_light(&b, i, &triangles[which[i]]);
        light_points(&b, first, c.probability, from, u, s);
    }
}

static void light_any(const light_triangle *const *chosen, const float *probability, size_t n, vectors from,
                      uint32_t *const u[3], light_samples s)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        light_block b;
        for (size_t i = 0; i < BLOCK; i++) load_light(&b, i, chosen[first + i]);
        light_points(&b, first, probability, from, u, s);
    }
}
