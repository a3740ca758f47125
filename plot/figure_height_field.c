/* figure_height_field.c: a quantity of a material over two variables, as the V-Ray note shows G1.
 *
 * Dimov, Deriving the Smith shadowing function G1 for gamma in (0, 4], 2015, sections 4 and 6.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/error.h"
#include "plot/figure.h"
#include "plot/frame.h"
#include "plot/relief.h"

/* Points along an angle, over which quantities may change fast, and along a parameter; the albedo, an integral, has
 * fewer; about how many mesh lines.  The height of the box whose sides are 1. */
enum { ANGLE_SIDE = 121, SIDE = 31, ALBEDO_SIDE = 17, MESH = 15 };
static const double HEIGHT = 0.75, DEGREE = 3.14159265358979323846/180;

typedef struct field {
    int n_x, n_y;
    double values[ANGLE_SIDE][ANGLE_SIDE]; /* [x][y] */
    axis x, y, z;
} field;

/* ---- Values ------------------------------------------------------------------------------------ */

enum { THETA, COS, TAN, COT, N_ANGLES, NO_ANGLE = N_ANGLES };

static const struct {
    const char *name, *label;
} variables[] = {
    {"theta", "θ [degrees]"}, {"cos", "cos θ [1]"}, {"tan", "tan θ [1]"},
    {"cot", "μ = cot θ [1]"}, {"alpha", "α [1]"},   {"gamma", "γ [1]"},
};
enum { N_VARIABLES = sizeof variables/sizeof *variables };

static int angle_of(const figure_variable *v)
{
    int k = 0;
    while (k < N_ANGLES && strcmp(v->name, variables[k].name) != 0) k++;
    return k;
}

static bool is_angle(const figure_variable *v)
{
    return angle_of(v) != NO_ANGLE;
}

const char *figure_variable_label(const figure_variable *v)
{
    for (int k = 0; k < N_VARIABLES; k++)
        if (strcmp(v->name, variables[k].name) == 0) return variables[k].label;
    return v->name;
}

static axis axis_of(const figure_variable *v)
{
    return (axis){figure_variable_label(v), angle_of(v) == THETA ? AXIS_DEGREES : AXIS_LINEAR, v->low, v->high};
}

static double theta_of(int angle, double value)
{
    switch (angle) {
    case COS: return acos(value)/DEGREE;
    case TAN: return atan(value)/DEGREE;
    case COT: return value > 0 ? atan(1/value)/DEGREE : 90;
    default: return value;
    }
}

static double quantity_of(const figure *f, const facet_bsdf64 *bsdf, double theta)
{
    double v[3], reflected[3], transmitted[3];
    figure_direction(theta, f->phi, v);
    if (strcmp(f->quantity, "D") == 0) return facet_bsdf64_D(bsdf, v);
    if (strcmp(f->quantity, "Lambda") == 0) return v[2] > 0 ? facet_bsdf64_terms(bsdf, v).Lambda : NAN;
    if (strcmp(f->quantity, "G1") == 0) return facet_bsdf64_terms(bsdf, v).G1;
    if (v[2] <= 0) return NAN;
    facet_bsdf64_albedo(bsdf, v, reflected, transmitted, NULL);
    return figure_channel_of(f, reflected);
}

/* Sets one of the variables: an angle, or a parameter of the material. */
static facet_status set_variable(const figure_variable *v, double value, facet_material *m, double *theta,
                                 facet_error *why)
{
    if (!is_angle(v)) return facet_material_set(m, v->name, &value, 1, why);
    *theta = theta_of(angle_of(v), value);
    return FACET_OK;
}

/* The share of the range at which point i lies: angles are closer to each other towards grazing, where masking sets
 * in. */
static double share_of(const figure_variable *v, int i, int n)
{
    const double t = (double)i/(n - 1);
    switch (angle_of(v)) {
    case THETA: return 1 - (1 - t)*(1 - t);
    case COS:
    case COT: return t*t;
    default: return t;
    }
}

static double between(const figure_variable *v, int i, int n)
{
    return v->low + (v->high - v->low)*share_of(v, i, n);
}

/* Adds `sign` times the quantity to the values. */
static facet_status add_values(const figure *f, const figure_material *m, double sign, field *d, facet_error *why)
{
    double theta = f->thetas[0];
    facet_bsdf64 bsdf = m->bsdf;
    facet_material material = m->material;
    /* The angle, if there is one, varies fastest, so that a material is prepared once for each of its parameters. */
    const bool is_x_angle = is_angle(&f->x), has_angle = is_x_angle || is_angle(&f->y);
    const int n_fast = is_x_angle ? d->n_x : d->n_y;
    for (int i = 0; i < d->n_x*d->n_y; i++) {
        const int fast = i%n_fast, slow = i/n_fast, x = is_x_angle ? fast : slow, y = is_x_angle ? slow : fast;
        facet_status status = set_variable(&f->x, between(&f->x, x, d->n_x), &material, &theta, why);
        if (!status) status = set_variable(&f->y, between(&f->y, y, d->n_y), &material, &theta, why);
        if (!status && (fast == 0 || !has_angle)) status = facet_bsdf64_prepare(&material, &bsdf, why);
        if (status) return status;
        d->values[x][y] += sign*f->times*quantity_of(f, &bsdf, theta);
    }
    return FACET_OK;
}

