/* light_tree_build.c: building the tree of lights from the top down.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "render/light_tree.h"

enum { WIDTH = LIGHT_NODE_WIDTH, BINS = 16 };

/* From this level on ranges are halved whatever the cost: a bound on the depth. */
#define MOST_LEVELS_BY_COST 24

typedef struct builder {
    const placed_light *lights;
    light_tree *tree;
    uint32_t *order; /* lights; a range of it is a subtree */
    uint32_t room;   /* nodes allocated */
} builder;

typedef struct range {
    uint32_t begin, end;
    float cost;
} range;

/* What the cost of a group of lights needs. */
typedef struct group {
    uint32_t n;
    real3 low, high;
    real3 axes; /* sum of the axes, by intensity */
    float intensity;
} group;

static bool has_axis(const placed_light *light)
{
    return max_abs3(light->axis) > 0;
}

static real3 middle(real3 low, real3 high)
{
    return add3(scale3(0.5f, low), scale3(0.5f, high));
}

static group empty_group(void)
{
    return (group){.low = splat3(INFINITY), .high = splat3(-INFINITY)};
}

static group join(group a, group b)
{
    return (group){a.n + b.n, min3(a.low, b.low), max3(a.high, b.high), add3(a.axes, b.axes),
                   a.intensity + b.intensity};
}

static group group_of(const placed_light *light)
{
    return (group){1, light->low, light->high, scale3(light->intensity, light->axis), light->intensity};
}

static group group_of_range(const builder *b, uint32_t begin, uint32_t end)
{
    group g = empty_group();
    for (uint32_t i = begin; i < end; i++) g = join(g, group_of(&b->lights[b->order[i]]));
    return g;
}

/* What a group adds to the variance, up to a factor: intensity by size by the solid angle that it shines into.  In
 * place of [conty18]'s areas, which are 0 for lights in a line, and cones, which cost an arccosine a light: the squared
 * diagonal, and a factor from 1 to 4 by how far the axes agree. */
static float cost_of(const group *g)
{
    const real3 size = sub3(g->high, g->low);
    return g->n ? dot3(size, size)*(4*g->intensity - 3*length3(g->axes)) : 0;
}

static float coordinate(real3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

typedef struct split {
    int axis; /* -1: none */
    float low, scale;
    int first_right; /* bin */
} split;

static int bin_of(const placed_light *light, int axis, float low, float scale)
{
    const float place = (coordinate(middle(light->low, light->high), axis) - low)*scale;
    return place > 0 ? (int)kmin(place, BINS - 1) : 0;
}

/* The plane between bins whose two sides cost least. */
static split best_split(const builder *b, uint32_t begin, uint32_t end)
{
    real3 low = splat3(INFINITY), high = splat3(-INFINITY);
    for (uint32_t i = begin; i < end; i++) {
        const placed_light *light = &b->lights[b->order[i]];
        const real3 center = middle(light->low, light->high);
        low = min3(low, center);
        high = max3(high, center);
    }
    split best = {.axis = -1};
    float least = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        const float start = coordinate(low, axis), scale = BINS/(coordinate(high, axis) - start);
        if (!(scale < INFINITY)) continue;
        group bins[BINS], right[BINS];
        for (int k = 0; k < BINS; k++) bins[k] = empty_group();
        for (uint32_t i = begin; i < end; i++) {
            const placed_light *light = &b->lights[b->order[i]];
            group *bin = &bins[bin_of(light, axis, start, scale)];
            *bin = join(*bin, group_of(light));
        }
        right[BINS - 1] = bins[BINS - 1];
        for (int k = BINS - 2; k >= 0; k--) right[k] = join(bins[k], right[k + 1]);
        group left = bins[0];
        for (int k = 1; k < BINS; left = join(left, bins[k++])) {
            const float cost = cost_of(&left) + cost_of(&right[k]);
            if (left.n == 0 || right[k].n == 0 || !(cost < least)) continue;
            least = cost;
            best = (split){axis, start, scale, k};
        }
    }
    return best;
}

