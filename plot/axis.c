/* axis.c: ranges and round numbers.
 * SPDX-License-Identifier: MIT */
#include "plot/axis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Beyond these a difference of two values, or a step between them, could overflow or vanish. */
static const double LARGEST = 1e290, SMALLEST = 1e-290;
static const double LOG_DECADES = 8;

/* Steps of 1, 2 and 5 times a power of ten; for angles those that divide the circle. */
static double step_above(double least, axis_scale scale)
{
    static const double angles[] = {1, 2, 5, 10, 15, 30, 45, 60, 90};
    for (size_t i = 0; scale == AXIS_DEGREES && least > 0.5 && i < sizeof angles/sizeof *angles; i++)
        if (angles[i] >= least) return angles[i];
    const double power = pow(10, floor(log10(least)));
    const double ratio = least/power*(1 - 1e-9);
    return (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10)*power;
}

/* ---- Ranges ------------------------------------------------------------------------------------ */

void axis_include(const axis *a, double value, double *low, double *high)
{
    if (!isfinite(value) || (a->scale == AXIS_LOG && value <= 0)) return;
    *low = fmin(*low, value);
    *high = fmax(*high, value);
}

static void fit_log(axis *a, double low, double high)
{
    if (!(high > 0) || !isfinite(high)) high = 1;
    high = fmin(fmax(high, SMALLEST), LARGEST);
    if (!(low > 0 && low <= high)) low = high/10;
    low = fmax(low, high*pow(10, -LOG_DECADES));
    a->high = pow(10, ceil(log10(high) - 1e-9));
    a->low = fmin(pow(10, floor(log10(low) + 1e-9)), a->high/10);
}

static void fit_linear(axis *a, double low, double high)
{
    if (!isfinite(low) || !isfinite(high) || low > high) {
        low = 0;
        high = 1;
    }
    low = fmin(fmax(low, -LARGEST), LARGEST);
    high = fmin(fmax(high, -LARGEST), LARGEST);
    if (low >= 0) low = 0;
    const double size = fmax(fabs(low), fabs(high));
    if (size < SMALLEST) high = low + 1;
    else if (high - low < 1e-9*size) {
        low -= 0.5*size;
        high += 0.5*size;
    }
    const double step = step_above((high - low)/8, a->scale);
    /* A value may lie beyond the end by what nobody sees. */
    a->low = step*floor(low/step + 2e-3);
    a->high = step*ceil(high/step - 2e-3);
}

axis axis_fit(axis a, double low, double high)
{
    if (a.low < a.high && (a.scale != AXIS_LOG || a.low > 0)) return a;
    if (a.scale == AXIS_LOG) fit_log(&a, low, high);
    else fit_linear(&a, low, high);
    return a;
}

double axis_place(const axis *a, double value)
{
    if (a->scale != AXIS_LOG) return (value - a->low)/(a->high - a->low);
    if (value <= 0) return -INFINITY;
    return log(value/a->low)/log(a->high/a->low);
}

/* ---- Ticks ------------------------------------------------------------------------------------- */

/* "-" and "e" as print has them. */
static void set_label(char label[AXIS_LABEL_CAP], const char *number)
{
    char exponent[16] = "";
    const char *e = strchr(number, 'e');
    if (e) {
        int power = 0;
        sscanf(e + 1, "%d", &power);
        snprintf(exponent, sizeof exponent, "%s%d", power < 0 ? "−" : "", power < 0 ? -power : power);
    }
    const int length = e ? (int)(e - number) : (int)strlen(number);
    const char *minus = *number == '-' ? "−" : "";
    const int skipped = *number == '-';
    snprintf(label, AXIS_LABEL_CAP, e ? "%s%.*s×10^{%s}" : "%s%.*s", minus, length - skipped, number + skipped,
             exponent);
}

static void add_tick(axis_ticks *t, double value, const char *label)
{
    if (t->n == AXIS_MOST_TICKS) return;
    t->ticks[t->n].value = value;
    snprintf(t->ticks[t->n++].label, AXIS_LABEL_CAP, "%s", label);
}

/* The label of k times the step; size: of the largest value on the axis. */
static void print_label(char label[AXIS_LABEL_CAP], double value, double step, double size)
{
    char number[AXIS_LABEL_CAP];
    const int n_digits = (int)ceil(log10(size/step) - 1e-9) + 1; /* that tell the ticks apart */
    const int n_decimals = step < 1 && value != 0 ? (int)ceil(-log10(step) - 1e-9) : 0;
    const bool is_plain = value == 0 || (size < 1e5 && size >= 1e-3 && n_decimals < 12);
    if (is_plain) snprintf(number, sizeof number, "%.*f", n_decimals, value);
    else snprintf(number, sizeof number, "%.*e", n_digits > 2 && n_digits < 12 ? n_digits - 1 : 0, value);
    set_label(label, number);
}

static axis_ticks linear_ticks(const axis *a, int most)
{
    axis_ticks t = {0};
    const double size = fmax(fabs(a->low), fabs(a->high));
    /* n labels have n - 1 steps between them.  A short range may lie between two ticks: then steps get smaller. */
    for (int n = most; t.n == 0; n++) {
        const double step = step_above((a->high - a->low)/(n - 1), a->scale);
        const double first = ceil(a->low/step - 1e-9), last = floor(a->high/step + 1e-9);
        for (double k = first; k <= last && t.n < AXIS_MOST_TICKS; k++) {
            char label[AXIS_LABEL_CAP];
            const double value = k == 0 ? 0 : k*step; /* no -0 */
            print_label(label, value, step, size);
            add_tick(&t, value, label);
        }
    }
    return t;
}

static void add_minor_ticks(axis_ticks *t, const axis *a, double decade)
{
    for (int k = 2; k < 10; k++)
        if (k*decade >= a->low && k*decade <= a->high) add_tick(t, k*decade, "");
}

/* A label for each decade, or for every few of them. */
static axis_ticks log_ticks(const axis *a, int most)
{
    enum { MOST_WITH_MINOR = 10, MOST_DECADES = 60 };
    axis_ticks t = {0};
    const int first = (int)ceil(log10(a->low) - 1e-9), last = (int)floor(log10(a->high) + 1e-9);
    if (last <= first) return linear_ticks(a, most);
    const int decades = last - first, stride = (decades + most)/most;
    if (decades <= MOST_WITH_MINOR) add_minor_ticks(&t, a, pow(10, first - 1));
    for (int k = first; k <= last; k++) {
        char label[AXIS_LABEL_CAP];
        if (k >= 0 && k <= 2) snprintf(label, sizeof label, "%.0f", pow(10, k));
        else if (k == -1) snprintf(label, sizeof label, "0.1");
        else snprintf(label, sizeof label, "10^{%s%d}", k < 0 ? "−" : "", abs(k));
        const bool is_labelled = (k - first)%stride == 0;
        if (is_labelled || decades < MOST_DECADES) add_tick(&t, pow(10, k), is_labelled ? label : "");
        if (decades <= MOST_WITH_MINOR) add_minor_ticks(&t, a, pow(10, k));
    }
    return t;
}

axis_ticks axis_make_ticks(const axis *a, int most)
{
    return a->scale == AXIS_LOG ? log_ticks(a, most) : linear_ticks(a, most);
}
