/* lanes.c: batches whose parameters vary from element to element.
 *
 * The elements go in blocks through the loops of batch_lanes_text.h, which read every parameter from an array: what
 * does not vary is filled in.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 0
#include "batch.h"
#include "error.h"
#include "prepared.h"

_Static_assert(NDF_GGX == 0 && NDF_BECKMANN == 1 && NDF_PHONG == 2 && NDF_GTR == 3 && NDF_COUNT == BATCH_LANE_KINDS,
               "batch_lanes_text.h has the distributions in this order");

/* What a call works on. */
typedef struct lane_call {
    const prepared *p;
    const facet_lanes *lanes;
    float alpha_x, alpha_y, gamma; /* where they do not vary */
    real3 kd, ks;
    float lowest, highest; /* roughness */
} lane_call;

static int is_colour_incomplete(const float *const c[3])
{
    const int n = (c[0] != NULL) + (c[1] != NULL) + (c[2] != NULL);
    return n != 0 && n != 3;
}

static facet_status begin(const facet_bsdf *bsdf, const facet_lanes *lanes, lane_call *call, facet_error *why)
{
    if (!bsdf) return facet_error_set(why, FACET_BAD_ARGUMENT, "", "bsdf is NULL");
    if (!lanes) return facet_error_set(why, FACET_BAD_ARGUMENT, "", "lanes is NULL");
    if (lanes->struct_size != sizeof *lanes)
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "lanes->struct_size is not sizeof(facet_lanes)");
    const prepared *p = (const prepared *)(const void *)bsdf;
    if (p->kernel != KERNEL_microfacet)
        return facet_error_set(why, FACET_UNSUPPORTED, "",
                               "only microfacet models have parameters that vary: ggx, "
                               "beckmann, phong, gtr, cs500 and vray");
    const microfacet_params *m = &p->of.microfacet;
    if (m->d.masking != MASKING_EXACT)
        return facet_error_set(why, FACET_UNSUPPORTED, "masking", "must be exact where parameters vary");
    if (m->ms.kind != ENERGY_SINGLE)
        return facet_error_set(why, FACET_UNSUPPORTED, "energy", "must be single where parameters vary");
    if (distribution_is_disney(m->d))
        return facet_error_set(why, FACET_UNSUPPORTED, "anisotropy", "must be stretch where parameters vary");
    if (!lanes->alpha_x != !lanes->alpha_y)
        return facet_error_set(why, FACET_BAD_ARGUMENT, lanes->alpha_x ? "alpha_y" : "alpha_x",
                               "is NULL; give both, the same array twice for an isotropic surface");
    if (lanes->gamma && m->d.kind != NDF_GTR)
        return facet_error_set(why, FACET_BAD_ARGUMENT, "gamma", "only gtr has it");
    if (is_colour_incomplete(lanes->kd) || is_colour_incomplete(lanes->ks))
        return facet_error_set(why, FACET_BAD_ARGUMENT, is_colour_incomplete(lanes->kd) ? "kd" : "ks",
                               "has a channel that is NULL; give red, green and blue, or none");
    if (lanes->ks[0] && m->F.kind != FRESNEL_SCHLICK)
        return facet_error_set(why, FACET_BAD_ARGUMENT, "ks", "the material has another Fresnel term than ks");
    const int is_phong = m->d.kind == NDF_PHONG, is_gtr = m->d.kind == NDF_GTR;
    const float mean = is_phong ? ksqrt(2/(m->d.phong.exponent + 2)) : 1;
    *call = (lane_call){.p = p,
                        .lanes = lanes,
                        .alpha_x = mean*m->d.alpha_x,
                        .alpha_y = mean*m->d.alpha_y,
                        .gamma = m->d.gtr.gamma,
                        .kd = m->kd,
                        .ks = fresnel_reflectance(m->F, 1),
                        .lowest = is_phong ? 1e-3f : 1e-4f,
                        .highest = is_phong || is_gtr ? 1.0f : 4.0f};
    return FACET_OK;
}

/* n values of `from`, held in the range, or n times `value` where it is NULL. */
static void fill(float *restrict to, size_t n, const float *from, float value, float lowest, float highest)
{
    for (size_t i = 0; i < n; i++) to[i] = from ? kclamp(from[i], lowest, highest) : value;
    for (size_t i = n; i < LANES_BLOCK; i++) to[i] = value; /* vectors reach beyond the last element */
}

