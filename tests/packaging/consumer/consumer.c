/* consumer.c: a program of somebody who uses libfacet, in C and in C++: prints a value and the library's version.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>

#include <facet/facet.h>

int main(void)
{
    facet_material material;
    facet_bsdf bsdf;
    facet_error why;
    const float wi[3] = {0, 0.6f, 0.8f}, wo[3] = {0, -0.6f, 0.8f};
    float f[3];
    if (facet_material_parse("ggx alpha=.3 ks=.9,.7,.3", &material, &why) ||
        facet_bsdf_prepare(&material, &bsdf, &why)) {
        fprintf(stderr, "%s: %s\n", why.place, why.text);
        return 1;
    }
    facet_bsdf_eval(&bsdf, wi, wo, f);
    printf("%.4f %.4f %.4f, facet %s\n", (double)f[0], (double)f[1], (double)f[2], facet_version());
    return 0;
}
