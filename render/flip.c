/* flip.c: LDR-FLIP, [flip] in image_metrics.h, with the constants published there; section numbers below
 * are the paper's.  Pixels beyond the border repeat the border's.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "core/error.h"
#include "render/image_metrics.h"
#include "render/texture.h"
#include "render/view.h"

static const double PI = 3.14159265358979323846;
static const double PIXELS_PER_DEGREE = 67;

/* ---- Colour ------------------------------------------------------------------------------------ */

/* Linear sRGB to CIE XYZ relative to its white point D65, so that white is (1,1,1), and back. */
static void rgb_to_xyz(const float rgb[3], float xyz[3])
{
    static const float M[3][3] = {{0.4123866f, 0.3575915f, 0.1804505f},
                                  {0.2126368f, 0.7151830f, 0.0721802f},
                                  {0.0193306f, 0.1191972f, 0.9503726f}};
    for (int i = 0; i < 3; i++)
        xyz[i] = (M[i][0]*rgb[0] + M[i][1]*rgb[1] + M[i][2]*rgb[2])/(M[i][0] + M[i][1] + M[i][2]);
}

static void xyz_to_rgb(const float xyz[3], float rgb[3])
{
    static const float WHITE[3] = {0.9504285f, 1, 1.0889004f};
    static const float M[3][3] = {{3.2410032f, -1.5373990f, -0.4986159f},
                                  {-0.9692243f, 1.8759300f, 0.0415542f},
                                  {0.0556394f, -0.2040112f, 1.0571490f}};
    for (int i = 0; i < 3; i++)
        rgb[i] = M[i][0]*xyz[0]*WHITE[0] + M[i][1]*xyz[1]*WHITE[1] + M[i][2]*xyz[2]*WHITE[2];
}

/* YCxCz, the linear relative of CIELAB in which the eye's filters act (section 4.1.1). */
static void rgb_to_ycxcz(const float rgb[3], float c[3])
{
    float xyz[3];
    rgb_to_xyz(rgb, xyz);
    c[0] = 116*xyz[1] - 16;
    c[1] = 500*(xyz[0] - xyz[1]);
    c[2] = 200*(xyz[1] - xyz[2]);
}

static void ycxcz_to_rgb(const float c[3], float rgb[3])
{
    const float y = (c[0] + 16)/116;
    const float xyz[3] = {y + c[1]/500, y, y - c[2]/200};
    xyz_to_rgb(xyz, rgb);
}

static float lab_curve(float t)
{
    const float d = 6/29.f;
    return t > d*d*d ? cbrtf(t) : t/(3*d*d) + 4/29.f;
}

/* CIELAB of a colour clamped to the screen's gamut, with the Hunt effect: chroma seems weaker in the dark
 * (section 4.1.2). */
static void rgb_to_hunt_lab(const float rgb[3], float lab[3])
{
    float inside[3], xyz[3];
    for (int k = 0; k < 3; k++) inside[k] = fminf(fmaxf(rgb[k], 0), 1);
    rgb_to_xyz(inside, xyz);
    const float x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
    lab[0] = 116*y - 16;
    lab[1] = 0.01f*lab[0]*500*(x - y);
    lab[2] = 0.01f*lab[0]*200*(y - z);
}

/* HyAB, for large colour differences. */
static float hyab(const float p[3], const float q[3])
{
    return fabsf(p[0] - q[0]) + hypotf(p[1] - q[1], p[2] - q[2]);
}

/* ---- Filters ----------------------------------------------------------------------------------- */

enum { LONGEST_RADIUS = 16 };

/* A one-dimensional filter; taps[0..2 radius]. */
typedef struct taps {
    int radius;
    float at[2*LONGEST_RADIUS + 1];
} taps;

typedef struct planes {
    size_t width, height;
    float *scratch; /* one plane */
} planes;

