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

#define LANE_LOOPS(name, kind)                                                                                         \
    static void name##_lanes_eval(const prepared *p, const lane_block *b, facet_dirs wi, facet_dirs wo, facet_rgb f)   \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        float *restrict const red = f.r, *restrict const green = f.g, *restrict const blue = f.b;                      \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const real3 v = microfacet_eval(params_of_lane(common, kind, b, i), gather(wi, i), gather(wo, i));         \
            red[i] = v.x;                                                                                              \
            green[i] = v.y;                                                                                            \
            blue[i] = v.z;                                                                                             \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_lanes_pdf(const prepared *p, const lane_block *b, facet_dirs wi, facet_dirs wo, float *pdf)     \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        float *restrict const out = pdf;                                                                               \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
            out[i] = microfacet_pdf(params_of_lane(common, kind, b, i), gather(wi, i), gather(wo, i));                 \
    }                                                                                                                  \
    static void name##_lanes_eval_pdf(const prepared *p, const lane_block *b, facet_dirs wi, facet_dirs wo,            \
                                      facet_rgb f, float *pdf)                                                         \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        float *restrict const red = f.r, *restrict const green = f.g, *restrict const blue = f.b;                      \
        float *restrict const out = pdf;                                                                               \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const microfacet_params q = params_of_lane(common, kind, b, i);                                            \
            const real3 to_light = gather(wi, i), to_viewer = gather(wo, i);                                           \
            const real3 v = microfacet_eval(q, to_light, to_viewer);                                                   \
            const real density = microfacet_pdf(q, to_light, to_viewer);                                               \
            red[i] = v.x;                                                                                              \
            green[i] = v.y;                                                                                            \
            blue[i] = v.z;                                                                                             \
            out[i] = density;                                                                                          \
        }                                                                                                              \
    }                                                                                                                  \
    static void name##_lanes_sample(const prepared *p, const lane_block *b, facet_dirs wo, facet_dirs u,               \
                                    facet_samples to)                                                                  \
    {                                                                                                                  \
        const microfacet_params common = p->of.microfacet;                                                             \
        _Pragma("omp simd") for (size_t i = 0; i < b->n; i++)                                                          \
        {                                                                                                              \
            const bsdf_sample s = microfacet_sample(params_of_lane(common, kind, b, i), gather(wo, i), gather(u, i));  \
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
