/* test_cli_fit.c: `facet fit` on values that `facet eval` has printed, and on a file like those of the MERL database.
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
#include <jansson.h>

#include "tests/draws.h"
#include "tests/merl_file.h"
#include "tests/program_folder.h"

static void write_file(const char *name, const char *text)
{
    FILE *stream = fopen(in_folder(folder, name), "w");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
}

/* Values of a material for 300 pairs of directions. */
static void measure(const char *spec, const char *name)
{
    draws d = {9};
    FILE *stream = fopen(in_folder(folder, "directions.csv"), "w");
    assert_non_null(stream);
    fputs("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n", stream);
    for (int i = 0; i < 300; i++) {
        double wi[3], wo[3];
        draw_direction(&d, wi);
        draw_direction(&d, wo);
        fprintf(stream, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", wi[0], wi[1], wi[2], wo[0], wo[1], wo[2]);
    }
    assert_int_equal(fclose(stream), 0);
    program_run run = RUN("eval", spec, "--csv", "directions.csv", "--double");
    assert_int_equal(run.status, 0);
    write_file(name, run.out);
    program_run_free(&run);
}

static void the_material_of_the_values_is_printed(void **state)
{
    (void)state;
    measure("gtr alpha=.2 gamma=1.5 ks=.6,.5,.4 kd=.1", "m.csv");
    program_run run = RUN("fit", "m.csv", "--model", "beckmann", "--model", "gtr", "--model", "ggx");
    program_run_check(&run, 0, "", "facet: note: gtr: error ");
    assert_true(strncmp(run.out, "gtr alpha=0.2 gamma=1.5 kd=0.1,0.1,0.1 ks=0.6,0.5,0.4\nggx alpha=", 62) == 0);
    assert_non_null(strstr(run.out, "\nbeckmann alpha="));
    program_run_free(&run);
    run = RUN("fit", "m.csv", "--model", "gtr g2=separable gamma=1.5", "--keys", "alpha,ks", "--json");
    json_t *told = json_loads(run.out, 0, NULL), *first = json_array_get(json_object_get(told, "fits"), 0);
    const char *spec = json_string_value(json_object_get(first, "material"));
    assert_non_null(spec);
    assert_true(strncmp(spec, "gtr alpha=0.", 12) == 0);
    assert_non_null(strstr(spec, " gamma=1.5 ks=0."));
    assert_non_null(strstr(spec, " g2=separable"));
    assert_null(strstr(spec, "kd="));
    assert_int_equal(json_integer_value(json_object_get(told, "pairs")), 300);
    assert_true(json_number_value(json_object_get(first, "error")) > 1e-3);
    expect_run(RUN("albedo", spec, "--cos", "0.5"), 0, ""); /* as other commands take it */
    json_decref(told);
    program_run_free(&run);
}

static void a_measured_file_is_fitted(void **state)
{
    (void)state;
    write_merl(in_folder(folder, "white.binary"));
    program_run run = RUN("fit", "white.binary", "--model", "lambert", "--quiet");
    program_run_check(&run, 0, "lambert kd=1,1,1\n", "");
    program_run_free(&run);
}

static void wrong_use_is_told(void **state)
{
    (void)state;
    static const char header[] = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f_r,f_g,f_b\n";
    char text[512];
    measure("ggx", "m.csv");
    write_file("empty.csv", header);
    write_file("no_f.csv", "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,0,0,1\n");
    snprintf(text, sizeof text, "%s0,0,1,0,0,1,1,-2,1\n", header);
    write_file("negative.csv", text);
    snprintf(text, sizeof text, "%s0,0,1,0,0,2,1,1,1\n", header);
    write_file("long.csv", text);
    snprintf(text, sizeof text, "%s0,0,1,0,0,1,1,1,1\n", header);
    write_file("one.csv", text);
    write_file("short.binary", "short");
    expect_run(RUN("fit", "m.csv"), 2, "--model: is needed");
    expect_run(RUN("fit", "m.csv", "--model", "gxg"), 2, "did you mean `ggx`?");
    expect_run(RUN("fit", "m.csv", "--model", "ggx", "--keys", "alpha,colour"), 2, "no number or colour `colour`");
    expect_run(RUN("fit", "m.csv", "--model", "ggx", "--keys", "g2"), 2, "no number or colour `g2`");
    expect_run(RUN("fit", "m.csv", "--model", "ggx alpha=.1", "--keys", "alpha"), 2, "has a value in --model");
    expect_run(RUN("fit", "m.csv", "--model", "ggx", "--keys", "ks,ior"), 2, "--keys:ior: ");
    expect_run(RUN("fit", "m.csv", "--model", "lambert kd=.5"), 2, "leaves nothing to be found");
    expect_run(RUN("fit", "missing.csv", "--model", "ggx"), 3, "missing.csv: ");
    expect_run(RUN("fit", "empty.csv", "--model", "ggx"), 3, "empty.csv: has no values");
    expect_run(RUN("fit", "no_f.csv", "--model", "ggx"), 3, "no column `f_r`");
    expect_run(RUN("fit", "negative.csv", "--model", "ggx"), 3, "negative.csv:line 2: f_g is -2");
    expect_run(RUN("fit", "long.csv", "--model", "ggx"), 3, "long.csv:line 2: (wo_x,wo_y,wo_z) is not a unit vector");
    expect_run(RUN("fit", "one.csv", "--model", "ggx"), 3, "one.csv: 3 values are too few for 7 unknowns");
    expect_run(RUN("fit", "short.binary", "--model", "ggx"), 3, "short.binary: ");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_material_of_the_values_is_printed),
        cmocka_unit_test(a_measured_file_is_fitted),
        cmocka_unit_test(wrong_use_is_told),
    };
    return cmocka_run_group_tests_name("cli_fit", tests, make_test_folder, remove_test_folder);
}
