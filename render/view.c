/* view.c: the views standard, filmic and agx.
 *
 * standard  clips to [0,1] and encodes with the sRGB curve: exact below 1, harsh above.
 *
 * filmic    per channel, T(x) = m x^c / (x^c + s), c = 1.2, then the sRGB curve: a hyperbola in log
 *           exposure (Naka and Rushton's response of the eye), which falls off towards black as film does
 *           in its toe and never quite clips.  s and m follow from two anchors: middle grey stays where it
 *           is, T(0.18) = 0.18, and T(16) = 1, six and a half stops above.  T(1) = 0.64.
 *
 * agx       in the manner of Troy Sobotka's AgX: colours are first drawn towards grey (an inset of the
 *           gamut by 20 %), so that bright saturated lights go to white instead of clipping to a pure hue;
 *           then log2 exposure from 10 stops below middle grey to 6.5 above is mapped to [0,1] and bent by
 *           a sigmoid of slope 2.4 through middle grey.  Both halves of the sigmoid are
 *           k f(slope d/k), f(x) = x/(1 + x^p)^(1/p), d the distance from middle grey, where k makes the
 *           half end at 0 or 1 exactly.  Its result is a display value of gamma 2.2.
 *
 * SPDX-License-Identifier: MIT */
#include "render/view.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "render/texture.h"

static const float MIDDLE_GREY = 0.18f;

bool view_find(const char *name, view *found)
{
    static const char *const names[] = {"standard", "filmic", "agx"};
    for (int i = 0; i < 3; i++)
        if (strcmp(name, names[i]) == 0) {
            *found = (view)i;
            return true;
        }
    return false;
}

float srgb_encode(float linear)
{
    return linear <= 0.0031308f ? 12.92f*linear : 1.055f*powf(linear, 1/2.4f) - 0.055f;
}

/* ---- filmic ------------------------------------------------------------------------------------ */

static float filmic(float x)
{
    /* With g = 0.18^c, w = 16^c: m (g/(g + s)) = 0.18 and m = 1 + s/w, solved for s. */
    const float c = 1.2f, g = 0.12774003f, w = 27.857618f;
    const float s = g*(1 - MIDDLE_GREY)/(MIDDLE_GREY - g/w), m = 1 + s/w;
    if (x >= 16) return 1;
    const float p = powf(x, c);
    return fminf(m*p/(p + s), 1);
}

/* ---- agx --------------------------------------------------------------------------------------- */

/* One half of the sigmoid: from 0 with the given slope to `end` at distance `reach`. */
static float sigmoid_half(float d, float slope, float reach, float end)
{
    const float p = 1.5f, x = slope*d;
    const float k = powf(powf(end, -p) - powf(slope*reach, -p), -1/p);
    if (d >= reach) return end;
    return x <= 0 ? 0 : fminf(x*powf(1 + powf(x/k, p), -1/p), end);
}

static float agx_curve(float x)
{
    const float stops_below = 10, stops_above = 6.5f, slope = 2.4f;
    const float range = stops_below + stops_above;
    const float grey = 0.45865645f; /* 0.18^(1/2.2) */
    const float stops = x > 0 ? log2f(x/MIDDLE_GREY) : -stops_below;
    const float d = fminf(fmaxf(stops, -stops_below), stops_above)/range;
    return d < 0 ? grey - sigmoid_half(-d, slope, stops_below/range, grey)
                 : grey + sigmoid_half(d, slope, stops_above/range, 1 - grey);
}

/* ---- Pixels and pictures ----------------------------------------------------------------------- */

void view_pixel(view v, float exposure, const float linear[3], float display[3])
{
    const float gain = exp2f(exposure);
    float c[3];
    for (int k = 0; k < 3; k++) c[k] = linear[k] > 0 ? fminf(linear[k]*gain, 1e30f) : 0; /* NaN: 0 */
    if (v == VIEW_AGX) {
        const float inset = 0.2f, mean = (c[0] + c[1] + c[2])/3;
        for (int k = 0; k < 3; k++) c[k] += inset*(mean - c[k]);
    }
    for (int k = 0; k < 3; k++) switch (v) {
        case VIEW_STANDARD: display[k] = srgb_encode(fminf(c[k], 1)); break;
        case VIEW_FILMIC: display[k] = srgb_encode(filmic(c[k])); break;
        case VIEW_AGX: display[k] = srgb_encode(powf(agx_curve(c[k]), 2.2f)); break;
        }
}

/* Memory for n_values values of `size` bytes, as the pixels of an RGB picture. */
static facet_status rgb_like(const image *model, pixel_type type, image *picture, facet_error *why)
{
    const size_t size = type == PIXEL_U8 ? 1 : sizeof(float);
    if (model->height == 0 || model->width > IMAGE_PIXEL_CAP/model->height)
        return facet_error_set(why, FACET_BAD_ARGUMENT, "",
                               "the picture has %zu x %zu pixels, which is none or too many", model->width,
                               model->height);
    *picture = (image){model->width, model->height, 3, type, malloc(model->width*model->height*3*size)};
    if (!picture->pixels && model->width)
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a picture of %zu x %zu pixels", model->width,
                               model->height);
    return FACET_OK;
}

facet_status view_picture(view v, float exposure, const image *linear, pixel_type type, image *display,
                          facet_error *why)
{
    if (linear->type != PIXEL_F32 || linear->n_channels != 3 || type == PIXEL_U16)
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "view_picture turns F32 RGB into F32 or U8 RGB");
    image result;
    const facet_status status = rgb_like(linear, type, &result, why);
    if (status) return status;
    const float(*in)[3] = (const float(*)[3])linear->pixels;
    for (size_t i = 0; i < linear->width*linear->height; i++) {
        float shown[3];
        view_pixel(v, exposure, in[i], shown);
        for (int k = 0; k < 3; k++) {
            if (type == PIXEL_U8) ((uint8_t *)result.pixels)[3*i + (size_t)k] = (uint8_t)(255*shown[k] + 0.5f);
            else ((float *)result.pixels)[3*i + (size_t)k] = shown[k];
        }
    }
    *display = result;
    return FACET_OK;
}

/* Value i of a picture, linear. */
static float linear_value(const image *picture, size_t i)
{
    switch (picture->type) {
    case PIXEL_U8: return srgb_to_linear((float)((const uint8_t *)picture->pixels)[i]/255);
    case PIXEL_U16: return srgb_to_linear((float)((const uint16_t *)picture->pixels)[i]/65535);
    case PIXEL_F32: break;
    }
    return ((const float *)picture->pixels)[i];
}

facet_status image_to_linear(const image *picture, image *linear, facet_error *why)
{
    image result;
    const facet_status status = rgb_like(picture, PIXEL_F32, &result, why);
    if (status) return status;
    const size_t n = picture->n_channels;
    float *out = result.pixels;
    for (size_t i = 0; i < picture->width*picture->height; i++)
        for (size_t k = 0; k < 3; k++) out[3*i + k] = linear_value(picture, n*i + (n >= 3 ? k : 0));
    *linear = result;
    return FACET_OK;
}
