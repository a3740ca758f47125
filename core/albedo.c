/* albedo.c: the share of light that a material reflects and transmits, by quadrature.
 *
 * The albedo of wo is the integral of f(wi,wo) |cos theta_i| over wi.  It is taken over the normal m that mirrors wo
 * into wi, or refracts it, because lobes are narrow around m = n and smooth there:
 *     mirrored    wi = 2 (wo.m) m - wo,                   d wi = 4 (wo.m) dm                      [walter07, eq. 14]
 *     refracted   wi = -(wo + (g - wo.m) m)/eta,          d wi = (g - wo.m)^2/(eta g) dm          [walter07, eq. 17]
 *                 g = sqrt(eta^2 - 1 + (wo.m)^2), eta = n_i/n_o
 *     thin        the mirrored wi, turned over to the other side.
 * The integral runs over the azimuth phi of m from wo's and the logarithm of its angle theta, in which a lobe of any
 * width is as smooth as another, nested, each by the adaptive Gauss-Kronrod rule of 21 points.  Where wi crosses the
 * horizon theta ends, at (pi/2 + atan2(sin theta_o cos phi, cos theta_o))/2 for the mirrored wi.
 * Delta lobes (mirrors, smooth glass) have no integrand: their directions are found by sampling.
 *
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, EGSR 2007.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "facet/facet.h"

static const double PI = 3.14159265358979323846;

/* A colour and, beside it, the error that is known of it. */
typedef struct estimate {
    double rgb[3], error;
} estimate;

static void add(estimate *sum, double weight, const estimate *x)
{
    for (int k = 0; k < 3; k++) sum->rgb[k] += weight*x->rgb[k];
    sum->error += weight*x->error;
}

static double distance(const estimate *a, const estimate *b)
{
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, fabs(a->rgb[k] - b->rgb[k]));
    return most;
}

/* ---- Quadrature -------------------------------------------------------------------------------- */

typedef estimate (*integrand)(const void *context, double x);

/* Points of Kronrod's rule from the end to the middle, its weights, and Gauss's for every other point (QUADPACK). */
static const double points[11] = {0.995657163025808080735527280689003,
                                  0.973906528517171720077964012084452,
                                  0.930157491355708226001207180059508,
                                  0.865063366688984510732096688423493,
                                  0.780817726586416897063717578345042,
                                  0.679409568299024406234327365114874,
                                  0.562757134668604683339000099272694,
                                  0.433395394129247190799265943165784,
                                  0.294392862701460198131126603103866,
                                  0.148874338981631210884826001129720,
                                  0};
static const double kronrod_weights[11] = {
    0.011694638867371874278064396062192, 0.032558162307964727478818972459390, 0.054755896574351996031381300244580,
    0.075039674810919952767043140916190, 0.093125454583697605535065465083366, 0.109387158802297641899210590325805,
    0.123491976262065851077958109585166, 0.134709217311473325928054001771707, 0.142775938577060080797094273138717,
    0.147739104901338491374841515972068, 0.149445554002916905664936468389821};
static const double gauss_weights[5] = {0.066671344308688137593568809893332, 0.149451349150580593145863396957658,
                                        0.219086362515982043995534934228163, 0.269266719309996355091226921569469,
                                        0.295524224714752870173815619188769};

/* sum += the integral over [low, high], halved until Gauss's and Kronrod's rules agree within the tolerance (absolute,
 * of each part), at most `depth` times; their difference is added to the error. */
static void integrate(integrand f, const void *context, double low, double high, double tolerance, int depth,
                      estimate *sum)
{
    const double middle = 0.5*(low + high), half = 0.5*(high - low);
    estimate kronrod = {{0}, 0}, gauss = {{0}, 0};
    for (int i = 0; i < 11; i++)
        for (int side = i < 10 ? -1 : 1; side <= 1; side += 2) {
            const estimate value = f(context, middle + side*half*points[i]);
            add(&kronrod, half*kronrod_weights[i], &value);
            if (i%2) add(&gauss, half*gauss_weights[i/2], &value);
        }
    const double error = distance(&kronrod, &gauss);
    if (error <= tolerance || depth == 0) {
        add(sum, 1, &kronrod);
        sum->error += error;
    } else {
        integrate(f, context, low, middle, tolerance, depth - 1, sum);
        integrate(f, context, middle, high, tolerance, depth - 1, sum);
    }
}

