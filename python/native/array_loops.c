/* array_loops.c: the loops of array_loops.h, for float by libfacet's batches, and for double one element after another.
 * SPDX-License-Identifier: MIT */
#include "array_loops.h"

#include <stdint.h>
#include <string.h>

#include "array_layout.h"

/* Moving and checking numbers takes as long as evaluating ggx, unless by the widest registers; the loader picks. */
#if defined(__x86_64__) && defined(__gnu_linux__)
#define EACH_ISA __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define EACH_ISA
#endif

#define REAL float
#define BITS uint32_t
#define NAME(x) x##_f32
#define PUBLIC(x) facet_python_##x
#define BSDF facet_bsdf
#define SAMPLE facet_sample
#define TERMS facet_terms
#define BSDF_CALL(x) facet_bsdf_##x
#define HAS_BATCHES 1
#include "array_loops_text.h"
#undef REAL
#undef BITS
#undef NAME
#undef PUBLIC
#undef BSDF
#undef SAMPLE
#undef TERMS
#undef BSDF_CALL
#undef HAS_BATCHES

#define REAL double
#define BITS uint64_t
#define NAME(x) x##_f64
#define PUBLIC(x) facet_python_##x##64
#define BSDF facet_bsdf64
#define SAMPLE facet_sample64
#define TERMS facet_terms64
#define BSDF_CALL(x) facet_bsdf64_##x
#define HAS_BATCHES 0
#include "array_loops_text.h"
