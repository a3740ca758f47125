/* 11_your_renderer.c: libfacet in a path tracer of one's own: a ball of long-tailed copper on a floor, under a sun and
 * a sky.  How the two reflect is libfacet's; everything else is here.  Writes 11_your_renderer.svg.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "facet/facet.h"

enum { WIDTH = 60, HEIGHT = 40, SAMPLES = 128, DEPTH = 5 };

typedef struct vec {
    float x, y, z;
} vec;
static const vec sun = {-0.36f, 0.8f, 0.48f}; /* unit length, towards it */

static vec along(vec o, vec d, float t)
{
    return (vec){o.x + t*d.x, o.y + t*d.y, o.z + t*d.z};
}

static float dot(vec a, vec b)
{
    return a.x*b.x + a.y*b.y + a.z*b.z;
}

static float next(unsigned *state) /* in [0,1), by a linear congruence */
{
    return (float)((*state = *state*1664525 + 1013904223) >> 8)*0x1p-24f;
}

/* The ball (0) of radius 1, the floor (1) at y = -1, or nothing (-1): the point and the normal. */
static int hit(vec o, vec d, vec *p, vec *n)
{
    const float b = dot(o, d), root = b*b - dot(o, o) + 1, t = root > 0 ? -b - sqrtf(root) : -1;
    *p = along(o, d, t > 0 ? t : (-1 - o.y)/d.y);
    *n = t > 0 ? *p : (vec){0, 1, 0};
    return t > 0 ? 0 : d.y < 0 ? 1 : -1;
}

/* Tangents to a normal (Duff et al. 2017).  libfacet wants directions in this frame, where the normal is (0, 0, 1). */
static void frame(vec n, vec *t, vec *b)
{
    const float sign = n.z < 0 ? -1 : 1, a = -1/(sign + n.z), c = n.x*n.y*a;
    *t = (vec){1 + sign*n.x*n.x*a, sign*c, -sign*n.x};
    *b = (vec){c, sign + n.y*n.y*a, -n.y};
}

static void radiance(const facet_bsdf bsdf[2], vec o, vec d, unsigned *state, float L[3])
{
    float carried[3] = {1, 1, 1}, f[3];
    vec p, n, t, b, q;
    for (int depth = 0; depth < DEPTH; depth++) {
        const int what = hit(o, d, &p, &n);
        for (int c = 0; what < 0 && c < 3; c++)
            L[c] += carried[c]*(0.4f + ((float)c - 1)*0.15f*d.y + 0.5f*d.y*d.y);
        if (what < 0) return;
        frame(n, &t, &b);
        o = along(p, n, 1e-4f);
        const float wo[3] = {-dot(d, t), -dot(d, b), -dot(d, n)}, wi[3] = {dot(sun, t), dot(sun, b), dot(sun, n)};
        facet_bsdf_eval(&bsdf[what], wi, wo, f); /* the cosine is in it; 0 if the sun is behind the surface */
        for (int c = 0; c < 3 && hit(o, sun, &q, &q) < 0; c++) L[c] += carried[c]*f[c]*3;
        const float u[3] = {next(state), next(state), next(state)};
        const facet_sample s = facet_bsdf_sample(&bsdf[what], wo, u);
        if (s.pdf == 0) return;
        for (int c = 0; c < 3; c++) carried[c] *= s.weight[c];
        d = along(along(along((vec){0, 0, 0}, t, s.wi[0]), b, s.wi[1]), n, s.wi[2]);
    }
}

int main(void)
{
    static const char *const texts[2] = {"gtr alpha=.15 gamma=1.2 ks=.95,.64,.54", "lambert kd=.5"};
    facet_bsdf bsdf[2];
    for (int i = 0; i < 2; i++) {
        facet_material material;
        facet_error why;
        if (facet_material_parse(texts[i], &material, &why) || facet_bsdf_prepare(&material, &bsdf[i], &why))
            return fprintf(stderr, "%s: %s: %s\n", texts[i], why.place, why.text), 1;
    }
    FILE *const svg = fopen("11_your_renderer.svg", "w");
    if (!svg) return perror("11_your_renderer.svg"), 1;
    fprintf(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"480\" height=\"320\" viewBox=\"0 -.5 60 40\">\n");
    unsigned state = 1;
    for (int i = 0; i < WIDTH*HEIGHT; i++) {
        float L[3] = {0, 0, 0};
        for (int k = 0; k < SAMPLES; k++) {
            const float x = ((float)(i%WIDTH) + next(&state))/HEIGHT - 0.75f,
                        y = 0.5f - ((float)(i/WIDTH) + next(&state))/HEIGHT, l = sqrtf(x*x + y*y + 1.96f);
            radiance(bsdf, (vec){0, 0.2f, 4}, (vec){x/l, y/l, -1.4f/l}, &state, L);
        }
        int rgb[3];
        for (int c = 0; c < 3; c++) rgb[c] = (int)(255*fminf(1, sqrtf(L[c]/SAMPLES)));
        fprintf(svg, "<path stroke=\"rgb(%d,%d,%d)\" d=\"M%d %dh1\"/>\n", rgb[0], rgb[1], rgb[2], i%WIDTH, i/WIDTH);
    }
    fprintf(svg, "</svg>\n");
    if (fclose(svg)) return perror("11_your_renderer.svg"), 1;
    printf("11_your_renderer.svg: %d samples a pixel\n", SAMPLES);
    return 0;
}
