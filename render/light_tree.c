/* light_tree.c: walking the tree of lights.
 * SPDX-License-Identifier: MIT */
#include "render/light_node.h"

#include <stdlib.h>

enum { WIDTH = LIGHT_NODE_WIDTH };

void light_tree_destroy(light_tree *tree)
{
    free(tree->nodes);
    free(tree->place);
    *tree = (light_tree){0};
}

/* The weights of the children of the top, and their sum. */
static double weigh_top(const light_tree *tree, const light_receiver *to, float weights[LIGHT_TREE_TOP])
{
    double sum = 0;
    for (uint32_t first = 0; first < tree->n_top; first += WIDTH)
        light_node_weigh(&tree->nodes[first/WIDTH], to, weights + first);
    for (uint32_t k = 0; k < tree->n_top; k++) sum += (double)weights[k];
    return sum;
}

static double weight_of(const light_tree *tree, const light_receiver *to)
{
    float weights[LIGHT_TREE_TOP];
    return to->weight > 0 ? (double)to->weight : weigh_top(tree, to, weights);
}

float light_tree_weight(const light_tree *tree, const light_receiver *to)
{
    return (float)weight_of(tree, to);
}

double light_tree_draw(const light_tree *tree, const light_receiver *to, double *u, uint32_t *light)
{
    float weights[LIGHT_TREE_TOP];
    const double sum = weigh_top(tree, to, weights), at = *u*sum;
    double end = 0, begin = 0, probability = 0;
    uint32_t next = 0;
    for (uint32_t k = 0; k < tree->n_top; k++) {
        if (at >= end && weights[k] > 0) {
            next = tree->nodes[k/WIDTH].child[k%WIDTH];
            begin = end;
            probability = (double)weights[k];
        }
        end += (double)weights[k];
    }
    if (!(probability > 0)) return 0;
    const double rest = (at - begin)/probability;
    *u = rest < 1 ? rest : 0;
    probability /= sum;
    while (probability > 0 && !(next & LIGHT_NODE_LEAF))
        probability *= light_node_draw(&tree->nodes[next], to, u, &next);
    *light = next & ~LIGHT_NODE_LEAF;
    return probability;
}

double light_tree_probability(const light_tree *tree, const light_receiver *to, uint32_t light)
{
    return light_walk_probability(tree, to, weight_of(tree, to), light);
}