/* The block of elements that starts at `first`, of n in all. */
static void fill_block(const lane_call *call, size_t first, size_t n, lane_block *b)
{
    const facet_lanes *l = call->lanes;
    const float kd[3] = {call->kd.x, call->kd.y, call->kd.z}, ks[3] = {call->ks.x, call->ks.y, call->ks.z};
    b->n = n - first < LANES_BLOCK ? n - first : LANES_BLOCK;
    fill(b->alpha_x, b->n, l->alpha_x ? l->alpha_x + first : NULL, call->alpha_x, call->lowest, call->highest);
    fill(b->alpha_y, b->n, l->alpha_y ? l->alpha_y + first : NULL, call->alpha_y, call->lowest, call->highest);
    fill(b->gamma, b->n, l->gamma ? l->gamma + first : NULL, call->gamma, 1e-3f, 20);
    for (int k = 0; k < 3; k++) {
        fill(b->kd[k], b->n, l->kd[k] ? l->kd[k] + first : NULL, kd[k], 0, 1);
        fill(b->ks[k], b->n, l->ks[k] ? l->ks[k] + first : NULL, ks[k], 0, 1);
    }
}

static facet_dirs dirs_at(facet_dirs d, size_t first)
{
    return (facet_dirs){d.x + first, d.y + first, d.z + first};
}

static facet_rgb rgb_at(facet_rgb f, size_t first)
{
    return (facet_rgb){f.r + first, f.g + first, f.b + first};
}

static facet_samples samples_at(facet_samples s, size_t first)
{
    return (facet_samples){s.wi_x + first,     s.wi_y + first,     s.wi_z + first,    s.pdf + first,
                           s.weight_r + first, s.weight_g + first, s.weight_b + first};
}

facet_status facet_bsdf_eval_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n, facet_dirs wi,
                                   facet_dirs wo, facet_rgb f, facet_error *why)
{
    lane_call call;
    const facet_status status = begin(bsdf, lanes, &call, why);
    if (status) return status;
    lane_block b;
    for (size_t first = 0; first < n; first += b.n) {
        fill_block(&call, first, n, &b);
        facet_batch_loops()->lanes_eval[call.p->of.microfacet.d.kind](call.p, &b, dirs_at(wi, first),
                                                                      dirs_at(wo, first), rgb_at(f, first));
    }
    return FACET_OK;
}

facet_status facet_bsdf_pdf_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n, facet_dirs wi,
                                  facet_dirs wo, float *pdf, facet_error *why)
{
    lane_call call;
    const facet_status status = begin(bsdf, lanes, &call, why);
    if (status) return status;
    lane_block b;
    for (size_t first = 0; first < n; first += b.n) {
        fill_block(&call, first, n, &b);
        facet_batch_loops()->lanes_pdf[call.p->of.microfacet.d.kind](call.p, &b, dirs_at(wi, first), dirs_at(wo, first),
                                                                     pdf + first);
    }
    return FACET_OK;
}

facet_status facet_bsdf_eval_pdf_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n, facet_dirs wi,
                                       facet_dirs wo, facet_rgb f, float *pdf, facet_error *why)
{
    lane_call call;
    const facet_status status = begin(bsdf, lanes, &call, why);
    if (status) return status;
    lane_block b;
    for (size_t first = 0; first < n; first += b.n) {
        fill_block(&call, first, n, &b);
        facet_batch_loops()->lanes_eval_pdf[call.p->of.microfacet.d.kind](
            call.p, &b, dirs_at(wi, first), dirs_at(wo, first), rgb_at(f, first), pdf + first);
    }
    return FACET_OK;
}

facet_status facet_bsdf_sample_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n, facet_dirs wo,
                                     facet_dirs u, facet_samples samples, facet_error *why)
{
    lane_call call;
    const facet_status status = begin(bsdf, lanes, &call, why);
    if (status) return status;
    lane_block b;
    for (size_t first = 0; first < n; first += b.n) {
        fill_block(&call, first, n, &b);
        facet_batch_loops()->lanes_sample[call.p->of.microfacet.d.kind](call.p, &b, dirs_at(wo, first),
                                                                        dirs_at(u, first), samples_at(samples, first));
    }
    return FACET_OK;
}
