/* array_loops_text.h: the loops of array_loops.h for one type of number.
 *
 * Included by array_loops.c with REAL, and BITS, the unsigned integer of its size; NAME(x) and PUBLIC(x), names with
 * the type's suffix; BSDF and SAMPLE and TERMS, types of facet.h; BSDF_CALL(x), a function of facet.h; HAS_BATCHES,
 * whether there are batch functions of this type.
 * SPDX-License-Identifier: MIT */
#include "array_blocks_text.h"

/* ---- What is computed for one block ------------------------------------------------------------ */

static void NAME(eval_block)(const BSDF *bsdf, size_t n, const NAME(window)*wi, const NAME(window)*wo,
                             NAME(window)*f, NAME(window)*pdf)
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
static void NAME(sample_block)(const BSDF *bsdf, size_t n, const NAME(window)*wo, const NAME(window)*u,
                               NAME(window)*wi, NAME(window)*pdf, NAME(window)*weight, NAME(window)*eta,
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

static void NAME(terms_block)(const BSDF *bsdf, size_t n, const NAME(window)*m, NAME(window)*D,
                              NAME(window)*Lambda, NAME(window)*G1)
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

/* Inputs are checked, unless fault is NULL, when they are in the cache.  In float that is after they were used, which
 * lets computing hide the time that memory takes: float kernels look nothing up, so that any numbers are safe.  Double
 * ones do. */
#define CHECKS_FIRST (!HAS_BATCHES)

static int NAME(check_pair)(const NAME(window)*wi, const NAME(window)*wo, size_t n, size_t first,
                            facet_python_fault *fault)
{
    return !fault || NAME(are_units)(wi, wo, n) ||
           (NAME(tell)(wi, NAME(is_unit), n, first, 1, fault) && NAME(tell)(wo, NAME(is_unit), n, first, 2, fault));
}

static int NAME(check_draw)(const NAME(window)*wo, const NAME(window)*u, size_t n, size_t first,
                            facet_python_fault *fault)
{
    return !fault || NAME(are_units_and_in_cube)(wo, u, n) ||
           (NAME(tell)(wo, NAME(is_unit), n, first, 1, fault) && NAME(tell)(u, NAME(is_in_cube), n, first, 2, fault));
}

int PUBLIC(eval)(const BSDF *bsdf, size_t n, const facet_python_array *wi, const facet_python_array *wo,
                 const facet_python_array *f, const facet_python_array *pdf, facet_python_fault *fault)
{
    NAME(window) i, o, value, density;
    NAME(open_input)(&i, wi);
    NAME(open_input)(&o, wo);
    NAME(open_output)(&value, f, 3);
    NAME(open_output)(&density, pdf, 1);
    const int has_columns = i.layout == ARRAY_COLUMNS && o.layout == ARRAY_COLUMNS &&
                            (!f->data || value.layout == ARRAY_COLUMNS) &&
                            (!pdf->data || density.layout == ARRAY_COLUMNS);
    const array_work work = f->data ? ARRAY_VALUES : ARRAY_DENSITIES;
    const size_t size = has_columns ? array_columns_block(work, fault != NULL) : array_copies_block(work);
    EACH_BLOCK(n, size)
    {
        NAME(read)(&i, some);
        NAME(read)(&o, some);
        if (CHECKS_FIRST && !NAME(check_pair)(&i, &o, some, first, fault)) return 0;
        if (f->data) NAME(make_room)(&value, some);
        if (pdf->data) NAME(make_room)(&density, some);
        NAME(eval_block)(bsdf, some, &i, &o, f->data ? &value : NULL, pdf->data ? &density : NULL);
        if (!CHECKS_FIRST && !NAME(check_pair)(&i, &o, some, first, fault)) return 0;
        if (f->data) NAME(write)(&value, some);
        if (pdf->data) NAME(write)(&density, some);
    }
    return 1;
}

int PUBLIC(sample)(const BSDF *bsdf, size_t n, const facet_python_array *wo, const facet_python_array *u,
                   const facet_python_samples *samples, facet_python_fault *fault)
{
    const int has_lobes = samples->lobe.data != NULL;
    array_cursor at_lobe = array_cursor_start(&samples->lobe);
    NAME(window) o, x, i, density, weight, eta;
    NAME(open_input)(&o, wo);
    NAME(open_input)(&x, u);
    NAME(open_output)(&i, &samples->wi, 3);
    NAME(open_output)(&density, &samples->pdf, 1);
    NAME(open_output)(&weight, &samples->weight, 3);
    NAME(open_output)(&eta, &samples->eta, 1);
    const int has_rows = o.layout == ARRAY_ROWS || i.layout == ARRAY_ROWS,
              has_columns = o.layout == ARRAY_COLUMNS && x.layout == ARRAY_COLUMNS && i.layout == ARRAY_COLUMNS &&
                            density.layout == ARRAY_COLUMNS && weight.layout == ARRAY_COLUMNS && !has_lobes;
    const size_t size = has_columns ? array_columns_block(ARRAY_DRAWS, fault != NULL)
                        : has_rows  ? array_copies_block(ARRAY_DRAWS)
                                    : ARRAY_LARGEST_COPY;
    int32_t lobe[ARRAY_LARGEST_COPY] = {0};
    EACH_BLOCK(n, size)
    {
        NAME(read)(&o, some);
        NAME(read)(&x, some);
        if (CHECKS_FIRST && !NAME(check_draw)(&o, &x, some, first, fault)) return 0;
        NAME(make_room)(&i, some);
        NAME(make_room)(&density, some);
        NAME(make_room)(&weight, some);
        if (has_lobes) NAME(make_room)(&eta, some);
        NAME(sample_block)(bsdf, some, &o, &x, &i, &density, &weight, &eta, has_lobes ? lobe : NULL);
        if (!CHECKS_FIRST && !NAME(check_draw)(&o, &x, some, first, fault)) return 0;
        NAME(write)(&i, some);
        NAME(write)(&density, some);
        NAME(write)(&weight, some);
        if (!has_lobes) continue;
        NAME(write)(&eta, some);
        for (size_t k = 0; k < some; k++, array_cursor_advance(&at_lobe, 1)) *(int32_t *)(void *)at_lobe.at = lobe[k];
    }
    return 1;
}

int PUBLIC(terms)(const BSDF *bsdf, size_t n, const facet_python_array *m, const facet_python_array *D,
                  const facet_python_array *Lambda, const facet_python_array *G1, facet_python_fault *fault)
{
    const facet_python_array *const outputs[3] = {D, Lambda, G1};
    NAME(window) v, values[3];
    NAME(open_input)(&v, m);
    for (int k = 0; k < 3; k++) NAME(open_output)(&values[k], outputs[k], 1);
    const size_t size = array_copies_block(ARRAY_VALUES);
    EACH_BLOCK(n, size)
    {
        NAME(read)(&v, some);
        if (!NAME(tell)(&v, NAME(is_unit), some, first, 1, fault)) return 0;
        for (int k = 0; k < 3; k++)
            if (outputs[k]->data) NAME(make_room)(&values[k], some);
        NAME(terms_block)
        (bsdf, some, &v, D->data ? &values[0] : NULL, Lambda->data ? &values[1] : NULL, G1->data ? &values[2] : NULL);
        for (int k = 0; k < 3; k++)
            if (outputs[k]->data) NAME(write)(&values[k], some);
    }
    return 1;
}
#undef EACH_BLOCK
#undef CHECKS_FIRST
