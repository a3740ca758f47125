/* batch_terms_text.h: what the distributions of normals say about blocks of directions, and draw for them, in short
 * stages.  Included by batch_microfacet_text.h, and by the benchmark of these loops.
 *
 * A processor sees a few hundred instructions ahead.  A loop whose body is a long chain of them, each waiting for the
 * one before, leaves it idle half of the time; the same work as several loops over a block of elements, with what they
 * hand on in arrays that stay in the first cache, does not.
 *
 * The tail of gtr's visible normals (kernel/gtr_sample.h) costs several times as much as the rest and is chosen for few
 * samples: those of a block are collected, drawn together, and put back.
 *
 * All results are those of the single calls, to the last bit.
 * SPDX-License-Identifier: MIT */
#include "facet/facet.h"

#include "kernel/microfacet.h"

static inline real3 gather(facet_dirs d, size_t i)
{
    return make3(d.x[i], d.y[i], d.z[i]);
}

enum { BLOCK = 512, LANES = 16 }; /* LANES: those of the widest vectors */

typedef struct block_vectors {
    float x[BLOCK], y[BLOCK], z[BLOCK];
} block_vectors;

/* What the distribution says about each pair of directions; drawn_*: the same arrays, or others. */
typedef struct block_terms {
    float D[BLOCK], sigma_i[BLOCK], sigma_o[BLOCK], other_D[BLOCK], other_sigma[BLOCK];
    const float *drawn_D, *drawn_sigma;
} block_terms;

static inline facet_dirs dirs_from(facet_dirs d, size_t first)
{
    return (facet_dirs){d.x + first, d.y + first, d.z + first};
}

static inline facet_dirs dirs_of(const block_vectors *v)
{
    return (facet_dirs){v->x, v->y, v->z};
}

static inline void scatter(block_vectors *to, size_t i, real3 v)
{
    to->x[i] = v.x;
    to->y[i] = v.y;
    to->z[i] = v.z;
}

/* The loops below run over whole vectors: a remainder would take as long as all of them. */
static inline size_t whole_vectors(size_t n)
{
    return (n + LANES - 1)/LANES*LANES;
}

/* n directions from the first on, in `room` if vectors would reach beyond them. */
static inline facet_dirs block_of(facet_dirs d, size_t first, size_t n, block_vectors *room)
{
    const facet_dirs from = dirs_from(d, first);
    if (n == whole_vectors(n)) return from;
    for (size_t i = 0; i < whole_vectors(n); i++) scatter(room, i, gather(from, i < n ? i : n - 1));
    return dirs_of(room);
}

/* A loop over n elements, n of whole vectors, which the compiler is to know. */
#define EACH_OF(n) _Pragma("omp simd") for (size_t i = 0; i < (n)/LANES*LANES; i++)

/* The loops of one distribution.  n: of whole vectors. */
typedef struct ndf_loops {
    void (*drawn_D)(const distribution *d, size_t n, facet_dirs m, float *D);
    void (*exact_sigma)(const distribution *d, size_t n, facet_dirs v, float *sigma);
    void (*published_sigma)(const distribution *d, size_t n, facet_dirs v, float *sigma);
    void (*all_normals)(const distribution *d, size_t n, facet_dirs u, block_vectors *m);
    void (*visible_normals)(const distribution *d, size_t n, facet_dirs wo, facet_dirs u, block_vectors *m);
} ndf_loops;

/* The distribution with its kind known where the loop is compiled. */
static inline distribution of_kind(const distribution *d, int kind)
{
    distribution q = *d;
    q.kind = kind;
    return q;
}

#define NDF_LOOPS(name, ndf)                                                                                           \
    static void name##_drawn_D(const distribution *d, size_t n, facet_dirs m, float *D)                                \
    {                                                                                                                  \
        const distribution q = of_kind(d, ndf);                                                                        \
        float *restrict const out = D;                                                                                 \
        EACH_OF(n) out[i] = distribution_drawn_D(q, gather(m, i));                                                     \
    }                                                                                                                  \
    static void name##_exact_sigma(const distribution *d, size_t n, facet_dirs v, float *sigma)                        \
    {                                                                                                                  \
        const distribution q = of_kind(d, ndf);                                                                        \
        float *restrict const out = sigma;                                                                             \
        EACH_OF(n) out[i] = distribution_exact_sigma(q, gather(v, i));                                                 \
    }
