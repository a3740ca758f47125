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
#include "tests/merl_file.h"
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

/* Two pictures of the same size, equal but for roundings to the next byte. */
static void expect_same_picture(const char *a, const char *b)
{
    const char *const names[] = {a, b};
    image pictures[2] = {{0}};
    for (int k = 0; k < 2; k++) assert_int_equal(image_read(in_folder(folder, names[k]), &pictures[k], NULL), FACET_OK);
    assert_true(pictures[0].width == pictures[1].width && pictures[0].height == pictures[1].height);
    const unsigned char *const x = pictures[0].pixels, *const y = pictures[1].pixels;
    for (size_t i = 0; i < 3*pictures[0].width*pictures[0].height; i++)
        if (abs(x[i] - y[i]) > 1) fail_msg("%s and %s differ at byte %zu: %d, %d", a, b, i, x[i], y[i]);
    for (int k = 0; k < 2; k++) image_destroy(&pictures[k]);
}

/* A measurement of f = 1/pi is drawn as the Lambert reflector that it is. */
static void measurements_are_drawn_like_models(void **state)
{
    (void)state;
    need_cairo();
    static const char *const figures[] = {"f", "fcos", "albedo", "theta-h", "theta-d", "slice", "lobe"};
    static const char *const without[] = {"D",           "Lambda",  "G1",          "F",       "pdf",
                                          "heightfield", "samples", "convergence", "G1-error"};
    write_merl(in_folder(folder, "white.binary"));
    for (int k = 0; k < 7; k++) {
        expect(RUN("merl file=white.binary", "--label", "white", "--of", figures[k], "-o", "a.png"), 0, "");
        expect(RUN("lambert kd=1", "--label", "white", "--of", figures[k], "-o", "b.png"), 0, "");
        expect_same_picture("a.png", "b.png");
    }
    for (int k = 0; k < 9; k++)
        expect(RUN("ggx", "merl file=white.binary", "--of", without[k], "-o", "y.png"), 2, "merl file=white.binary: ");
    expect(RUN("ggx", "--minus", "merl file=white.binary", "--of", "heightfield", "-o", "y.png"), 2,
           "merl file=white.binary: is none of facet's models");
    expect(RUN("merl", "--of", "f", "-o", "y.png"), 2, "SPEC:merl: has no file; write `merl file=FILE.binary`");
    write_merl_of(in_folder(folder, "huge.binary"), 1e300);
    expect(RUN("merl file=huge.binary", "--of", "albedo", "-o", "a.png"), 0, "");
    expect(RUN("merl file=absent.binary", "--of", "f", "-o", "y.png"), 3, "absent.binary: ");
    write_text(in_folder(folder, "text.binary"), "no measurements\n");
    expect(RUN("merl file=text.binary", "--of", "f", "-o", "y.png"), 3, "text.binary:byte 0: its sizes are");
}

#define PLUGIN(name) "plugin file=" FACET_PLUGINS "/" name ".so"

/* GTR with gamma 1 and its own D, but the masking of GGX. */
static void plugins_are_drawn_like_models(void **state)
{
    (void)state;
    need_cairo();
    static const char *const figures[] = {"f",       "fcos",  "pdf",  "albedo",  "theta-h",
                                          "theta-d", "slice", "lobe", "samples", "convergence"};
    static const struct {
        const char *of, *plugin, *model;
    } same[] = {{"D", PLUGIN("gtr1_ggx_masking") " alpha=.2", "gtr gamma=1 alpha=.2"},
                {"G1", PLUGIN("gtr1_ggx_masking"), "ggx alpha=.25"},
                {"Lambda", PLUGIN("gtr1_ggx_masking"), "ggx alpha=.25"}};
    for (int k = 0; k < 3; k++) {
        expect(RUN(same[k].plugin, "--label", "it", "--of", same[k].of, "-o", "a.png"), 0, "");
        expect(RUN(same[k].model, "--label", "it", "--of", same[k].of, "-o", "b.png"), 0, "");
        expect_same_picture("a.png", "b.png");
    }
    for (int k = 0; k < 10; k++) {
        expect(
            RUN(PLUGIN("gtr1_ggx_masking"), "ggx", "--of", figures[k], "-o", "a.png", "-n", "20", "--size", "600x500"),
            0, "");
        expect_picture("a.png", 600, 500);
    }
    expect(RUN(PLUGIN("gtr1_ggx_masking"), "--of", "F", "-o", "y.png"), 2, "is none of facet's models");
}

static void plugins_that_fail_end_with_a_line(void **state)
{
    (void)state;
    need_cairo();
#define BAD(...) RUN(__VA_ARGS__, "ggx", "--of", "f", "-o", "z.png")
    expect(BAD("plugin"), 2, "SPEC:plugin: has no file; write `plugin file=FILE.so");
    expect(BAD("plugin file=a.so file=b.so"), 2, "SPEC:file: the key is given twice");
    expect(RUN(PLUGIN("leave"), "--of", "f", "-o", "z.png"), 3, "ended its process, with status 0, in eval;");
    expect(RUN(PLUGIN("huge") " scale=308", "--of", "albedo", "-o", "z.png"), 2, "is too large for a number; ");
    expect(BAD("plugin file=absent.so"), 3, "absent.so: No such file");
    expect(BAD(PLUGIN("gtr1_ggx_masking") " alfa=.1"), 2, "did you mean `alpha`?");
    expect(BAD(PLUGIN("gtr1_ggx_masking") " alpha=7"), 2, "gtr1_ggx_masking.so:alpha: 7 is out of range");
    expect(BAD(PLUGIN("no_describe")), 3, "defines no facet_plugin_describe");
    /* The one that fails is named, not the first one. */
    expect(BAD(PLUGIN("gtr1_ggx_masking"), PLUGIN("crash")), 3, "crash.so: the plugin was ended by signal 11");
    expect(BAD(PLUGIN("gtr1_ggx_masking"), PLUGIN("hang"), "--patience", "0.5"), 3,
           "hang.so: the plugin has not returned for 0.5 s in eval");
#undef BAD
    program_run files = run_program(folder, NULL, NULL,
                                    (const char *const[]){"/bin/sh", "-c", "ls z*; ls *tmp*", NULL});
    assert_string_equal(files.out, "");
    program_run_free(&files);
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
        cmocka_unit_test(measurements_are_drawn_like_models),
        cmocka_unit_test(plugins_are_drawn_like_models),
        cmocka_unit_test(plugins_that_fail_end_with_a_line),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
