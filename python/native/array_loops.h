/* array_loops.h: libfacet over arrays as NumPy has them: any shape, any strides, float and double.
 *
 * An array is a block of reals, or of triples of reals (directions, colours), in any number of axes.  Broadcasting is a
 * stride of 0.  What lies one number after another is handed to the batch functions of facet.h as it is; everything
 * else goes through blocks that stay in the cache.
 *
 * python/facet/_library.py calls these through cffi; they are not part of libfacet.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { FACET_PYTHON_AXES = 64 }; /* NumPy's own limit */

/* `data` is NULL for an output that is not wanted.  All arrays of a call have the same number of elements. */
typedef struct facet_python_array {
    char *data;          /* the first element */
    ptrdiff_t component; /* bytes from x to y and from y to z */
    int n_axes;
    size_t shape[FACET_PYTHON_AXES];
    ptrdiff_t strides[FACET_PYTHON_AXES]; /* bytes */
} facet_python_array;

/* The first element that is not what the function needs: of the `argument`-th array, 0 for none. */
typedef struct facet_python_fault {
    int argument; /* from 1: wi, wo, or wo, u, or m */
    size_t element;
    double value[3];
} facet_python_fault;

/* Directions have unit length, |w|^2 = 1 within this: what rounding to five digits leaves. */
#define FACET_PYTHON_UNIT 1e-4

/* f |cos theta_i| and the pdf, either or both.  False and *fault if a direction is not a unit vector; the outputs then
 * hold what has no meaning.  With float, fault may be NULL here and below: nothing is checked, and what is not as it
 * should be gives numbers without meaning. */
FACET_API int facet_python_eval(const facet_bsdf *bsdf, size_t n, const facet_python_array *wi,
                                const facet_python_array *wo, const facet_python_array *f,
                                const facet_python_array *pdf, facet_python_fault *fault);
FACET_API int facet_python_eval64(const facet_bsdf64 *bsdf, size_t n, const facet_python_array *wi,
                                  const facet_python_array *wo, const facet_python_array *f,
                                  const facet_python_array *pdf, facet_python_fault *fault);

/* Draws wi for each wo from u, triples in [0,1).  lobe (int32) and eta come one by one, without batches. */
typedef struct facet_python_samples {
    facet_python_array wi, pdf, weight, lobe, eta;
} facet_python_samples;
FACET_API int facet_python_sample(const facet_bsdf *bsdf, size_t n, const facet_python_array *wo,
                                  const facet_python_array *u, const facet_python_samples *samples,
                                  facet_python_fault *fault);
FACET_API int facet_python_sample64(const facet_bsdf64 *bsdf, size_t n, const facet_python_array *wo,
                                    const facet_python_array *u, const facet_python_samples *samples,
                                    facet_python_fault *fault);

/* D(m), Lambda(m) and G1(m), those that are wanted. */
FACET_API int facet_python_terms(const facet_bsdf *bsdf, size_t n, const facet_python_array *m,
                                 const facet_python_array *D, const facet_python_array *Lambda,
                                 const facet_python_array *G1, facet_python_fault *fault);
FACET_API int facet_python_terms64(const facet_bsdf64 *bsdf, size_t n, const facet_python_array *m,
                                   const facet_python_array *D, const facet_python_array *Lambda,
                                   const facet_python_array *G1, facet_python_fault *fault);

#ifdef __cplusplus
}
#endif
