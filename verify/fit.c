/* fit.c: parameters as unknowns between 0 and 1, and searches from many starts.
 * SPDX-License-Identifier: MIT */
#include "verify/fit.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "verify/least_squares.h"

enum { MOST_UNKNOWNS = 3*FACET_MAX_PARAMETERS };

/* Ranges of more than this ratio are searched by their logarithms: roughness, gamma, exponents. */
#define WIDE 100

/* Of the sum of squares: rounding of doubles is far below, and what measurements tell far above. */
#define NO_DIFFERENCE 1e-9

/* Searches that end within this part of the least error have found the same. */
#define SAME 1e-3

/* One number of a material. */
typedef struct unknown {
    size_t parameter, component;
    bool is_colour; /* all numbers of it are unknowns of their own */
    bool is_wide;
    double low, high;
} unknown;

typedef struct problem {
    facet_material material;
    size_t n;
    unknown unknowns[MOST_UNKNOWNS];
    size_t n_points, stride; /* of all points, every stride-th */
    const fit_point *points;
} problem;

/* ---- What is to be found --------------------------------------------------------------------------------------- */

static bool is_usual(const char *name)
{
    static const char *const others[] = {"alpha_x", "alpha_y", "anisotropic", "f82",
                                         "ior",     "eta",     "k",           "specular_color"};
    for (size_t i = 0; i < sizeof others/sizeof *others; i++)
        if (strcmp(name, others[i]) == 0) return false;
    return true;
}

fit_keys fit_usual_keys(facet_material *m)
{
    const facet_model_info *model = facet_model_get(m->model);
    fit_keys keys = 0;
    for (size_t k = 0; k < model->n_parameters; k++) {
        const facet_parameter *p = &model->parameters[k];
        if (p->kind == FACET_CHOICE || m->given >> k & 1 || !is_usual(p->name)) continue;
        /* Refused where it excludes something that is given. */
        if (!facet_material_set(m, p->name, p->initial, p->kind == FACET_COLOUR ? 3 : 1, NULL)) keys |= 1u << k;
    }
    return keys;
}

static void list_unknowns(problem *p, fit_keys keys)
{
    const facet_model_info *model = facet_model_get(p->material.model);
    for (size_t k = 0; k < model->n_parameters; k++) {
        const facet_parameter *q = &model->parameters[k];
        const bool is_colour = q->kind == FACET_COLOUR;
        for (size_t c = 0; c < (is_colour ? 3 : 1) && keys >> k & 1; c++)
            p->unknowns[p->n++] = (unknown){k, c, is_colour, q->low > 0 && q->high > WIDE*q->low, q->low, q->high};
    }
}

static double value_of(const unknown *u, double x)
{
    return u->is_wide ? u->low*pow(u->high/u->low, x) : u->low + x*(u->high - u->low);
}

static double place_of(const unknown *u, double value)
{
    const double x = u->is_wide ? log(value/u->low)/log(u->high/u->low) : (value - u->low)/(u->high - u->low);
    return fmin(fmax(x, 0), 1);
}

static void set_unknowns(const problem *p, const double *x, facet_material *m)
{
    for (size_t i = 0; i < p->n; i++) {
        const unknown *u = &p->unknowns[i];
        m->values[u->parameter][u->component] = fmin(fmax(value_of(u, x[i]), u->low), u->high);
    }
}

/* ---- How near it comes ----------------------------------------------------------------------------------------- */

static size_t n_taken(const problem *p)
{
    return (p->n_points - 1)/p->stride + 1;
}

/* A least_squares_function. */
static bool compare(void *user, const double *x, double *residuals)
{
    const problem *p = user;
    facet_material m = p->material;
    facet_bsdf64 bsdf;
    set_unknowns(p, x, &m);
    if (facet_bsdf64_prepare(&m, &bsdf, NULL)) return false;
    for (size_t i = 0; i < p->n_points; i += p->stride) {
        const fit_point *at = &p->points[i];
        double f[3];
        facet_bsdf64_eval(&bsdf, at->wi, at->wo, f);
        for (int c = 0; c < 3; c++) *residuals++ = log1p(f[c]) - log1p(at->value[c]);
    }
    return true;
}

/* ---- Searches -------------------------------------------------------------------------------------------------- */

/* The fraction of i times an irrational number: of each unknown its own. */
static double spread(size_t i, size_t unknown_index)
{
    const double x = (double)i*sqrt((double)(2 + 3*unknown_index)) + 0.5;
    return x - floor(x);
}

