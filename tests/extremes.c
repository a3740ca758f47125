/* extremes.c: see extremes.h.
 * SPDX-License-Identifier: MIT */
#include "tests/extremes.h"

#include <stdio.h>

extreme extreme_shape(int i)
{
    static const double gammas[EXTREME_GAMMAS] = {.05, .999, 1, 1.001, 2, 4.5, 20};
    static const double roughnesses[EXTREME_ROUGHNESSES][2] = {{1e-4, 1e-4}, {1, 1}, {1, .1}, {1e-4, 1e-3}};
    static const double phongs[EXTREME_ROUGHNESSES][2] = {{1e-3, 1e-3}, {1, 1}, {1, .1}, {1e-3, 1e-2}};
    static const char *const names[] = {"ggx", "beckmann", "phong"};
    const int kind = i/EXTREME_ROUGHNESSES;
    const double *alpha = (kind == 2 ? phongs : roughnesses)[i%EXTREME_ROUGHNESSES];
    extreme s = {.x = alpha[0], .y = alpha[1]};
    if (kind < 3) snprintf(s.spec, sizeof s.spec, "%s alpha_x=%g alpha_y=%g", names[kind], s.x, s.y);
    else {
        s.gamma = gammas[kind - 3];
        snprintf(s.spec, sizeof s.spec, "gtr alpha_x=%g alpha_y=%g gamma=%g", s.x, s.y, s.gamma);
    }
    return s;
}