static facet_status check_range(const figure_variable *v, const char *place, const figure_material *m, facet_error *why)
{
    static const double highest[N_ANGLES] = {90, 1, 1e6, 1e6};
    const facet_model_info *model = facet_model_get(m->material.model);
    const int angle = angle_of(v);
    double low = 0, high = angle != NO_ANGLE ? highest[angle] : -1;
    for (size_t i = 0; angle == NO_ANGLE && i < model->n_parameters; i++) {
        const facet_parameter *p = &model->parameters[i];
        if (p->kind == FACET_CHOICE || strcmp(p->name, v->name) != 0) continue;
        low = p->low;
        high = p->high;
    }
    if (low > high)
        return facet_error_set(why, FACET_UNKNOWN_NAME, place,
                               "%s has no number called `%s`; name one of its parameters, or theta, cos, tan or cot",
                               model->name, v->name);
    if (v->low < low || v->high > high)
        return facet_error_set(why, FACET_BAD_VALUE, place, "%s of %s is from %g to %g", v->name, model->name, low,
                               high);
    return FACET_OK;
}

static facet_status check_variables(const figure *f, const figure_material *m, facet_error *why)
{
    if (strcmp(f->x.name, f->y.name) == 0 || (is_angle(&f->x) && is_angle(&f->y)))
        return facet_error_set(why, FACET_BAD_VALUE, "--x", "cannot be `%s` while --y is `%s`; vary two things",
                               f->x.name, f->y.name);
    const facet_status status = check_range(&f->x, "--x", m, why);
    return status ? status : check_range(&f->y, "--y", m, why);
}

static int point_count(const figure *f, const figure_variable *v)
{
    if (strcmp(f->quantity, "albedo") == 0) return ALBEDO_SIDE;
    return is_angle(v) ? ANGLE_SIDE : SIDE;
}

static facet_status measure(const figure *f, field *d, facet_error *why)
{
    const figure_material *const both[] = {f->materials, f->minus};
    *d = (field){.n_x = point_count(f, &f->x), .n_y = point_count(f, &f->y)};
    static const char what[] = "parameters that can be varied";
    facet_status status = figure_need_own(f, what, why);
    if (!status && f->minus) status = figure_need_own(&(figure){.materials = f->minus, .n_materials = 1}, what, why);
    if (!status && strcmp(f->quantity, "albedo") != 0) status = figure_need_terms(f, f->quantity, why);
    for (int k = 0; k < (f->minus ? 2 : 1) && !status; k++) {
        status = check_variables(f, both[k], why);
        if (!status) status = add_values(f, both[k], k ? -1 : 1, d, why);
    }
    if (status) return status;
    double low = INFINITY, high = -INFINITY;
    d->x = axis_of(&f->x);
    d->y = axis_of(&f->y);
    d->z = (axis){NULL, f->is_log ? AXIS_LOG : AXIS_LINEAR, f->low, f->high};
    for (int x = 0; x < d->n_x; x++)
        for (int y = 0; y < d->n_y; y++) {
            if (f->minus) d->values[x][y] = fabs(d->values[x][y]);
            axis_include(&d->z, d->values[x][y], &low, &high);
        }
    d->z = axis_fit(d->z, low, high);
    return FACET_OK;
}

/* ---- Drawing ----------------------------------------------------------------------------------- */

/* A point of the box by shares of its three axes. */
static point box_at(const relief *r, double x, double y, double z)
{
    const double p[3] = {x, y, HEIGHT*z};
    return relief_at(r, p);
}

static void draw_grid(canvas *page, const relief *r, const field *d)
{
    const pen thin = {LIGHT_GREY, 0.06, SOLID};
    const axis_ticks x = axis_make_ticks(&d->x, 6), y = axis_make_ticks(&d->y, 6), z = axis_make_ticks(&d->z, 6);
    for (size_t i = 0; i < x.n; i++) {
        const double t = axis_place(&d->x, x.ticks[i].value);
        canvas_segment(page, box_at(r, t, 0, 0), box_at(r, t, 1, 0), thin);
        canvas_segment(page, box_at(r, t, 1, 0), box_at(r, t, 1, 1), thin);
    }
    for (size_t i = 0; i < y.n; i++) {
        const double t = axis_place(&d->y, y.ticks[i].value);
        canvas_segment(page, box_at(r, 0, t, 0), box_at(r, 1, t, 0), thin);
        canvas_segment(page, box_at(r, 0, t, 0), box_at(r, 0, t, 1), thin);
    }
    for (size_t i = 0; i < z.n; i++) {
        const double t = axis_place(&d->z, z.ticks[i].value);
        if (!z.ticks[i].label[0]) continue;
        canvas_segment(page, box_at(r, 0, 0, t), box_at(r, 0, 1, t), thin);
        canvas_segment(page, box_at(r, 0, 1, t), box_at(r, 1, 1, t), thin);
    }
}

