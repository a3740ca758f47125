/* energy_fit.c: see energy_fit.h; docs/energy.md has the derivation and the errors.
 *
 * With the slopes p of the facets, which are (alpha_x r cos, alpha_y r sin) of stretched polar coordinates,
 *     E(wo) = Int P22(p) (1 + p.wo/cos_o) G2(wi,wo) dp
 * over the disc |p|^2 < 1 + 2 p.wo/cos_o, where wi is above the horizon.  The disc contains the origin, and along an
 * azimuth it ends at a radius R that is known, so that the integrand is smooth inside:
 *   - along the radius, S(r) = (1 - x^2)^4 of the facets are steeper: Gauss's rule in x from 0 to that of R.  x is like
 *     r near 0, and the tail, weighted by r, stays smooth at x = 1;
 *   - the azimuth from a direction across wo is like y^3, because near y = 0 the integrand changes within c/alpha;
 * where
 *     slopes are stretched, also from the axis of the lesser roughness, around which those of one azimuth are many.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 1
#include "energy_fit.h"

#include "kernel/energy.h"
#include "kernel/microfacet.h"
#define FACET_PREPARE
#include "model/model_gtr.h"

enum { LARGEST_RULE = 32, TERMS = ENERGY_TERMS, MODES = ENERGY_MODES, MASKING_STEPS = 256 };

_Static_assert(sizeof((energy_fit){0}.coefficients)/sizeof(double) == ENERGY_COEFFICIENTS,
               "energy_fit.h has their number");

/* How many terms the polynomials of the modes keep. */
static const int kept[MODES] = {16, 12, 10, 8, 6, 4};

/* Gauss-Legendre on [0,1]. */
typedef struct rule {
    int n;
    double x[LARGEST_RULE], w[LARGEST_RULE];
} rule;

static rule gauss_rule(int n)
{
    rule g = {.n = n};
    for (int i = 0; i < n; i++) {
        double x = kcossin_turn(0.5*(i + 0.75)/(n + 0.5)).x, slope = 1;
        for (int step = 0; step < 6; step++) { /* Newton's method from Tricomi's start */
            double p = 1, before = 0;
            for (int k = 1; k <= n; k++) {
                const double next = ((2*k - 1)*x*p - (k - 1)*before)/k;
                before = p;
                p = next;
            }
            slope = n*(x*p - before)/(x*x - 1);
            x -= p/slope;
        }
        g.x[i] = 0.5 + 0.5*x;
        g.w[i] = 1/((1 - x*x)*slope*slope);
    }
    return g;
}

/* A surface, prepared for the quadrature. */
typedef struct surface {
    distribution d;
    int g2, is_isotropic;
    int is_tabulated;             /* whether G1 comes from the table: where Lambda takes a series */
    double slope;                 /* mean slope before the stretch, E|p.x| */
    double G1[MASKING_STEPS + 3]; /* at cot = slope q/(1 - q), q = -1, 0, ... steps of 1/MASKING_STEPS */
    rule radial, across;          /* along an azimuth, and over the azimuths */
} surface;

/* E|slope along a line| before the stretch by alpha: 2 cot Lambda at grazing angles. */
static double mean_slope(distribution d)
{
    const double cot = 1e-9;
    return 2*cot*distribution_exact_Lambda(d, make3(1, 0, cot))/d.alpha_x;
}

static double masking_at(const distribution *d, double cot)
{
    distribution round = *d;
    round.alpha_x = round.alpha_y = 1;
    return 1/(1 + distribution_Lambda(round, make3(1, 0, cot)));
}

