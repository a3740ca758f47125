/* array_loops_text.h: the loops of array_loops.h for one type of number.
 *
 * Included by array_loops.c with REAL; NAME(x) and PUBLIC(x), names with the type's suffix; BSDF and SAMPLE and TERMS,
 * types of facet.h; BSDF_CALL(x), a function of facet.h; HAS_BATCHES, whether there are batch functions of this type.
 * SPDX-License-Identifier: MIT */
#include "array_blocks_text.h"

/* ---- What is computed for one block ------------------------------------------------------------ */

static void NAME(eval_block)(const BSDF *bsdf, size_t n, const NAME(block)*wi, const NAME(block)*wo,
                             NAME(block)*f, NAME(block)*pdf)
{
#if HAS_BATCHES
    const facet_dirs i = {wi->part[0], wi->part[1], wi->part[2]}, o = {wo->part[0], wo->part[1], wo->part[2]};
    if (f && pdf)
        facet_bsdf_eval_pdf_batch(bsdf, n, i, o, (facet_rgb){f->part[0], f->part[1], f->part[2]}, pdf->part[0]);
    else if (f) facet_bsdf_eval_batch(bsdf, n, i, o, (facet_rgb){f->part[0], f->part[1], f->part[2]});
    else facet_bsdf_pdf_batch(bsdf, n, i, o, pdf->part[0]);
#else
    for (size_t k = 0; k < n; k++) {
        const REAL i[3] = {wi->part[0][k], wi->part[1][k], wi->part[2][k]},
                   o[3] = {wo->part[0][k], wo->part[1][k], wo->part[2][k]};
        REAL value[3] = {0}, density = 0;
        if (f && pdf) density = BSDF_CALL(eval_pdf)(bsdf, i, o, value);
        else if (f) BSDF_CALL(eval)(bsdf, i, o, value);
        else density = BSDF_CALL(pdf)(bsdf, i, o);
        for (int c = 0; f && c < 3; c++) f->part[c][k] = value[c];
        if (pdf) pdf->part[0][k] = density;
    }
#endif
}

/* lobe and eta may be NULL, both or neither. */
static void NAME(sample_block)(const BSDF *bsdf, size_t n, const NAME(block)*wo, const NAME(block)*u,
                               NAME(block)*wi, NAME(block)*pdf, NAME(block)*weight, NAME(block)*eta,
                               int32_t *lobe)
{
#if HAS_BATCHES
    if (!lobe) {
        facet_bsdf_sample_batch(bsdf, n, (facet_dirs){wo->part[0], wo->part[1], wo->part[2]},
                                (facet_dirs){u->part[0], u->part[1], u->part[2]},
                                (facet_samples){wi->part[0], wi->part[1], wi->part[2], pdf->part[0], weight->part[0],
                                                weight->part[1], weight->part[2]});
        return;
    }
#endif
    for (size_t k = 0; k < n; k++) {
        const REAL o[3] = {wo->part[0][k], wo->part[1][k], wo->part[2][k]},
                   x[3] = {u->part[0][k], u->part[1][k], u->part[2][k]};
        const SAMPLE s = BSDF_CALL(sample)(bsdf, o, x);
        for (int c = 0; c < 3; c++) {
            wi->part[c][k] = s.wi[c];
            weight->part[c][k] = s.weight[c];
        }
        pdf->part[0][k] = s.pdf;
        if (!lobe) continue;
        eta->part[0][k] = s.eta;
        lobe[k] = s.lobe;
    }
}

static void NAME(terms_block)(const BSDF *bsdf, size_t n, const NAME(block)*m, NAME(block)*D, NAME(block)*Lambda,
                              NAME(block)*G1)
{
    for (size_t k = 0; k < n; k++) {
        const REAL v[3] = {m->part[0][k], m->part[1][k], m->part[2][k]};
        if (!Lambda && !G1) {
            D->part[0][k] = BSDF_CALL(D)(bsdf, v);
            continue;
        }
        const TERMS t = BSDF_CALL(terms)(bsdf, v);
        if (D) D->part[0][k] = t.D;
        if (Lambda) Lambda->part[0][k] = t.Lambda;
        if (G1) G1->part[0][k] = t.G1;
    }
}

/* ---- The public loops -------------------------------------------------------------------------- */

/* Runs over blocks of a size: `some` elements from `first`. */
#define EACH_BLOCK(n, size)                                                                                            \
    for (size_t first = 0, some = 0; some = (n)-first < (size) ? (n)-first : (size), first < (n); first += some)

/* Inputs are checked when they are in the cache.  In float that is after they were used, which lets computing hide the
 * time that memory takes: float kernels look nothing up, so that any numbers are safe.  Double ones do. */
#define CHECKS_FIRST (!HAS_BATCHES)

static int NAME(check_pair)(const NAME(block)*wi, const NAME(block)*wo, size_t n, size_t first,
                            facet_python_fault *fault)
{
    return NAME(are_units)(wi, wo, n) ||
           (NAME(tell)(wi, NAME(is_unit), n, first, 1, fault) && NAME(tell)(wo, NAME(is_unit), n, first, 2, fault));
}

