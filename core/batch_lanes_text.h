/* batch_lanes_text.h: the batch loops with parameters that vary.  Included by batch_text.h.
 * SPDX-License-Identifier: MIT */
#include "kernel/microfacet_lane.h"

/* In the order of NDF_GGX, NDF_BECKMANN, NDF_PHONG and NDF_GTR. */
#define LANE_KINDS(X) X(ggx, NDF_GGX) X(beckmann, NDF_BECKMANN) X(phong, NDF_PHONG) X(gtr, NDF_GTR_DIRECT)

/* The parameters of element i.  `kind` is a constant. */
KERNEL microfacet_params params_of_lane(microfacet_params p, int kind, const lane_block *b, size_t i)
{
    const microfacet_lane lane = {.alpha_x = b->alpha_x[i],
                                  .alpha_y = b->alpha_y[i],
                                  .gamma = b->gamma[i],
                                  .kd = make3(b->kd[0][i], b->kd[1][i], b->kd[2][i]),
                                  .ks = make3(b->ks[0][i], b->ks[1][i], b->ks[2][i])};
    microfacet_params q = p;
    q.d.kind = kind;
    return microfacet_at_lane(q, lane);
}

/* gtr integrates Lambda for each element, in stages; the others find their terms where they are used. */
#define LANE_TERMS(kind) (kind == NDF_GTR_DIRECT ? terms_of(&t, i) : microfacet_terms_at(q, to_light, to_viewer))

/* The terms of gtr at directions and the sums of them, in stages (batch_microfacet_text.h). */
static __attribute__((noinline)) void gtr_lane_terms(const lane_block *b, facet_dirs wi, facet_dirs wo, block_terms *t)
{
    const size_t n = b->n, whole = whole_vectors(n);
    float alpha[BLOCK], mu_i[BLOCK], mu_o[BLOCK];
    for (size_t i = n; i < whole; i++) alpha[i] = mu_i[i] = mu_o[i] = 1;
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const gtr_shape g = gtr_elementary_shape(b->alpha_x[i], b->alpha_y[i], b->gamma[i]);
        const real3 light = gather(wi, i), viewer = gather(wo, i);
        alpha[i] = g.alpha;
        mu_i[i] = gtr_cot(light, g);
        mu_o[i] = gtr_cot(viewer, g);
        t->D[i] = gtr_D(add3(light, viewer), g);
    }
    gtr_direct_block(whole, alpha, b->gamma, mu_i, t->sigma_i);
    gtr_direct_block(whole, alpha, b->gamma, mu_o, t->sigma_o);
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        t->sigma_i[i] = wi.z[i]*(1 + t->sigma_i[i]);
        t->sigma_o[i] = wo.z[i]*(1 + t->sigma_o[i]);
    }
    t->drawn_D = t->D;
    t->drawn_sigma = t->sigma_o;
}

#define LANE_LOOPS(name, kind)                                                                                         \
    static void name##_lanes_eval(const prepared *p, const lane_block *b, facet_dirs wi, facet_dirs wo, facet_rgb f)   \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        float *restrict const red = f.r, *restrict const green = f.g, *restrict const blue = f.b;                      \
        block_terms t;                                                                                                 \
        if (kind == NDF_GTR_DIRECT) gtr_lane_terms(b, wi, wo, &t);                                                     \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const microfacet_params q = params_of_lane(common, kind, b, i);                                            \
            const real3 to_light = gather(wi, i), to_viewer = gather(wo, i);                                           \
            const real3 v = microfacet_eval_with(q, LANE_TERMS(kind), to_light, to_viewer);                            \
            red[i] = v.x;                                                                                              \
            green[i] = v.y;                                                                                            \
            blue[i] = v.z;                                                                                             \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_lanes_pdf(const prepared *p, const lane_block *b, facet_dirs wi, facet_dirs wo, float *pdf)     \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        float *restrict const out = pdf;                                                                               \
        block_terms t;                                                                                                 \
        if (kind == NDF_GTR_DIRECT) gtr_lane_terms(b, wi, wo, &t);                                                     \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const microfacet_params q = params_of_lane(common, kind, b, i);                                            \
            const real3 to_light = gather(wi, i), to_viewer = gather(wo, i);                                           \
            out[i] = microfacet_pdf_with(q, LANE_TERMS(kind), to_light, to_viewer);                                    \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_lanes_eval_pdf(const prepared *p, const lane_block *b, facet_dirs wi, facet_dirs wo,            \
                                      facet_rgb f, float *pdf)                                                         \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        float *restrict const red = f.r, *restrict const green = f.g, *restrict const blue = f.b;                      \
        float *restrict const out = pdf;                                                                               \
        block_terms t;                                                                                                 \
        if (kind == NDF_GTR_DIRECT) gtr_lane_terms(b, wi, wo, &t);                                                     \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const microfacet_params q = params_of_lane(common, kind, b, i);                                            \
            const real3 to_light = gather(wi, i), to_viewer = gather(wo, i);                                           \
            const bsdf_value both = microfacet_eval_pdf_with(q, LANE_TERMS(kind), to_light, to_viewer);                \
            red[i] = both.f.x;                                                                                         \
            green[i] = both.f.y;                                                                                       \
            blue[i] = both.f.z;                                                                                        \
            out[i] = both.pdf;                                                                                         \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_lanes_sample(const prepared *p, const lane_block *b, facet_dirs wo, facet_dirs u,               \
                                    facet_samples to)                                                                  \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        block_terms t;                                                                                                 \
        block_vectors normals, lights;                                                                                 \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const microfacet_params q = params_of_lane(common, kind, b, i);                                            \
            const real3 m = microfacet_sample_normal(q, gather(wo, i), gather(u, i));                                  \
            scatter(&normals, i, m);                                                                                   \
            scatter(&lights, i, microfacet_sample_direction(q, gather(wo, i), gather(u, i), m));                       \
        }                                                                                                              \
        if (kind == NDF_GTR_DIRECT) gtr_lane_terms(b, dirs_of(&lights), wo, &t);                                       \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const microfacet_params q = params_of_lane(common, kind, b, i);                                            \
            const real3 to_light = gather(dirs_of(&lights), i), to_viewer = gather(wo, i);                             \
            const bsdf_sample s = microfacet_complete(q, LANE_TERMS(kind), to_light, to_viewer, gather(u, i),          \
                                                      gather(dirs_of(&normals), i));                                   \
            to.wi_x[i] = s.wi.x;                                                                                       \
            to.wi_y[i] = s.wi.y;                                                                                       \
            to.wi_z[i] = s.wi.z;                                                                                       \
            to.pdf[i] = s.pdf;                                                                                         \
            to.weight_r[i] = s.weight.x;                                                                               \
            to.weight_g[i] = s.weight.y;                                                                               \
            to.weight_b[i] = s.weight.z;                                                                               \
        }                                                                                                              \
    }
LANE_KINDS(LANE_LOOPS)

#define LANES_EVAL_ENTRY(name, kind) name##_lanes_eval,
#define LANES_PDF_ENTRY(name, kind) name##_lanes_pdf,
#define LANES_EVAL_PDF_ENTRY(name, kind) name##_lanes_eval_pdf,
#define LANES_SAMPLE_ENTRY(name, kind) name##_lanes_sample,
