/* canvas.c: the canvas on Cairo, whose headers are seen here only.
 * SPDX-License-Identifier: MIT */
#include "plot/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"
#include "plot/words.h"

struct canvas {
    canvas_kind kind;
    double em;
    cairo_surface_t *surface;
    cairo_t *context;
    unsigned char *bytes; /* of the SVG or PDF file */
    size_t size, capacity;
};

static const double DEGREE = 3.14159265358979323846/180;

static cairo_status_t keep(void *closure, const unsigned char *bytes, unsigned int n)
{
    canvas *page = closure;
    if (page->size + n > page->capacity) {
        const size_t capacity = 2*page->capacity + n;
        unsigned char *grown = realloc(page->bytes, capacity);
        if (!grown) return CAIRO_STATUS_NO_MEMORY;
        page->bytes = grown;
        page->capacity = capacity;
    }
    memcpy(page->bytes + page->size, bytes, n);
    page->size += n;
    return CAIRO_STATUS_SUCCESS;
}

static cairo_surface_t *create_surface(canvas *page, double width, double height)
{
    const double points = 72.0/96; /* of a pixel */
    cairo_surface_t *surface = NULL;
    switch (page->kind) {
    case CANVAS_SVG:
        surface = cairo_svg_surface_create_for_stream(keep, page, width, height);
        cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
        break;
    case CANVAS_PDF:
        surface = cairo_pdf_surface_create_for_stream(keep, page, points*width, points*height);
        cairo_surface_set_device_scale(surface, points, points);
        /* In place of the time of day. */
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
        break;
    case CANVAS_PNG:
    case CANVAS_UNKNOWN: surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)height); break;
    }
    return surface;
}

static facet_status check_drawing(canvas *page, facet_error *why)
{
    cairo_status_t status = cairo_status(page->context);
    if (!status) status = cairo_surface_status(page->surface);
    if (!status) return FACET_OK;
    return facet_error_set(why, status == CAIRO_STATUS_NO_MEMORY ? FACET_NO_MEMORY : FACET_IO, "",
                           "the picture cannot be drawn: %s", cairo_status_to_string(status));
}

facet_status canvas_create(canvas_kind kind, double width, double height, double em, canvas **page, facet_error *why)
{
    canvas *made = calloc(1, sizeof *made);
    if (!made) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a picture");
    made->kind = kind;
    made->em = em;
    made->surface = create_surface(made, width, height);
    made->context = cairo_create(made->surface);
    const facet_status status = check_drawing(made, why);
    if (status) {
        canvas_destroy(made);
        return status;
    }
    /* Outlines as the font has them, so that text has the same width on every surface. */
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(made->context, options);
    cairo_font_options_destroy(options);
    cairo_set_line_join(made->context, CAIRO_LINE_JOIN_ROUND);
    canvas_fill_box(made, (box){0, 0, width, height}, WHITE);
    *page = made;
    return FACET_OK;
}

void canvas_destroy(canvas *page)
{
    if (!page) return;
    cairo_destroy(page->context);
    cairo_surface_destroy(page->surface);
    free(page->bytes);
    free(page);
}

double canvas_em(const canvas *page)
{
    return page->em;
}

/* ---- Files ------------------------------------------------------------------------------------- */

static facet_status write_pixels(canvas *page, const char *path, const image_text *texts, size_t n_texts,
                                 facet_error *why)
{
    const size_t width = (size_t)cairo_image_surface_get_width(page->surface);
    const size_t height = (size_t)cairo_image_surface_get_height(page->surface);
    const size_t stride = (size_t)cairo_image_surface_get_stride(page->surface);
    const unsigned char *rows = cairo_image_surface_get_data(page->surface);
    unsigned char *pixels = malloc(3*width*height);
    if (!pixels) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for %zux%zu pixels", width, height);
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            uint32_t pixel;
            memcpy(&pixel, rows + y*stride + 4*x, 4);
            for (int k = 0; k < 3; k++)
                pixels[3*(y*width + x) + (size_t)k] = (unsigned char)(pixel >> (16 - 8*k));
        }
    const image picture = {width, height, 3, PIXEL_U8, pixels};
    const facet_status status = png_write(path, &picture, texts, n_texts, why);
    free(pixels);
    return status;
}