static int NAME(check_draw)(const NAME(block)*wo, const NAME(block)*u, size_t n, size_t first,
                            facet_python_fault *fault)
{
    return NAME(are_units_and_in_cube)(wo, u, n) ||
           (NAME(tell)(wo, NAME(is_unit), n, first, 1, fault) && NAME(tell)(u, NAME(is_in_cube), n, first, 2, fault));
}

int PUBLIC(eval)(const BSDF *bsdf, size_t n, const facet_python_array *wi, const facet_python_array *wo,
                 const facet_python_array *f, const facet_python_array *pdf, facet_python_fault *fault)
{
    array_cursor at_wi = array_cursor_start(wi), at_wo = array_cursor_start(wo), at_f = array_cursor_start(f),
                 at_pdf = array_cursor_start(pdf);
    NAME(block) i, o, value, density;
    EACH_BLOCK(n, ARRAY_BLOCK)
    {
        NAME(read_block)(&i, &at_wi, some, 3);
        NAME(read_block)(&o, &at_wo, some, 3);
        if (CHECKS_FIRST && !NAME(check_pair)(&i, &o, some, first, fault)) return 0;
        if (f->data) NAME(point)(&value, &at_f, some, 3);
        if (pdf->data) NAME(point)(&density, &at_pdf, some, 1);
        NAME(eval_block)(bsdf, some, &i, &o, f->data ? &value : NULL, pdf->data ? &density : NULL);
        if (!CHECKS_FIRST && !NAME(check_pair)(&i, &o, some, first, fault)) return 0;
        if (f->data) NAME(write_block)(&value, &at_f, some, 3);
        if (pdf->data) NAME(write_block)(&density, &at_pdf, some, 1);
    }
    return 1;
}

int PUBLIC(sample)(const BSDF *bsdf, size_t n, const facet_python_array *wo, const facet_python_array *u,
                   const facet_python_samples *samples, facet_python_fault *fault)
{
    array_cursor at_wo = array_cursor_start(wo), at_u = array_cursor_start(u), at_wi = array_cursor_start(&samples->wi),
                 at_pdf = array_cursor_start(&samples->pdf), at_weight = array_cursor_start(&samples->weight),
                 at_lobe = array_cursor_start(&samples->lobe), at_eta = array_cursor_start(&samples->eta);
    const int has_lobes = samples->lobe.data != NULL;
    NAME(block) o, x, i, density, weight, eta;
    int32_t lobe[ARRAY_SAMPLE_BLOCK] = {0};
    EACH_BLOCK(n, ARRAY_SAMPLE_BLOCK)
    {
        NAME(read_block)(&o, &at_wo, some, 3);
        NAME(read_block)(&x, &at_u, some, 3);
        if (CHECKS_FIRST && !NAME(check_draw)(&o, &x, some, first, fault)) return 0;
        NAME(expect_block)(&at_u, some); /* the kernels leave parts of u alone, which the check then waits for */
        NAME(point)(&i, &at_wi, some, 3);
        NAME(point)(&density, &at_pdf, some, 1);
        NAME(point)(&weight, &at_weight, some, 3);
        if (has_lobes) NAME(point)(&eta, &at_eta, some, 1);
        NAME(sample_block)(bsdf, some, &o, &x, &i, &density, &weight, &eta, has_lobes ? lobe : NULL);
        if (!CHECKS_FIRST && !NAME(check_draw)(&o, &x, some, first, fault)) return 0;
        NAME(write_block)(&i, &at_wi, some, 3);
        NAME(write_block)(&density, &at_pdf, some, 1);
        NAME(write_block)(&weight, &at_weight, some, 3);
        if (!has_lobes) continue;
        NAME(write_block)(&eta, &at_eta, some, 1);
        for (size_t k = 0; k < some; k++, array_cursor_advance(&at_lobe, 1)) *(int32_t *)(void *)at_lobe.at = lobe[k];
    }
    return 1;
}

int PUBLIC(terms)(const BSDF *bsdf, size_t n, const facet_python_array *m, const facet_python_array *D,
                  const facet_python_array *Lambda, const facet_python_array *G1, facet_python_fault *fault)
{
    const facet_python_array *const outputs[3] = {D, Lambda, G1};
    array_cursor at_m = array_cursor_start(m), at[3];
    for (int k = 0; k < 3; k++) at[k] = array_cursor_start(outputs[k]);
    NAME(block) v, values[3];
    EACH_BLOCK(n, ARRAY_BLOCK)
    {
        NAME(read_block)(&v, &at_m, some, 3);
        if (!NAME(tell)(&v, NAME(is_unit), some, first, 1, fault)) return 0;
        for (int k = 0; k < 3; k++)
            if (outputs[k]->data) NAME(point)(&values[k], &at[k], some, 1);
        NAME(terms_block)
        (bsdf, some, &v, D->data ? &values[0] : NULL, Lambda->data ? &values[1] : NULL, G1->data ? &values[2] : NULL);
        for (int k = 0; k < 3; k++)
            if (outputs[k]->data) NAME(write_block)(&values[k], &at[k], some, 1);
    }
    return 1;
}
#undef EACH_BLOCK
#undef CHECKS_FIRST
