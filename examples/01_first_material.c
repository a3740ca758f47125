/* 01_first_material.c: a material from its text form, evaluated for one pair of directions.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "facet/facet.h"

int main(void)
{
    facet_material material;
    facet_bsdf bsdf;
    facet_error why;
    if (facet_material_parse("ggx alpha=.3 ks=.9,.7,.3", &material, &why) || facet_bsdf_prepare(&material, &bsdf, &why))
        return fprintf(stderr, "%s: %s\n", why.place, why.text), 1;
    const float wi[3] = {0, 0.6f, 0.8f}, wo[3] = {0, -0.6f, 0.8f};
    float f[3];
    facet_bsdf_eval(&bsdf, wi, wo, f); /* f |cos theta_i| */
    printf("%.4f %.4f %.4f, pdf %.4f\n", f[0], f[1], f[2], facet_bsdf_pdf(&bsdf, wi, wo));
    return 0;
}
