/* search.c: see search.h.
 * SPDX-License-Identifier: MIT */
#include "verify/search.h"

#include <math.h>
#include <stdbool.h>

#include "verify/integrals.h"
#include "verify/views.h"

const char *const search_names[SEARCH_TERMS] = {"D", "Lambda", "G1", "albedo"};

#define PI 3.14159265358979323846
#define LEAST_VALUE 1e-30

enum { COORDINATES = SEARCH_PARAMETERS + 2, KEPT = 24, CLIMB = 300, KEPT_ALBEDOS = 2, CLIMB_ALBEDO = 30 };

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

/* A prepared material and a view, for an integral. */
typedef struct at_view {
    const facet_bsdf64 *bsdf;
    const double *wo;
} at_view;

static double red_towards(const void *context, const double wi[3])
{
    const at_view *at = context;
    double f[3] = {0};
    facet_bsdf64_eval(at->bsdf, wi, at->wo, f);
    return f[0];
}

static void compare_albedo(const facet_bsdf64 *bsdf, const double wo[3], double *found, double *truth)
{
    double reflected[3] = {NAN}, transmitted[3];
    facet_bsdf64_albedo(bsdf, wo, reflected, transmitted, NULL);
    const at_view at = {bsdf, wo};
    *found = reflected[0];
    *truth = over_mirrored(red_towards, &at, wo, 1e-13);
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
    const bool is_relative = s->term == SEARCH_D || s->term == SEARCH_LAMBDA;
    double m[3] = {(double)r->m[0], (double)r->m[1], (double)r->m[2]};
    if (s->term == SEARCH_ALBEDO) {
        const double length = sqrt(m[0]*m[0] + m[1]*m[1] + m[2]*m[2]);
        for (int k = 0; k < 3; k++) m[k] /= length;
        compare_albedo(&twice, m, &r->found, &r->truth);
    } else {
        const facet_terms found = facet_bsdf_terms(&single, r->m);
        const facet_terms64 truth = facet_bsdf64_terms(&twice, m);
        const double values[SEARCH_ALBEDO][2] = {
            {(double)found.D, truth.D}, {(double)found.Lambda, truth.Lambda}, {(double)found.G1, truth.G1}};
        r->found = values[s->term][0];
        r->truth = values[s->term][1];
    }
    if (is_relative && !(fabs(r->truth) > LEAST_VALUE && fabs(r->truth) < 1e30)) return -1;
    r->error = fabs(r->found - r->truth)/(is_relative ? fabs(r->truth) : 1);
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
    const bool is_slow = term == SEARCH_ALBEDO;
    const int n_climbs = is_slow ? KEPT_ALBEDOS : KEPT, climb = is_slow ? CLIMB_ALBEDO : CLIMB;
    verify_random random = {seed};
    point kept[KEPT];
    for (int i = 0; i < KEPT; i++) kept[i] = (point){.result = {.error = -1}};
    for (int i = 0; i < (is_slow ? evaluations/100 : evaluations); i++) {
        point p;
        for (int k = 0; k < n + 2; k++) p.x[k] = verify_draw(&random);
        error_at(&s, &p);
        keep(kept, &p);
    }
    search_result worst = kept[0].result;
    for (int i = 0; i < n_climbs; i++) {
        point here = kept[i];
        for (int step = 0; step < climb && here.result.error >= 0; step++) {
            point there = here;
            const double size = 0.05*exp(-12.0*step/climb);
            for (int k = 0; k < n + 2; k++)
                there.x[k] = fmin(fmax(here.x[k] + size*(2*verify_draw(&random) - 1), 0), 1);
            if (error_at(&s, &there) > here.result.error) here = there;
        }
        if (here.result.error > worst.error) worst = here.result;
    }
    return worst;
}
