/* test_canvas.c: pages, charts and heat maps as files, down to their pixels.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/image_file.h"
#include "plot/chart.h"
#include "plot/heatmap.h"
#include "tests/run_program.h"

static char *folder;

static int setup(void **state)
{
    (void)state;
    folder = make_folder();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

/* A page of 200x100; without Cairo the test is skipped. */
static canvas *make_page(canvas_kind kind)
{
    canvas *page;
    facet_error why = {0};
    const facet_status status = canvas_create(kind, 200, 100, 10, &page, &why);
    if (status == FACET_UNSUPPORTED) skip();
    assert_int_equal(status, FACET_OK);
    return page;
}

static void save(canvas *page, const char *name)
{
    const image_text texts[] = {{"Title", "a <b> & \xff"}, {"facet:version", "1"}};
    facet_error why = {0};
    if (canvas_write(page, in_folder(folder, name), texts, 2, &why)) fail_msg("%s: %s", name, why.text);
    canvas_destroy(page);
}

static image save_and_read(canvas *page)
{
    image picture = {0};
    facet_error why = {0};
    save(page, "page.png");
    assert_int_equal(image_read(in_folder(folder, "page.png"), &picture, &why), FACET_OK);
    assert_true(picture.width == 200 && picture.height == 100 && picture.type == PIXEL_U8);
    return picture;
}

static const unsigned char *pixel_at(const image *picture, size_t x, size_t y)
{
    return (const unsigned char *)picture->pixels + (y*picture->width + x)*picture->n_channels;
}

static void expect_pixel(const image *picture, double x, double y, colour c)
{
    const unsigned char *pixel = pixel_at(picture, (size_t)x, (size_t)y);
    const double wanted[3] = {c.r, c.g, c.b};
    for (int k = 0; k < 3; k++)
        if (fabs(pixel[k] - 255*wanted[k]) > 1)
            fail_msg("pixel (%g, %g) is %d,%d,%d, expected %g,%g,%g", x, y, pixel[0], pixel[1], pixel[2], 255*c.r,
                     255*c.g, 255*c.b);
}

static void kinds_are_told_by_extension(void **state)
{
    (void)state;
    assert_int_equal(canvas_kind_of("a.b/c.SVG"), CANVAS_SVG);
    assert_int_equal(canvas_kind_of("x.png"), CANVAS_PNG);
    assert_int_equal(canvas_kind_of("x.svg.pdf"), CANVAS_PDF);
    static const char *const others[] = {"", "png", ".png", "a/.png", "a.png/b", "a.jpg", "a.pngx"};
    for (size_t i = 0; i < sizeof others/sizeof *others; i++)
        assert_int_equal(canvas_kind_of(others[i]), CANVAS_UNKNOWN);
}

static void shapes_cover_the_pixels_that_they_should(void **state)
{
    (void)state;
    const colour blue = palette_colour(0), red = palette_colour(1);
    canvas *page = make_page(CANVAS_PNG);
    canvas_fill_box(page, (box){10, 20, 30, 40}, blue);
    canvas_segment(page, (point){100, 50}, (point){180, 50}, (pen){red, 0.4, SOLID}); /* 48 to 52 */
    canvas_clip(page, (box){0, 80, 200, 10});
    canvas_fill_box(page, (box){60, 0, 20, 100}, BLACK);
    canvas_unclip(page);
    canvas_disc(page, (point){150, 20}, 8, blue);
    image picture = save_and_read(page);
    expect_pixel(&picture, 10, 20, blue);
    expect_pixel(&picture, 39, 59, blue);
    expect_pixel(&picture, 9, 20, WHITE);
    expect_pixel(&picture, 40, 59, WHITE);
    expect_pixel(&picture, 140, 48, red);
    expect_pixel(&picture, 140, 51, red);
    expect_pixel(&picture, 140, 52, WHITE);
    expect_pixel(&picture, 70, 79, WHITE);
    expect_pixel(&picture, 70, 80, BLACK);
    expect_pixel(&picture, 70, 90, WHITE);
    expect_pixel(&picture, 150, 20, blue);
    expect_pixel(&picture, 157, 13, WHITE);
    image_destroy(&picture);
}

static colour checker(const void *context, size_t column, size_t row)
{
    const colour *colours = context;
    return colours[2*row + column];
}

static void cells_have_their_colours_up_to_their_edges(void **state)
{
    (void)state;
    const colour colours[4] = {palette_colour(0), palette_colour(1), palette_colour(2), palette_colour(3)};
    canvas *page = make_page(CANVAS_PNG);
    canvas_cells(page, (box){20, 10, 100, 80}, 2, 2, checker, colours);
    image picture = save_and_read(page);
    expect_pixel(&picture, 20, 10, colours[0]);
    expect_pixel(&picture, 69, 49, colours[0]);
    expect_pixel(&picture, 70, 49, colours[1]);
    expect_pixel(&picture, 69, 50, colours[2]);
    expect_pixel(&picture, 119, 89, colours[3]);
    expect_pixel(&picture, 120, 89, WHITE);
    image_destroy(&picture);
}

