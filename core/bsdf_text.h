/* bsdf_text.h: the public functions on a prepared material, written once for both precisions.
 *
 * Included by bsdf_f32.c and bsdf_f64.c, which define FACET_REAL_IS_DOUBLE, and NAME(verb), SAMPLE, TERMS and
 * STORAGE: the public names and types of their precision.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "facet/facet.h"

#include "error.h"
#include "material.h"
#define FACET_PREPARE
#include "model_table.h"
#include "prepared.h"

_Static_assert(LOBE_REFLECTION == FACET_REFLECTION && LOBE_TRANSMISSION == FACET_TRANSMISSION &&
                   LOBE_DIFFUSE == FACET_DIFFUSE && LOBE_GLOSSY == FACET_GLOSSY && LOBE_DELTA == FACET_DELTA,
               "the kernels' lobes are the public ones");

_Static_assert(sizeof(prepared) <= sizeof(STORAGE), "a prepared material fits its public storage");

static const prepared *content(const STORAGE *bsdf)
{
    return (const prepared *)(const void *)bsdf;
}

static real3 load3(const real v[3])
{
    return make3(v[0], v[1], v[2]);
}

static void store3(real to[3], real3 v)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

facet_status NAME(prepare)(const facet_material *material, STORAGE *bsdf, facet_error *why)
{
    if (!bsdf) return facet_error_set(why, FACET_BAD_ARGUMENT, "", "bsdf is NULL");
    const facet_status status = facet_material_check(material, why);
    if (status) return status;
    prepared p;
    memset(&p, 0, sizeof p); /* padding included: equal materials give equal bytes */
    p.model = (int)material->model;
    switch (p.model) {
#define PREPARE_ROW(name, summary, source)                                                                             \
    case MODEL_##name: p.of.name = name##_prepare(material); break;
        FACET_MODELS(PREPARE_ROW)
    }
    memset(bsdf, 0, sizeof *bsdf);
    memcpy(bsdf, &p, sizeof p);
    return FACET_OK;
}

void NAME(eval)(const STORAGE *bsdf, const real wi[3], const real wo[3], real f[3])
{
    const prepared *p = content(bsdf);
    switch (p->model) {
#define EVAL_ROW(name, summary, source)                                                                                \
    case MODEL_##name: store3(f, name##_eval(p->of.name, load3(wi), load3(wo))); break;
        FACET_MODELS(EVAL_ROW)
    }
}

real NAME(pdf)(const STORAGE *bsdf, const real wi[3], const real wo[3])
{
    const prepared *p = content(bsdf);
    switch (p->model) {
#define PDF_ROW(name, summary, source)                                                                                 \
    case MODEL_##name: return name##_pdf(p->of.name, load3(wi), load3(wo));
        FACET_MODELS(PDF_ROW)
    }
    return 0;
}

SAMPLE NAME(sample)(const STORAGE *bsdf, const real wo[3], const real u[3])
{
    const prepared *p = content(bsdf);
    bsdf_sample s = {.pdf = 0};
    switch (p->model) {
#define SAMPLE_ROW(name, summary, source)                                                                              \
    case MODEL_##name: s = name##_sample(p->of.name, load3(wo), load3(u)); break;
        FACET_MODELS(SAMPLE_ROW)
    }
    return (SAMPLE){.wi = {s.wi.x, s.wi.y, s.wi.z},
                    .pdf = s.pdf,
                    .weight = {s.weight.x, s.weight.y, s.weight.z},
                    .lobe = s.lobe,
                    .eta = s.eta};
}

TERMS NAME(terms)(const STORAGE *bsdf, const real m[3])
{
    const prepared *p = content(bsdf);
    real3 t = splat3(0);
    switch (p->model) {
#define TERMS_ROW(name, summary, source)                                                                               \
    case MODEL_##name: t = name##_terms(p->of.name, load3(m)); break;
        FACET_MODELS(TERMS_ROW)
    }
    return (TERMS){.D = t.x, .Lambda = t.y, .G1 = t.z};
}

int NAME(lobes)(const STORAGE *bsdf)
{
    const prepared *p = content(bsdf);
    switch (p->model) {
#define LOBES_ROW(name, summary, source)                                                                               \
    case MODEL_##name: return name##_lobes(p->of.name);
        FACET_MODELS(LOBES_ROW)
    }
    return 0;
}
