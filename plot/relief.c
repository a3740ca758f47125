/* relief.c: the painter's algorithm.
 * SPDX-License-Identifier: MIT */
#include "plot/relief.h"

#include <math.h>
#include <stdlib.h>

#include "core/error.h"

static const double DEGREE = 3.14159265358979323846/180;

typedef struct part {
    point corners[4];
    double depth; /* towards the eye */
    size_t order; /* of parts with the same depth */
    colour fill;
    pen edge;
    unsigned edges; /* of a patch */
    bool is_line;
} part;

struct relief {
    double right[3], up[3], towards[3]; /* unit vectors of the eye */
    point origin;
    double scale;
    size_t n, capacity;
    part *parts;
};

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* The scale and origin with which the eight corners fill the place. */
static void fit(relief *r, box place, const double low[3], const double high[3])
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 8; k++) {
        const double corner[3] = {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]};
        const double at[2] = {dot(r->right, corner), dot(r->up, corner)};
        for (int i = 0; i < 2; i++) {
            least[i] = fmin(least[i], at[i]);
            most[i] = fmax(most[i], at[i]);
        }
    }
    r->scale = fmin(place.width/(most[0] - least[0]), place.height/(most[1] - least[1]));
    r->origin.x = place.x + 0.5*place.width - 0.5*r->scale*(least[0] + most[0]);
    r->origin.y = place.y + 0.5*place.height + 0.5*r->scale*(least[1] + most[1]);
}

facet_status relief_create(box place, double azimuth, double elevation, const double low[3], const double high[3],
                           size_t n_parts, relief **made, facet_error *why)
{
    const double ca = cos(azimuth*DEGREE), sa = sin(azimuth*DEGREE), ce = cos(elevation*DEGREE),
                 se = sin(elevation*DEGREE);
    relief *r = malloc(sizeof *r);
    part *parts = malloc(n_parts*sizeof *parts);
    if (!r || !parts) {
        free(r);
        free(parts);
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a surface of %zu parts", n_parts);
    }
    *r = (relief){.right = {-sa, ca, 0},
                  .up = {-ca*se, -sa*se, ce},
                  .towards = {ca*ce, sa*ce, se},
                  .capacity = n_parts,
                  .parts = parts};
    fit(r, place, low, high);
    *made = r;
    return FACET_OK;
}

void relief_destroy(relief *r)
{
    if (!r) return;
    free(r->parts);
    free(r);
}

point relief_at(const relief *r, const double p[3])
{
    return (point){r->origin.x + r->scale*dot(r->right, p), r->origin.y - r->scale*dot(r->up, p)};
}

static void add_part(relief *r, part p)
{
    if (r->n == r->capacity) return;
    p.order = r->n;
    r->parts[r->n++] = p;
}

/* The patch's colour by the angle of its normal, either side of which may be seen, to a light above the eye's left. */
static colour lit(const relief *r, double corners[4][3], colour c)
{
    double a[3], b[3], light[3];
    for (int k = 0; k < 3; k++) {
        a[k] = corners[2][k] - corners[0][k];
        b[k] = corners[3][k] - corners[1][k];
        light[k] = 0.6*r->towards[k] + 0.6*r->up[k] - 0.53*r->right[k];
    }
    const double n[3] = {a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0]};
    const double length = sqrt(dot(n, n));
    const double side = dot(n, r->towards) < 0 ? -1 : 1, cosine = length > 0 ? side*dot(n, light)/length : 1;
    const double share = 0.72 + 0.28*fmax(cosine, 0);
    return (colour){c.r*share, c.g*share, c.b*share, 1};
}

void relief_quad(relief *r, double corners[4][3], colour c, unsigned edges)
{
    part p = {.fill = lit(r, corners, c), .edges = edges};
    p.edge = (pen){{0.6*p.fill.r, 0.6*p.fill.g, 0.6*p.fill.b, 1}, 0.04, SOLID};
    for (int i = 0; i < 4; i++) {
        p.corners[i] = relief_at(r, corners[i]);
        p.depth += 0.25*dot(r->towards, corners[i]);
    }
    add_part(r, p);
}

/* Pieces of a line overlap, so that no seam shows. */
static const double OVERLAP = 1.15;

void relief_line(relief *r, const double from[3], const double to[3], pen pencil)
{
    double at[2][3];
    for (int i = 0; i < RELIEF_PIECES; i++) {
        for (int k = 0; k < 3; k++) {
            at[0][k] = from[k] + (to[k] - from[k])*i/RELIEF_PIECES;
            at[1][k] = from[k] + (to[k] - from[k])*(i + OVERLAP)/RELIEF_PIECES;
        }
        if (pencil.dash != SOLID && i%2) continue;
        part p = {.edge = pencil, .is_line = true};
        p.edge.dash = SOLID; /* pieces are the dashes */
        for (int k = 0; k < 2; k++) {
            p.corners[k] = relief_at(r, at[k]);
            p.depth += 0.5*dot(r->towards, at[k]);
        }
        add_part(r, p);
    }
}

static int compare_depths(const void *a, const void *b)
{
    const part *p = a, *q = b;
    if (p->depth != q->depth) return p->depth < q->depth ? -1 : 1;
    return (p->order > q->order) - (p->order < q->order);
}

static void draw_patch(canvas *page, const part *p)
{
    /* The second time closes the seams between patches. */
    for (int twice = 0; twice < 2; twice++) {
        canvas_move(page, p->corners[0]);
        for (int k = 1; k < 4; k++) canvas_line(page, p->corners[k]);
        canvas_close(page);
        if (twice) canvas_stroke(page, (pen){p->fill, 0.04, SOLID});
        else canvas_fill(page, p->fill);
    }
    for (int k = 0; k < 4; k++)
        if (p->edges >> k & 1) canvas_segment(page, p->corners[k], p->corners[(k + 1)%4], p->edge);
}

void relief_draw(canvas *page, relief *r)
{
    qsort(r->parts, r->n, sizeof *r->parts, compare_depths);
    for (size_t i = 0; i < r->n; i++) {
        const part *p = &r->parts[i];
        if (p->is_line) canvas_segment(page, p->corners[0], p->corners[1], p->edge);
        else draw_patch(page, p);
    }
}
