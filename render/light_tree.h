/* light_tree.h: choosing one of many lights for a point, in time that grows with the logarithm of their number.
 *
 * A tree of eight children a node.  A child is chosen in proportion to an estimate of what the point takes up of its
 * light: its intensity by a mean cosine over the squared distance, by the receiver's share (light_receiver.h).  It is 0
 * only where a cone of the lights' axes and a sphere around them prove that nothing comes.  [conty18] Conty Estevez and
 * Kulla, Importance sampling of many lights with adaptive tree splitting, 2018, without the splitting; eight children
 * weighed at once fill vectors and shorten the way down to a third.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/geometry.h"
#include "render/light_receiver.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A light with a place. */
typedef struct placed_light {
    real3 low, high;      /* a box around it [m] */
    real3 axis;           /* unit; 0: it shines all around */
    float cos_spread;     /* it shines up to this angle around the axis */
    bool is_double_sided; /* and around -axis alike */
    float intensity;      /* luminance along the axis, at most [W/sr]; the sum over all lights is finite */
} placed_light;

/* Children of a node; and of the top, whose nodes are weighed as if they were one. */
enum { LIGHT_NODE_WIDTH = 8, LIGHT_TREE_TOP = 128 };

/* Children as arrays; `along` is 0 for those that are not there. */
typedef struct light_node {
    float x[LIGHT_NODE_WIDTH], y[LIGHT_NODE_WIDTH], z[LIGHT_NODE_WIDTH], radius[LIGHT_NODE_WIDTH]; /* of a sphere */
    float axis_x[LIGHT_NODE_WIDTH], axis_y[LIGHT_NODE_WIDTH], axis_z[LIGHT_NODE_WIDTH];            /* unit */
    float cos_axes[LIGHT_NODE_WIDTH], sin_axes[LIGHT_NODE_WIDTH]; /* of a cone around all the lights' axes */
    float cos_spread[LIGHT_NODE_WIDTH];                           /* the widest */
    float back[LIGHT_NODE_WIDTH];                                 /* -1: shines around -axis too; 1 */
    float along[LIGHT_NODE_WIDTH];    /* intensity that goes with the cosine to the axis; > 0 */
    float around[LIGHT_NODE_WIDTH];   /* and the rest, the same everywhere */
    uint32_t child[LIGHT_NODE_WIDTH]; /* a node, or LIGHT_NODE_LEAF | light */
    uint32_t parent;                  /* LIGHT_NODE_WIDTH*node + which of its children this is; 0 at the top */
} light_node;

#define LIGHT_NODE_LEAF (1u << 31)

/* In place of a light of the tree: what lies at a distance has been drawn (loops.h). */
#define LIGHT_DISTANT UINT32_MAX

/* About 100 bytes a light. */
typedef struct light_tree {
    light_node *nodes; /* those of the top first; NULL: no light shines */
    uint32_t n_nodes;
    uint32_t n_top;  /* children of the top, up to LIGHT_TREE_TOP */
    uint32_t *place; /* [n] as light_node.parent, or LIGHT_NODE_LEAF for a light that does not shine */
} light_tree;

/* n < LIGHT_NODE_LEAF/LIGHT_NODE_WIDTH; n log(n) time; the same lights give the same tree.  FACET_NO_MEMORY. */
facet_status light_tree_create(const placed_light *lights, uint32_t n, light_tree *result);
void light_tree_destroy(light_tree *tree);

/* About what is taken up of the light at a point [W/m^2], luminance; the irradiance where all is.  The receiver's own
 * figure if it has one. */
float light_tree_weight(const light_tree *tree, const light_receiver *to);

/* Draws a light by *u in [0,1), of which it leaves the rest, again in [0,1).  The probability of that light; 0: none,
 * as where all of a node's children prove dark though the node did not. */
double light_tree_draw(const light_tree *tree, const light_receiver *to, double *u, uint32_t *light);

/* The probability with which light_tree_draw draws this one. */
double light_tree_probability(const light_tree *tree, const light_receiver *to, uint32_t light);

#ifdef __cplusplus
}
#endif