/* Divides a range in two; returns where the second begins. */
static uint32_t divide(const builder *b, range r, int level)
{
    const split s = level < MOST_LEVELS_BY_COST ? best_split(b, r.begin, r.end) : (split){.axis = -1};
    if (s.axis < 0) return r.begin + (r.end - r.begin)/2;
    uint32_t begin = r.begin, end = r.end;
    while (begin < end) {
        const uint32_t light = b->order[begin];
        if (bin_of(&b->lights[light], s.axis, s.low, s.scale) < s.first_right) {
            begin++;
        } else {
            b->order[begin] = b->order[--end];
            b->order[end] = light;
        }
    }
    return begin;
}

static range make_range(const builder *b, uint32_t begin, uint32_t end)
{
    const group g = group_of_range(b, begin, end);
    return (range){begin, end, cost_of(&g)};
}

/* Divides a range into at most `most_parts`, the most costly first; their number.  What would fit into one node is
 * divided only if there is room for all of its lights here: half as many nodes, a fifth less variance. */
static int divide_in_many(const builder *b, range whole, int level, int most_parts, range *parts)
{
    int n = 1;
    parts[0] = whole;
    while (n < most_parts) {
        int most = -1;
        for (int k = 0; k < n; k++) {
            const uint32_t size = parts[k].end - parts[k].begin;
            const bool is_divided = size > WIDTH || (size > 1 && size <= (uint32_t)(most_parts - n + 1));
            if (is_divided && (most < 0 || parts[k].cost > parts[most].cost)) most = k;
        }
        if (most < 0) break;
        const range r = parts[most];
        const uint32_t middle = divide(b, r, level);
        parts[most] = make_range(b, r.begin, middle);
        parts[n++] = make_range(b, middle, r.end);
    }
    return n;
}

/* A cone around the axes of a range, and how far they agree. */
typedef struct axis_cone {
    real3 axis;
    float cos;
    float directed, along; /* intensity of lights that have an axis, and the sum of it along the axes */
} axis_cone;

/* A cone that counts on both sides may hold the opposite of any axis. */
static axis_cone cone_of_range(const builder *b, range r, bool is_double_sided)
{
    const real3 first = b->lights[b->order[r.begin]].axis;
    axis_cone cone = {.axis = splat3(0), .cos = 1};
    for (uint32_t i = r.begin; i < r.end; i++) {
        const placed_light *light = &b->lights[b->order[i]];
        const bool is_turned = is_double_sided && dot3(light->axis, first) < 0;
        cone.axis = add3(cone.axis, scale3(is_turned ? -light->intensity : light->intensity, light->axis));
        cone.directed += has_axis(light) ? light->intensity : 0;
    }
    const float most = max_abs3(cone.axis);
    if (most > 0) {
        cone.axis = scale3(1/most, cone.axis);
        cone.along = most*length3(cone.axis);
    }
    cone.axis = most > 0 ? normalize3(cone.axis) : make3(0, 0, 1);
    for (uint32_t i = r.begin; i < r.end; i++) {
        const placed_light *light = &b->lights[b->order[i]];
        const float cos = dot3(light->axis, cone.axis);
        cone.cos = kmin(cone.cos, !has_axis(light) ? -1.0f : is_double_sided ? kabs(cos) : cos);
    }
    cone.cos = kmax(cone.cos, -1);
    return cone;
}

/* Bounds the lights of a range. */
static void bound(const builder *b, range r, light_node *node, int k)
{
    const group g = group_of_range(b, r.begin, r.end);
    const real3 center = middle(g.low, g.high);
    float radius = 0, cos_spread = 1;
    bool is_double_sided = false;
    for (uint32_t i = r.begin; i < r.end; i++) {
        const placed_light *light = &b->lights[b->order[i]];
        radius = kmax(radius, length3(max3(sub3(light->high, center), sub3(center, light->low))));
        cos_spread = kmin(cos_spread, light->cos_spread);
        is_double_sided |= light->is_double_sided;
    }
    const axis_cone cone = cone_of_range(b, r, is_double_sided);
    node->x[k] = center.x;
    node->y[k] = center.y;
    node->z[k] = center.z;
    node->radius[k] = 1.00001f*radius + 1e-6f*max_abs3(center); /* distances to it are rounded */
    node->axis_x[k] = cone.axis.x;
    node->axis_y[k] = cone.axis.y;
    node->axis_z[k] = cone.axis.z;
    node->cos_axes[k] = cone.cos;
    node->sin_axes[k] = ksqrt(1 - cone.cos*cone.cos);
    node->cos_spread[k] = cos_spread;
    node->back[k] = is_double_sided ? -1.0f : 1.0f;
    /* Axes that go anywhere meet a direction at a mean cosine of a half, or of a quarter if those behind count as 0. */
    node->around[k] = kmax(g.intensity - cone.directed, 0) +
                      kmax(cone.directed - cone.along, 0)*(is_double_sided ? 0.5f : 0.25f);
    node->along[k] = kmax(cone.along, REAL_MIN);
}

