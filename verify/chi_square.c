/* chi_square.c: see chi_square.h.
 * SPDX-License-Identifier: MIT */
#include "verify/chi_square.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_EXPECTED 5.0
#define NOTHING 1e-9

/* The regularised upper incomplete gamma function Q(a, x): series below x = a + 1, Lentz's fraction above. */
static double upper_gamma(double a, double x)
{
    if (x <= 0) return 1;
    const double scale = exp(a*log(x) - x - lgamma(a));
    if (x < a + 1) {
        double term = 1/a, sum = term;
        for (int k = 1; k < 10000 && term > 1e-17*sum; k++) {
            term *= x/(a + k);
            sum += term;
        }
        return 1 - scale*sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1/b, f = d;
    for (int k = 1; k < 10000; k++) {
        const double an = -k*(k - a);
        b += 2;
        d = 1/(an*d + b);
        c = b + an/c;
        f *= c*d;
        if (fabs(c*d - 1) < 1e-15) break;
    }
    return scale*f;
}

double chi_square_p(double statistic, int degrees)
{
    return upper_gamma(0.5*degrees, 0.5*statistic);
}

double sidak_level(double overall, int n)
{
    return -expm1(log1p(-overall)/n);
}

typedef struct cell {
    double expected, observed;
} cell;

static int by_expectation(const void *a, const void *b)
{
    const double x = ((const cell *)a)->expected, y = ((const cell *)b)->expected;
    return (x > y) - (x < y);
}

chi_square chi_square_test(const double *expected, const double *observed, int n_cells)
{
    chi_square result = {0};
    cell *cells = malloc((size_t)n_cells*sizeof *cells);
    if (!cells) abort();
    for (int i = 0; i < n_cells; i++) cells[i] = (cell){expected[i], observed[i]};
    qsort(cells, (size_t)n_cells, sizeof *cells, by_expectation);
    double pool_expected = 0, pool_observed = 0;
    int n = 0;
    for (int i = 0; i < n_cells; i++) {
        if (cells[i].expected < NOTHING) {
            result.forbidden += cells[i].observed;
            continue;
        }
        pool_expected += cells[i].expected;
        pool_observed += cells[i].observed;
        if (pool_expected < LEAST_EXPECTED) continue;
        const double difference = pool_observed - pool_expected;
        result.statistic += difference*difference/pool_expected;
        pool_expected = 0;
        pool_observed = 0;
        n++;
    }
    free(cells);
    result.degrees = n > 1 ? n - 1 : 0;
    result.p = n > 1 ? chi_square_p(result.statistic, result.degrees) : 1;
    return result;
}