#define MORE_NDF_LOOPS(name, ndf)                                                                                      \
    static void name##_published_sigma(const distribution *d, size_t n, facet_dirs v, float *sigma)                    \
    {                                                                                                                  \
        const distribution q = of_kind(d, ndf);                                                                        \
        float *restrict const out = sigma;                                                                             \
        EACH_OF(n)                                                                                                     \
        out[i] = v.z[i]*(1 + distribution_published_Lambda(q, gather(v, i)));                                          \
    }                                                                                                                  \
    static void name##_all_normals(const distribution *d, size_t n, facet_dirs u, block_vectors *m)                    \
    {                                                                                                                  \
        const distribution q = of_kind(d, ndf);                                                                        \
        EACH_OF(n) scatter(m, i, distribution_sample_ndf(q, u.x[i], u.y[i]));                                          \
    }
#define VISIBLE_LOOPS(name, ndf)                                                                                       \
    static void name##_visible_normals(const distribution *d, size_t n, facet_dirs wo, facet_dirs u, block_vectors *m) \
    {                                                                                                                  \
        const distribution q = of_kind(d, ndf);                                                                        \
        EACH_OF(n)                                                                                                     \
        scatter(m, i, distribution_sample_vndf(q, gather(wo, i), u.x[i], u.y[i], u.z[i]));                             \
    }
NDF_LOOPS(beckmann, NDF_BECKMANN)
MORE_NDF_LOOPS(beckmann, NDF_BECKMANN)
VISIBLE_LOOPS(beckmann, NDF_BECKMANN)
NDF_LOOPS(phong, NDF_PHONG)
MORE_NDF_LOOPS(phong, NDF_PHONG)
VISIBLE_LOOPS(phong, NDF_PHONG)
MORE_NDF_LOOPS(gtr, NDF_GTR)

/* A loop with the shape g known to be isotropic is compiled for itself: it takes less of the directions. */
#define WITH_ISOTROPY(loop, g, ...) ((g).is_isotropic ? loop(g, 1, __VA_ARGS__) : loop(g, 0, __VA_ARGS__))

KERNEL void gtr_drawn_D_loop(gtr_shape g, int is_isotropic, size_t n, facet_dirs m, float *D)
{
    g.is_isotropic = is_isotropic;
    float *restrict const out = D;
    float exponent[BLOCK], ratio[BLOCK];
    EACH_OF(n)
    {
        const real2 base = gtr_base(gather(m, i), g);
        exponent[i] = base.x;
        if (!is_isotropic) ratio[i] = base.y;
    }
    EACH_OF(n) exponent[i] = g.gamma*klog_quick(exponent[i]);
    EACH_OF(n) out[i] = gtr_D_of(m.z[i], g, is_isotropic ? 1 : ratio[i], exponent[i]);
}

static void gtr_drawn_D(const distribution *d, size_t n, facet_dirs m, float *D)
{
    WITH_ISOTROPY(gtr_drawn_D_loop, d->gtr, n, m, D);
}

static void gtr_disney_D_block(const gtr_shape *shape, size_t n, facet_dirs m, float *D)
{
    const gtr_shape g = *shape;
    float *restrict const out = D;
    EACH_OF(n) out[i] = gtr_disney_D(gather(m, i), g);
}

/* gtr_A at x; count is a constant. */
KERNEL void gtr_A_loop(gtr_shape g, size_t n, const float *x, float *A, int count)
{
    float *restrict const out = A;
    EACH_OF(n) out[i] = gtr_A_by(g, x[i], count);
}

/* gtr_A at x, and its slope if that is not NULL. */
static void gtr_A_block(const gtr_shape *shape, size_t n, const float *x, float *A, float *slope)
{
    const gtr_shape g = *shape;
    float *restrict const out = A, *restrict const derivative = slope;
    if (derivative) {
        EACH_OF(n)
        {
            const real2 at = gtr_A_and_slope(g, x[i]);
            out[i] = at.x;
            derivative[i] = at.y;
        }
    } else if (g.count <= 8) gtr_A_loop(g, n, x, A, 8);
    else if (g.count <= 12) gtr_A_loop(g, n, x, A, 12);
    else if (g.count <= 16) gtr_A_loop(g, n, x, A, 16);
    else gtr_A_loop(g, n, x, A, GTR_TERMS);
}

/* 1/s towards n directions, and gtr_A from it for n numbers, which `x` holds and loses. */
KERNEL void gtr_inverses_loop(gtr_shape g, int is_isotropic, size_t n, facet_dirs v, float *x)
{
    g.is_isotropic = is_isotropic;
    float *restrict const out = x;
    EACH_OF(n) out[i] = gtr_inverse_s_towards(gather(v, i), g);
}

