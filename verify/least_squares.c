/* least_squares.c: Levenberg and Marquardt's method in a box.
 *
 * [more78] More, The Levenberg-Marquardt algorithm: implementation and theory, 1978: steps scaled by the columns' own
 * lengths.
 * SPDX-License-Identifier: MIT */
#include "verify/least_squares.h"

#include <math.h>
#include <string.h>

enum { MOST_STEPS = 200, LAST_STEPS = 4 };

/* Where LAST_STEPS in a row lower the sum of squares by less than this part of itself, the end is reached. */
#define ENOUGH 1e-9

/* Of an unknown: its derivatives are good to about as much. */
#define DIFFERENCE 1e-6

/* The parts of the workspace. */
typedef struct matrices {
    double *residuals, *moved, *jacobian;          /* [n_residuals], the same, [n][n_residuals] */
    double *normal, *factor;                       /* [n][n] */
    double *gradient, *step, *next, *right, *held; /* [n]; held: 1 or 0 */
} matrices;

size_t least_squares_room(size_t n, size_t n_residuals)
{
    return (n + 2)*n_residuals + 2*n*n + 5*n;
}

static matrices divide(const least_squares *p)
{
    matrices m;
    m.residuals = p->work;
    m.moved = m.residuals + p->n_residuals;
    m.jacobian = m.moved + p->n_residuals;
    m.normal = m.jacobian + p->n*p->n_residuals;
    m.factor = m.normal + p->n*p->n;
    m.gradient = m.factor + p->n*p->n;
    m.step = m.gradient + p->n;
    m.next = m.step + p->n;
    m.right = m.next + p->n;
    m.held = m.right + p->n;
    return m;
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i]*b[i];
    return sum;
}

static double square_sum(const least_squares *p, const double *x, double *residuals)
{
    return p->evaluate(p->user, x, residuals) ? dot(residuals, residuals, p->n_residuals) : INFINITY;
}

/* The derivatives at x, the products of them, and with the residuals. */
static void differentiate(const least_squares *p, const matrices *m, const double *x)
{
    const size_t n = p->n, many = p->n_residuals;
    memcpy(m->next, x, n*sizeof *x);
    for (size_t i = 0; i < n; i++) {
        const double h = x[i] < 0.5 ? DIFFERENCE : -DIFFERENCE;
        double *column = m->jacobian + i*many;
        m->next[i] = x[i] + h;
        const bool is_there = p->evaluate(p->user, m->next, m->moved);
        m->next[i] = x[i];
        for (size_t k = 0; k < many; k++) column[k] = is_there ? (m->moved[k] - m->residuals[k])/h : 0;
    }
    for (size_t i = 0; i < n; i++) {
        m->gradient[i] = dot(m->jacobian + i*many, m->residuals, many);
        for (size_t j = 0; j <= i; j++)
            m->normal[i*n + j] = m->normal[j*n + i] = dot(m->jacobian + i*many, m->jacobian + j*many, many);
    }
}

/* Solves (N + damping diag N) step = -gradient by Cholesky's method for the unknowns that are not held, whose steps are
 * known. */
static void solve(const least_squares *p, const matrices *m, double damping)
{
    const size_t n = p->n;
    double *const L = m->factor, *const y = m->right;
    for (size_t i = 0; i < n; i++) {
        y[i] = -m->gradient[i];
        for (size_t k = 0; k < n; k++) y[i] -= m->held[k] > 0 ? m->normal[i*n + k]*m->step[k] : 0;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            double sum = m->held[i] > 0 || m->held[j] > 0 ? 0 : m->normal[i*n + j];
            if (i == j) sum = m->held[i] > 0 ? 1 : sum*(1 + damping);
            for (size_t k = 0; k < j; k++) sum -= L[i*n + k]*L[j*n + k];
            L[i*n + j] = i > j ? sum/L[j*n + j] : sqrt(fmax(sum, 1e-300));
        }
        for (size_t k = 0; k < i; k++) y[i] -= L[i*n + k]*y[k];
        y[i] = m->held[i] > 0 ? 0 : y[i]/L[i*n + i];
    }
    for (size_t i = n; i-- > 0;) {
        if (m->held[i] > 0) continue;
        for (size_t k = i + 1; k < n; k++) y[i] -= m->held[k] > 0 ? 0 : L[k*n + i]*y[k];
        m->step[i] = y[i] /= L[i*n + i];
    }
}

/* A step from x that stays in the box: what would leave it goes to the bound, and the others make the best of that. */
static void choose_step(const least_squares *p, const matrices *m, const double *x, double damping)
{
    for (size_t i = 0; i < p->n; i++) {
        const bool rests = (x[i] <= 0 && m->gradient[i] > 0) || (x[i] >= 1 && m->gradient[i] < 0);
        m->held[i] = rests || !(m->normal[i*p->n + i] > 0);
        m->step[i] = 0;
    }
    for (bool is_new = true; is_new;) {
        is_new = false;
        solve(p, m, damping);
        for (size_t i = 0; i < p->n; i++) {
            const double end = x[i] + m->step[i];
            if (m->held[i] > 0 || (end >= 0 && end <= 1)) continue;
            m->step[i] = (end < 0 ? 0 : 1) - x[i];
            m->held[i] = is_new = true;
        }
    }
}

double least_squares_descend(const least_squares *p, double *x)
{
    const matrices m = divide(p);
    double least = square_sum(p, x, m.residuals), damping = 1e-3;
    bool is_new = true;
    int n_last = 0;
    for (int i = 0; i < MOST_STEPS && n_last < LAST_STEPS && least > 0 && least < INFINITY && damping < 1e9; i++) {
        if (is_new) differentiate(p, &m, x);
        choose_step(p, &m, x, damping);
        for (size_t k = 0; k < p->n; k++) m.next[k] = fmin(fmax(x[k] + m.step[k], 0), 1);
        const double sum = square_sum(p, m.next, m.moved);
        is_new = sum < least;
        damping *= is_new ? 0.2 : 5;
        if (!is_new) continue;
        n_last = least - sum < ENOUGH*least ? n_last + 1 : 0;
        memcpy(x, m.next, p->n*sizeof *x);
        memcpy(m.residuals, m.moved, p->n_residuals*sizeof *m.residuals);
        least = sum;
    }
    return least;
}
