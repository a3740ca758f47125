/* draws.c: see draws.h.
 * SPDX-License-Identifier: MIT */
#include "tests/draws.h"

#include <math.h>

#include "tests/any_bsdf.h"

uint64_t draw_bits(draws *d)
{
    d->state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t z = d->state;
    z = (z ^ (z >> 30))*UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27))*UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

double draw(draws *d)
{
    return (double)(draw_bits(d) >> 40)*0x1p-24;
}

double draw_between(draws *d, double low, double high)
{
    return low + (high - low)*draw(d);
}

double draw_log(draws *d, double low, double high)
{
    return exp(draw_between(d, log(low), log(high)));
}

void draw_direction(draws *d, double v[3])
{
    const double cos_theta = 1 - draw(d);
    any_direction(cos_theta, 6.283185307179586*draw(d), v);
}
