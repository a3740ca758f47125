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

float light_tree_weight(const light_tree *tree, const light_receiver *to)
{
    float weights[WIDTH];
    return tree->nodes ? light_node_weigh(tree->nodes, to, weights) : 0;
}

double light_tree_draw(const light_tree *tree, const light_receiver *to, double *u, uint32_t *light)
{
    if (!tree->nodes) return 0;
    double probability = 1;
    uint32_t next = 0;
    while (probability > 0 && !(next & LIGHT_NODE_LEAF))
        probability *= light_node_draw(&tree->nodes[next], to, u, &next);
    *light = next & ~LIGHT_NODE_LEAF;
    return probability;
}

double light_tree_probability(const light_tree *tree, const light_receiver *to, uint32_t light)
{
    uint32_t place = tree->place[light];
    if (place == LIGHT_NODE_LEAF) return 0;
    double probability = 1;
    for (;; place = tree->nodes[place/WIDTH].parent) {
        float weights[WIDTH];
        const float sum = light_node_weigh(&tree->nodes[place/WIDTH], to, weights);
        const float weight = weights[place%WIDTH];
        if (!(weight > 0)) return 0;
        probability *= (double)(weight/sum);
        if (place < WIDTH) return probability;
    }
}
