/* palette.c: Okabe and Ito's colours for lines, and colour maps by their perceived lightness.
 *
 * Okabe and Ito, Color Universal Design, 2008 (without its yellow, which a white page swallows).  The maps are arcs in
 * Oklab (Ottosson, A perceptual color space for image processing, 2020).
 * SPDX-License-Identifier: MIT */
#include "plot/palette.h"

#include <math.h>

colour palette_colour(size_t k)
{
    static const colour colours[PALETTE_COLOURS] = {
        {0, 0.447, 0.698, 1},     /* blue */
        {0.835, 0.369, 0, 1},     /* vermilion */
        {0, 0.620, 0.451, 1},     /* bluish green */
        {0.800, 0.475, 0.655, 1}, /* reddish purple */
        {0.902, 0.624, 0, 1},     /* orange */
        {0.1, 0.1, 0.1, 1},       /* black */
        {0.337, 0.706, 0.914, 1}, /* sky blue */
    };
    return colours[k%PALETTE_COLOURS];
}

static double clip(double value)
{
    return value > 0 ? fmin(value, 1) : 0;
}

/* The sRGB curve, IEC 61966-2-1. */
static double encode(double linear)
{
    return linear <= 0.0031308 ? 12.92*linear : 1.055*pow(linear, 1/2.4) - 0.055;
}

/* Lightness in [0, 1], chroma, and hue [degrees]. */
static colour from_oklab(double lightness, double chroma, double hue)
{
    const double angle = hue*3.14159265358979323846/180, a = chroma*cos(angle), b = chroma*sin(angle);
    const double l = pow(lightness + 0.3963377774*a + 0.2158037573*b, 3);
    const double m = pow(lightness - 0.1055613458*a - 0.0638541728*b, 3);
    const double s = pow(lightness - 0.0894841775*a - 1.2914855480*b, 3);
    return (colour){encode(clip(4.0767416621*l - 3.3077115913*m + 0.2309699292*s)),
                    encode(clip(-1.2684380046*l + 2.6097574011*m - 0.3413193965*s)),
                    encode(clip(-0.0041960863*l - 0.7034186147*m + 1.7076147010*s)), 1};
}

colour sequential_colour(double t)
{
    if (isnan(t)) return LIGHT_GREY;
    t = clip(t);
    return from_oklab(0.28 + 0.66*t, 0.10 + 0.07*t, 305 - 200*t);
}

colour diverging_colour(double t)
{
    if (isnan(t)) return LIGHT_GREY;
    const double strength = fmin(fabs(t), 1);
    return from_oklab(0.98 - 0.53*strength, 0.14*strength, t < 0 ? 255 : 45);
}

colour tone(const double linear[3])
{
    return (colour){pow(clip(linear[0]), 1/2.2), pow(clip(linear[1]), 1/2.2), pow(clip(linear[2]), 1/2.2), 1};
}