/* Whether a pixel of the colour is within the box. */
static bool has_colour(const image *picture, box b, colour c)
{
    for (double y = b.y; y < b.y + b.height; y++)
        for (double x = b.x; x < b.x + b.width; x++) {
            const unsigned char *p = pixel_at(picture, (size_t)x, (size_t)y);
            if (fabs(p[0] - 255*c.r) < 40 && fabs(p[1] - 255*c.g) < 40 && fabs(p[2] - 255*c.b) < 40) return true;
        }
    return false;
}

static void text_stands_where_it_is_put_and_has_its_width(void **state)
{
    (void)state;
    canvas *page = make_page(CANVAS_PNG);
    const text_style style = {.size = 2, .ink = BLACK, .across = 1, .down = 1};
    const double width = canvas_text_width(page, style, "MMM");
    /* DejaVu Sans's M is 0.863 wide and 0.729 high; no font that would be put in its place is as far off as this. */
    assert_true(width > 0.7*60 && width < 1.0*60);
    canvas_text(page, (point){150, 60}, style, "MMM");
    image picture = save_and_read(page);
    assert_true(has_colour(&picture, (box){150 - width, 40, width, 20}, BLACK));
    assert_false(has_colour(&picture, (box){0, 0, 150 - width - 1, 100}, BLACK));
    assert_false(has_colour(&picture, (box){151, 0, 49, 100}, BLACK));
    assert_false(has_colour(&picture, (box){0, 61, 200, 39}, BLACK));
    assert_false(has_colour(&picture, (box){0, 0, 200, 42}, BLACK));
    image_destroy(&picture);
}

static void a_lowered_letter_is_lower_and_smaller(void **state)
{
    (void)state;
    canvas *page = make_page(CANVAS_PNG);
    text_style style = {.size = 3, .ink = BLACK, .down = 1};
    const double plain = canvas_text_width(page, style, "HH");
    style.is_formula = true;
    const double formula = canvas_text_width(page, style, "H_H");
    assert_true(fabs(formula/plain - 0.5*1.72) < 1e-6);
    canvas_text(page, (point){20, 60}, style, "H_H");
    image picture = save_and_read(page);
    assert_false(has_colour(&picture, (box){20, 61, 0.5*plain, 20}, BLACK));
    assert_true(has_colour(&picture, (box){20 + 0.5*plain, 61, 0.4*plain, 5}, BLACK));
    image_destroy(&picture);
}

static void a_curve_passes_through_its_points(void **state)
{
    (void)state;
    const double x[3] = {0, 1, 2}, y[3] = {0, 4, 0};
    canvas *page = make_page(CANVAS_PNG);
    const series s = series_make(0, NULL, 3, x, y);
    /* Without names the frame is wide; where it lies is the frame's own to tell. */
    const chart c = {.x = {NULL, AXIS_LINEAR, 0, 2}, .y = {NULL, AXIS_LINEAR, 0, 4}, .items = &s, .n_items = 1};
    const box place = {0, 0, 200, 100};
    const frame f = frame_make(page, place, c.x, c.y);
    chart_draw(page, place, &c);
    image picture = save_and_read(page);
    const point half = frame_at(&f, 0.5, 2), late = frame_at(&f, 1.5, 2), off = frame_at(&f, 1, 1);
    const double inside = f.inside.x + 0.25*f.inside.width;
    assert_true(fabs(half.x - inside) < 1e-9);
    assert_true(has_colour(&picture, (box){half.x - 1, half.y - 1, 3, 3}, palette_colour(0)));
    assert_true(has_colour(&picture, (box){late.x - 1, late.y - 1, 3, 3}, palette_colour(0)));
    assert_false(has_colour(&picture, (box){off.x - 5, off.y - 5, 10, 10}, palette_colour(0)));
    image_destroy(&picture);
}

