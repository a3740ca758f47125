/* test_plot.c: `facet plot`: every figure, and what it refuses.
 * SPDX-License-Identifier: MIT */
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
#include "plot/figure.h"
#include "tests/run_program.h"

static char *folder;

#define RUN(...) run_program(folder, NULL, NULL, (const char *const[]){FACET_PROGRAM, "plot", __VA_ARGS__, NULL})

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

static void expect(program_run run, int status, const char *in_err)
{
    if (run.status != status || !strstr(run.err, in_err) || *run.out)
        fail_msg("status %d (expected %d), stderr, expected `%s`:\n%s\n%s", run.status, status, in_err, run.err,
                 run.out);
    program_run_free(&run);
}

static void need_cairo(void)
{
    canvas *page;
    if (canvas_create(CANVAS_PNG, 100, 100, 10, &page, NULL) == FACET_UNSUPPORTED) skip();
    canvas_destroy(page);
}

/* The picture at NAME in the folder, whose size is known and which is not all white. */
static void expect_picture(const char *name, size_t width, size_t height)
{
    image picture = {0};
    facet_error why = {0};
    if (image_read(in_folder(folder, name), &picture, &why)) fail_msg("%s: %s", name, why.text);
    assert_true(picture.width == width && picture.height == height && picture.n_channels == 3);
    const unsigned char *pixels = picture.pixels;
    size_t n_marked = 0;
    for (size_t i = 0; i < 3*width*height; i++) n_marked += pixels[i] < 200;
    assert_true(n_marked > width*height/200);
    image_destroy(&picture);
}

/* Metal, dielectric over diffuse, and GTR for everything; the others where they have what is shown. */
#define MICROFACETS "ggx alpha=.3 metal=Au", "beckmann alpha=.4 ior=1.5 kd=.3", "gtr alpha=.1 gamma=1.2"
#define OTHERS                                                                                                         \
    "phong exponent=100", "glass alpha=.2", "ward alpha_x=.1 alpha_y=.4", "disney roughness=.4", "lambert kd=.5"

static void every_figure_draws_the_models_that_have_it(void **state)
{
    (void)state;
    need_cairo();
    static const char *const of_facets[] = {"D", "Lambda", "G1", "F", "heightfield", "G1-error"};
    for (size_t k = 0; k < FIGURE_KINDS; k++) {
        const char *name = figure_kinds[k].name;
        bool is_of_facets = false;
        for (int i = 0; i < 6; i++) is_of_facets |= strcmp(name, of_facets[i]) == 0;
        expect(is_of_facets
                   ? RUN(MICROFACETS, "--of", name, "-o", "figure.png", "--size", "600x500", "-n", "20")
                   : RUN(MICROFACETS, OTHERS, "--of", name, "-o", "figure.png", "--size", "600x500", "-n", "20"),
               0, "");
        expect_picture("figure.png", 600, 500);
        if (is_of_facets)
            expect(RUN("lambert", "--of", name, "-o", "no.png"), 2, "lambert: has no distribution of normals");
    }
}

static void the_same_command_gives_the_same_bytes(void **state)
{
    (void)state;
    need_cairo();
    static const char *const names[] = {"a.svg", "a.png", "a.pdf"};
    static const char *const figures[] = {"fcos", "lobe", "slice"};
    for (int f = 0; f < 3; f++)
        for (int k = 0; k < 3; k++) {
            size_t sizes[2];
            char *bytes[2];
            for (int twice = 0; twice < 2; twice++) {
                expect(RUN("ggx", "gtr gamma=1", "--of", figures[f], "-o", names[k]), 0, "");
                bytes[twice] = read_bytes(in_folder(folder, names[k]), &sizes[twice]);
            }
            assert_true(sizes[0] == sizes[1] && sizes[0] > 1000);
            assert_memory_equal(bytes[0], bytes[1], sizes[0]);
            free(bytes[0]);
            free(bytes[1]);
        }
}

static void svg_is_xml_and_tells_how_it_was_made(void **state)
{
    (void)state;
    need_cairo();
    expect(RUN("ggx alpha=.3", "--of", "D", "--title", "<D> & more", "--label", "\xff", "-o", "x.svg"), 0, "");
    static const char parse[] = "import xml.dom.minidom as m, sys\n"
                                "d = m.parse('x.svg').documentElement\n"
                                "t = d.getElementsByTagName('title')[0].firstChild.data\n"
                                "s = d.getElementsByTagName('desc')[0].firstChild.data\n"
                                "assert t == '<D> & more', t\n"
                                "assert \"facet plot 'ggx alpha=.3' --of D\" in s, s\n"
                                "assert d.getAttribute('width') == '800px'\n";
    program_run run = run_program(folder, NULL, NULL,
                                  (const char *const[]){"/usr/bin/env", "python3", "-c", parse, NULL});
    if (run.status) fail_msg("%s", run.err);
    program_run_free(&run);
}

/* The panels of three materials lie side by side, five make two rows. */
static void the_usual_size_has_room_for_all_panels(void **state)
{
    (void)state;
    need_cairo();
    expect(RUN("ggx", "beckmann", "gtr", "--of", "slice", "-o", "x.png"), 0, "");
    expect_picture("x.png", 1260, 440);
    expect(RUN("ggx", "ggx", "ggx", "ggx", "ggx", "--of", "lobe", "-o", "x.png"), 0, "");
    expect_picture("x.png", 1440, 880);
    expect(RUN("ggx", "lambert", "--of", "albedo", "-o", "x.png"), 0, "");
    expect_picture("x.png", 800, 600);
}

