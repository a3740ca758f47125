/* test_cli_values.c: eval, terms, sample and albedo print what the library computes.
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

#include "facet/facet.h"
#include "tests/program_folder.h"

/* The numbers of line `row` (0 is the header) of CSV text; fails unless there are n. */
static void csv_row(const char *text, size_t row, double *numbers, size_t n)
{
    const char *p = text;
    for (size_t i = 0; i < row && p; i++) {
        p = strchr(p, '\n');
        if (p) p++;
    }
    for (size_t i = 0; i < n; i++) {
        char *end = NULL;
        if (p) numbers[i] = strtod(p, &end);
        if (!p || end == p || *end != (i + 1 < n ? ',' : '\n'))
            fail_msg("row %zu has not %zu numbers:\n%s", row, n, text);
        p = end + 1;
    }
}

static facet_bsdf prepare(const char *text)
{
    facet_material m;
    facet_bsdf bsdf;
    assert_int_equal(facet_material_parse(text, &m, NULL), FACET_OK);
    assert_int_equal(facet_bsdf_prepare(&m, &bsdf, NULL), FACET_OK);
    return bsdf;
}

static facet_bsdf64 prepare64(const char *text)
{
    facet_material m;
    facet_bsdf64 bsdf;
    assert_int_equal(facet_material_parse(text, &m, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_prepare(&m, &bsdf, NULL), FACET_OK);
    return bsdf;
}

static const char material[] = "ggx alpha_x=.2 alpha_y=.4 ks=.9,.7,.3";

/* ---- eval -------------------------------------------------------------------------------------- */

static void eval_equals_the_library(void **state)
{
    (void)state;
    double got[13], f64[3];
    float f[3];
    const float wi[3] = {0, .6f, .8f}, wo[3] = {.28f, 0, .96f};
    const double wi64[3] = {0, .6, .8}, wo64[3] = {.28, 0, .96};
    const facet_bsdf bsdf = prepare(material);
    const facet_bsdf64 bsdf64 = prepare64(material);
    facet_bsdf_eval(&bsdf, wi, wo, f);
    facet_bsdf64_eval(&bsdf64, wi64, wo64, f64);

    program_run run = RUN("eval", material, "--wi", "0,.6,.8", "--wo", ".28,0,.96");
    program_run_check(&run, 0, "", "");
    csv_row(run.out, 1, got, 13);
    for (int k = 0; k < 3; k++) {
        assert_true((float)got[9 + k] == f[k]); /* 9 digits tell floats apart */
        assert_true((float)got[6 + k] == f[k]/wi[2]);
    }
    assert_true((float)got[12] == facet_bsdf_pdf(&bsdf, wi, wo));
    program_run_free(&run);

    run = RUN("eval", material, "--wi=0,.6,.8", "--wo=.28,0,.96", "--double");
    program_run_check(&run, 0, "", "");
    csv_row(run.out, 1, got, 13);
    /* The program normalises its input, which may move it by one rounding: 4 epsilon in the result. */
    for (int k = 0; k < 3; k++) assert_true(fabs(got[9 + k]/f64[k] - 1) < 1e-14);
    assert_true(fabs(got[12]/facet_bsdf64_pdf(&bsdf64, wi64, wo64) - 1) < 1e-14);
    program_run_free(&run);
}

static void eval_csv_takes_columns_in_any_order_and_copies_the_six(void **state)
{
    (void)state;
    const char *path = in_folder(folder, "in.csv");
    write_text(path, "# made by hand\nname,wo_x,wo_y,wo_z, wi_z ,wi_y,wi_x\r\n"
                     "a,0.28,0,9.6e-1,0.8,0.60,0\r\n\nb,0,0,1,1,0,-0\n");
    program_run pair = RUN("eval", material, "--wi", "0,0.6,0.8", "--wo", "0.28,0,0.96");
    program_run run = RUN("eval", material, "--csv", path),
                piped = run_program(folder, path, NULL,
                                    (const char *const[]){FACET_PROGRAM, "eval", material, "--csv", "-", NULL});
    program_run_check(&run, 0, "", "");
    assert_string_equal(run.out, piped.out);
    const char header[] = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f_r,f_g,f_b,fcos_r,fcos_g,fcos_b,pdf\n";
    assert_int_equal(strncmp(run.out, header, sizeof header - 1), 0);
    assert_non_null(strstr(run.out, "\n0,0.60,0.8,0.28,0,9.6e-1,")); /* as they were written */
    assert_non_null(strstr(run.out, "\n-0,0,1,0,0,1,"));
    double a[13], b[13];
    csv_row(run.out, 1, a, 13);
    csv_row(pair.out, 1, b, 13);
    assert_memory_equal(a, b, sizeof a);
    program_run_free(&pair);
    program_run_free(&run);
    program_run_free(&piped);
}

/* Rows beyond one batch of 1024 still come one for one, in order. */
static void eval_csv_keeps_every_row_of_a_long_file(void **state)
{
    (void)state;
    enum { ROWS = 2500 };
    const char *path = in_folder(folder, "long.csv");
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fprintf(stream, "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n");
    for (int i = 0; i < ROWS; i++) {
        const double angle = 1.5*i/ROWS;
        fprintf(stream, "%.17g,0,%.17g,0,0,1\n", sin(angle), cos(angle));
    }
    fclose(stream);
    const facet_bsdf bsdf = prepare(material);
    program_run run = RUN("eval", material, "--csv", path);
    program_run_check(&run, 0, "", "");
    const char *line = run.out;
    for (int i = 0; i < ROWS; i++) {
        double got[13];
        const double angle = 1.5*i/ROWS;
        const float wi[3] = {(float)sin(angle), 0, (float)cos(angle)}, wo[3] = {0, 0, 1};
        line = strchr(line, '\n');
        assert_non_null(line);
        csv_row(++line, 0, got, 13);
        assert_true(fabs(got[0] - sin(angle)) == 0);
        /* One rounding of wi by the program's normalisation: below 1e-5 in a lobe of this width. */
        assert_true(fabs(got[12]/(double)facet_bsdf_pdf(&bsdf, wi, wo) - 1) < 1e-5);
    }
    assert_string_equal(strchr(line, '\n'), "\n");
    program_run_free(&run);
}

static void damaged_csv_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "bad.csv: is empty"},
        {"wi_x,wi_y\n", "bad.csv:line 1: no column `wi_z`"},
        {"WI_X,wi_y,wi_z,wo_x,wo_y,wo_z\n", "bad.csv:line 1: no column `wi_x`; is `WI_X` meant"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,wi_x\n", "line 1: two columns are called `wi_x`"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,0,0\n", "line 2: has only 5 fields"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,0,0,1\n\n0,0,one,0,0,1\n",
         "line 4: `one` in column wi_z is not a number"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,,0,0,1\n", "line 2: `` in column wi_z is not a number"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,nan,0,0,1\n", "line 2: `nan` in column wi_z is not finite"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1e999,0,0,1\n", "is not finite"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,0.9,0,0,1\n", "line 2: (wi_x,wi_y,wi_z) is not a unit vector"},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,1e200,0,1\n", "line 2: (wo_x,wo_y,wo_z) is not a unit vector"},
    };
    expect_run(RUN("eval", "lambert", "--csv", "/dev/zero"), 3, "/dev/zero: is neither a regular file nor a pipe");
    const char *const zeros[] = {FACET_PROGRAM, "eval", "lambert", "--csv", "-", NULL};
    expect_run(run_program(folder, "/dev/zero", NULL, zeros), 3, "stdin:line 1: has a zero byte");
    const char *path = in_folder(folder, "bad.csv");
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        write_text(path, cases[i].text);
        program_run run = RUN("eval", "lambert", "--csv", "bad.csv");
        expect_run(run, 3, cases[i].message);
    }
    write_text(path, "cos_theta\n1.5\n");
    program_run run = RUN("terms", "ggx", "--csv", "bad.csv");
    expect_run(run, 3, "bad.csv:line 2: cos_theta is 1.5; it has to be from -1 to 1");
    char *line = malloc(70001);
    memset(line, '1', 70000);
    line[70000] = 0;
    write_text(path, line);
    free(line);
    run = RUN("terms", "ggx", "--csv", "bad.csv");
    expect_run(run, 3, "bad.csv:line 1: the line is longer than");
}