/* out = in filtered along x by fx and along y by fy; in and out have stride 1. */
static void filter(const planes *p, const float *in, const taps *fx, const taps *fy, float *out)
{
    const long w = (long)p->width, h = (long)p->height;
    for (long y = 0; y < h; y++)
        for (long x = 0; x < w; x++) {
            float sum = 0;
            for (int i = -fx->radius; i <= fx->radius; i++) {
                const long j = x + i < 0 ? 0 : x + i >= w ? w - 1 : x + i;
                sum += fx->at[i + fx->radius]*in[y*w + j];
            }
            p->scratch[y*w + x] = sum;
        }
    for (long y = 0; y < h; y++)
        for (long x = 0; x < w; x++) {
            float sum = 0;
            for (int i = -fy->radius; i <= fy->radius; i++) {
                const long j = y + i < 0 ? 0 : y + i >= h ? h - 1 : y + i;
                sum += fy->at[i + fy->radius]*p->scratch[j*w + x];
            }
            out[y*w + x] = sum;
        }
}

/* exp(-pi^2 x^2/b), x in degrees: one Gaussian of a contrast sensitivity filter; *sum is that of its taps. */
static taps sensitivity(double b, double *sum)
{
    taps f = {.radius = (int)ceil(3*sqrt(0.04/(2*PI*PI))*PIXELS_PER_DEGREE)};
    *sum = 0;
    for (int i = -f.radius; i <= f.radius; i++) {
        const double x = i/PIXELS_PER_DEGREE, g = exp(-PI*PI*x*x/b);
        f.at[i + f.radius] = (float)g;
        *sum += g;
    }
    return f;
}

/* Scaled so that the positive taps sum to 1 and the negative ones to -1. */
static void balance(taps *f)
{
    double positive = 0, negative = 0;
    for (int i = 0; i <= 2*f->radius; i++) {
        if (f->at[i] > 0) positive += f->at[i];
        else negative -= f->at[i];
    }
    for (int i = 0; i <= 2*f->radius; i++) f->at[i] = (float)(f->at[i]/(f->at[i] > 0 ? positive : negative));
}

/* Gaussian (normalised) and its first and second derivatives (balanced), for features as wide as the eye
 * resolves them (section 4.2). */
static void feature_filters(taps *smooth, taps *edge, taps *point)
{
    const double deviation = 0.5*0.082*PIXELS_PER_DEGREE;
    const int radius = (int)ceil(3*deviation);
    double sum = 0;
    for (int i = -radius; i <= radius; i++) sum += exp(-i*i/(2*deviation*deviation));
    smooth->radius = edge->radius = point->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        const double g = exp(-i*i/(2*deviation*deviation))/sum;
        smooth->at[i + radius] = (float)g;
        edge->at[i + radius] = (float)(-i*g);
        point->at[i + radius] = (float)((i*i/(deviation*deviation) - 1)*g);
    }
    balance(edge);
    balance(point);
}

/* ---- The two pipelines ------------------------------------------------------------------------- */

/* What one picture goes through, in planes of n floats each. */
typedef struct channels {
    float *y, *cx, *cz;  /* YCxCz, then filtered in place */
    float *edge, *point; /* strength of features */
    float *temporary;
} channels;

/* Filters the three channels by the eye's contrast sensitivity (section 4.1.1, table 1). */
static void filter_colour(const planes *p, const channels *c, size_t n)
{
    static const double a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}};
    static const double b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    float *const plane[3] = {c->y, c->cx, c->cz};
    for (int k = 0; k < 3; k++) {
        double sum[2], weight[2];
        taps f[2];
        for (int i = 0; i < 2; i++) {
            f[i] = sensitivity(b[k][i], &sum[i]);
            weight[i] = a[k][i]*sqrt(PI/b[k][i]);
        }
        const double total = weight[0]*sum[0]*sum[0] + weight[1]*sum[1]*sum[1];
        filter(p, plane[k], &f[0], &f[0], c->temporary);
        if (weight[1] > 0) filter(p, plane[k], &f[1], &f[1], c->edge); /* edge is not in use yet */
        for (size_t i = 0; i < n; i++)
            plane[k][i] = (float)((weight[0]*c->temporary[i] + (weight[1] > 0 ? weight[1]*c->edge[i] : 0))/total);
    }
}