static surface prepare_surface(const energy_surface *s)
{
    surface p = {.g2 = s->g2,
                 .is_isotropic = s->alpha_x == s->alpha_y,
                 .is_tabulated = s->kind == NDF_BECKMANN || s->kind == NDF_PHONG};
    p.d = (distribution){.kind = s->kind, .masking = s->masking, .phong = phong_shape_of(s->exponent)};
    p.d.alpha_x = s->alpha_x;
    p.d.alpha_y = s->alpha_y;
    if (s->kind == NDF_GTR) {
        p.d.gtr = gtr_shape_of(s->alpha_x, s->alpha_y, s->gamma, s->anisotropy);
        p.d.spline = gtr_spline_at(s->gamma);
    }
    p.slope = mean_slope(p.d);
    for (int i = 0; i <= MASKING_STEPS && p.is_tabulated; i++) {
        const double q = (double)i/MASKING_STEPS;
        p.G1[i + 1] = i ? masking_at(&p.d, q < 1 ? p.slope*q/(1 - q) : COT_LARGEST) : 0;
    }
    /* One step beyond both ends, by the cubic through the last four. */
    p.G1[0] = 4*p.G1[1] - 6*p.G1[2] + 4*p.G1[3] - p.G1[4];
    p.G1[MASKING_STEPS + 2] = 1;
    p.radial = gauss_rule(p.is_isotropic ? 24 : 16);
    p.across = gauss_rule(16);
    return p;
}

/* G1 of w; in the table by a cubic through four steps, within 1e-8. */
static double masking_of(const surface *p, real3 w)
{
    if (!p->is_tabulated) return w.z/distribution_sigma(p->d, w);
    const double sine = stretched_sin(w, p->d.alpha_x, p->d.alpha_y);
    const double q = w.z/(w.z + p->slope*sine)*MASKING_STEPS;
    const int i = q < MASKING_STEPS - 1 ? (int)q : MASKING_STEPS - 1;
    const double x = q - i, y = 1 - x, *const g = &p->G1[i];
    const double bend = x*y*(1.0/6);
    return y*g[1] + x*g[2] - bend*((1 + y)*(g[0] - 2*g[1] + g[2]) + (1 + x)*(g[1] - 2*g[2] + g[3]));
}

/* The integral along the azimuth (ex, ey) of the stretched slopes. */
static double along_azimuth(const surface *p, real3 wo, double G1_o, double ex, double ey)
{
    const distribution d = p->d;
    const double dx = d.alpha_x*ex, dy = d.alpha_y*ey;
    const double b = (dx*wo.x + dy*wo.y)/wo.z, d2 = dx*dx + dy*dy, root = ksqrt(b*b + d2);
    const double R = b > 0 ? (b + root)/d2 : 1/(root - b);
    const double end = ksqrt(kmax(1 - ksqrt(ksqrt(distribution_share_beyond(d, R*R))), 0));
    double sum = 0;
    for (int i = 0; i < p->radial.n; i++) {
        const double x = end*p->radial.x[i], x2 = x*x, s = 1 - x2;
        const double r = ksqrt(distribution_tan2_beyond(d, s*s*s*s, x2*(2 - x2)*(1 + s*s)));
        const double px = r*dx, py = r*dy, facing = 1 + b*r, scale = 2*wo.z*facing/(1 + px*px + py*py);
        const real3 wi = make3(scale*px - wo.x, scale*py - wo.y, kmax(scale - wo.z, COS_SMALLEST));
        const double both = G1_o*masking_of(p, wi);
        const double G2 = p->g2 == G2_SEPARABLE ? both : both/(G1_o + both/G1_o - both);
        /* Nodes are spread like the normals that are drawn, which are not those of Disney's anisotropic gtr. */
        const real3 m = make3(px, py, 1);
        const double drawn = distribution_is_disney(d) ? distribution_D(d, m)/distribution_drawn_D(d, m) : 1;
        sum += p->radial.w[i]*8*x*s*s*s*facing*G2*drawn;
    }
    return end*sum;
}

/* The integral over the azimuths from `start` to start + length [rad], of either sign, with nodes that crowd
 * cubically at the start, or at both ends. */
static double over_azimuths(const surface *p, real3 wo, double G1_o, double start, double length)
{
    double sum = 0;
    for (int j = 0; j < p->across.n; j++) {
        const double y = p->across.x[j], y3 = y*y*y, z = 1 - y;
        const double fraction = p->is_isotropic ? y3 : y3*(10 - y*(15 - 6*y));
        const double speed = p->is_isotropic ? 3*y*y : 30*y*y*z*z;
        const real2 e = kcossin(start + length*fraction);
        sum += p->across.w[j]*speed*along_azimuth(p, wo, G1_o, e.x, e.y);
    }
    return kabs(length)*INV_TWO_PI*sum;
}