/* ---- terms, sample, albedo --------------------------------------------------------------------- */

static void terms_equal_the_library(void **state)
{
    (void)state;
    const char *path = in_folder(folder, "angles.csv");
    write_text(path, "phi,cos_theta\n0.5,0.25\n0,1\n");
    double got[5];
    const double c = 0.25, s = sqrt(1 - c*c);
    const double m[3] = {s*cos(.5), s*sin(.5), c};
    const float single[3] = {(float)m[0], (float)m[1], (float)m[2]};
    const facet_bsdf bsdf = prepare(material);
    const facet_bsdf64 bsdf64 = prepare64(material);
    const facet_terms t = facet_bsdf_terms(&bsdf, single);
    const facet_terms64 t64 = facet_bsdf64_terms(&bsdf64, m);

    program_run run = RUN("terms", material, "--csv", path);
    program_run_check(&run, 0, "", "");
    assert_int_equal(strncmp(run.out, "cos_theta,phi,D,Lambda,G1\n0.25,0.5,", 35), 0);
    csv_row(run.out, 1, got, 5);
    assert_true((float)got[2] == t.D && (float)got[3] == t.Lambda && (float)got[4] == t.G1);
    program_run_free(&run);
    run = RUN("terms", material, "--double", "--csv", path);
    csv_row(run.out, 1, got, 5);
    /* (1 - c)(1 + c) and 1 - c^2 are both exact for c = 1/4, so that the directions are the same. */
    assert_true(got[2] == t64.D && got[3] == t64.Lambda && got[4] == t64.G1);
    csv_row(run.out, 2, got, 5);
    assert_true(fabs(got[2]*3.14159265358979323846*.2*.4 - 1) < 1e-14); /* D(n) = 1/(pi alpha_x alpha_y) */
    program_run_free(&run);

    write_text(path, "cos_theta\n0.25\n");
    run = RUN("terms", "ggx alpha=.3", "--csv", path);
    assert_int_equal(strncmp(run.out, "cos_theta,D,Lambda,G1\n0.25,", 27), 0);
    program_run_free(&run);
}

