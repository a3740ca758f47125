/* check_energy.c: the checks that integrate: normals and light neither appear nor vanish.
 *
 * [heitz14]  Heitz, Understanding the masking-shadowing function in microfacet-based BRDFs, JCGT 2014: the projected
 *            area (eq. 15) and the weak white furnace (eq. 84).
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, EGSR 2007.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "verify/checks.h"
#include "verify/integrals.h"
#include "verify/views.h"

/* Of parts of integrals. */
#define PART 1e-6

/* ---- Functions of a direction, to be integrated ------------------------------------------------ */

static double value_towards(const void *context, const double wi[3])
{
    const at_view *at = context;
    double f[3] = {0}, i[3], o[3];
    turn_over(at, wi, i);
    turn_over(at, at->wo, o);
    at->s->eval(at->s->self, i, o, f);
    return largest_channel(f);
}

static double value_below(const void *context, const double wi[3])
{
    return wi[2] < 0 ? value_towards(context, wi) : 0;
}

static double projected_normal(const void *context, const double m[3])
{
    const verify_subject *s = context;
    return s->D(s->self, m)*m[2];
}

static double normal_towards(const void *context, const double m[3])
{
    const at_view *at = context;
    return at->s->D(at->s->self, m)*(at->wo[0]*m[0] + at->wo[1]*m[1] + at->wo[2]*m[2]);
}

static double visible_normal(const void *context, const double m[3])
{
    const at_view *at = context;
    const double c = at->wo[0]*m[0] + at->wo[1]*m[1] + at->wo[2]*m[2];
    return c > 0 ? at->G1*at->s->D(at->s->self, m)*c : 0;
}

static double weak_furnace_value(const void *context, const double wi[3])
{
    const at_view *at = context;
    double h[3];
    for (int k = 0; k < 3; k++) h[k] = wi[k] + at->wo[k];
    const double length = sqrt(h[0]*h[0] + h[1]*h[1] + h[2]*h[2]);
    if (!(length > 1e-12) || !(h[2] > 0)) return 0;
    for (int k = 0; k < 3; k++) h[k] /= length;
    return at->G1*at->s->D(at->s->self, h)/(4*at->wo[2]);
}

static at_view masked_view_of(const verify_subject *s, const double wo[3])
{
    at_view at = view_of(s, wo);
    if (s->G1) at.G1 = s->G1(s->self, wo);
    return at;
}

double verify_albedo(const verify_subject *s, const double wo[3])
{
    const at_view at = view_of(s, wo);
    const double reflected = over_mirrored(value_towards, &at, at.wo, PART);
    if (!(s->claims & FACET_CLAIMS_TRANSMITS)) return reflected;
    const double through[3] = {-at.wo[0], -at.wo[1], -at.wo[2]};
    return reflected + over_sphere(value_below, &at, through, PART);
}

double verify_weak_furnace(const verify_subject *s, const double wo[3])
{
    if (!s->D || !s->G1) return NAN;
    const at_view at = masked_view_of(s, wo);
    const double mirror[3] = {-wo[0], -wo[1], wo[2]};
    return over_sphere(weak_furnace_value, &at, mirror, PART);
}

double verify_furnace_deviation(const verify_subject *s, double albedo)
{
    if (s->claims & FACET_CLAIMS_LOSSLESS) return fabs(albedo - 1);
    if (s->claims & FACET_CLAIMS_PASSIVE) return albedo <= 1 ? 0 : albedo - 1;
    return NAN;
}

/* ---- The checks -------------------------------------------------------------------------------- */

verify_result check_normalisation(const verify_subject *s)
{
    if (!s->D) return check_leave_out(VERIFY_NORMALISATION, "the model gives no D");
    verify_result r = check_start(s, VERIFY_NORMALISATION);
    const double n[3] = {0, 0, 1}, area = over_normals(projected_normal, s, PART);
    char text[CHECK_NUMBER];
    check_is_worst(&r, fabs(area - 1), n, NULL);
    snprintf(r.found, sizeof r.found, "Int D cos dm = %s", check_number(area, 7, text));
    return r;
}

/* The facets of a level surface project to its area: Int D (v.m) dm = cos_v, and to that with those alone that face
 * v and are not masked. */
verify_result check_projected_area(const verify_subject *s)
{
    if (!s->D) return check_leave_out(VERIFY_PROJECTED_AREA, "the model gives no D");
    verify_result r = check_start(s, VERIFY_PROJECTED_AREA);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views);
    char text[CHECK_NUMBER];
    for (int i = 0; i < n; i++) {
        if (views[i][2] < 0) continue;
        const at_view at = masked_view_of(s, views[i]);
        const double all = over_normals(normal_towards, &at, PART);
        if (check_is_worst(&r, fabs(all - views[i][2]), views[i], NULL))
            snprintf(r.found, sizeof r.found, "Int D (v.m) dm = %s, cos_v = %.6f", check_number(all, 6, text),
                     views[i][2]);
        if (!s->G1) continue;
        const double seen = over_normals(visible_normal, &at, PART*views[i][2])/views[i][2];
        if (check_is_worst(&r, fabs(seen - 1), views[i], NULL))
            snprintf(r.found, sizeof r.found, "G1 Int D (v.m)+ dm/cos_v = %s", check_number(seen, 6, text));
    }
    return r;
}

verify_result check_weak_furnace(const verify_subject *s)
{
    if (!s->D || !s->G1) return check_leave_out(VERIFY_WEAK_FURNACE, "the model gives no D, or no G1");
    verify_result r = check_start(s, VERIFY_WEAK_FURNACE);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views);
    char text[CHECK_NUMBER];
    for (int i = 0; i < n; i++) {
        if (views[i][2] < 0) continue;
        const double sum = verify_weak_furnace(s, views[i]);
        if (check_is_worst(&r, fabs(sum - 1), views[i], NULL))
            snprintf(r.found, sizeof r.found, "Int G1 D/(4 cos_o) = %s", check_number(sum, 6, text));
    }
    return r;
}

verify_result check_furnace(const verify_subject *s)
{
    if (!(s->claims & (FACET_CLAIMS_LOSSLESS | FACET_CLAIMS_PASSIVE)))
        return check_leave_out(VERIFY_FURNACE, "the model does not claim to conserve energy");
    verify_result r = check_start(s, VERIFY_FURNACE);
    double views[VERIFY_MOST_VIEWS][3], highest = 0;
    const int n = verify_views(s, views);
    char text[CHECK_NUMBER];
    for (int i = 0; i < n; i++) {
        const double albedo = verify_albedo(s, views[i]);
        highest = fmax(highest, albedo);
        if (check_is_worst(&r, verify_furnace_deviation(s, albedo), views[i], NULL))
            snprintf(r.found, sizeof r.found, "the albedo is %s", check_number(albedo, 6, text));
    }
    if (r.worst <= 0) snprintf(r.found, sizeof r.found, "the albedo is at most %.6f", highest);
    return r;
}
