/* light_tree.c: walking the tree of lights.
 * SPDX-License-Identifier: MIT */
#include "render/light_tree.h"

#include <stdlib.h>

enum { WIDTH = LIGHT_NODE_WIDTH };

/* Rounding may take a cosine this far down, and no further. */
#define COSINE_ERROR 1e-5f

/* Weights stay in a range whose sums are finite. */
#define LEAST_WEIGHT REAL_MIN
#define MOST_WEIGHT 1e36f

void light_tree_destroy(light_tree *tree)
{
    free(tree->nodes);
    free(tree->place);
    *tree = (light_tree){0};
}

/* The weights of a node's children for a point, and their sum.  Distances count as half the radius at least: the
 * mean of 1/d^2 over a cube is 5.8/r^2 at its centre, 3.4/r^2 on a face and 1.4/r^2 at a corner.  Children that a wide
 * cone may turn to the point have a tenth of their bound at least, however their mean axis lies. */
static float weigh(const light_node *node, real3 from, float weights[WIDTH])
{
    _Pragma("omp simd") for (int k = 0; k < WIDTH; k++)
    {
        const float x = from.x - node->x[k], y = from.y - node->y[k], z = from.z - node->z[k];
        const float d2 = x*x + y*y + z*z, radius = node->radius[k], r2 = radius*radius;
        const float inverse = 1/ksqrt(kmax(d2, REAL_MIN));
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
        const float weight = intensity/kmax(kmax(d2, 0.25f*r2), REAL_MIN);
        const int is_lit = (cos2 >= node->cos_spread[k] - COSINE_ERROR) & (node->along[k] > 0);
        weights[k] = is_lit ? kmin(kmax(weight, LEAST_WEIGHT), MOST_WEIGHT) : 0;
    }
    float sum = 0;
    for (int k = 0; k < WIDTH; k++) sum += weights[k];
    return sum;
}

uint32_t draw_weighted(const float *weights, uint32_t n, float sum, double *u)
{
    double left = *u*(double)sum;
    uint32_t index = 0, last = 0;
    for (; index < n; left -= (double)weights[index++]) {
        if (weights[index] > 0) last = index;
        if (left < (double)weights[index]) break;
    }
    if (index == n) { /* rounding at the upper end */
        index = last;
        left = 0;
    }
    const double rest = left/(double)weights[index];
    *u = rest < 1 ? rest : 0;
    return index;
}

float light_tree_irradiance(const light_tree *tree, real3 from)
{
    float weights[WIDTH];
    return tree->nodes ? weigh(tree->nodes, from, weights) : 0;
}

double light_tree_draw(const light_tree *tree, real3 from, double *u, uint32_t *light)
{
    if (!tree->nodes) return 0;
    double probability = 1;
    uint32_t next = 0;
    while (!(next & LIGHT_NODE_LEAF)) {
        const light_node *node = &tree->nodes[next];
        float weights[WIDTH];
        const float sum = weigh(node, from, weights);
        if (!(sum > 0)) return 0;
        const uint32_t k = draw_weighted(weights, WIDTH, sum, u);
        probability *= (double)(weights[k]/sum);
        next = node->child[k];
    }
    *light = next & ~LIGHT_NODE_LEAF;
    return probability;
}

double light_tree_probability(const light_tree *tree, real3 from, uint32_t light)
{
    uint32_t place = tree->place[light];
    if (place == LIGHT_NODE_LEAF) return 0;
    double probability = 1;
    for (;; place = tree->nodes[place/WIDTH].parent) {
        float weights[WIDTH];
        const float sum = weigh(&tree->nodes[place/WIDTH], from, weights);
        const float weight = weights[place%WIDTH];
        if (!(weight > 0)) return 0;
        probability *= (double)(weight/sum);
        if (place < WIDTH) return probability;
    }
}
