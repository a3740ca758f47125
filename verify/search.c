/* search.c: see search.h.
 * SPDX-License-Identifier: MIT */
#include "verify/search.h"

#include <math.h>
#include <stdbool.h>

#include "verify/views.h"

const char *const search_names[SEARCH_TERMS] = {"D", "Lambda", "G1"};

#define PI 3.14159265358979323846
#define LEAST_VALUE 1e-30

enum { COORDINATES = SEARCH_PARAMETERS + 2, KEPT = 24, CLIMB = 300 };

/* A point of the domain, each coordinate in [0, 1]: the parameters, then the direction's elevation and azimuth. */
typedef struct point {
    double x[COORDINATES];
    search_result result;
} point;

typedef struct search {
    const facet_material *material;
    const search_parameter *parameters;
    int n;
    search_term term;
} search;

static double between(double low, double high, double t)
{
    return low > 0 ? exp(log(low) + t*(log(high) - log(low))) : low + t*(high - low);
}

/* Logarithmic in the tangent, from 1e-5 to 1e5.  Not inlined: gcc 12 vectorises the conversions to float and, at the
 * caller, back to double, and loses the rounding between them. */
static __attribute__((noinline)) void direction_of(const double x[2], float m[3])
{
    const double tangent = exp((2*x[0] - 1)*log(1e5)), inverse = 1/hypot(1, tangent);
    m[0] = (float)(tangent*inverse*cos(2*PI*x[1]));
    m[1] = (float)(tangent*inverse*sin(2*PI*x[1]));
    m[2] = (float)inverse;
}

/* The error at a point; -1 where the material is not one. */
static double error_at(const search *s, point *p)
{
    facet_material material = *s->material;
    facet_bsdf single;
    facet_bsdf64 twice;
    search_result *r = &p->result;
    r->error = -1;
    for (int i = 0; i < s->n; i++) {
        const search_parameter *q = &s->parameters[i];
        r->values[i] = fmin(fmax((double)(float)between(q->low, q->high, p->x[i]), q->low), q->high);
        r->values[i] = (double)(float)r->values[i];
        if (facet_material_set(&material, q->name, &r->values[i], 1, NULL)) return -1;
    }
    if (facet_bsdf_prepare(&material, &single, NULL) || facet_bsdf64_prepare(&material, &twice, NULL)) return -1;
    direction_of(p->x + s->n, r->m);
    const double m[3] = {(double)r->m[0], (double)r->m[1], (double)r->m[2]};
    const facet_terms found = facet_bsdf_terms(&single, r->m);
    const facet_terms64 truth = facet_bsdf64_terms(&twice, m);
    const double values[SEARCH_TERMS][2] = {
        {(double)found.D, truth.D}, {(double)found.Lambda, truth.Lambda}, {(double)found.G1, truth.G1}};
    r->found = values[s->term][0];
    r->truth = values[s->term][1];
    if (s->term != SEARCH_G1 && !(fabs(r->truth) > LEAST_VALUE && fabs(r->truth) < 1e30)) return -1;
    r->error = fabs(r->found - r->truth)/(s->term == SEARCH_G1 ? 1 : fabs(r->truth));
    if (isnan(r->error)) r->error = INFINITY;
    return r->error;
}

/* Puts a point among those kept, the worst first. */
static void keep(point kept[KEPT], const point *p)
{
    if (!(p->result.error > kept[KEPT - 1].result.error)) return;
    int i = KEPT - 1;
    for (; i > 0 && p->result.error > kept[i - 1].result.error; i--) kept[i] = kept[i - 1];
    kept[i] = *p;
}

search_result search_worst(const facet_material *material, const search_parameter *parameters, int n, search_term term,
                           int evaluations, uint64_t seed)
{
    const search s = {material, parameters, n, term};
    verify_random random = {seed};
    point kept[KEPT];
    for (int i = 0; i < KEPT; i++) kept[i] = (point){.result = {.error = -1}};
    for (int i = 0; i < evaluations; i++) {
        point p;
        for (int k = 0; k < n + 2; k++) p.x[k] = verify_draw(&random);
        error_at(&s, &p);
        keep(kept, &p);
    }
    search_result worst = kept[0].result;
    for (int i = 0; i < KEPT; i++) {
        point here = kept[i];
        for (int step = 0; step < CLIMB && here.result.error >= 0; step++) {
            point there = here;
            const double size = 0.05*exp(-12.0*step/CLIMB);
            for (int k = 0; k < n + 2; k++)
                there.x[k] = fmin(fmax(here.x[k] + size*(2*verify_draw(&random) - 1), 0), 1);
            if (error_at(&s, &there) > here.result.error) here = there;
        }
        if (here.result.error > worst.error) worst = here.result;
    }
    return worst;
}
