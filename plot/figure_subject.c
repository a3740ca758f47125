/* figure_subject.c: the values of what is plotted: of facet's own materials in double precision, and of measurements
 * and plugins by their functions.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "core/error.h"
#include "plot/figure.h"
#include "verify/integrals.h"

/* Of parts of integrals: convergence shows errors down to this. */
static const double PART = 1e-6;

static bool is_own(const figure_material *m)
{
    return !m->foreign.eval;
}

void figure_eval(const figure_material *m, const double wi[3], const double wo[3], double f[3])
{
    if (is_own(m)) facet_bsdf64_eval(&m->bsdf, wi, wo, f);
    else m->foreign.eval(m->foreign.self, wi, wo, f);
}

double figure_pdf(const figure_material *m, const double wi[3], const double wo[3])
{
    return is_own(m) ? facet_bsdf64_pdf(&m->bsdf, wi, wo) : m->foreign.pdf(m->foreign.self, wi, wo);
}

bool figure_sample(const figure_material *m, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    if (!is_own(m)) {
        memset(weight, 0, 3*sizeof *weight);
        return m->foreign.sample(m->foreign.self, wo, u, wi, weight);
    }
    const facet_sample64 s = facet_bsdf64_sample(&m->bsdf, wo, u);
    memcpy(wi, s.wi, sizeof s.wi);
    memcpy(weight, s.weight, sizeof s.weight);
    return s.pdf > 0;
}

double figure_D(const figure_material *m, const double normal[3])
{
    return is_own(m) ? facet_bsdf64_D(&m->bsdf, normal) : m->foreign.D(m->foreign.self, normal);
}

double figure_G1(const figure_material *m, const double v[3])
{
    return is_own(m) ? facet_bsdf64_terms(&m->bsdf, v).G1 : m->foreign.G1(m->foreign.self, v);
}

double figure_Lambda(const figure_material *m, const double v[3])
{
    return is_own(m) ? facet_bsdf64_terms(&m->bsdf, v).Lambda : 1/m->foreign.G1(m->foreign.self, v) - 1;
}

bool figure_transmits(const figure_material *m)
{
    if (is_own(m)) return facet_bsdf64_lobes(&m->bsdf) & FACET_TRANSMISSION;
    return m->foreign.claims & FACET_CLAIMS_TRANSMITS;
}

/* ---- Albedo ------------------------------------------------------------------------------------ */

typedef struct towards {
    const figure *f;
    const figure_material *m;
    double wo[3];
} towards;

static double value_towards(const void *context, const double wi[3])
{
    const towards *t = context;
    double value[3] = {0, 0, 0};
    t->m->foreign.eval(t->m->foreign.self, wi, t->wo, value);
    return figure_channel_of(t->f, value);
}

static double value_below(const void *context, const double wi[3])
{
    return wi[2] < 0 ? value_towards(context, wi) : 0;
}

void figure_albedo(const figure *f, const figure_material *m, const double wo[3], double *reflected,
                   double *transmitted)
{
    double above[3], below[3];
    if (is_own(m)) {
        facet_bsdf64_albedo(&m->bsdf, wo, above, below, NULL);
        *reflected = figure_channel_of(f, above);
        *transmitted = figure_channel_of(f, below);
        return;
    }
    const towards t = {f, m, {wo[0], wo[1], wo[2]}};
    const double through[3] = {-wo[0], -wo[1], -wo[2]};
    *reflected = over_mirrored(value_towards, &t, wo, PART);
    *transmitted = figure_transmits(m) ? over_sphere(value_below, &t, through, PART) : 0;
}

/* ---- What a kind of figure needs --------------------------------------------------------------- */

bool figure_has_terms(const figure_material *m)
{
    const double n[3] = {0, 0, 1};
    if (!is_own(m)) return m->foreign.D && m->foreign.G1;
    return facet_bsdf64_D(&m->bsdf, n) > 0;
}

facet_status figure_need_terms(const figure *f, const char *what, facet_error *why)
{
    for (size_t k = 0; k < f->n_materials; k++) {
        const figure_material *m = &f->materials[k];
        const bool has_it = is_own(m)                ? figure_has_terms(m)
                            : strcmp(what, "D") == 0 ? m->foreign.D != NULL
                                                     : m->foreign.G1 != NULL;
        if (has_it) continue;
        return facet_error_set(why, FACET_UNSUPPORTED, m->label,
                               "has no distribution of normals, and therefore no %s; ggx, beckmann, phong and gtr "
                               "have one, and plugins that define it",
                               what);
    }
    return FACET_OK;
}

facet_status figure_need_sampler(const figure *f, facet_error *why)
{
    for (size_t k = 0; k < f->n_materials; k++)
        if (!is_own(&f->materials[k]) && !f->materials[k].foreign.sample)
            return facet_error_set(why, FACET_UNSUPPORTED, f->materials[k].label,
                                   "has no sampler to show; facet's models have one, and plugins that define it");
    return FACET_OK;
}

facet_status figure_need_own(const figure *f, const char *what, facet_error *why)
{
    for (size_t k = 0; k < f->n_materials; k++)
        if (!is_own(&f->materials[k]))
            return facet_error_set(why, FACET_UNSUPPORTED, f->materials[k].label,
                                   "is none of facet's models, which alone have %s; `facet materials` lists them",
                                   what);
    return FACET_OK;
}