static void samples_are_the_librarys_and_repeat_by_seed(void **state)
{
    (void)state;
    const facet_bsdf bsdf = prepare(material);
    const facet_bsdf64 bsdf64 = prepare64(material);
    const float wo[3] = {0, 0, 1};
    const double wo64[3] = {0, 0, 1};
    double g[10];
    program_run run = RUN("sample", material, "--wo", "0,0,1", "-n", "3", "--seed", "5");
    program_run again = RUN("sample", material, "--wo", "0,0,1", "-n", "3", "--seed", "5");
    program_run other = RUN("sample", material, "--wo", "0,0,1", "-n", "3", "--seed", "6");
    assert_string_equal(run.out, again.out);
    assert_string_not_equal(run.out, other.out);
    for (size_t row = 1; row <= 3; row++) {
        csv_row(run.out, row, g, 10);
        const float u[3] = {(float)g[0], (float)g[1], (float)g[2]};
        const facet_sample s = facet_bsdf_sample(&bsdf, wo, u);
        for (int k = 0; k < 3; k++) assert_true((float)g[3 + k] == s.wi[k] && (float)g[7 + k] == s.weight[k]);
        assert_true((float)g[6] == s.pdf);
    }
    program_run_free(&run);
    program_run_free(&again);
    program_run_free(&other);
    run = RUN("sample", material, "--wo", "0,0,1", "--double");
    csv_row(run.out, 1, g, 10);
    const facet_sample64 s = facet_bsdf64_sample(&bsdf64, wo64, g);
    assert_true(g[3] == s.wi[0] && g[6] == s.pdf && g[7] == s.weight[0]);
    /* SplitMix64's first number for seed 0 is 0xe220a8397b1dcdaf. */
    assert_true(g[0] == (double)(0xe220a8397b1dcdafu >> 11)*0x1p-53);
    program_run_free(&run);
}