/* The node's index, or UINT32_MAX without memory. */
static uint32_t add_node(builder *b)
{
    light_tree *tree = b->tree;
    if (tree->n_nodes == b->room) {
        const uint32_t room = b->room ? 2*b->room : 16;
        light_node *larger = realloc(tree->nodes, room*sizeof *larger);
        if (!larger) return UINT32_MAX;
        tree->nodes = larger;
        b->room = room;
    }
    memset(&tree->nodes[tree->n_nodes], 0, sizeof tree->nodes[0]);
    return tree->n_nodes++;
}

static bool add_children(builder *b, uint32_t index, const range *parts, int n, int level);

/* The node's index, or UINT32_MAX without memory. */
static uint32_t build(builder *b, range whole, uint32_t parent, int level)
{
    const uint32_t index = add_node(b);
    if (index == UINT32_MAX) return index;
    b->tree->nodes[index].parent = parent;
    range parts[WIDTH];
    const int n = divide_in_many(b, whole, level, WIDTH, parts);
    return add_children(b, index, parts, n, level) ? index : UINT32_MAX;
}

/* Children of the node `index` and, if they are more than it takes, of those after it; false without memory. */
static bool add_children(builder *b, uint32_t index, const range *parts, int n, int level)
{
    for (int k = 0; k < n; k++) {
        const uint32_t place = WIDTH*index + (uint32_t)k, light = b->order[parts[k].begin];
        bound(b, parts[k], &b->tree->nodes[place/WIDTH], (int)(place%WIDTH));
        const bool is_leaf = parts[k].end - parts[k].begin == 1;
        if (is_leaf) b->tree->place[light] = place;
        const uint32_t child = is_leaf ? LIGHT_NODE_LEAF | light : build(b, parts[k], place, level + 1);
        if (child == UINT32_MAX) return false;
        b->tree->nodes[place/WIDTH].child[place%WIDTH] = child;
    }
    return true;
}

/* A hundred lights are weighed one by one: where their axes go anywhere, pairs of them leave three times the variance.
 * Of more, few groups: so wide a top takes longer than it spares. */
enum { PARTS_OF_MANY = 32 };

static bool build_top(builder *b, uint32_t n_lights)
{
    range parts[LIGHT_TREE_TOP];
    const int most_parts = n_lights > LIGHT_TREE_TOP ? PARTS_OF_MANY : LIGHT_TREE_TOP;
    const int n = divide_in_many(b, make_range(b, 0, n_lights), 0, most_parts, parts);
    for (int k = 0; k < n; k += WIDTH)
        if (add_node(b) == UINT32_MAX) return false;
    b->tree->n_top = (uint32_t)n;
    return add_children(b, 0, parts, n, 0);
}

facet_status light_tree_create(const placed_light *lights, uint32_t n, light_tree *result)
{
    light_tree tree = {.place = malloc((n + (size_t)1)*sizeof *tree.place)};
    builder b = {lights, &tree, malloc((n + (size_t)1)*sizeof *b.order), 0};
    bool is_built = tree.place && b.order;
    uint32_t n_shining = 0;
    for (uint32_t i = 0; i < n && is_built; i++) {
        tree.place[i] = LIGHT_NODE_LEAF;
        if (lights[i].intensity > 0) b.order[n_shining++] = i;
    }
    if (is_built && n_shining > 0) is_built = build_top(&b, n_shining);
    free(b.order);
    if (!is_built) {
        light_tree_destroy(&tree);
        return FACET_NO_MEMORY;
    }
    if (tree.nodes) {
        light_node *fitting = realloc(tree.nodes, tree.n_nodes*sizeof *fitting);
        if (fitting) tree.nodes = fitting;
    }
    *result = tree;
    return FACET_OK;
}
