/* 03_sampling.c: drawing directions.  The mean weight of samples is the albedo; the samples, seen from above, go to
 * 03_sampling.svg.
 * SPDX-License-Identifier: MIT */
#include <stdint.h>
#include <stdio.h>

#include "facet/facet.h"

/* Numbers in [0,1) from a 64-bit counter: Weyl's sequence, mixed (splitmix64). */
static float next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30))*0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27))*0x94d049bb133111ebu;
    return (float)((z ^ (z >> 31)) >> 40)*0x1p-24f;
}

int main(void)
{
    facet_material material;
    facet_bsdf bsdf;
    facet_bsdf64 exact;
    facet_error why;
    if (facet_material_parse("gtr alpha=.2 gamma=1.5", &material, &why) || facet_bsdf_prepare(&material, &bsdf, &why) ||
        facet_bsdf64_prepare(&material, &exact, &why))
        return fprintf(stderr, "%s: %s\n", why.place, why.text), 1;
    FILE *const svg = fopen("03_sampling.svg", "w");
    if (!svg) return perror("03_sampling.svg"), 1;
    fprintf(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"320\" height=\"320\">"
                 "<rect width=\"320\" height=\"320\" fill=\"#fff\"/>"
                 "<circle cx=\"160\" cy=\"160\" r=\"150\" fill=\"none\" stroke=\"#999\"/>\n");

    enum { N = 100000, SHOWN = 1500 };
    const float wo[3] = {-0.6f, 0, 0.8f};
    uint64_t state = 1;
    double sum = 0;
    for (int i = 0; i < N; i++) {
        const float u[3] = {next(&state), next(&state), next(&state)};
        const facet_sample s = facet_bsdf_sample(&bsdf, wo, u);
        sum += (double)s.weight[1]; /* 0 where there is no sample */
        if (i < SHOWN && s.pdf > 0)
            fprintf(svg, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.5\" fill=\"#3b6fd4\"/>\n", 160 + 150*(double)s.wi[0],
                    160 - 150*(double)s.wi[1]);
    }
    fprintf(svg, "<circle cx=\"%.1f\" cy=\"160\" r=\"5\" fill=\"#d4703b\"/></svg>\n", 160 + 150*(double)wo[0]);
    if (fclose(svg)) return perror("03_sampling.svg"), 1;

    const double view[3] = {-0.6, 0, 0.8};
    double reflected[3], transmitted[3];
    facet_bsdf64_albedo(&exact, view, reflected, transmitted, NULL);
    printf("mean weight of %d samples %.4f, albedo %.4f\n", N, sum/N, reflected[1]);
    return 0;
}