static void gtr_inverses(const gtr_shape *shape, size_t n, facet_dirs v, float *x)
{
    WITH_ISOTROPY(gtr_inverses_loop, *shape, n, v, x);
}

static void gtr_A_of(const gtr_shape *shape, size_t n, float *x, float *A)
{
    const gtr_shape g = *shape;
    EACH_OF(n) x[i] = gtr_variable(g, x[i]);
    gtr_A_block(shape, n, x, A, NULL);
}

KERNEL void gtr_sigma_loop(gtr_shape g, int is_isotropic, size_t n, facet_dirs v, const float *A, float *sigma)
{
    g.is_isotropic = is_isotropic;
    float *restrict const out = sigma;
    EACH_OF(n) out[i] = gtr_sigma_of(gather(v, i), g, A[i]);
}

static void gtr_sigma_with(const gtr_shape *shape, size_t n, facet_dirs v, const float *A, float *sigma)
{
    WITH_ISOTROPY(gtr_sigma_loop, *shape, n, v, A, sigma);
}

static void gtr_exact_sigma(const distribution *d, size_t n, facet_dirs v, float *sigma)
{
    float x[BLOCK], A[BLOCK];
    gtr_inverses(&d->gtr, n, v, x);
    gtr_A_of(&d->gtr, n, x, A);
    gtr_sigma_with(&d->gtr, n, v, A, sigma);
}

/* Towards both directions: a loop of twice the length costs less than two, which each begin with the constants. */
static void gtr_exact_sigmas(const distribution *d, size_t n, facet_dirs wi, facet_dirs wo, block_terms *t)
{
    float x[2*BLOCK], A[2*BLOCK];
    gtr_inverses(&d->gtr, n, wi, x);
    gtr_inverses(&d->gtr, n, wo, x + n);
    gtr_A_of(&d->gtr, 2*n, x, A);
    gtr_sigma_with(&d->gtr, n, wi, A, t->sigma_i);
    gtr_sigma_with(&d->gtr, n, wo, A + n, t->sigma_o);
}

/* The radii of normals: of those beyond Y0, a share xi lies before. */
static void gtr_radii(const gtr_shape *shape, size_t n, const float *Y0, const float *xi, float *r)
{
    const gtr_shape g = *shape;
    float *restrict const out = r;
    float Y[BLOCK];
    EACH_OF(n) Y[i] = gtr_grown(g.excess, Y0[i], xi[i]);
    EACH_OF(n)
    {
        const real2 at = gtr_quantile_of(g.excess, Y0[i], xi[i], Y[i]);
        out[i] = at.x;
        Y[i] = at.y;
    }
    EACH_OF(n) out[i] = gtr_radius(g, Y0[i], make2(out[i], Y[i]));
}

/* Tails that are drawn together. */
typedef struct gtr_tails {
    block_vectors u; /* x: gtr_rest_of */
    float mu[BLOCK], T[BLOCK], q[BLOCK], Y0[BLOCK];
    float along[BLOCK], across[BLOCK]; /* slopes */
} gtr_tails;

/* The lines of n tails, n of whole vectors. */
static void gtr_draw_lines(const gtr_shape *shape, size_t n, gtr_tails *t)
{
    const gtr_shape g = *shape;
    float mass[BLOCK], x[BLOCK], A[BLOCK], slope[BLOCK];
    EACH_OF(n)
    {
        const gtr_view v = {0, 0, t->mu[i], t->T[i]};
        mass[i] = gtr_tail_mass(v, t->u.x[i]);
        t->q[i] = gtr_line_guess(g, mass[i], t->mu[i]);
    }
    for (int step = 0; step < GTR_LINE_STEPS; step++) {
        EACH_OF(n)
        x[i] = gtr_variable(g, gtr_inverse_s(g, t->q[i]*t->q[i], 1));
        gtr_A_block(shape, n, x, A, slope);
        EACH_OF(n)
        t->q[i] = gtr_line_step(g, mass[i], t->mu[i], t->q[i], make2(A[i], slope[i]));
    }
    EACH_OF(n) t->Y0[i] = gtr_minus_log_s(g, t->q[i]*t->q[i], 1);
}