/* ---- The integral over normals ----------------------------------------------------------------- */

typedef enum chart { MIRRORED, REFRACTED, THIN } chart;

typedef struct view {
    const facet_bsdf64 *bsdf;
    double wo[3];
    double cosine, sine; /* of the angle between wo and the normal on its side */
    double azimuth[2];   /* cosine and sine of wo's azimuth */
    double side;         /* 1 above the surface, -1 below */
    double tolerance;    /* of one part of an integral over theta; over phi four times as much */
    chart chart;
    double eta; /* REFRACTED: n_i/n_o */
} view;

typedef struct meridian {
    const view *v;
    double cos_phi, sin_phi; /* of the azimuth of m from that of wo */
} meridian;

/* The direction that the normal m sends wo to, for a viewer above, and d wi/dm; 0 if it does not get there. */
static double scatter(const view *v, const double m[3], double wi[3])
{
    const double c = v->sine*m[0] + v->cosine*m[2]; /* wo.m */
    const double eta2_1 = (v->eta - 1)*(v->eta + 1), g2 = eta2_1 + c*c;
    if (!(c > 0)) return 0;
    if (v->chart == REFRACTED) {
        if (!(g2 > 0)) return 0;
        const double g = sqrt(g2), bend = eta2_1/(g + c);
        wi[0] = -(v->sine + bend*m[0])/v->eta;
        wi[1] = -bend*m[1]/v->eta;
        wi[2] = -(v->cosine + bend*m[2])/v->eta;
        return wi[2] < 0 ? bend*bend/(v->eta*g) : 0;
    }
    wi[0] = 2*c*m[0] - v->sine;
    wi[1] = 2*c*m[1];
    wi[2] = 2*c*m[2] - v->cosine;
    if (!(wi[2] > 0)) return 0;
    if (v->chart == THIN) wi[2] = -wi[2];
    return 4*c;
}

/* f |cos theta_i| dwi/dm sin theta dtheta/dx at theta = e^x. */
static estimate at_normal(const void *context, double x)
{
    const meridian *at = context;
    const view *v = at->v;
    const double theta = exp(x), sine = sin(theta);
    const double m[3] = {sine*at->cos_phi, sine*at->sin_phi, cos(theta)};
    double local[3] = {0};
    estimate value = {{0}, 0};
    const double jacobian = scatter(v, m, local)*sine*theta;
    if (!(jacobian > 0)) return value;
    const double wi[3] = {v->azimuth[0]*local[0] - v->azimuth[1]*local[1],
                          v->azimuth[1]*local[0] + v->azimuth[0]*local[1], v->side*local[2]};
    facet_bsdf64_eval(v->bsdf, wi, v->wo, value.rgb);
    for (int k = 0; k < 3; k++) value.rgb[k] *= jacobian;
    return value;
}

/* The integral over theta at one azimuth.  What is left out at theta < 1e-9 is below (1e-9/alpha)^2, 1e-10. */
static estimate at_azimuth(const void *context, double phi)
{
    static const double starts[] = {1e-9, 1e-5, 1e-3, .03, .3};
    const view *v = context;
    const meridian at = {v, cos(phi), sin(phi)};
    const double horizon = (PI/2 + atan2(v->sine*at.cos_phi, v->cosine))/2;
    const double end = v->chart == REFRACTED ? PI/2 : horizon;
    estimate sum = {{0}, 0};
    for (int i = 0; i < 5; i++) {
        const double low = starts[i], high = i < 4 ? fmin(starts[i + 1], end) : end;
        if (low < high) integrate(at_normal, &at, log(low), log(high), v->tolerance, 30, &sum);
    }
    return sum;
}

static estimate over_normals(const view *v)
{
    estimate sum = {{0}, 0};
    for (int quarter = 0; quarter < 4; quarter++)
        integrate(at_azimuth, v, quarter*PI/2, (quarter + 1)*PI/2, 4*v->tolerance, 30, &sum);
    return sum;
}

