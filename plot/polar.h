/* polar.h: curves over an angle around a point, as lobes are drawn.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/chart.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The chart with x as the angle to the upright [degrees], to the right, and y as the distance; the lower half is there
 * if the axis of x goes beyond 90 degrees. */
void polar_draw(canvas *page, box place, const chart *c);

#ifdef __cplusplus
}
#endif
