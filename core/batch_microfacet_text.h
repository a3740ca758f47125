/* batch_microfacet_text.h: the batch loops of the kernel microfacet, over blocks.  Included by batch_text.h.
 *
 * The terms of the distributions are found first, in stages (batch_terms_text.h), and the rest takes them from arrays;
 * only ggx, whose terms cost little, is evaluated in one loop.
 * SPDX-License-Identifier: MIT */
KERNEL void microfacet_eval_staged(const microfacet_params *given, int variant, size_t n, facet_dirs wi, facet_dirs wo,
                                   facet_rgb f)
{
    const microfacet_params p = microfacet_fix(*given, variant);
    if (p.is_ggx) {
        microfacet_eval_each(given, variant, n, wi, wo, f);
        return;
    }
    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t some = n - first < BLOCK ? n - first : BLOCK;
        block_vectors room_i, room_o;
        block_terms t;
        const facet_dirs i_dirs = block_of(wi, first, some, &room_i), o_dirs = block_of(wo, first, some, &room_o);
        find_terms_between(&given->d, whole_vectors(some), i_dirs, o_dirs, &t);
        float *restrict const r = f.r + first, *restrict const g = f.g + first, *restrict const b = f.b + first;
        _Pragma("omp simd") for (size_t i = 0; i < some; i++)
        {
            const real3 value = microfacet_eval_with(p, terms_of(&t, i), gather(i_dirs, i), gather(o_dirs, i));
            r[i] = value.x;
            g[i] = value.y;
            b[i] = value.z;
        }
    }
}

KERNEL void microfacet_pdf_staged(const microfacet_params *given, int variant, size_t n, facet_dirs wi, facet_dirs wo,
                                  float *pdf)
{
    const microfacet_params p = microfacet_fix(*given, variant);
    if (p.is_ggx) {
        microfacet_pdf_each(given, variant, n, wi, wo, pdf);
        return;
    }
    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t some = n - first < BLOCK ? n - first : BLOCK;
        block_vectors room_i, room_o;
        block_terms t;
        const facet_dirs i_dirs = block_of(wi, first, some, &room_i), o_dirs = block_of(wo, first, some, &room_o);
        find_terms_between(&given->d, whole_vectors(some), i_dirs, o_dirs, &t);
        float *restrict const out = pdf + first;
        _Pragma("omp simd") for (size_t i = 0; i < some; i++)
            out[i] = microfacet_pdf_with(p, terms_of(&t, i), gather(i_dirs, i), gather(o_dirs, i));
    }
}

KERNEL void microfacet_eval_pdf_staged(const microfacet_params *given, int variant, size_t n, facet_dirs wi,
                                       facet_dirs wo, facet_rgb f, float *pdf)
{
    const microfacet_params p = microfacet_fix(*given, variant);
    if (p.is_ggx) {
        microfacet_eval_pdf_each(given, variant, n, wi, wo, f, pdf);
        return;
    }
    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t some = n - first < BLOCK ? n - first : BLOCK;
        block_vectors room_i, room_o;
        block_terms t;
        const facet_dirs i_dirs = block_of(wi, first, some, &room_i), o_dirs = block_of(wo, first, some, &room_o);
        find_terms_between(&given->d, whole_vectors(some), i_dirs, o_dirs, &t);
        float *restrict const r = f.r + first, *restrict const g = f.g + first, *restrict const b = f.b + first;
        float *restrict const out = pdf + first;
        _Pragma("omp simd") for (size_t i = 0; i < some; i++)
        {
            const bsdf_value both = microfacet_eval_pdf_with(p, terms_of(&t, i), gather(i_dirs, i), gather(o_dirs, i));
            r[i] = both.f.x;
            g[i] = both.f.y;
            b[i] = both.f.z;
            out[i] = both.pdf;
        }
    }
}

/* The normals of n samples, n of whole vectors. */
KERNEL void draw_normals(const microfacet_params *given, microfacet_params p, size_t n, facet_dirs wo, facet_dirs u,
                         block_vectors *m)
{
    if (p.is_ggx) {
        EACH_OF(n)
        scatter(m, i, microfacet_sample_normal(p, gather(wo, i), gather(u, i)));
        return;
    }
    const ndf_loops *loops = &loops_of_ndf[given->d.kind];
    if (p.sampling == SAMPLING_NDF) {
        loops->all_normals(&given->d, n, u, m);
        return;
    }
    float number[BLOCK];
    EACH_OF(n) number[i] = microfacet_mirror_number(p, gather(wo, i), u.z[i]);
    loops->visible_normals(&given->d, n, wo, (facet_dirs){u.x, u.y, number}, m);
}

KERNEL void microfacet_sample_staged(const microfacet_params *given, int variant, size_t n, facet_dirs wo, facet_dirs u,
                                     facet_samples s)
{
    const microfacet_params p = microfacet_fix(*given, variant);
    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t some = n - first < BLOCK ? n - first : BLOCK, whole = whole_vectors(some);
        block_vectors room_o, room_u, m, wi, about;
        block_terms t;
        const facet_dirs o_dirs = block_of(wo, first, some, &room_o), u_block = block_of(u, first, some, &room_u);
        draw_normals(given, p, whole, o_dirs, u_block, &m);
        EACH_OF(whole)
        {
            const real3 normal = gather(dirs_of(&m), i), viewer = gather(o_dirs, i);
            const real3 light = microfacet_sample_direction(p, viewer, gather(u_block, i), normal);
            scatter(&wi, i, light);
            scatter(&about, i, microfacet_normal_of(p, light, viewer, normal));
        }
        if (!p.is_ggx) find_terms(&given->d, whole, dirs_of(&wi), o_dirs, dirs_of(&about), &t);
        const facet_samples to = {s.wi_x + first,     s.wi_y + first,     s.wi_z + first,    s.pdf + first,
                                  s.weight_r + first, s.weight_g + first, s.weight_b + first};
        _Pragma("omp simd") for (size_t i = 0; i < some; i++)
        {
            const real3 light = gather(dirs_of(&wi), i), viewer = gather(o_dirs, i);
            const smith_terms terms = p.is_ggx
                                          ? smith_terms_at(p.d, p.sampling, light, viewer, gather(dirs_of(&about), i))
                                          : terms_of(&t, i);
            const bsdf_sample drawn = microfacet_complete(p, terms, light, viewer, gather(u_block, i),
                                                          gather(dirs_of(&m), i));
            to.wi_x[i] = drawn.wi.x;
            to.wi_y[i] = drawn.wi.y;
            to.wi_z[i] = drawn.wi.z;
            to.pdf[i] = drawn.pdf;
            to.weight_r[i] = drawn.weight.x;
            to.weight_g[i] = drawn.weight.y;
            to.weight_b[i] = drawn.weight.z;
        }
    }
}