/* A stratified mean of sample weights in three numbers against the albedo; 5 sigma of unstratified samples. */
static void expect_mean_weight(const char *spec, const double wo[3], double albedo, double error)
{
    enum { SIDE = 60 };
    facet_material described;
    facet_bsdf64 bsdf;
    assert_int_equal(facet_material_parse(spec, &described, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_prepare(&described, &bsdf, NULL), FACET_OK);
    double sum = 0, sum2 = 0;
    const int n = SIDE*SIDE*SIDE;
    for (int i = 0; i < n; i++) {
        const double u[3] = {(i%SIDE + .5)/SIDE, (i/SIDE%SIDE + .5)/SIDE, (i/SIDE/SIDE + .5)/SIDE};
        const double w = facet_bsdf64_sample(&bsdf, wo, u).weight[0];
        sum += w;
        sum2 += w*w;
    }
    const double mean = sum/n, sigma = sqrt((sum2/n - mean*mean)/n);
    if (!(fabs(albedo - mean) < 5*sigma + error))
        fail_msg("%s: albedo %.9g, sampled %.9g +- %.2g", spec, albedo, mean, sigma);
}

static void albedo_of_known_materials(void **state)
{
    (void)state;
    double got[8];
    program_run run = RUN("albedo", "lambert kd=.1,.5,.9", "--cos", "1,.5,.01");
    for (size_t row = 1; row <= 3; row++) {
        csv_row(run.out, row, got, 8);
        /* Nine digits are printed. */
        assert_true(fabs(got[1] - .1) < 1e-9 && fabs(got[2] - .5) < 1e-9 && fabs(got[3] - .9) < 1e-9);
        assert_true(got[4] == 0 && got[7] < 1e-6);
    }
    program_run_free(&run);

    /* Against the mean weight of 200000 samples: 5 standard errors of weights within [0,1]. */
    run = RUN("albedo", "ggx alpha_x=.1 alpha_y=.5", "--cos", ".3", "--phi", "90");
    csv_row(run.out, 1, got, 8);
    const facet_bsdf64 bsdf = prepare64("ggx alpha_x=.1 alpha_y=.5");
    const double wo[3] = {0, sqrt(1 - .09), .3};
    double sum = 0, sum2 = 0;
    enum { SIDE = 450 };
    for (int i = 0; i < SIDE*SIDE; i++) {
        const double u[3] = {(i%SIDE + .5)/SIDE, (i/SIDE + .5)/SIDE, .5};
        const double w = facet_bsdf64_sample(&bsdf, wo, u).weight[1];
        sum += w;
        sum2 += w*w;
    }
    const double mean = sum/(SIDE*SIDE), sigma = sqrt((sum2/(SIDE*SIDE) - mean*mean)/(SIDE*SIDE));
    if (!(fabs(got[2] - mean) < 5*sigma)) fail_msg("albedo %.9g, sampled %.9g +- %.2g", got[2], mean, sigma);
    program_run_free(&run);

    /* Glass: F, and (1 - F)/ior^2, radiance being compressed inside; F at normal incidence is 0.04. */
    run = RUN("albedo", "glass ior=1.5", "--cos", "1");
    csv_row(run.out, 1, got, 8);
    assert_true(fabs(got[1] - .04) < 1e-9 && fabs(got[4] - .96/2.25) < 1e-9);
    program_run_free(&run);

    /* From inside, and the average over all views: ten digits of an independent program. */
    run = RUN("albedo", "glass ior=1.5", "--cos", "1,.5", "--inside", "--average");
    csv_row(run.out, 1, got, 8);
    assert_true(fabs(got[1] - .04) < 1e-9 && fabs(got[4] - .96*2.25) < 1e-8);
    csv_row(run.out, 2, got, 8);
    assert_true(got[1] == 1 && got[4] == 0);
    const char *const average = strstr(run.out, "\naverage,");
    assert_non_null(average);
    assert_true(fabs(strtod(average + strlen("\naverage,"), NULL) - .596345760) < 1e-6);
    program_run_free(&run);

    /* Rough glass: hardly rough, it is the same; rougher and with a tint, or as a thin wall, the mean of samples. */
    run = RUN("albedo", "glass alpha=1e-4", "--cos", "1");
    csv_row(run.out, 1, got, 8);
    assert_true(fabs(got[1] - .04) < 1e-6 && fabs(got[4] - .96/2.25) < 1e-6);
    program_run_free(&run);
    static const char *const specs[] = {"glass alpha=.4 tint=.5", "glass alpha=.4 wall=thin", "glass alpha=.4 ior=.8"};
    for (int k = 0; k < 3; k++) {
        run = RUN("albedo", specs[k], "--cos", ".6");
        csv_row(run.out, 1, got, 8);
        expect_mean_weight(specs[k], (double[3]){.8, 0, .6}, got[1] + got[4], got[7]);
        program_run_free(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eval_equals_the_library),
        cmocka_unit_test(eval_csv_takes_columns_in_any_order_and_copies_the_six),
        cmocka_unit_test(eval_csv_keeps_every_row_of_a_long_file),
        cmocka_unit_test(damaged_csv_is_refused_with_its_line),
        cmocka_unit_test(terms_equal_the_library),
        cmocka_unit_test(samples_are_the_librarys_and_repeat_by_seed),
        cmocka_unit_test(albedo_of_known_materials),
    };
    return cmocka_run_group_tests(tests, make_test_folder, remove_test_folder);
}
