/* texture.h: looking up pictures.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* RGBA at (u,v) of the texture's image, decoded to linear in [0,1] for integer images; missing channels as
 * PNG means them: grey repeats, alpha is 1.  u and v may be anything finite. */
typedef struct texel {
    float c[4];
} texel;
texel texture_lookup(const scene *s, const texture *t, float u, float v);

/* sRGB's transfer curve: from encoded to linear, [0,1].  IEC 61966-2-1. */
float srgb_to_linear(float encoded);

#ifdef __cplusplus
}
#endif