/* What the trials of a round need, for several trials of the same tail where fewer tails than lanes are left. */
typedef struct gtr_trials {
    block_vectors u;
    int tail[BLOCK], number[BLOCK];
    float q[BLOCK], Y0[BLOCK], y[BLOCK], z[BLOCK], radius[BLOCK], along[BLOCK], across[BLOCK];
} gtr_trials;

static inline void copy_trial(gtr_trials *r, size_t to, size_t from, int later)
{
    scatter(&r->u, to, gather(dirs_of(&r->u), from));
    r->tail[to] = r->tail[from];
    r->number[to] = r->number[from] + later;
    r->q[to] = r->q[from];
    r->Y0[to] = r->Y0[from];
}

static inline int goes_on(const gtr_trials *r, size_t i)
{
    return (r->along[i] < r->q[i]) & (r->number[i] + 1 < GTR_TRIALS);
}

static void gtr_try_all(const gtr_shape *shape, size_t n, gtr_trials *r)
{
    EACH_OF(n)
    {
        const real2 u = gtr_numbers_of_trial(gather(dirs_of(&r->u), i), r->number[i]);
        r->y[i] = u.x;
        r->z[i] = u.y;
    }
    gtr_radii(shape, n, r->Y0, r->z, r->radius);
    EACH_OF(n)
    {
        const real2 slopes = gtr_half_turn(r->radius[i], r->y[i]);
        r->along[i] = slopes.x;
        r->across[i] = slopes.y;
    }
}

/* The slopes of n tails whose lines are drawn: of the first trial that succeeds. */
static void gtr_draw_beyond(const gtr_shape *shape, size_t n, gtr_tails *t)
{
    gtr_trials r;
    for (size_t i = 0; i < n; i++) {
        scatter(&r.u, i, gather(dirs_of(&t->u), i));
        r.tail[i] = (int)i;
        r.number[i] = 0;
        r.q[i] = t->q[i];
        r.Y0[i] = t->Y0[i];
    }
    while (n > 0) {
        const size_t whole = whole_vectors(n);
        for (size_t k = n; k < whole; k++) copy_trial(&r, k, k - n, 1);
        gtr_try_all(shape, whole, &r);
        size_t left = 0;
        for (size_t first = 0; first < n; first++) { /* without branches, which nobody could predict */
            size_t k = first;
            for (size_t later = first + n; later < whole; later += n) k = goes_on(&r, k) ? later : k;
            t->along[r.tail[k]] = kmax(r.along[k], r.q[k]);
            t->across[r.tail[k]] = r.across[k];
            const size_t kept = (size_t)goes_on(&r, k);
            copy_trial(&r, left, k, 1);
            left += kept;
        }
        n = left;
    }
}

static void gtr_visible_normals(const distribution *d, size_t n, facet_dirs wo, facet_dirs u, block_vectors *m)
{
    const gtr_shape g = d->gtr;
    float A[BLOCK], mu[BLOCK], T[BLOCK], cos_phi[BLOCK], sin_phi[BLOCK], rest[BLOCK] = {0}, Y0[BLOCK] = {0}, r[BLOCK];
    int is_tail[BLOCK];
    gtr_inverses(&g, n, wo, rest);
    gtr_A_of(&g, n, rest, A);
    EACH_OF(n)
    {
        const gtr_view v = gtr_view_of(gather(wo, i), g, A[i]);
        mu[i] = v.mu;
        T[i] = v.T;
        cos_phi[i] = v.cos_phi;
        sin_phi[i] = v.sin_phi;
        rest[i] = gtr_rest_of(v, u.x[i]);
        Y0[i] = g.log_range;
        is_tail[i] = gtr_is_tail(v, u.x[i]);
    }
    gtr_radii(&g, n, Y0, rest, r);
    EACH_OF(n)
    {
        const gtr_view v = {cos_phi[i], sin_phi[i], mu[i], T[i]};
        scatter(m, i, gtr_sample_body(v, r[i], u.y[i], u.z[i], g));
    }
    gtr_tails t;
    int index[BLOCK];
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        index[count] = (int)i;
        count += is_tail[i] != 0; /* cppcheck-suppress uninitvar */
    }
    for (size_t k = 0; k < whole_vectors(count); k++) {
        const int i = index[k < count ? k : 0]; /* cppcheck-suppress uninitvar */
        scatter(&t.u, k, make3(rest[i], u.y[i], u.z[i]));
        t.mu[k] = mu[i];
        t.T[k] = T[i];
    }
    gtr_draw_lines(&g, whole_vectors(count), &t);
    gtr_draw_beyond(&g, count, &t);
    for (size_t k = 0; k < count; k++) {
        const int i = index[k];
        const gtr_view v = {cos_phi[i], sin_phi[i], mu[i], T[i]};
        scatter(m, (size_t)i, gtr_turn(v, t.along[k], t.across[k], g));
    }
}