static double directional(const surface *p, real3 wo)
{
    const double G1_o = masking_of(p, wo);
    const double edge = katan2(p->d.alpha_x*wo.x, -p->d.alpha_y*wo.y); /* across wo, in the stretched slopes */
    if (p->is_isotropic) /* forwards and backwards, with their mirror images */
        return 2*(over_azimuths(p, wo, G1_o, edge, -HALF_PI) + over_azimuths(p, wo, G1_o, edge, HALF_PI));
    const double axis = p->d.alpha_x > p->d.alpha_y ? HALF_PI : 0, apart = axis - edge;
    const double first = apart - PI*kfloor(apart*INV_PI), second = PI - first;
    return over_azimuths(p, wo, G1_o, edge, first) + over_azimuths(p, wo, G1_o, edge + first, second) +
           over_azimuths(p, wo, G1_o, edge + PI, first) + over_azimuths(p, wo, G1_o, edge + PI + first, second);
}

/* The direction at which energy_loss has the variables u = 2 x - 1 and t. */
static real3 direction_at(const energy_fit *f, double u, double t)
{
    const double x = 0.5 + 0.5*u, z = f->is_root ? x*x : x;
    const double cos2 = (1 + t)*f->skew/((1 + t)*f->skew + (1 - t)), sin2 = 1 - cos2;
    const double across2 = f->reach2_x*cos2 + f->reach2_y*sin2; /* a^2 at the horizon */
    /* c/(c + a) = v with a^2 = across2 + (reach2_z - across2) c^2 */
    const double v = z/(1 + f->a_n), v2 = v*v;
    const double c2 = v2*across2/((1 - v)*(1 - v) - v2*(f->reach2_z - across2));
    const double c = ksqrt(kmin(c2, 1)), sine = ksqrt(kmax(1 - c*c, 0));
    return make3(sine*ksqrt(cos2), sine*ksqrt(sin2), c);
}

/* What the polynomial is multiplied by. */
static double tail_weight(const energy_fit *f, int power, double x)
{
    const double weight = 1 - (f->is_root ? x*x : x)/(1 + f->a_n);
    return power == 2 ? weight*weight : power == 1 ? weight : 1;
}

/* A square matrix; of its numbers only the first n x n count. */
typedef struct matrix {
    double at[TERMS][TERMS];
} matrix;

/* From values at the nodes cos(pi (i + 1/2)/n) to coefficients of Chebyshev's polynomials. */
static matrix to_chebyshev(int n)
{
    matrix m = {.at = {{0}}};
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++) m.at[k][i] = (k ? 2.0 : 1.0)/n*kcossin_turn(0.5*k*(i + 0.5)/n).x;
    return m;
}

/* From coefficients of Chebyshev's polynomials to those of powers, ascending. */
static matrix to_powers(int n)
{
    matrix m = {.at[0][0] = 1, .at[1][1] = 1};
    for (int k = 2; k < n; k++)
        for (int j = 0; j <= k; j++) m.at[j][k] = (j ? 2*m.at[j - 1][k - 1] : 0) - m.at[j][k - 2];
    return m;
}

/* v = m v for a vector of n numbers, `stride` apart. */
static void transform(const matrix *m, int n, double *v, int stride)
{
    double result[TERMS] = {0};
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++) result[k] += m->at[k][i]*v[i*stride];
    for (int k = 0; k < n; k++) v[k*stride] = result[k];
}

/* The polynomial through the values at the nodes, n_modes of t times TERMS of u, less its small terms. */
static void fit_polynomial(energy_fit *f, int n_modes, double v[MODES][TERMS])
{
    const matrix u_chebyshev = to_chebyshev(TERMS), u_powers = to_powers(TERMS);
    const matrix t_chebyshev = to_chebyshev(n_modes), t_powers = to_powers(n_modes);
    for (int i = 0; i < TERMS; i++) transform(&t_chebyshev, n_modes, &v[0][i], TERMS);
    for (int k = 0; k < n_modes; k++) {
        transform(&u_chebyshev, TERMS, v[k], 1);
        for (int i = kept[k]; i < TERMS; i++) v[k][i] = 0;
        transform(&u_powers, TERMS, v[k], 1);
    }
    for (int i = 0; i < TERMS; i++) transform(&t_powers, n_modes, &v[0][i], TERMS);
    int used = 0;
    for (int k = 0; k < MODES; k++)
        for (int i = kept[k] - 1; i >= 0; i--) f->coefficients[used++] = k < n_modes ? v[k][i] : 0;
}

