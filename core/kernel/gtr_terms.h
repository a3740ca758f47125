/* gtr_terms.h: the sizes and forms of GTR's polynomials, for the kernel and for the code that fits them.
 * SPDX-License-Identifier: MIT */
#pragma once

#define GTR_TERMS  20 /* coefficients of a polynomial */
#define GTR_PIECES 8  /* polynomials of the double build */
#define GTR_GUESS  12 /* coefficients of the first guess at the inverse of T */

/* What the float build's polynomial gives, of which variable v. */
#define GTR_LOGARITHM 0 /* sqrt(A) of v = -ln s, for gamma below GTR_STEEP */
#define GTR_QUOTIENT  1 /* A of v = 1/s */
#define GTR_STEEP     3
