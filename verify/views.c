/* views.c: see views.h.
 * SPDX-License-Identifier: MIT */
#include "verify/views.h"

#include <math.h>

int verify_views(const verify_subject *s, double views[VERIFY_MOST_VIEWS][3])
{
    static const double cosines[] = {1, .95, .7, .4, .15, .04};
    static const double azimuths[] = {.3, 1.9, 4};
    const int n_azimuths = s->claims & FACET_CLAIMS_ISOTROPIC ? 1 : 3;
    const int n_sides = s->claims & FACET_CLAIMS_TRANSMITS ? 2 : 1;
    int n = 0;
    for (int side = 0; side < n_sides; side++)
        for (int c = 0; c < 6; c++)
            for (int a = 0; a < (c ? n_azimuths : 1); a++) {
                verify_direction(cosines[c], azimuths[a], views[n]);
                if (side) views[n][2] = -views[n][2];
                n++;
            }
    return n;
}

double verify_draw(verify_random *r)
{
    uint64_t z = (r->state += UINT64_C(0x9e3779b97f4a7c15)); /* splitmix64 */
    z = (z ^ (z >> 30))*UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27))*UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11)*0x1p-53;
}
