/* checks.h: what the checks of verify.h share.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A check that passes so far, with verify_tolerance; and one that cannot be made. */
verify_result check_start(const verify_subject *s, verify_check check);
verify_result check_leave_out(verify_check check, const char *why);

/* Keeps the largest deviation, and fails the check if it is above the tolerance; NaN counts as infinite.  wi: NULL
 * where the check is of a whole view.  Whether it is the largest so far. */
bool check_is_worst(verify_result *r, double deviation, const double wo[3], const double *wi);

/* A number of so many decimals, in powers of ten if it is so large that its digits would fill a line. */
enum { CHECK_NUMBER = 32 };
const char *check_number(double x, int n_decimals, char text[CHECK_NUMBER]);

double largest_channel(const double f[3]);

/* Sample number k of those that a seed gives. */
bool draw_numbered(const verify_subject *s, uint64_t seed, uint64_t number, const double wo[3], double wi[3],
                   double weight[3]);

/* A view for integrals over the hemisphere above: the subject is turned over if wo is below. */
typedef struct at_view {
    const verify_subject *s;
    double wo[3]; /* above */
    double side;  /* of the subject's wo: 1 or -1 */
    double G1;    /* of wo, for those who need it */
} at_view;

at_view view_of(const verify_subject *s, const double wo[3]);

/* v on the subject's side. */
void turn_over(const at_view *at, const double v[3], double turned[3]);

/* check_energy.c */
verify_result check_normalisation(const verify_subject *s);
verify_result check_projected_area(const verify_subject *s);
verify_result check_weak_furnace(const verify_subject *s);
verify_result check_furnace(const verify_subject *s);

/* check_sampler.c */
verify_result check_pdf(const verify_subject *s, const verify_settings *settings);
verify_result check_chi_square(const verify_subject *s, const verify_settings *settings);
verify_result check_weight(const verify_subject *s, const verify_settings *settings);
verify_result check_efficiency(const verify_subject *s, const verify_settings *settings);

#ifdef __cplusplus
}
#endif