/* ---- The lobes of a material ------------------------------------------------------------------- */

/* The numbers u[2] that choose among lobes: both ends, where the least likely lobes are, and between. */
enum { N_PICKS = 66 };
static double pick(int i)
{
    return i == 0 ? 0 : i < N_PICKS - 1 ? (i - 0.5)/(N_PICKS - 2) : 1 - 0x1p-53;
}

/* n_i/n_o of what the material refracts when seen from that side; 1 if it only lets light pass straight.  Found at
 * normal incidence, where nothing is totally reflected. */
static double transmitted_index(const facet_bsdf64 *bsdf, double side)
{
    const double wo[3] = {0, 0, side};
    double eta = 1;
    for (int i = 0; i < N_PICKS; i++) {
        const double u[3] = {0.5, 0.25, pick(i)};
        const facet_sample64 s = facet_bsdf64_sample(bsdf, wo, u);
        if (s.pdf > 0 && (s.lobe & FACET_TRANSMISSION)) eta = s.eta;
    }
    return eta;
}

typedef enum half { REFLECTED, TRANSMITTED } half;

/* Adds what delta lobes scatter into one half: each of their directions once, times its probability. */
static void add_delta_lobes(const facet_bsdf64 *bsdf, const double wo[3], half which, estimate *sum)
{
    enum { MAX_DIRECTIONS = 4 };
    double found[MAX_DIRECTIONS][3];
    int n_found = 0;
    for (int i = 0; i < N_PICKS && n_found < MAX_DIRECTIONS; i++) {
        const double u[3] = {0.5, 0.5, pick(i)};
        const facet_sample64 s = facet_bsdf64_sample(bsdf, wo, u);
        const half side = s.wi[2]*wo[2] > 0 ? REFLECTED : TRANSMITTED;
        bool is_new = s.pdf > 0 && (s.lobe & FACET_DELTA) && side == which;
        for (int j = 0; j < n_found; j++) {
            const double dx = found[j][0] - s.wi[0], dy = found[j][1] - s.wi[1], dz = found[j][2] - s.wi[2];
            is_new = is_new && dx*dx + dy*dy + dz*dz > 1e-18;
        }
        if (!is_new) continue;
        for (int k = 0; k < 3; k++) {
            found[n_found][k] = s.wi[k];
            sum->rgb[k] += s.pdf*s.weight[k];
        }
        n_found++;
    }
}

static estimate albedo_of(const facet_bsdf64 *bsdf, const double wo[3], half which, double tolerance)
{
    estimate sum = {{0}, 0};
    const int lobes = facet_bsdf64_lobes(bsdf);
    const double cosine = fabs(wo[2]), sine = hypot(wo[0], wo[1]);
    if (!(cosine > 0) || !(lobes & (which == REFLECTED ? FACET_REFLECTION : FACET_TRANSMISSION))) return sum;
    view v = {.bsdf = bsdf,
              .wo = {wo[0], wo[1], wo[2]},
              .cosine = cosine,
              .sine = sine,
              .azimuth = {sine > 0 ? wo[0]/sine : 1, sine > 0 ? wo[1]/sine : 0},
              .side = wo[2] > 0 ? 1 : -1,
              .tolerance = tolerance,
              .chart = MIRRORED,
              .eta = 1};
    if (lobes & (FACET_DIFFUSE | FACET_GLOSSY)) {
        if (which == TRANSMITTED) {
            v.eta = transmitted_index(bsdf, v.side);
            v.chart = v.eta == 1 ? THIN : REFRACTED;
        }
        sum = over_normals(&v);
    }
    if (lobes & FACET_DELTA) add_delta_lobes(bsdf, wo, which, &sum);
    return sum;
}

/* The results of both halves, at the end of a public function. */
static void store(const estimate *up, const estimate *down, double reflected[3], double transmitted[3], double *error)
{
    for (int k = 0; k < 3; k++) {
        reflected[k] = up->rgb[k];
        transmitted[k] = down->rgb[k];
    }
    if (error) *error = up->error + down->error;
}

