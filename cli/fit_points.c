/* fit_points.c: see fit_points.h.
 * SPDX-License-Identifier: MIT */
#include "cli/fit_points.h"

#include <math.h>
#include <stdlib.h>

#include "cli/csv_reader.h"
#include "cli/report.h"
#include "io/merl.h"

static const double PI = 3.14159265358979323846;

/* Places in the angles of a measurement: those of the half vector lie closer where lobes are narrow, as the file's own
 * do.  Beyond 80 degrees from the normal the database is known to be unreliable. */
enum { HALVES = 40, DIFFERENCES = 12, AZIMUTHS = 4 };
#define LEAST_COSINE 0.17

typedef struct point_list {
    fit_point *items;
    size_t n, room;
} point_list;

static fit_point *add_point(point_list *list)
{
    if (list->n == list->room) {
        const size_t room = list->room ? 2*list->room : 1024;
        fit_point *larger = realloc(list->items, room*sizeof *larger);
        if (!larger) return NULL;
        list->items = larger;
        list->room = room;
    }
    return &list->items[list->n++];
}

/* ---- CSV ----------------------------------------------------------------------------------------------------- */

static int read_row(const csv_reader *reader, const csv_row *row, fit_point *p)
{
    const int status = csv_directions(reader, row, p->wi, p->wo);
    for (int k = 0; k < 3 && !status; k++) {
        const double f = row->values[6 + k];
        if (!(f >= 0)) return csv_fail(reader, "f_%c is %g; a BRDF is not negative", "rgb"[k], f);
        p->value[k] = f*fabs(p->wi[2]);
    }
    return status;
}

static int read_csv(const char *path, point_list *list)
{
    static const char *const columns[] = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z", "f_r", "f_g", "f_b"};
    enum { COLUMNS = sizeof columns/sizeof *columns };
    csv_reader reader;
    csv_row row;
    bool is_end = false;
    int status = csv_open(&reader, path, columns, COLUMNS, COLUMNS);
    while (!status && !(status = csv_read(&reader, &row, &is_end)) && !is_end) {
        fit_point *p = add_point(list);
        status = p ? read_row(&reader, &row, p) : fail_memory();
    }
    csv_close(&reader);
    return status;
}

/* ---- MERL ---------------------------------------------------------------------------------------------------- */

/* Both directions from the angles of the half vector, of their difference, and its azimuth [rad]; y is across. */
static void find_directions(double half, double difference, double azimuth, double wi[3], double wo[3])
{
    const double s = sin(difference), c = cos(difference), x = s*cos(azimuth), y = s*sin(azimuth);
    wi[0] = cos(half)*x + sin(half)*c;
    wi[1] = y;
    wi[2] = -sin(half)*x + cos(half)*c;
    wo[0] = -cos(half)*x + sin(half)*c;
    wo[1] = -y;
    wo[2] = sin(half)*x + cos(half)*c;
}

static int read_merl(const char *path, point_list *list)
{
    merl m;
    facet_error why = {0};
    if (merl_read(path, &m, &why)) return fail_with(FROM_INPUT, path, &why);
    int status = 0;
    for (int i = 0; i < HALVES*DIFFERENCES*AZIMUTHS && !status; i++) {
        const int azimuth = i%AZIMUTHS, difference = i/AZIMUTHS%DIFFERENCES, half = i/AZIMUTHS/DIFFERENCES;
        const double h = ((double)half + 0.5)/HALVES, d = ((double)difference + 0.5)/DIFFERENCES;
        fit_point p = {.wi = {0}};
        find_directions(h*h*PI/2, d*PI/2, ((double)azimuth + 0.5)*PI/AZIMUTHS, p.wi, p.wo);
        if (p.wi[2] < LEAST_COSINE || p.wo[2] < LEAST_COSINE) continue;
        merl_eval(&m, p.wi, p.wo, p.value);
        fit_point *added = add_point(list);
        if (added) *added = p;
        else status = fail_memory();
    }
    merl_free(&m);
    return status;
}

int fit_points_read(const char *path, fit_points *points)
{
    point_list list = {0};
    int status = has_extension(path, "binary") ? read_merl(path, &list) : read_csv(path, &list);
    if (!status && list.n == 0) status = fail(EXIT_INPUT, path, NULL, "has no values; at least one row is needed");
    *points = (fit_points){list.n, list.items};
    if (status) fit_points_free(points);
    return status;
}

void fit_points_free(fit_points *points)
{
    free((fit_point *)points->items);
    *points = (fit_points){0};
}
