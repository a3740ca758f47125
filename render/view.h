/* view.h: from linear radiance to what a screen shows.
 *
 * A view maps linear Rec.709 colour to display values in [0,1], sRGB encoded.  Every view is monotone in
 * each channel and keeps neutral greys neutral; what is negative or NaN counts as 0.  The formulas are in
 * view.c and in docs/cli.md.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum view { VIEW_STANDARD, VIEW_FILMIC, VIEW_AGX } view;

/* "standard", "filmic", "agx"; false for any other name. */
bool view_find(const char *name, view *found);

/* The sRGB curve (IEC 61966-2-1) on [0,1], the inverse of texture.h's srgb_to_linear. */
float srgb_encode(float linear);

/* One pixel, after multiplication by 2^exposure. */
void view_pixel(view v, float exposure, const float linear[3], float display[3]);

/* A whole F32 RGB picture; *display becomes F32 RGB (not yet rounded) or U8 RGB, and is the caller's to
 * destroy.  FACET_NO_MEMORY; FACET_BAD_ARGUMENT for a picture of another kind. */
facet_status view_picture(view v, float exposure, const image *linear, pixel_type type, image *display,
                          facet_error *why);

/* Any picture as linear F32 RGB: U8 and U16 are decoded from sRGB, grey is repeated, alpha is dropped. */
facet_status image_to_linear(const image *picture, image *linear, facet_error *why);

#ifdef __cplusplus
}
#endif