/* By NDF_GGX, ...; ggx's terms are found where they are used. */
#define NDF_ENTRY(name)                                                                                                \
    {                                                                                                                  \
        name##_drawn_D, name##_exact_sigma, name##_published_sigma, name##_all_normals, name##_visible_normals         \
    }
static const ndf_loops loops_of_ndf[NDF_COUNT] = {
    [NDF_BECKMANN] = NDF_ENTRY(beckmann), [NDF_PHONG] = NDF_ENTRY(phong), [NDF_GTR] = NDF_ENTRY(gtr)};

/* smith_terms_at for n pairs of directions and the normals m, n of whole vectors. */
static inline void find_terms(const distribution *d, size_t n, facet_dirs wi, facet_dirs wo, facet_dirs m,
                              block_terms *t)
{
    const ndf_loops *loops = &loops_of_ndf[d->kind];
    t->drawn_D = t->D;
    t->drawn_sigma = t->sigma_o;
    if (distribution_is_disney(*d)) {
        gtr_disney_D_block(&d->gtr, n, m, t->D);
        loops->drawn_D(d, n, m, t->other_D);
        t->drawn_D = t->other_D;
    } else loops->drawn_D(d, n, m, t->D);
    if (d->masking == MASKING_PUBLISHED) {
        loops->published_sigma(d, n, wi, t->sigma_i);
        loops->published_sigma(d, n, wo, t->sigma_o);
        loops->exact_sigma(d, n, wo, t->other_sigma);
        t->drawn_sigma = t->other_sigma;
    } else if (d->kind == NDF_GTR) {
        gtr_exact_sigmas(d, n, wi, wo, t);
    } else {
        loops->exact_sigma(d, n, wi, t->sigma_i);
        loops->exact_sigma(d, n, wo, t->sigma_o);
    }
}

static inline smith_terms terms_of(const block_terms *t, size_t i)
{
    return (smith_terms){t->D[i], t->drawn_D[i], t->sigma_i[i], t->sigma_o[i], t->drawn_sigma[i]};
}

/* Of the pairs, and the sums of the two. */
static inline void find_terms_between(const distribution *d, size_t n, facet_dirs wi, facet_dirs wo, block_terms *t)
{
    block_vectors h;
    EACH_OF(n) scatter(&h, i, add3(gather(wi, i), gather(wo, i)));
    find_terms(d, n, wi, wo, dirs_of(&h), t);
}

/* Lambda at a block of cotangents, for an alpha and a gamma each; n of whole vectors. */
static __attribute__((noinline)) void gtr_direct_block(size_t n, const float *alpha, const float *gamma,
                                                       const float *mu, float *Lambda)
{
    float *restrict const out = Lambda;
    float m[BLOCK], ratio[BLOCK], Y[BLOCK], rho[BLOCK], excess[BLOCK], scale[BLOCK], z[BLOCK], x[BLOCK], sum[BLOCK];
    EACH_OF(n)
    {
        const gtr_direct d = gtr_direct_at(alpha[i], gamma[i], mu[i]);
        m[i] = d.m;
        ratio[i] = d.ratio;
        Y[i] = d.Y;
        rho[i] = d.rho;
        excess[i] = d.excess;
        scale[i] = d.scale;
        sum[i] = 0;
    }
    for (int node = 0; node < 16; node++) {
        const gtr_direct_node at = gtr_direct_nodes[node];
        EACH_OF(n)
        {
            const real2 here = gtr_direct_node_at((gtr_direct){m[i], ratio[i], Y[i], rho[i], excess[i], scale[i]}, at);
            z[i] = here.x;
            x[i] = here.y;
        }
        EACH_OF(n)
        {
            const gtr_direct d = {m[i], ratio[i], Y[i], rho[i], excess[i], scale[i]};
            sum[i] += gtr_direct_term(d, at, make2(z[i], x[i]));
        }
    }
    EACH_OF(n)
    {
        const gtr_direct d = {m[i], ratio[i], Y[i], rho[i], excess[i], scale[i]};
        out[i] = gtr_direct_Lambda(d, sum[i], mu[i]);
    }
}
