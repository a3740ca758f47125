/* bsdf_f32.c: prepared materials in single precision, two models straight from their values, and parameters as words.
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

facet_bsdf facet_bsdf_glass(float ior, float alpha, const float tint[3], int is_thin)
{
    prepared p;
    size_t size;
    const int wall = is_thin ? WALL_THIN : WALL_SOLID;
    if (is_rough_interface(ior, alpha)) {
        p.kernel = KERNEL_rough_dielectric;
        p.of.rough_dielectric = (rough_dielectric_params){
            .d = {.kind = NDF_GGX, .alpha_x = alpha, .alpha_y = alpha}, .eta = ior, .tint = load3(tint), .wall = wall};
        p.variant = rough_dielectric_variant(p.of.rough_dielectric);
        size = sizeof p.of.rough_dielectric;
    } else {
        p.kernel = KERNEL_glass;
        p.of.glass = (glass_params){.eta = ior, .tint = load3(tint), .wall = wall};
        p.variant = 0;
        size = sizeof p.of.glass;
    }
    facet_bsdf bsdf;
    memcpy(&bsdf, &p, offsetof(prepared, of) + size);
    return bsdf;
}

size_t facet_bsdf_words(const facet_bsdf *bsdf, size_t n, uint32_t *words)
{
#define SIZE_ROW(name) [KERNEL_##name] = sizeof(name##_params),
    static const size_t sizes[] = {FACET_KERNELS(SIZE_ROW)};
    const prepared *p = content(bsdf);
    const size_t size = sizes[p->kernel];
    const size_t n_there = size/sizeof *words;
    if (n > n_there) memset(words + n_there, 0, (n - n_there)*sizeof *words);
    if (n > 0) memcpy(words, &p->of, n < n_there ? n*sizeof *words : size);
    return n_there;
}

const char *facet_bsdf_kernel(const facet_bsdf *bsdf)
{
#define KERNEL_NAME_ROW(name) [KERNEL_##name] = #name,
    static const char *const names[] = {FACET_KERNELS(KERNEL_NAME_ROW)};
    return names[content(bsdf)->kernel];
}