static void put_escaped(FILE *stream, const char *text)
{
    for (; *text; text++) switch (*text) {
        case '&': fputs("&amp;", stream); break;
        case '<': fputs("&lt;", stream); break;
        case '>': fputs("&gt;", stream); break;
        default: fputc((unsigned char)*text < 32 ? ' ' : *text, stream);
        }
}

/* The texts as <title> and <desc>, behind the opening tag. */
static void put_svg(FILE *stream, const canvas *page, const image_text *texts, size_t n_texts)
{
    const char *svg = (const char *)page->bytes, *end = svg + page->size, *tag = svg;
    while (tag + 4 < end && memcmp(tag, "<svg", 4) != 0) tag++;
    const char *rest = memchr(tag, '>', (size_t)(end - tag));
    rest = rest ? rest + 1 : end;
    fwrite(svg, 1, (size_t)(rest - svg), stream);
    for (size_t i = 0; i < n_texts; i++) {
        char value[WORDS_CAP];
        words_clean(texts[i].value, value);
        fputs(i == 0 ? "\n<title>" : i == 1 ? "\n<desc>" : "\n", stream);
        if (i > 0) fprintf(stream, "%s: ", texts[i].key);
        put_escaped(stream, value);
        if (i == 0) fputs("</title>", stream);
        else if (i + 1 == n_texts) fputs("</desc>", stream);
    }
    fwrite(rest, 1, (size_t)(end - rest), stream);
}

static void describe_pdf(canvas *page, const image_text *texts, size_t n_texts)
{
    char all[2*WORDS_CAP] = "", value[WORDS_CAP];
    for (size_t i = 1; i < n_texts; i++) {
        const size_t length = strlen(all);
        snprintf(all + length, sizeof all - length, "%s%s: %s", i > 1 ? "; " : "", texts[i].key, texts[i].value);
    }
    words_clean(all, value);
    cairo_pdf_surface_set_metadata(page->surface, CAIRO_PDF_METADATA_SUBJECT, value);
    if (n_texts) {
        words_clean(texts[0].value, value);
        cairo_pdf_surface_set_metadata(page->surface, CAIRO_PDF_METADATA_TITLE, value);
    }
}

facet_status canvas_write(canvas *page, const char *path, const image_text *texts, size_t n_texts, facet_error *why)
{
    if (page->kind == CANVAS_PDF) describe_pdf(page, texts, n_texts);
    if (page->kind == CANVAS_PNG) cairo_surface_flush(page->surface);
    else cairo_surface_finish(page->surface);
    facet_status status = FACET_OK;
    if ((status = check_drawing(page, why))) return status;
    if (page->kind == CANVAS_PNG) return write_pixels(page, path, texts, n_texts, why);
    file_writer writer;
    if ((status = file_writer_open(&writer, path, why))) return status;
    if (page->kind == CANVAS_SVG) put_svg(writer.stream, page, texts, n_texts);
    else fwrite(page->bytes, 1, page->size, writer.stream);
    return file_writer_commit(&writer, why); /* finds earlier failures, too */
}

/* ---- Lines and areas --------------------------------------------------------------------------- */

static void take_ink(canvas *page, colour ink)
{
    cairo_set_source_rgba(page->context, ink.r, ink.g, ink.b, ink.alpha);
}

void canvas_move(canvas *page, point to)
{
    cairo_move_to(page->context, to.x, to.y);
}

void canvas_line(canvas *page, point to)
{
    cairo_line_to(page->context, to.x, to.y);
}

void canvas_close(canvas *page)
{
    cairo_close_path(page->context);
}

void canvas_stroke(canvas *page, pen p)
{
    static const struct {
        int n;
        double lengths[4]; /* [width of the line] */
    } dashes[N_DASHES] = {{0, {0}}, {2, {4.5, 2.5}}, {2, {1.2, 1.8}}, {4, {6, 2, 1.2, 2}}};
    const double width = p.width*page->em;
    double lengths[4];
    for (int k = 0; k < 4; k++) lengths[k] = dashes[p.dash].lengths[k]*width;
    cairo_set_dash(page->context, lengths, dashes[p.dash].n, 0);
    cairo_set_line_width(page->context, width);
    take_ink(page, p.ink);
    cairo_stroke(page->context);
}

void canvas_fill(canvas *page, colour ink)
{
    take_ink(page, ink);
    cairo_fill(page->context);
}

