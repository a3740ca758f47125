/* texture.c: nearest and bilinear lookups in 8-bit, 16-bit and float pictures, in their own storage.
 * SPDX-License-Identifier: MIT */
#include "render/texture.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>

#include "render/geometry.h"

float srgb_to_linear(float encoded)
{
    return encoded <= 0.04045f ? encoded/12.92f : kpow((encoded + 0.055f)/1.055f, 2.4f);
}

/* An index brought into [0, n) as the wrap mode says. */
static size_t wrap_index(int64_t i, size_t n, texture_wrap wrap)
{
    const int64_t size = (int64_t)n;
    if (i >= 0 && i < size) return (size_t)i;
    if (wrap == WRAP_CLAMP) return (size_t)(i < 0 ? 0 : i >= size ? size - 1 : i);
    const int64_t period = wrap == WRAP_MIRROR ? 2*size : size;
    int64_t k = i%period;
    if (k < 0) k += period;
    return (size_t)(k < size ? k : period - 1 - k);
}

/* What the bytes of a picture mean: as they are, and as sRGB. */
static float values_of_bytes[2][256];
static pthread_once_t has_values = PTHREAD_ONCE_INIT;

static void tabulate_bytes(void)
{
    for (int i = 0; i < 256; i++) {
        values_of_bytes[0][i] = (float)i/255;
        values_of_bytes[1][i] = srgb_to_linear((float)i/255);
    }
}

static float channel(const image *picture, size_t index, bool is_srgb)
{
    switch (picture->type) {
    case PIXEL_U8: return values_of_bytes[is_srgb][((const uint8_t *)picture->pixels)[index]];
    case PIXEL_U16: {
        const float value = (float)((const uint16_t *)picture->pixels)[index]/65535;
        return is_srgb ? srgb_to_linear(value) : value;
    }
    case PIXEL_F32: break;
    }
    return ((const float *)picture->pixels)[index];
}

static texel fetch(const image *picture, size_t x, size_t y, bool is_srgb)
{
    const size_t n = picture->n_channels;
    const size_t base = (y*picture->width + x)*n;
    if (picture->type == PIXEL_U8 && n >= 3) { /* the usual */
        const uint8_t *bytes = (const uint8_t *)picture->pixels + base;
        const float *values = values_of_bytes[is_srgb];
        return (texel){
            {values[bytes[0]], values[bytes[1]], values[bytes[2]], n == 4 ? values_of_bytes[0][bytes[3]] : 1}};
    }
    texel t = {{0, 0, 0, 1}};
    t.c[0] = channel(picture, base, is_srgb);
    for (size_t k = 1; k < 3; k++) t.c[k] = n >= 3 ? channel(picture, base + k, is_srgb) : t.c[0];
    if (n == 2 || n == 4) t.c[3] = channel(picture, base + n - 1, false);
    return t;
}

/* Coordinates beyond this have no fractional texels left in float; they are taken as the border. */
static float bounded(float coordinate)
{
    return kmin(kmax(coordinate, -1e6f), 1e6f);
}

texel texture_lookup(const scene *s, const texture *t, float u, float v)
{
    pthread_once(&has_values, tabulate_bytes);
    const image *picture = &s->images[t->image];
    const float x = bounded(u)*(float)picture->width, y = bounded(v)*(float)picture->height;
    if (t->is_nearest)
        return fetch(picture, wrap_index((int64_t)floorf(x), picture->width, t->wrap_u),
                     wrap_index((int64_t)floorf(y), picture->height, t->wrap_v), t->is_srgb);
    const float x0 = floorf(x - 0.5f), y0 = floorf(y - 0.5f);
    const float fx = x - 0.5f - x0, fy = y - 0.5f - y0;
    const size_t columns[2] = {wrap_index((int64_t)x0, picture->width, t->wrap_u),
                               wrap_index((int64_t)x0 + 1, picture->width, t->wrap_u)};
    const size_t rows[2] = {wrap_index((int64_t)y0, picture->height, t->wrap_v),
                            wrap_index((int64_t)y0 + 1, picture->height, t->wrap_v)};
    texel sum = {{0, 0, 0, 0}};
    for (int corner = 0; corner < 4; corner++) {
        const int i = corner & 1, j = corner >> 1;
        const float weight = (i ? fx : 1 - fx)*(j ? fy : 1 - fy);
        const texel one = fetch(picture, columns[i], rows[j], t->is_srgb);
        for (int k = 0; k < 4; k++) sum.c[k] += weight*one.c[k];
    }
    return sum;
}