static void bad_requests_are_refused_and_leave_nothing(void **state)
{
    (void)state;
    need_cairo();
    expect(RUN("ggx", "-o", "y.png"), 2, "plot needs --of");
    expect(RUN("ggx", "--of", "D"), 2, "plot needs -o");
    expect(RUN("ggx", "--of", "lobes", "-o", "y.png"), 2, "--of: `lobes` is not a figure; did you mean `lobe`?");
    expect(RUN("ggx", "--of", "D", "-o", "y.gif"), 2, "y.gif: is none of .svg, .png and .pdf");
    expect(RUN("gxg", "--of", "D", "-o", "y.png"), 2, "did you mean `ggx`?");
    expect(RUN("ggx alpha=9", "--of", "D", "-o", "y.png"), 2, "SPEC:alpha: ");
    expect(RUN("ggx", "lambert", "--of", "D", "-o", "y.png"), 2, "lambert: has no distribution of normals");
    expect(RUN("disney", "--of", "F", "-o", "y.png"), 2, "disney: has no");
    expect(RUN("ggx", "--of", "D", "-o", "y.png", "--size", "99x500"), 2, "--size: 99x500 is out of range");
    expect(RUN("ggx", "--of", "D", "-o", "y.png", "--size", "500x99999"), 2, "--size: 500x99999 is out of range");
    expect(RUN("ggx", "--of", "D", "-o", "y.png", "--range", "2,1"), 2, "--range");
    expect(RUN("ggx", "--of", "D", "-o", "y.png", "--range", "0,1", "--log"), 2, "--range");
    expect(RUN("ggx", "--of", "lobe", "-o", "y.png", "--polar"), 2, "--polar: is not for --of lobe");
    expect(RUN("ggx", "--of", "slice", "-o", "y.png", "--theta", "1,2"), 2, "--theta: has 2 angles");
    expect(RUN("ggx", "--of", "D", "-o", "y.png", "--label", "a", "--label", "b"), 2, "--label: is given 2 times");
    expect(RUN("ggx", "--of", "D", "-o", "none/y.png"), 4, "none/y.png: cannot create");
    expect(RUN("ggx", "--of", "D", "-o", "none/y.svg"), 4, "none/y.svg: cannot create");
    program_run files = run_program(folder, NULL, NULL,
                                    (const char *const[]){"/bin/sh", "-c", "ls y*; ls *tmp*", NULL});
    assert_string_equal(files.out, "");
    program_run_free(&files);
}

static void variables_of_height_fields_are_checked(void **state)
{
    (void)state;
    need_cairo();
#define FIELD(...) RUN("gtr gamma=4", "--of", "heightfield", "-o", "y.png", __VA_ARGS__)
    expect(FIELD("--x", "alpha"), 2, "--x: `alpha` is not NAME=LOW:HIGH");
    expect(FIELD("--x", "alpha=.5:.1"), 2, "--x: `alpha=.5:.1` is not");
    expect(FIELD("--x", "alpha=0:.5"), 2, "--x: alpha of gtr is from 0.0001 to 1");
    expect(FIELD("--x", "alfa=.1:.5"), 2, "--x: gtr has no number called `alfa`");
    expect(FIELD("--x", "metal=0:1"), 2, "--x: gtr has no number called `metal`");
    expect(FIELD("--y", "cos=0:2"), 2, "--y: cos of gtr is from 0 to 1");
    expect(FIELD("--x", "tan=0:1", "--y", "cot=0:1"), 2, "--x: cannot be `tan` while --y is `cot`");
    expect(FIELD("--minus", "lambert"), 2, "lambert");
    expect(FIELD("--x", "gamma=1:3", "--y", "alpha=.1:.9", "--theta", "60"), 0, "");
#undef FIELD
    expect(RUN("ggx", "--of", "heightfield", "--quantity", "albedo", "--y", "cos=.01:1", "-o", "y.png"), 0, "");
}

static void a_file_that_stands_in_the_way_stays_as_it_was(void **state)
{
    (void)state;
    need_cairo();
    program_run made = run_program(folder, NULL, NULL, (const char *const[]){"/bin/mkdir", "d.png", NULL});
    program_run_free(&made);
    expect(RUN("ggx", "--of", "D", "-o", "d.png"), 4, "d.png: is a directory");
    write_text(in_folder(folder, "old.svg"), "old");
    expect(RUN("lambert", "--of", "G1", "-o", "old.svg"), 2, "lambert");
    char *bytes = read_bytes(in_folder(folder, "old.svg"), NULL);
    assert_string_equal(bytes, "old");
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_figure_draws_the_models_that_have_it),
        cmocka_unit_test(the_same_command_gives_the_same_bytes),
        cmocka_unit_test(svg_is_xml_and_tells_how_it_was_made),
        cmocka_unit_test(the_usual_size_has_room_for_all_panels),
        cmocka_unit_test(bad_requests_are_refused_and_leave_nothing),
        cmocka_unit_test(variables_of_height_fields_are_checked),
        cmocka_unit_test(a_file_that_stands_in_the_way_stays_as_it_was),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