facet_status facet_bsdf64_albedo(const facet_bsdf64 *bsdf, const double wo[3], double reflected[3],
                                 double transmitted[3], double *error)
{
    if (!bsdf || !wo || !reflected || !transmitted) return FACET_BAD_ARGUMENT;
    const double length2 = wo[0]*wo[0] + wo[1]*wo[1] + wo[2]*wo[2];
    if (!(fabs(length2 - 1) <= 1e-6)) return FACET_BAD_VALUE;
    const estimate up = albedo_of(bsdf, wo, REFLECTED, 1e-9), down = albedo_of(bsdf, wo, TRANSMITTED, 1e-9);
    store(&up, &down, reflected, transmitted, error);
    return FACET_OK;
}

/* ---- The average over views -------------------------------------------------------------------- */

/* Tolerances: of one part of an albedo, of its mean over azimuths, and of one part of the integral over cosines. */
static const double AVERAGED = 1e-8, AZIMUTHS = 1e-7, COSINES = 1e-7;

typedef struct average {
    const facet_bsdf64 *bsdf;
    double side;
    half which;
    bool is_isotropic;
} average;

static estimate albedo_at(const average *a, double cosine, double azimuth)
{
    const double sine = sqrt((1 - cosine)*(1 + cosine));
    const double wo[3] = {sine*cos(azimuth), sine*sin(azimuth), a->side*cosine};
    return albedo_of(a->bsdf, wo, a->which, AVERAGED);
}

/* The mean over n azimuths, from the first on. */
static estimate azimuth_mean(const average *a, double cosine, int n, double first)
{
    estimate sum = {{0}, 0};
    for (int i = 0; i < n; i++) {
        const estimate value = albedo_at(a, cosine, first + 2*PI*i/n);
        add(&sum, 1.0/n, &value);
    }
    return sum;
}

/* 2 cos times the mean of the albedo over azimuths, of which there are 3, 9, 27 ...: odd numbers, because a material
 * that is the same after half a turn would look the same from each view and its opposite.  The rule converges
 * exponentially: after a change d the error is about d^3; d^2 is what is counted. */
static estimate at_cosine(const void *context, double cosine)
{
    const average *a = context;
    estimate mean = azimuth_mean(a, cosine, a->is_isotropic ? 1 : 3, 0), weighted = {{0}, 0};
    double error = a->is_isotropic ? 0 : 1;
    for (int n = 3; error > AZIMUTHS && n < 200; n *= 3) {
        const estimate before = azimuth_mean(a, cosine, n, -2*PI/(3*n)),
                       after = azimuth_mean(a, cosine, n, 2*PI/(3*n));
        estimate all = {{0}, 0};
        add(&all, 1.0/3, &before);
        add(&all, 1.0/3, &mean);
        add(&all, 1.0/3, &after);
        const double change = distance(&all, &mean);
        error = change*change;
        mean = all;
    }
    mean.error += error;
    add(&weighted, 2*cosine, &mean);
    return weighted;
}

/* Isotropic is what looks the same from three azimuths at two heights. */
static estimate average_of(const facet_bsdf64 *bsdf, double side, half which)
{
    average a = {.bsdf = bsdf, .side = side, .which = which, .is_isotropic = true};
    for (int i = 1; i <= 2; i++) {
        const estimate one = albedo_at(&a, 0.3*i, 0.1), two = albedo_at(&a, 0.3*i, 1.2),
                       three = albedo_at(&a, 0.3*i, 2);
        if (distance(&one, &two) > AZIMUTHS || distance(&two, &three) > AZIMUTHS) a.is_isotropic = false;
    }
    estimate sum = {{0}, 0};
    integrate(at_cosine, &a, 0, 1, COSINES, 12, &sum);
    return sum;
}

facet_status facet_bsdf64_average_albedo(const facet_bsdf64 *bsdf, int is_inside, double reflected[3],
                                         double transmitted[3], double *error)
{
    if (!bsdf || !reflected || !transmitted) return FACET_BAD_ARGUMENT;
    const double side = is_inside ? -1 : 1;
    const estimate up = average_of(bsdf, side, REFLECTED), down = average_of(bsdf, side, TRANSMITTED);
    store(&up, &down, reflected, transmitted, error);
    return FACET_OK;
}
