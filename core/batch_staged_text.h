/* batch_staged_text.h: the batch loop that samples the visible normals of gtr in stages.  Included by batch_text.h.
 *
 * The tail of the visible normals (kernel/gtr_sample.h) costs ten times as much as the rest and is chosen for few
 * samples.  A block of samples is drawn as if there were no tail; those that belong to it are collected, drawn again
 * together, and put back; then all are completed.  The results are those of the single call, to the last bit.
 * SPDX-License-Identifier: MIT */
enum { STAGED_BLOCK = 512, STAGED_WIDTH = 16 }; /* the second: lanes of the widest vectors */

typedef struct staged_vectors {
    float x[STAGED_BLOCK], y[STAGED_BLOCK], z[STAGED_BLOCK];
} staged_vectors;

/* Tails that are drawn together: inputs, normals, and what passes from one stage to the next. */
typedef struct staged_tails {
    staged_vectors wo, u, m;
    float mu[STAGED_BLOCK], T[STAGED_BLOCK], cos_phi[STAGED_BLOCK], sin_phi[STAGED_BLOCK];
    float q[STAGED_BLOCK], z[STAGED_BLOCK], total[STAGED_BLOCK], h[STAGED_BLOCK];
} staged_tails;

/* The normals of n tails, n a multiple of STAGED_WIDTH: the loops have no remainder then, which would take as long as
 * all of them.  The steps of gtr_sample_tail, one loop each: gcc vectorises the steps, but not the whole.  One function
 * for all settings of a material. */
static __attribute__((noinline)) void draw_tails(const gtr_shape *shape, size_t n, staged_tails *t)
{
    const gtr_shape g = *shape;
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const gtr_view v = gtr_view_of(make3(t->wo.x[i], t->wo.y[i], t->wo.z[i]), g);
        t->u.x[i] = gtr_rest_of(v, t->u.x[i]);
        t->mu[i] = v.mu;
        t->T[i] = v.T;
        t->cos_phi[i] = v.cos_phi;
        t->sin_phi[i] = v.sin_phi;
    }
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const gtr_tail_line line = gtr_draw_line(g, t->mu[i], t->T[i], t->u.x[i]);
        t->q[i] = line.q;
        t->z[i] = line.z;
        t->total[i] = line.total;
    }
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const gtr_tail_line line = {t->q[i], t->z[i], t->total[i]};
        t->h[i] = gtr_azimuth(g, line, kabs(2*t->u.y[i] - 1));
    }
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const gtr_view v = {t->cos_phi[i], t->sin_phi[i], t->mu[i], t->T[i]};
        const real3 normal = gtr_draw_beyond(g, v, t->q[i], t->h[i], 2*t->u.y[i] - 1, t->u.z[i]);
        t->m.x[i] = normal.x;
        t->m.y[i] = normal.y;
        t->m.z[i] = normal.z;
    }
}

/* Draws the samples with is_tail, n at most STAGED_BLOCK, and puts their normals into m. */
static void replace_tails(const microfacet_params *p, size_t n, const int *is_tail, facet_dirs wo, facet_dirs u,
                          staged_vectors *m)
{
    staged_tails t;
    int index[STAGED_BLOCK];
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        index[count] = (int)i;
        count += is_tail[i] != 0;
    }
    if (count == 0) return;
    const size_t padded = (count + STAGED_WIDTH - 1)/STAGED_WIDTH*STAGED_WIDTH;
    for (size_t k = 0; k < padded; k++) {
        const int i = index[k < count ? k : 0];
        t.wo.x[k] = wo.x[i];
        t.wo.y[k] = wo.y[i];
        t.wo.z[k] = wo.z[i];
        t.u.x[k] = u.x[i];
        t.u.y[k] = u.y[i];
        t.u.z[k] = microfacet_mirror_number(*p, gather(wo, (size_t)i), u.z[i]);
    }
    draw_tails(&p->d.gtr, padded, &t);
    for (size_t k = 0; k < count; k++) {
        m->x[index[k]] = t.m.x[k];
        m->y[index[k]] = t.m.y[k];
        m->z[index[k]] = t.m.z[k];
    }
}

static facet_dirs dirs_from(facet_dirs d, size_t first)
{
    return (facet_dirs){d.x + first, d.y + first, d.z + first};
}

/* At most STAGED_BLOCK samples. */
KERNEL void sample_block(microfacet_params p, size_t n, facet_dirs wo, facet_dirs u, facet_samples to)
{
    const microfacet_params kept = p; /* p itself stays where the compiler knows its constants */
    staged_vectors m;
    int is_tail[STAGED_BLOCK];
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const gtr_view v = gtr_view_of(gather(wo, i), p.d.gtr);
        const real rest = microfacet_mirror_number(p, gather(wo, i), u.z[i]);
        const real3 normal = gtr_sample_body(v, gtr_rest_of(v, u.x[i]), u.y[i], rest, p.d.gtr);
        m.x[i] = normal.x;
        m.y[i] = normal.y;
        m.z[i] = normal.z;
        is_tail[i] = gtr_is_tail(v, u.x[i]);
    }
    replace_tails(&kept, n, is_tail, wo, u, &m);
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)
    {
        const bsdf_sample drawn = microfacet_sample_about(p, gather(wo, i), gather(u, i),
                                                          make3(m.x[i], m.y[i], m.z[i]));
        to.wi_x[i] = drawn.wi.x;
        to.wi_y[i] = drawn.wi.y;
        to.wi_z[i] = drawn.wi.z;
        to.pdf[i] = drawn.pdf;
        to.weight_r[i] = drawn.weight.x;
        to.weight_g[i] = drawn.weight.y;
        to.weight_b[i] = drawn.weight.z;
    }
}

KERNEL void microfacet_sample_staged(microfacet_params p, size_t n, facet_dirs wo, facet_dirs u, facet_samples s)
{
    microfacet_params q = p;
    if (p.d.kind == NDF_GTR && p.sampling == SAMPLING_VNDF) {
        q.sampling = SAMPLING_VNDF;
        for (size_t first = 0; first < n; first += STAGED_BLOCK) {
            const facet_samples to = {s.wi_x + first,     s.wi_y + first,     s.wi_z + first,    s.pdf + first,
                                      s.weight_r + first, s.weight_g + first, s.weight_b + first};
            sample_block(q, n - first < STAGED_BLOCK ? n - first : STAGED_BLOCK, dirs_from(wo, first),
                         dirs_from(u, first), to);
        }
        return;
    }
    if (p.d.kind == NDF_GTR) q.sampling = SAMPLING_NDF;
    microfacet_sample_each(q, n, wo, u, s);
}