/* An edge of the box with its labels, which lie `away` from it on the page [em]. */
static void draw_edge(canvas *page, point from, point to, point away, const axis *a, double name_distance)
{
    const double em = canvas_em(page);
    const axis_ticks t = axis_make_ticks(a, 6);
    text_style style = {
        .size = LABEL_SIZE, .ink = BLACK, .across = 0.5 - 0.5*away.x, .down = 0.5, .is_formula = true};
    canvas_segment(page, from, to, (pen){BLACK, 0.08, SOLID});
    for (size_t i = 0; i < t.n; i++) {
        const double share = axis_place(a, t.ticks[i].value);
        const point at = {from.x + share*(to.x - from.x), from.y + share*(to.y - from.y)};
        if (!t.ticks[i].label[0]) continue;
        canvas_segment(page, at, (point){at.x + 0.3*em*away.x, at.y + 0.3*em*away.y},
                       (pen){BLACK, 0.07, SOLID});
        canvas_text(page, (point){at.x + 0.6*em*away.x, at.y + 0.9*em*away.y}, style, t.ticks[i].label);
    }
    if (!a->name) return;
    style.size = NAME_SIZE;
    canvas_text(page,
                (point){0.5*(from.x + to.x) + name_distance*em*away.x,
                        0.5*(from.y + to.y) + name_distance*em*away.y},
                style, a->name);
}

/* The edges of patch (i, k) that are on mesh lines, which are fewer. */
static unsigned mesh_edges(const field *d, int i, int k)
{
    const int x_step = d->n_x/MESH, y_step = d->n_y/MESH;
    return (unsigned)(k%y_step == 0) | (unsigned)((i + 1)%x_step == 0) << 1 |
           (unsigned)((k + 1)%y_step == 0) << 2 | (unsigned)(i%x_step == 0) << 3;
}

static void add_surface(relief *r, const figure *f, const field *d)
{
    for (int i = 0; i + 1 < d->n_x; i++)
        for (int k = 0; k + 1 < d->n_y; k++) {
            static const int next[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            double corners[4][3], sum = 0;
            for (int c = 0; c < 4; c++) {
                const int x = i + next[c][0], y = k + next[c][1];
                const double share = fmin(fmax(axis_place(&d->z, d->values[x][y]), 0), 1);
                corners[c][0] = share_of(&f->x, x, d->n_x);
                corners[c][1] = share_of(&f->y, y, d->n_y);
                corners[c][2] = HEIGHT*share;
                sum += isnan(d->values[x][y]) ? NAN : 0.25*share;
            }
            if (!isnan(sum)) relief_quad(r, corners, sequential_colour(sum), mesh_edges(d, i, k));
        }
}

facet_status draw_height_field(canvas *page, box place, const figure *f, facet_error *why)
{
    static const double low[3] = {0, 0, 0}, high[3] = {1, 1, 0.75};
    const double em = canvas_em(page);
    field d;
    relief *r;
    facet_status status = measure(f, &d, why);
    if (status) return status;
    char title[256];
    snprintf(title, sizeof title, f->minus ? "%s − %s" : "%s", f->title, f->minus ? f->minus->label : "");
    frame_title(page, &place, place.x + 0.5*place.width, title);
    const box inside = {place.x + 3.5*em, place.y + 2*em, place.width - 6.5*em, place.height - 5*em};
    if ((status = relief_create(inside, -60, 25, low, high, ANGLE_SIDE*ANGLE_SIDE, &r, why))) return status;
    draw_grid(page, r, &d);
    add_surface(r, f, &d);
    relief_draw(page, r);
    draw_edge(page, box_at(r, 0, 0, 0), box_at(r, 1, 0, 0), (point){-0.5, 0.87}, &d.x, 2.4);
    draw_edge(page, box_at(r, 1, 0, 0), box_at(r, 1, 1, 0), (point){0.87, 0.5}, &d.y, 2.2);
    draw_edge(page, box_at(r, 0, 0, 0), box_at(r, 0, 0, 1), (point){-1, 0}, &d.z, 0);
    char name[64], times[32] = "";
    const char *symbol = strcmp(f->quantity, "Lambda") == 0 ? "Λ"
                         : strcmp(f->quantity, "G1") == 0   ? "G_1"
                                                            : f->quantity;
    if (f->times != 1) snprintf(times, sizeof times, "%g × ", f->times);
    snprintf(name, sizeof name, f->minus ? "%s|difference of %s|%s" : "%s%s%s", times, symbol,
             strcmp(f->quantity, "D") == 0 ? " [1/sr]" : " [1]");
    const point top = box_at(r, 0, 0, 1);
    canvas_text(page, (point){fmin(place.x + 0.3*em, top.x - 3*em), top.y - 1.2*em},
                (text_style){.size = NAME_SIZE, .ink = BLACK, .down = 0.5, .is_formula = true}, name);
    relief_destroy(r);
    return FACET_OK;
}
