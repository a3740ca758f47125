/* all_models.c: every model with its defaults, on every instruction set, at a grid of directions: a hash of the bits of
 * all results, to compare two builds of libfacet.
 * SPDX-License-Identifier: MIT */
#include <stdint.h>
#include <stdio.h>

#include <facet/facet.h>

enum { N = 12 };

static const float alphas[] = {1e-3f, 0.3f};

static uint64_t hash = 0xcbf29ce484222325u;

static void take(const void *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++) hash = (hash ^ ((const unsigned char *)bytes)[i])*0x100000001b3u; /* FNV-1a */
}

/* Directions with whole coordinates over 7: (2,3,6), (6,2,3), ... with all signs. */
static void make_directions(float w[3][N])
{
    static const float whole[3] = {2, 3, 6};
    for (int i = 0; i < N; i++)
        for (int k = 0; k < 3; k++) w[k][i] = whole[(i + k)%3]/7*((i >> k & 1) && k < 2 ? -1 : 1);
}

static void take_bsdf(const facet_bsdf *bsdf, float w[3][N])
{
    const facet_dirs dirs = {w[0], w[1], w[2]};
    float f[3][N], pdf[N];
    for (int i = 0; i < N; i++) {
        const float wi[3] = {w[0][i], w[1][i], w[2][i]}, wo[3] = {0, 0.6f, 0.8f}, u[3] = {0.3f, (float)i/N, 0.6f};
        float one[3];
        const float density = facet_bsdf_eval_pdf(bsdf, wi, wo, one);
        const facet_sample s = facet_bsdf_sample(bsdf, wi, u);
        take(one, sizeof one);
        take(&density, sizeof density);
        take(s.wi, sizeof s.wi);
        take(s.weight, sizeof s.weight);
    }
    facet_bsdf_eval_pdf_batch(bsdf, N, dirs, dirs, (facet_rgb){f[0], f[1], f[2]}, pdf);
    take(f, sizeof f);
    take(pdf, sizeof pdf);
}

int main(void)
{
    float w[3][N];
    make_directions(w);
    for (size_t isa = 0; facet_isa_name(isa); isa++) {
        if (facet_isa_force(facet_isa_name(isa))) return 1;
        for (size_t k = 0; k < facet_model_count(); k++)
            for (size_t i = 0; i < sizeof alphas/sizeof *alphas; i++) {
                facet_material material;
                facet_bsdf bsdf;
                const double alpha = (double)alphas[i];
                if (facet_material_defaults(facet_model_get(k)->name, &material, NULL)) return 1;
                facet_material_set(&material, "alpha", &alpha, 1, NULL); /* not every model has it */
                if (facet_bsdf_prepare(&material, &bsdf, NULL)) return 1;
                take_bsdf(&bsdf, w);
            }
        printf("%s %016llx\n", facet_isa_name(isa), (unsigned long long)hash);
    }
    return 0;
}