void canvas_circle(canvas *page, point centre, double radius, pen p)
{
    cairo_new_sub_path(page->context);
    cairo_arc(page->context, centre.x, centre.y, radius, 0, 360*DEGREE);
    canvas_stroke(page, p);
}

void canvas_disc(canvas *page, point centre, double radius, colour ink)
{
    cairo_new_sub_path(page->context);
    cairo_arc(page->context, centre.x, centre.y, radius, 0, 360*DEGREE);
    canvas_fill(page, ink);
}

void canvas_clip(canvas *page, box area)
{
    cairo_save(page->context);
    cairo_rectangle(page->context, area.x, area.y, area.width, area.height);
    cairo_clip(page->context);
}

void canvas_unclip(canvas *page)
{
    cairo_restore(page->context);
}

/* One cell as a block of side x side pixels. */
static void fill_block(cairo_surface_t *picture, size_t column, size_t row, size_t side, colour c)
{
    unsigned char *rows = cairo_image_surface_get_data(picture);
    const size_t stride = (size_t)cairo_image_surface_get_stride(picture);
    const uint32_t pixel = (uint32_t)lround(255*c.r) << 16 | (uint32_t)lround(255*c.g) << 8 |
                           (uint32_t)lround(255*c.b);
    for (size_t y = row*side; y < (row + 1)*side; y++)
        for (size_t x = column*side; x < (column + 1)*side; x++) memcpy(rows + y*stride + 4*x, &pixel, 4);
}

void canvas_cells(canvas *page, box area, size_t n_columns, size_t n_rows, cell_function *cell, const void *context)
{
    /* Blocks, because programs that show SVG and PDF may smooth between pixels. */
    const size_t least = 480, most = n_columns > n_rows ? n_columns : n_rows;
    const size_t side = most < least ? (least + most - 1)/most : 1;
    const int width = (int)(n_columns*side), height = (int)(n_rows*side);
    cairo_surface_t *picture = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    const bool is_made = cairo_surface_status(picture) == CAIRO_STATUS_SUCCESS;
    for (size_t row = 0; is_made && row < n_rows; row++)
        for (size_t column = 0; column < n_columns; column++)
            fill_block(picture, column, row, side, cell(context, column, row));
    cairo_surface_mark_dirty(picture);
    cairo_save(page->context);
    cairo_translate(page->context, area.x, area.y);
    cairo_scale(page->context, area.width/width, area.height/height);
    cairo_set_source_surface(page->context, picture, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(page->context), CAIRO_FILTER_NEAREST);
    cairo_rectangle(page->context, 0, 0, width, height);
    cairo_fill(page->context);
    cairo_restore(page->context);
    cairo_surface_destroy(picture);
}

/* ---- Text -------------------------------------------------------------------------------------- */

/* One stretch of text at the current point; returns its width. */
static double show(canvas *page, const char *text, double size, bool is_drawn)
{
    cairo_text_extents_t extents;
    cairo_set_font_size(page->context, size);
    cairo_text_extents(page->context, text, &extents);
    if (is_drawn) cairo_show_text(page->context, text);
    return extents.x_advance;
}

/* The whole text from (x, y) on its base line; returns its width. */
static double run(canvas *page, double x, double y, text_style style, const char *text, bool is_drawn)
{
    char clean[WORDS_CAP];
    words_clean(text, clean);
    cairo_select_font_face(page->context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           style.is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    const double size = style.size*page->em;
    double width = 0;
    const char *rest = clean;
    while (*rest) {
        char part[WORDS_CAP];
        const int level = words_next(&rest, style.is_formula, part);
        if (is_drawn) cairo_move_to(page->context, x + width, y - (level > 0 ? 0.38 : level < 0 ? -0.18 : 0)*size);
        width += show(page, part, level ? 0.72*size : size, is_drawn);
    }
    return width;
}

double canvas_text_width(canvas *page, text_style style, const char *text)
{
    return run(page, 0, 0, style, text, false);
}

void canvas_text(canvas *page, point at, text_style style, const char *text)
{
    const double capital = 0.73*style.size*page->em; /* the height of DejaVu Sans's capitals */
    cairo_save(page->context);
    take_ink(page, style.ink);
    cairo_translate(page->context, at.x, at.y);
    cairo_rotate(page->context, -style.angle*DEGREE);
    run(page, -style.across*canvas_text_width(page, style, text), (1 - style.down)*capital, style, text, true);
    cairo_restore(page->context);
}