/* Strength of the filter's response in either direction, from the unfiltered lightness in `grey`. */
static void feature(const planes *p, const float *grey, const taps *f, const taps *smooth, float *other, float *out)
{
    filter(p, grey, f, smooth, out);
    filter(p, grey, smooth, f, other);
    for (size_t i = 0; i < p->width*p->height; i++) out[i] = hypotf(out[i], other[i]);
}

static void prepare(const planes *p, const image *picture, channels *c, float *grey)
{
    const size_t n = p->width*p->height;
    const float(*pixel)[3] = (const float(*)[3])picture->pixels;
    for (size_t i = 0; i < n; i++) {
        float rgb[3], ycxcz[3];
        for (int k = 0; k < 3; k++) rgb[k] = srgb_to_linear(fminf(fmaxf(pixel[i][k], 0), 1));
        rgb_to_ycxcz(rgb, ycxcz);
        c->y[i] = ycxcz[0];
        c->cx[i] = ycxcz[1];
        c->cz[i] = ycxcz[2];
        grey[i] = (ycxcz[0] + 16)/116;
    }
    filter_colour(p, c, n);
    taps smooth = {0}, edge = {0}, point = {0};
    feature_filters(&smooth, &edge, &point);
    feature(p, grey, &edge, &smooth, c->temporary, c->edge);
    feature(p, grey, &point, &smooth, c->temporary, c->point);
}

/* The colour difference of a pixel, compressed to [0,1] (section 4.1.3). */
static float colour_error(const channels *a, const channels *b, size_t i, float largest)
{
    const float qc = 0.7f, pc = 0.4f, pt = 0.95f;
    const float ca[3] = {a->y[i], a->cx[i], a->cz[i]}, cb[3] = {b->y[i], b->cx[i], b->cz[i]};
    float rgb[2][3], lab[2][3];
    ycxcz_to_rgb(ca, rgb[0]);
    ycxcz_to_rgb(cb, rgb[1]);
    for (int k = 0; k < 2; k++) rgb_to_hunt_lab(rgb[k], lab[k]);
    const float e = powf(hyab(lab[0], lab[1]), qc), knee = pc*largest;
    return e < knee ? pt*e/knee : pt + (1 - pt)*(e - knee)/(largest - knee);
}

/* The largest colour difference that a screen can show: between its green and its blue. */
static float largest_error(void)
{
    const float green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    float lab[2][3];
    rgb_to_hunt_lab(green, lab[0]);
    rgb_to_hunt_lab(blue, lab[1]);
    return powf(hyab(lab[0], lab[1]), 0.7f);
}

facet_status image_flip(const image *a, const image *b, float *errors, double *mean, facet_error *why)
{
    enum { PER_PICTURE = 6, TOTAL = 2*PER_PICTURE + 2 };
    const size_t n = a->width*a->height;
    if (n == 0 || a->width != b->width || a->height != b->height)
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "flip needs two pictures of one size");
    float *memory = n > SIZE_MAX/(TOTAL*sizeof(float)) ? NULL : malloc(n*TOTAL*sizeof(float));
    if (!memory) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory to compare %zu pixels", n);
    channels c[2];
    for (int k = 0; k < 2; k++) {
        float *base = memory + (size_t)k*PER_PICTURE*n;
        c[k] = (channels){base, base + n, base + 2*n, base + 3*n, base + 4*n, base + 5*n};
    }
    const planes p = {a->width, a->height, memory + (TOTAL - 2)*n};
    prepare(&p, a, &c[0], memory + (TOTAL - 1)*n);
    prepare(&p, b, &c[1], memory + (TOTAL - 1)*n);

    const float largest = largest_error();
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const float edge = fabsf(c[0].edge[i] - c[1].edge[i]), point = fabsf(c[0].point[i] - c[1].point[i]);
        const float feature_error = fminf(sqrtf(fmaxf(edge, point)/sqrtf(2)), 1); /* section 4.2, qf = 1/2 */
        errors[i] = powf(colour_error(&c[0], &c[1], i, largest), 1 - feature_error);
        sum += errors[i];
    }
    *mean = sum/(double)n;
    free(memory);
    return FACET_OK;
}
