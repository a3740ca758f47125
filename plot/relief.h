/* relief.h: surfaces and lines in three dimensions, seen along parallel rays, drawn from the back to the front.
 *
 * Parts that intersect each other may hide each other wrongly, at most by their size.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/canvas.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct relief relief;

/* z is up; the eye is at this azimuth from x and this elevation [degrees].  The box from low to high fills `place`.
 * There is room for n_parts parts: a quad is one of them, a line RELIEF_PIECES. */
enum { RELIEF_PIECES = 12 };
facet_status relief_create(box place, double azimuth, double elevation, const double low[3], const double high[3],
                           size_t n_parts, relief **made, facet_error *why);
void relief_destroy(relief *r);

point relief_at(const relief *r, const double p[3]);

/* A patch lit from above the eye.  Bit i of `edges`: a thin line from corner i to the next one. */
void relief_quad(relief *r, double corners[4][3], colour c, unsigned edges);
void relief_line(relief *r, const double from[3], const double to[3], pen p);

void relief_draw(canvas *page, relief *r);

#ifdef __cplusplus
}
#endif
