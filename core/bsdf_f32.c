/* bsdf_f32.c: prepared materials in single precision, and two models straight from their values.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 0
#define NAME(verb) facet_bsdf_##verb
#define STORAGE facet_bsdf
#define SAMPLE facet_sample
#define TERMS facet_terms
#include "bsdf_text.h"

facet_bsdf facet_bsdf_metallic_roughness(const float base_color[3], float metallic, float roughness,
                                         float dielectric_F0, float specular, const float specular_color[3])
{
    prepared p = {.kernel = KERNEL_metallic_roughness};
    p.of.metallic_roughness = metallic_roughness_of(load3(base_color), metallic, roughness, dielectric_F0, specular,
                                                    load3(specular_color));
    facet_bsdf bsdf;
    memcpy(&bsdf, &p, offsetof(prepared, of) + sizeof p.of.metallic_roughness);
    return bsdf;
}

facet_bsdf facet_bsdf_glass(float ior, const float tint[3], int is_thin)
{
    prepared p = {.kernel = KERNEL_glass};
    p.of.glass = (glass_params){.eta = ior, .tint = load3(tint), .wall = is_thin ? WALL_THIN : WALL_SOLID};
    facet_bsdf bsdf;
    memcpy(&bsdf, &p, offsetof(prepared, of) + sizeof p.of.glass);
    return bsdf;
}
