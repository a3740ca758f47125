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
#define PREPARE_WITH(kernel_name, parameters)                                                                          \
    p.kernel = KERNEL_##kernel_name;                                                                                   \
    p.of.kernel_name = parameters;                                                                                     \
    p.variant = kernel_name##_variant(p.of.kernel_name);
    switch (material->model) {
#define PREPARE_ROW(name, kernel_name, summary, source)                                                                \
    case MODEL_##name: PREPARE_WITH(kernel_name, name##_prepare(material)) break;
        FACET_MODELS(PREPARE_ROW)
    }
#define SECOND_ROW(name, kernel_name)                                                                                  \
    if (material->model == MODEL_##name && name##_needs_##kernel_name(material)) {                                     \
        PREPARE_WITH(kernel_name, name##_prepare_##kernel_name(material))                                              \
    }
    FACET_SECOND_KERNELS(SECOND_ROW)
    memset(bsdf, 0, sizeof *bsdf);
    memcpy(bsdf, &p, sizeof p);
    return FACET_OK;
}

/* One function per variant and verb: a large one for all would keep nothing in registers. */
#define VARIANT_VERBS(name, v)                                                                                         \
    static __attribute__((noinline)) void name##_eval_##v(const prepared *p, const real wi[3], const real wo[3],       \
                                                          real f[3])                                                   \
    {                                                                                                                  \
        store3(f, name##_eval(name##_fix(p->of.name, v), load3(wi), load3(wo)));                                       \
    }                                                                                                                  \
    static __attribute__((noinline)) real name##_pdf_##v(const prepared *p, const real wi[3], const real wo[3])        \
    {                                                                                                                  \
        return name##_pdf(name##_fix(p->of.name, v), load3(wi), load3(wo));                                            \
    }                                                                                                                  \
    static __attribute__((noinline))                                                                                   \
    real name##_eval_pdf_##v(const prepared *p, const real wi[3], const real wo[3], real f[3])                         \
    {                                                                                                                  \
        const bsdf_value both = name##_eval_pdf(name##_fix(p->of.name, v), load3(wi), load3(wo));                      \
        store3(f, both.f);                                                                                             \
        return both.pdf;                                                                                               \
    }                                                                                                                  \
    static __attribute__((noinline)) SAMPLE name##_sample_##v(const prepared *p, const real wo[3], const real u[3])    \
    {                                                                                                                  \
        return public_sample(name##_sample(name##_fix(p->of.name, v), load3(wo), load3(u)));                           \
    }
#define VERB_ROWS(name) EACH_VARIANT_##name(VARIANT_VERBS, name)

static SAMPLE public_sample(bsdf_sample s)
{
    return (SAMPLE){.wi = {s.wi.x, s.wi.y, s.wi.z},
                    .pdf = s.pdf,
                    .weight = {s.weight.x, s.weight.y, s.weight.z},
                    .lobe = s.lobe,
                    .eta = s.eta};
}

FACET_KERNELS(VERB_ROWS)

typedef struct verbs {
    void (*eval)(const prepared *p, const real wi[3], const real wo[3], real f[3]);
    real (*pdf)(const prepared *p, const real wi[3], const real wo[3]);
    real (*eval_pdf)(const prepared *p, const real wi[3], const real wo[3], real f[3]);
    SAMPLE (*sample)(const prepared *p, const real wo[3], const real u[3]);
} verbs;

#define TABLE_ENTRY(name, v) [v] = {name##_eval_##v, name##_pdf_##v, name##_eval_pdf_##v, name##_sample_##v},
#define TABLE_ROW(name) [KERNEL_##name] = {EACH_VARIANT_##name(TABLE_ENTRY, name)},
static const verbs verbs_of[KERNEL_COUNT][MICROFACET_VARIANTS] = {FACET_KERNELS(TABLE_ROW)};

static const verbs *verbs_for(const prepared *p)
{
    return &verbs_of[p->kernel][p->variant];
}

void NAME(eval)(const STORAGE *bsdf, const real wi[3], const real wo[3], real f[3])
{
    const prepared *p = content(bsdf);
    verbs_for(p)->eval(p, wi, wo, f);
}

real NAME(pdf)(const STORAGE *bsdf, const real wi[3], const real wo[3])
{
    const prepared *p = content(bsdf);
    return verbs_for(p)->pdf(p, wi, wo);
}

real NAME(eval_pdf)(const STORAGE *bsdf, const real wi[3], const real wo[3], real f[3])
{
    const prepared *p = content(bsdf);
    return verbs_for(p)->eval_pdf(p, wi, wo, f);
}

SAMPLE NAME(sample)(const STORAGE *bsdf, const real wo[3], const real u[3])
{
    const prepared *p = content(bsdf);
    return verbs_for(p)->sample(p, wo, u);
}

TERMS NAME(terms)(const STORAGE *bsdf, const real m[3])
{
    const prepared *p = content(bsdf);
    real3 t = splat3(0);
    switch (p->kernel) {
#define TERMS_ROW(name)                                                                                                \
    case KERNEL_##name: t = name##_terms(p->of.name, load3(m)); break;
        FACET_KERNELS(TERMS_ROW)
    }
    return (TERMS){.D = t.x, .Lambda = t.y, .G1 = t.z};
}

real NAME(D)(const STORAGE *bsdf, const real m[3])
{
    const prepared *p = content(bsdf);
    switch (p->kernel) {
#define D_ROW(name)                                                                                                    \
    case KERNEL_##name: return name##_terms(p->of.name, load3(m)).x; /* the rest is not computed */
        FACET_KERNELS(D_ROW)
    }
    return 0;
}

int NAME(lobes)(const STORAGE *bsdf)
{
    const prepared *p = content(bsdf);
    switch (p->kernel) {
#define LOBES_ROW(name)                                                                                                \
    case KERNEL_##name: return name##_lobes(p->of.name);
        FACET_KERNELS(LOBES_ROW)
    }
    return 0;
}