/* The defaults, then places in the middle part of the ranges; colours begin grey. */
static void choose_start(const problem *p, size_t i, double *x)
{
    for (size_t k = 0; k < p->n; k++) {
        const unknown *u = &p->unknowns[k];
        if (i == 0) x[k] = place_of(u, p->material.values[u->parameter][u->component]);
        else x[k] = u->is_colour ? 0.1 + 0.6*spread(i, u->parameter) : 0.15 + 0.8*spread(i, u->parameter);
        x[k] = fmin(fmax(x[k], 0.01), 0.99); /* at a bound there may be no way to see the way down */
    }
}

static size_t stride_for(size_t n, size_t most)
{
    return (n - 1)/most + 1;
}

static double search(problem *p, fit_progress *progress, void *user, double *work, double *best, size_t *n_least)
{
    double sums[FIT_STARTS], least = INFINITY;
    for (size_t i = 0; i < FIT_STARTS; i++) {
        double x[MOST_UNKNOWNS];
        if (progress) progress(user, i);
        choose_start(p, i, x);
        sums[i] = least_squares_descend(&(least_squares){p->n, 3*n_taken(p), compare, p, work}, x);
        if (!(sums[i] < least)) continue;
        least = sums[i];
        memcpy(best, x, sizeof x);
    }
    *n_least = 0;
    for (size_t i = 0; i < FIT_STARTS; i++) *n_least += sqrt(sums[i]) <= (1 + SAME)*sqrt(least) + 1e-9;
    return least;
}

/* Sum of squares over all points. */
static double distance(problem *p, const double *x, double *work)
{
    double sum = 0;
    if (!compare(p, x, work)) return INFINITY;
    for (size_t i = 0; i < 3*n_taken(p); i++) sum += work[i]*work[i];
    return sum;
}

/* Gives keys that make no difference their defaults. */
static void drop_idle_keys(problem *p, fit_keys keys, double least, double *best, double *work, facet_material *m)
{
    const facet_model_info *model = facet_model_get(m->model);
    for (size_t k = 0; k < model->n_parameters; k++) {
        double x[MOST_UNKNOWNS];
        if (!(keys >> k & 1)) continue;
        memcpy(x, best, sizeof x);
        for (size_t i = 0; i < p->n; i++) {
            const unknown *u = &p->unknowns[i];
            if (u->parameter == k) x[i] = place_of(u, model->parameters[k].initial[u->component]);
        }
        const unsigned given = p->material.given;
        p->material.given &= ~(1u << k);
        if (distance(p, x, work) <= least*(1 + NO_DIFFERENCE) + NO_DIFFERENCE*NO_DIFFERENCE)
            memcpy(best, x, sizeof x);
        else p->material.given = given;
    }
    *m = p->material;
    set_unknowns(p, best, m);
}

facet_status fit_material(const facet_material *m, fit_keys keys, fit_points points, fit_progress *progress, void *user,
                          fit_result *result, facet_error *why)
{
    problem p = {.material = *m, .n_points = points.n, .points = points.items};
    *result = (fit_result){.material = *m};
    list_unknowns(&p, keys);
    if (p.n == 0) return facet_error_set(why, FACET_BAD_VALUE, "", "nothing is left to be found");
    if (3*points.n < p.n)
        return facet_error_set(why, FACET_BAD_VALUE, "", "%zu values are too few for %zu unknowns", 3*points.n, p.n);
    const size_t most = points.n < FIT_MANY ? points.n : FIT_MANY;
    double *work = malloc((least_squares_room(p.n, 3*most) + 3*points.n)*sizeof *work), best[MOST_UNKNOWNS];
    if (!work) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for %zu points", points.n);
    facet_status status = FACET_OK;
    p.stride = stride_for(points.n, FIT_FEW);
    if (search(&p, progress, user, work, best, &result->n_least) < INFINITY) {
        p.stride = stride_for(points.n, FIT_MANY);
        least_squares_descend(&(least_squares){p.n, 3*n_taken(&p), compare, &p, work}, best);
        p.stride = 1;
        const double least = distance(&p, best, work);
        drop_idle_keys(&p, keys, least, best, work, &result->material);
        result->error = sqrt(least/(3*(double)points.n));
    } else {
        status = facet_error_set(why, FACET_BAD_VALUE, "", "no values of its parameters were accepted");
    }
    free(work);
    return status;
}
