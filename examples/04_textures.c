/* 04_textures.c: parameters that differ from element to element, in one batch: roughness grows to the right, the
 * tail shrinks downwards.  04_textures.svg shows f cos of GTR, with the light 12 degrees beside the mirror direction.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "facet/facet.h"

enum { WIDTH = 40, HEIGHT = 20, N = WIDTH*HEIGHT };

static float alpha[N], gamma_[N], zero[N], sine_i[N], cos_i[N], sine_o[N], cos_o[N], f[3][N];

int main(void)
{
    facet_material material;
    facet_bsdf bsdf;
    facet_error why;
    if (facet_material_parse("gtr ks=.9", &material, &why) || facet_bsdf_prepare(&material, &bsdf, &why))
        return fprintf(stderr, "%s: %s\n", why.place, why.text), 1;
    const double view = 0.5, light = 0.5 + 12*0.017453292519943295;
    for (int i = 0; i < N; i++) {
        alpha[i] = 0.02f + 0.6f*(float)(i%WIDTH)/WIDTH;
        gamma_[i] = 0.5f + 4*(float)(i/WIDTH)/HEIGHT;
        sine_i[i] = (float)sin(light);
        cos_i[i] = (float)cos(light);
        sine_o[i] = (float)-sin(view);
        cos_o[i] = (float)cos(view);
    }

    const facet_lanes lanes = {.struct_size = sizeof lanes, .alpha_x = alpha, .alpha_y = alpha, .gamma = gamma_};
    const facet_dirs wi = {sine_i, zero, cos_i}, wo = {sine_o, zero, cos_o};
    if (facet_bsdf_eval_lanes(&bsdf, &lanes, N, wi, wo, (facet_rgb){f[0], f[1], f[2]}, &why))
        return fprintf(stderr, "%s: %s\n", why.place, why.text), 1;

    FILE *const svg = fopen("04_textures.svg", "w");
    if (!svg) return perror("04_textures.svg"), 1;
    fprintf(svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\" height=\"200\" shape-rendering=\"crispEdges\">\n");
    float most = 0;
    for (int i = 0; i < N; i++) most = fmaxf(most, f[1][i]);
    for (int i = 0; i < N; i++) {
        const int grey = (int)(255*sqrtf(f[1][i]/most));
        fprintf(svg, "<rect x=\"%d\" y=\"%d\" width=\"10\" height=\"10\" fill=\"rgb(%d,%d,%d)\"/>\n", 10*(i%WIDTH),
                10*(i/WIDTH), grey, grey*9/10, grey*7/10);
    }
    fprintf(svg, "</svg>\n");
    if (fclose(svg)) return perror("04_textures.svg"), 1;
    printf("f cos: at most %.3f /sr\n", (double)most);
    return 0;
}
