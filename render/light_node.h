/* light_node.h: one step down the tree of lights, for one point that is lit and for loops over many.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "render/expect.h"
#include "render/light_tree.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Weights stay in a range whose sums are finite. */
#define LEAST_LIGHT_WEIGHT REAL_MIN
#define MOST_LIGHT_WEIGHT 1e36f

/* The weight of a node's child for a point.  Distances count as half the radius at least: the mean of 1/d^2 over a cube
 * is 5.8/r^2 at its centre, 3.4/r^2 on a face and 1.4/r^2 at a corner.  Children that a wide cone may turn to the point
 * have a tenth of their bound at least, however their mean axis lies. */
KERNEL float light_child_weight(const light_node *node, size_t k, light_receiver at)
{
    const real3 from = at.position;
    const float x = from.x - node->x[k], y = from.y - node->y[k], z = from.z - node->z[k];
    const float d2 = kmax(x*x + y*y + z*z, REAL_MIN), d = ksqrt(d2), inverse = 1/d;
    const float radius = node->radius[k], r2 = radius*radius;
    /* The angle to the axis, ... */
    const float cos = (x*node->axis_x[k] + y*node->axis_y[k] + z*node->axis_z[k])*inverse;
    const float cos0 = kmin(kmax(cos, node->back[k]*cos), 1), sin0 = ksqrt(kmax(1 - cos0*cos0, 0));
    /* ... less that of the cone of axes, ... */
    const float cos_axes = node->cos_axes[k], sin_axes = node->sin_axes[k];
    const int is_in_cone = cos0 >= cos_axes;
    const float cos1 = is_in_cone ? 1 : cos0*cos_axes + sin0*sin_axes;
    const float sin1 = is_in_cone ? 0 : sin0*cos_axes - cos0*sin_axes;
    /* ... less that under which the lights are seen. */
    const float sin_size = kmin(radius*inverse, 1), cos_size = ksqrt(1 - sin_size*sin_size);
    const int is_in_size = (d2 <= r2) | (cos1 >= cos_size);
    const float cos2 = is_in_size ? 1 : cos1*cos_size + sin1*sin_size;
    const float intensity = node->around[k] + node->along[k]*kmax(cos0, 0.1f*cos2);
    const float taken = light_received(at, make3(x, y, z), d, radius);
    const float weight = taken*intensity/kmax(d2, 0.25f*r2);
    const int is_lit = (cos2 >= node->cos_spread[k] - LIGHT_COSINE_ERROR) & (node->along[k] > 0) & (taken > 0);
    return is_lit ? kmin(kmax(weight, LEAST_LIGHT_WEIGHT), MOST_LIGHT_WEIGHT) : 0;
}

/* Those of all children, and their sum. */
static inline float light_node_weigh(const light_node *node, const light_receiver *to, float weights[LIGHT_NODE_WIDTH])
{
    const light_receiver at = *to;
    _Pragma("omp simd") for (size_t k = 0; k < LIGHT_NODE_WIDTH; k++) weights[k] = light_child_weight(node, k, at);
    float sum = 0;
    for (size_t k = 0; k < LIGHT_NODE_WIDTH; k++) sum += weights[k];
    return sum;
}

/* Asks memory for a node that is weighed soon. */
EXPECTING void expect_light_node(const light_node *node)
{
    for (size_t at = 0; at < sizeof *node; at += 64) __builtin_prefetch((const char *)node + at);
}

/* ... for the node that a light hangs on. */
EXPECTING void expect_light(const light_tree *tree, uint32_t light)
{
    const uint32_t place = tree->place[light];
    if (place != LIGHT_NODE_LEAF) expect_light_node(&tree->nodes[place/LIGHT_NODE_WIDTH]);
}

/* Draws a child for a point by *u in [0,1), of which it leaves the rest; its probability, 0 where all prove dark.  The
 * ends of the children's shares are counted rather than searched, since no processor foresees where a search stops. */
static inline double light_node_draw(const light_node *node, const light_receiver *to, double *u, uint32_t *child)
{
    float weights[LIGHT_NODE_WIDTH];
    double ends[LIGHT_NODE_WIDTH + 1];
    const float sum = light_node_weigh(node, to, weights);
    if (!(sum > 0)) return 0;
    ends[0] = 0;
    for (int k = 0; k < LIGHT_NODE_WIDTH; k++) ends[k + 1] = ends[k] + (double)weights[k];
    const double at = *u*ends[LIGHT_NODE_WIDTH];
    uint32_t k = 0;
    for (int i = 1; i < LIGHT_NODE_WIDTH; i++) k += at >= ends[i];
    while (!(weights[k] > 0)) k--; /* rounding at the upper end */
    const double rest = (at - ends[k])/(double)weights[k];
    *u = rest < 1 ? rest : 0;
    *child = node->child[k];
    return (double)(weights[k]/sum);
}

/* light_tree_probability for a point that knows the sum of the weights of the top's children. */
static inline double light_walk_probability(const light_tree *tree, const light_receiver *to, double sum_of_top,
                                            uint32_t light)
{
    enum { WIDTH = LIGHT_NODE_WIDTH };
    uint32_t place = tree->place[light];
    if (place == LIGHT_NODE_LEAF) return 0;
    double probability = 1;
    for (; place >= tree->n_top; place = tree->nodes[place/WIDTH].parent) {
        float weights[WIDTH];
        const float sum = light_node_weigh(&tree->nodes[place/WIDTH], to, weights), weight = weights[place%WIDTH];
        if (!(weight > 0)) return 0;
        probability *= (double)(weight/sum);
    }
    const float weight = light_child_weight(&tree->nodes[place/WIDTH], place%WIDTH, *to);
    return weight > 0 ? probability*((double)weight/sum_of_top) : 0;
}

/* The same, but that for matte surfaces, to which nodes look like the sum of their lights, it is about that: the share
 * that the light itself has of the tree's weight, without the way down. */
static inline float light_tree_rate(const light_tree *tree, const light_receiver *to, uint32_t light)
{
    const uint32_t place = tree->place[light];
    if (place == LIGHT_NODE_LEAF || !(to->weight > 0)) return 0;
    if (to->peak > 0.1f*to->broad) return (float)light_walk_probability(tree, to, (double)to->weight, light);
    const light_node *node = &tree->nodes[place/LIGHT_NODE_WIDTH];
    return kmin(light_child_weight(node, place%LIGHT_NODE_WIDTH, *to)/to->weight, 1);
}

#ifdef __cplusplus
}
#endif
