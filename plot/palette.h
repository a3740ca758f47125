/* palette.h: colours that those who confuse some colours tell apart, too.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* sRGB, 0 to 1. */
typedef struct colour {
    double r, g, b, alpha;
} colour;

static const colour BLACK = {0.1, 0.1, 0.1, 1}, GREY = {0.45, 0.45, 0.45, 1}, LIGHT_GREY = {0.87, 0.87, 0.87, 1},
                    WHITE = {1, 1, 1, 1};

/* The k-th colour for lines and points; they repeat after PALETTE_COLOURS. */
enum { PALETTE_COLOURS = 7 };
colour palette_colour(size_t k);

/* A colour for t in [0, 1], dark to light in even steps of perceived lightness; values outside count as the ends, NaN
 * is grey. */
colour sequential_colour(double t);

/* A colour for t in [-1, 1]: blue through white at 0 to orange. */
colour diverging_colour(double t);

/* Linear Rec.709 to sRGB by a power of 1/2.2, clipped to [0, 1]. */
colour tone(const double linear[3]);

#ifdef __cplusplus
}
#endif
