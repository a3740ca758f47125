/* figure_samples.c: where a sampler's directions go, and how fast their mean approaches the albedo.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/error.h"
#include "plot/chart.h"
#include "plot/figure.h"
#include "verify/views.h"

/* False if the draw gives no sample; the weight is then 0. */
static bool draw_one(const figure_material *m, const double wo[3], verify_random *random, double wi[3],
                     double weight[3])
{
    double u[3];
    for (int k = 0; k < 3; k++) u[k] = verify_draw(random);
    return figure_sample(m, wo, u, wi, weight);
}

/* ---- Scatter ----------------------------------------------------------------------------------- */

static const text_style label_style = {.size = LABEL_SIZE, .ink = {0.1, 0.1, 0.1, 1}, .across = 0.5, .down = 0.5};

/* The hemisphere from above; a ring for 30 and 60 degrees. */
static void draw_disc(canvas *page, point centre, double radius)
{
    const double em = canvas_em(page), half = sqrt(0.5)*radius;
    const pen thin = {LIGHT_GREY, 0.06, SOLID};
    canvas_circle(page, centre, 0.5*radius, thin);
    canvas_circle(page, centre, sqrt(0.75)*radius, thin);
    canvas_segment(page, (point){centre.x - radius, centre.y}, (point){centre.x + radius, centre.y}, thin);
    canvas_segment(page, (point){centre.x, centre.y - radius}, (point){centre.x, centre.y + radius}, thin);
    canvas_circle(page, centre, radius, (pen){BLACK, 0.07, SOLID});
    text_style style = label_style;
    static const char *const names[] = {"30°", "60°", "90°"};
    const double places[] = {0.5*half, sqrt(0.75)*half, half};
    for (int k = 0; k < 3; k++) {
        const double away = k == 2 ? 0.5*em : -0.5*em; /* from the ring */
        style.across = k == 2 ? 0 : 1;
        canvas_text(page, (point){centre.x + places[k] + away, centre.y + places[k] + away}, style, names[k]);
    }
}

facet_status draw_samples(canvas *page, box place, const figure *f, facet_error *why)
{
    const facet_status status = figure_need_sampler(f, why);
    if (status) return status;
    const double em = canvas_em(page);
    frame_title(page, &place, place.x + 0.5*place.width, f->title);
    const double radius = 0.5*fmin(place.width - em, place.height - 4*em);
    const point centre = {place.x + 0.5*place.width, place.y + radius + 0.3*em};
    draw_disc(page, centre, radius);
    double wo[3];
    figure_direction(-f->thetas[0], f->phi, wo);
    verify_random random = {f->seed};
    uint64_t n_lost = 0;
    for (uint64_t i = 0; i < f->n_samples; i++) {
        double wi[3], weight[3];
        if (!draw_one(&f->materials[0], wo, &random, wi, weight)) {
            n_lost++;
            continue;
        }
        const colour ink = palette_colour(wi[2] > 0 ? 0 : 1);
        canvas_disc(page, (point){centre.x + radius*wi[0], centre.y - radius*wi[1]}, 0.11*em,
                    (colour){ink.r, ink.g, ink.b, 0.55});
    }
    const point view = {centre.x + radius*wo[0], centre.y - radius*wo[1]};
    canvas_circle(page, view, 0.4*em, (pen){BLACK, 0.13, SOLID});
    text_style style = label_style;
    style.is_formula = true;
    canvas_text(page, (point){view.x + 0.9*em, view.y - 1.1*em}, style, "ω_o");
    const bool has_two_sides = figure_transmits(&f->materials[0]);
    char note[128];
    snprintf(note, sizeof note, "%" PRIu64 " directions ω_i seen from above%s, %" PRIu64 " without a sample",
             f->n_samples, has_two_sides ? " (below: orange)" : "", n_lost);
    const double width = canvas_text_width(page, style, note), room = place.width - em;
    if (width > room) style.size *= room/width;
    canvas_text(page, (point){place.x + 0.5*place.width, centre.y + radius + 1.6*em}, style, note);
    return FACET_OK;
}

/* ---- Convergence ------------------------------------------------------------------------------- */

enum { N_RUNS = 100, MOST_COUNTS = 64, LOWER = 10, UPPER = 89 };

typedef struct convergence {
    double n[MOST_COUNTS], rms[MOST_COUNTS], below[MOST_COUNTS], above[MOST_COUNTS];
    char label[256];
} convergence;

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Smaller than this is the quadrature's own error, or rounding. */
static double shown(double error)
{
    return error > 1e-6 ? error : NAN;
}

static size_t converge(const figure *f, const figure_material *m, convergence *c)
{
    double wo[3], reflected, transmitted, sums[N_RUNS] = {0}, errors[N_RUNS];
    figure_direction(-f->thetas[0], f->phi, wo);
    figure_albedo(f, m, wo, &reflected, &transmitted);
    const double truth = reflected + transmitted;
    verify_random random[N_RUNS];
    for (int run = 0; run < N_RUNS; run++) random[run].state = f->seed + ((uint64_t)run << 40);
    size_t n_counts = 0;
    uint64_t done = 0;
    for (uint64_t n = 1; done < f->n_samples && n_counts < MOST_COUNTS; n = (3*n + 1)/2) {
        if (n > f->n_samples) n = f->n_samples;
        double squares = 0;
        for (int run = 0; run < N_RUNS; run++) {
            for (uint64_t i = done; i < n; i++) {
                double wi[3], weight[3];
                if (draw_one(m, wo, &random[run], wi, weight)) sums[run] += figure_channel_of(f, weight);
            }
            errors[run] = fabs(sums[run]/(double)n/truth - 1);
            squares += errors[run]*errors[run];
        }
        done = n;
        qsort(errors, N_RUNS, sizeof *errors, compare_numbers);
        c->n[n_counts] = (double)n;
        c->rms[n_counts] = shown(sqrt(squares/N_RUNS));
        c->below[n_counts] = shown(errors[LOWER]);
        c->above[n_counts++] = shown(errors[UPPER]);
    }
    snprintf(c->label, sizeof c->label, "%s%s", m->label, isnan(c->rms[0]) ? " (no error)" : "");
    return n_counts;
}

facet_status draw_convergence(canvas *page, box place, const figure *f, facet_error *why)
{
    convergence *runs = malloc(f->n_materials*sizeof *runs);
    series *items = malloc(f->n_materials*sizeof *items);
    facet_status status = figure_need_sampler(f, why);
    if (!runs || !items) {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for the runs");
        goto done;
    }
    if (status) goto done;
    for (size_t k = 0; k < f->n_materials; k++) {
        const size_t n = converge(f, &f->materials[k], &runs[k]);
        items[k] = series_make(k, runs[k].label, n, runs[k].n, runs[k].rms);
        items[k].below = runs[k].below;
        items[k].above = runs[k].above;
    }
    char title[128];
    snprintf(title, sizeof title, "Sampled albedo, viewer at %g°: %d runs, the middle 80 %% shaded", f->thetas[0],
             N_RUNS);
    const chart c = {.title = f->title ? f->title : title,
                     .x = {"number of samples [1]", AXIS_LOG, 1, (double)f->n_samples},
                     .y = {"root mean square of the relative error [1]", AXIS_LOG, f->low, f->high},
                     .items = items,
                     .n_items = f->n_materials};
    chart_draw(page, place, &c);
done:
    free(items);
    free(runs);
    return status;
}