/* 2 Int C c dc of the polynomial, averaged over the azimuth: Gauss's rule where c + a_n is log-uniform, and the
 * trapezoidal rule in the angle whose cosine is t. */
static double loss_average(const energy_fit *f)
{
    enum { AZIMUTHS = 24 };
    const energy e = energy_of_fit(f);
    const rule g = gauss_rule(LARGEST_RULE);
    const double a = f->a_n, range = klog1p(1/a);
    const int n = f->is_isotropic ? 1 : AZIMUTHS;
    double sum = 0, weights = 0;
    for (int k = 0; k < n; k++) {
        const double t = kcossin_turn(0.5*(k + 0.5)/n).x, weight = 1/(f->skew*(1 + t) + (1 - t));
        const double cos2 = (1 + t)*f->skew*weight, cosine = ksqrt(cos2), sine = ksqrt(1 - cos2);
        weights += weight;
        for (int i = 0; i < 2*g.n; i++) {
            const double y = 0.5*(g.x[i/2] + i%2), c = kmin(a*kexpm1(y*range), 1),
                         s = ksqrt((1 - c)*(1 + c));
            const double loss = energy_loss(e, make3(s*cosine, s*sine, c));
            sum += weight*0.5*g.w[i/2]*range*(c + a)*2*c*loss;
        }
    }
    return sum/weights;
}

#define REACH 3.0       /* of a, in mean slopes: fits best from the smoothest Beckmann to GGX and GTR of any gamma */
#define ROOT_SLOPE 0.1  /* above this mean slope the logarithm of c in C is best resolved by sqrt(z) */
#define SKEW_POWER 1.75 /* of alpha_y/alpha_x: between the azimuth (0) and the stretched azimuth (2) */

void facet_energy_fit_surface(const energy_surface *s, energy_fit *fit)
{
    const surface p = prepare_surface(s);
    const distribution d = p.d;
    const double reach = REACH*p.slope, alpha = ksqrt(d.alpha_x*d.alpha_y);
    energy_fit f = {.is_isotropic = p.is_isotropic, .is_root = p.slope*alpha > ROOT_SLOPE};
    f.reach2_x = ksquare(reach*d.alpha_x);
    f.reach2_y = ksquare(reach*d.alpha_y);
    f.reach2_z = ksquare(reach*alpha);
    f.a_n = reach*alpha;
    f.skew = f.is_isotropic ? 1 : kpow(d.alpha_y/d.alpha_x, SKEW_POWER);
    const int n_modes = f.is_isotropic ? 1 : MODES;
    double loss[MODES][TERMS], largest = 0;
    for (int k = 0; k < n_modes; k++)
        for (int i = 0; i < TERMS; i++) {
            const double u = kcossin_turn(0.5*(i + 0.5)/TERMS).x, t = kcossin_turn(0.5*(k + 0.5)/n_modes).x;
            loss[k][i] = 1 - directional(&p, direction_at(&f, u, f.is_isotropic ? 0 : t));
            largest = kmax(largest, loss[k][i]);
        }
    /* The steepest tail that leaves nothing at normal incidence for the polynomial to rise to. */
    f.power = 2;
    while (f.power > 0 && loss[0][0] > largest/8*tail_weight(&f, f.power, 1)) f.power--;
    for (int k = 0; k < n_modes; k++)
        for (int i = 0; i < TERMS; i++)
            loss[k][i] /= tail_weight(&f, f.power, 0.5 + 0.5*kcossin_turn(0.5*(i + 0.5)/TERMS).x);
    fit_polynomial(&f, n_modes, loss);
    f.loss_average = loss_average(&f);
    *fit = f;
}