static void gaps_and_infinities_interrupt_a_curve(void **state)
{
    (void)state;
    const double x[7] = {0, 1, 2, 3, 4, 5, 6}, y[7] = {1, 1, NAN, 1, 0, 1, 1};
    canvas *page = make_page(CANVAS_PNG);
    const series s = series_make(0, NULL, 7, x, y);
    const chart c = {.x = {NULL, AXIS_LINEAR, 0, 6}, .y = {NULL, AXIS_LOG, 0.1, 10}, .items = &s, .n_items = 1};
    const box place = {0, 0, 200, 100};
    const frame f = frame_make(page, place, c.x, c.y);
    chart_draw(page, place, &c);
    image picture = save_and_read(page);
    expect_pixel(&picture, frame_at(&f, 0.5, 1).x, frame_at(&f, 0.5, 1).y, palette_colour(0));
    for (double at = 1.2; at < 5; at += 0.4) {
        if (at > 2.8 && at < 3.2) continue;
        const point p = frame_at(&f, at, 1);
        assert_false(has_colour(&picture, (box){p.x - 1, p.y - 1, 2, 2}, palette_colour(0)));
    }
    expect_pixel(&picture, frame_at(&f, 5.5, 1).x, frame_at(&f, 5.5, 1).y, palette_colour(0));
    image_destroy(&picture);
}

static void a_heat_map_has_the_colours_of_its_values(void **state)
{
    (void)state;
    /* The lowest row first: 0 is at the bottom left, 1 at the top right. */
    const double values[6] = {0, 0.2, NAN, 0.6, 0.8, 1};
    canvas *page = make_page(CANVAS_PNG);
    const heatmap h = {.x = {NULL, AXIS_LINEAR, 0, 3},
                       .y = {NULL, AXIS_LINEAR, 0, 2},
                       .z = {"z", AXIS_LINEAR, 0, 1},
                       .n_columns = 3,
                       .n_rows = 2,
                       .values = values};
    heatmap_draw(page, (box){0, 0, 200, 100}, &h);
    image picture = save_and_read(page);
    /* The frame is found by the colours of its corners. */
    double left = 200, bottom = 0, right = 0, top = 100;
    for (double y = 0; y < 100; y++)
        for (double x = 0; x < 150; x++) {
            if (has_colour(&picture, (box){x, y, 1, 1}, sequential_colour(0)) && x < left) left = x;
            if (has_colour(&picture, (box){x, y, 1, 1}, sequential_colour(0.2))) bottom = y;
            if (!has_colour(&picture, (box){x, y, 1, 1}, sequential_colour(1))) continue;
            right = fmax(right, x);
            top = fmin(top, y);
        }
    assert_true(right - left > 60 && bottom - top > 50);
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 3; column++)
            expect_pixel(&picture, left + (column + 0.5)*(right - left)/3,
                         bottom - (row + 0.5)*(bottom - top)/2, sequential_colour(values[3*row + column]));
    image_destroy(&picture);
}

static void files_are_of_their_kind_and_hold_their_texts(void **state)
{
    (void)state;
    static const canvas_kind kinds[] = {CANVAS_SVG, CANVAS_PDF};
    static const char *const names[] = {"page.svg", "page.pdf"}, *const starts[] = {"<?xml", "%PDF-1."};
    for (int k = 0; k < 2; k++) {
        canvas *page = make_page(kinds[k]);
        canvas_text(page, (point){10, 50}, (text_style){.size = 1, .ink = BLACK}, "caf\xe9 θ");
        save(page, names[k]);
        char *bytes = read_bytes(in_folder(folder, names[k]), NULL);
        assert_non_null(bytes);
        assert_int_equal(strncmp(bytes, starts[k], strlen(starts[k])), 0);
        if (k == 0) {
            assert_non_null(strstr(bytes, "<title>a &lt;b&gt; &amp; ?</title>\n<desc>facet:version: 1</desc>"));
            assert_non_null(strstr(bytes, "width=\"200px\" height=\"100px\""));
        }
        free(bytes);
    }
}

static void a_page_that_cannot_be_written_leaves_nothing(void **state)
{
    (void)state;
    static const canvas_kind kinds[] = {CANVAS_SVG, CANVAS_PNG, CANVAS_PDF};
    for (int k = 0; k < 3; k++) {
        canvas *page = make_page(kinds[k]);
        facet_error why = {0};
        assert_int_equal(canvas_write(page, in_folder(folder, "none/page"), NULL, 0, &why), FACET_IO);
        assert_non_null(strstr(why.text, "No such file"));
        canvas_destroy(page);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_are_told_by_extension),
        cmocka_unit_test(shapes_cover_the_pixels_that_they_should),
        cmocka_unit_test(cells_have_their_colours_up_to_their_edges),
        cmocka_unit_test(text_stands_where_it_is_put_and_has_its_width),
        cmocka_unit_test(a_lowered_letter_is_lower_and_smaller),
        cmocka_unit_test(a_curve_passes_through_its_points),
        cmocka_unit_test(gaps_and_infinities_interrupt_a_curve),
        cmocka_unit_test(a_heat_map_has_the_colours_of_its_values),
        cmocka_unit_test(files_are_of_their_kind_and_hold_their_texts),
        cmocka_unit_test(a_page_that_cannot_be_written_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
