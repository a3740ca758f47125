/* test_verify.c: `facet verify` passes what is right, fails each published mistake for its reason, and survives
 * plugins that crash, hang or are none.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include <sys/stat.h>
#include <unistd.h>

#include "io/image_file.h"
#include "plot/canvas.h"
#include "tests/merl_file.h"
#include "tests/program_folder.h"

#define VERIFY(...) run_program(folder, NULL, NULL, (const char *const[]){FACET_PROGRAM, "verify", __VA_ARGS__, NULL})

/* Runs end with the status, and say this on stdout and stderr. */
static void expect(program_run run, int status, const char *in_out, const char *in_err)
{
    program_run_check(&run, status, in_out, in_err);
    program_run_free(&run);
}

static const char *plugin(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s.so", FACET_PLUGINS, name);
    return path;
}

/* The check that a control's source says must find it: the word after "expect: "; false if there is none. */
static int expected_check(const char *file, char check[32])
{
    char path[512];
    size_t size;
    snprintf(path, sizeof path, FACET_SOURCE_DIR "/tests/plugins/%s", file);
    char *text = read_bytes(path, &size);
    assert_non_null(text);
    const char *line = strstr(text, "expect: ");
    const int is_there = line != NULL && sscanf(line, "expect: %31[a-z-]", check) == 1;
    free(text);
    return is_there;
}

static void every_published_mistake_fails(void **state)
{
    (void)state;
    DIR *listing = opendir(FACET_SOURCE_DIR "/tests/plugins");
    assert_non_null(listing);
    int n = 0;
    for (const struct dirent *entry; (entry = readdir(listing));) {
        char check[32], name[256], line[64];
        const size_t length = strlen(entry->d_name);
        if (length < 3 || strcmp(entry->d_name + length - 2, ".c") != 0 || !expected_check(entry->d_name, check))
            continue;
        snprintf(name, sizeof name, "%.*s", (int)(length - 2), entry->d_name);
        snprintf(line, sizeof line, "  %-18s FAILS", check);
        print_message("  %s: %s\n", name, check);
        expect(VERIFY("--plugin", plugin(name), "--check", check, "--samples", "50000"), 1, line, "");
        n++;
    }
    closedir(listing);
    assert_true(n >= 20);
}

/* What only a mistake of the sampler is, is no mistake of the rest. */
static void the_rest_of_a_mistaken_model_holds(void **state)
{
    (void)state;
    expect(VERIFY("--plugin", plugin("phong_exponent"), "--check", "furnace"), 0, "all checks hold", "");
    expect(VERIFY("--plugin", plugin("phong_exponent"), "--check", "weight"), 0, "all checks hold", "");
    expect(VERIFY("--plugin", plugin("two_alphas"), "--check", "chi-square", "--samples", "50000"), 0,
           "all checks hold", "");
    expect(VERIFY("--plugin", plugin("two_alphas"), "--check", "normalisation"), 0, "all checks hold", "");
    expect(VERIFY("--plugin", plugin("bonn_ward"), "--check", "reciprocity"), 0, "all checks hold", "");
    expect(VERIFY("--plugin", plugin("weight_without_cos"), "--check", "chi-square", "--samples", "50000"), 0,
           "all checks hold", "");
}

static void the_example_holds(void **state)
{
    (void)state;
    expect(VERIFY("--plugin", FACET_EXAMPLES "/plugin_phong.so", "exponent=20"), 0, "all checks hold", "");
}

static void plugins_that_fail_end_with_a_line(void **state)
{
    (void)state;
    expect(VERIFY("--plugin", plugin("crash")), 3, "", "was ended by signal 11");
    expect(VERIFY("--plugin", plugin("leave")), 3, "", "ended its process, with status 0, in eval, called by");
    expect(VERIFY("--plugin", plugin("leave_at_start")), 3, "", "with status 7, in the library's start");
    expect(VERIFY("--plugin", plugin("hang"), "--patience", "0.5"), 3, "", "has not returned for 0.5 s in eval");
    expect(VERIFY("--plugin", plugin("nan")), 1, "positive           FAILS  inf", "");
    expect(VERIFY("--plugin", plugin("no_describe")), 3, "", "defines no facet_plugin_describe");
    expect(VERIFY("--plugin", plugin("old_size")), 3, "", "smaller than this version's");
    expect(VERIFY("--plugin", plugin("bad_table")), 3, "", "lowest, value and highest");
    expect(VERIFY("--plugin", plugin("absent")), 3, "", "No such file");
    expect(VERIFY("--plugin", plugin("two_alphas"), "roughnes=.5"), 2, "", "did you mean `roughness`?");
    expect(VERIFY("--plugin", plugin("two_alphas"), "roughness=7"), 2, "", "out of range");
    expect(VERIFY("--plugin", plugin("two_alphas"), "roughness=x"), 2, "", "is not a number");
    expect(VERIFY("--plugin", plugin("two_alphas"), "roughness"), 2, "", "NAME=VALUE");
    write_text(in_folder(folder, "text.so"), "no library\n");
    expect(VERIFY("--plugin", "text.so"), 3, "", "is no shared library");
}

/* Where quadrature has an absolute tolerance only, these take hours. */
static void huge_values_are_measured_or_overflow(void **state)
{
    (void)state;
    const char *const lines[] = {"scale=20",  "the albedo is 3.14159e+20", "scale=300", "the albedo is 3.14159e+300",
                                 "scale=308", "the albedo is inf"};
    for (size_t i = 0; i < sizeof lines/sizeof *lines; i += 2)
        expect(VERIFY("--plugin", plugin("huge"), lines[i], "--check", "furnace"), 1, lines[i + 1], "");
    expect(VERIFY("--plugin", plugin("huge"), "--check", "chi-square", "--samples", "10000"), 1, "chi^2 overflows", "");
    expect(VERIFY("--plugin", plugin("huge"), "--samples", "10000", "--json"), 1, "\"worst\": null", "");
}

static void measurements_are_of_their_format(void **state)
{
    (void)state;
    write_text(in_folder(folder, "text.binary"), "no measurements\n");
    expect(VERIFY("merl file=text.binary"), 3, "", "text.binary:byte 0: its sizes are");
    expect(VERIFY("merl file=absent.binary"), 3, "", "absent.binary");
    expect(VERIFY("merl"), 2, "", "`merl file=FILE.binary`");
    write_merl_of(in_folder(folder, "huge.binary"), 1e300);
    expect(VERIFY("merl file=huge.binary", "--check", "furnace"), 1, "the albedo is 3.14159e+300", "");
}

static void materials_are_verified(void **state)
{
    (void)state;
    expect(VERIFY("ggx alpha=.3", "--samples", "50000"), 0, "all checks hold", "");
    expect(VERIFY("gtr alpha=.1 gamma=1.5", "--fixed", "--samples", "50000"), 0, "all checks hold", "");
    expect(VERIFY("gtr alpha=.1 gamma=1.5 masking=published", "--check", "weak-furnace"), 1, "weak-furnace       FAILS",
           "");
    expect(VERIFY("phong exponent=1 masking=published", "--check", "weak-furnace"), 1, "weak-furnace       FAILS", "");
    expect(VERIFY("lambert kd=1", "--check", "furnace", "--json"), 0, "\"verdict\": \"passed\"", "");
    expect(VERIFY("ggx roughness=.3"), 2, "", "roughness");
    expect(VERIFY("--all", "ggx"), 2, "", "takes no material");
    expect(VERIFY("--check", "furnace"), 2, "", "one material is needed");
    expect(VERIFY("ggx", "--check", "colour"), 2, "", "colour");
    expect(VERIFY("ggx alpha=.3", "--search"), 0, "  albedo ", "");
}

/* The tables of 25 digits: those of the tree, whose rows are some of the full ones; and if these lie beside the tree,
 * docs/verification.md shows what they say. */
static void errors_against_tables_are_those_in_the_documents(void **state)
{
    (void)state;
    expect(VERIFY("--truth", FACET_SOURCE_DIR "/tests/data/reference"), 0, "| beckmann | Lambda | relative | 51 |", "");
    expect(VERIFY("--truth", FACET_SOURCE_DIR "/tests/data/reference", "--json"), 0, "\"term\": \"G1\"", "");
    expect(VERIFY("--truth", "absent"), 3, "", "absent: has none of the tables");
    expect(VERIFY("--truth", "absent", "ggx"), 2, "", "--truth: takes no material");
    write_text(in_folder(folder, "d.csv"), "model,alpha_x,alpha_y,cos_theta,phi\n");
    expect(VERIFY("--truth", "."), 3, "", "no column `gamma`");
    write_text(in_folder(folder, "d.csv"), "model,gamma,alpha_x,alpha_y,cos_theta,phi,D\ngxx,0,.1,.1,1,0,1\n");
    expect(VERIFY("--truth", "."), 3, "", "d.csv:line 2: ");
    if (access(FACET_SOURCE_DIR "/../shared/reference/d.csv", R_OK) != 0) return;
    program_run run = VERIFY("--truth", FACET_SOURCE_DIR "/../shared/reference");
    char *document = read_bytes(FACET_SOURCE_DIR "/docs/verification.md", NULL);
    assert_non_null(document);
    if (run.status != 0 || !strstr(document, run.out)) fail_msg("docs/verification.md has not:\n%s", run.out);
    free(document);
    program_run_free(&run);
}

static void need_cairo(void)
{
    canvas *page;
    if (canvas_create(CANVAS_PNG, 100, 100, 10, &page, NULL) == FACET_UNSUPPORTED) skip();
    canvas_destroy(page);
}

/* The picture in the folder of the tests, of this size; the share of its pixels that have colours. */
static double coloured_share(const char *name, size_t width, size_t height)
{
    image picture = {0};
    facet_error why = {0};
    if (image_read(in_folder(folder, name), &picture, &why)) fail_msg("%s: %s", name, why.text);
    assert_true(picture.width == width && picture.height == height && picture.n_channels == 3);
    const unsigned char *pixels = picture.pixels;
    size_t n = 0;
    for (size_t i = 0; i < width*height; i++) n += abs(pixels[3*i] - pixels[3*i + 2]) > 20;
    image_destroy(&picture);
    return (double)n/(double)(width*height);
}

static void what_was_verified_is_drawn(void **state)
{
    (void)state;
    need_cairo();
    expect(VERIFY("ggx alpha_x=.1 alpha_y=.4", "--fixed", "--samples", "20000", "--plot", "right"), 0,
           "all checks hold", "");
    assert_true(coloured_share("right/1-chi-square.png", 1320, 1065) > 0.3);
    assert_true(coloured_share("right/1-furnace.png", 1200, 500) > 0.02);
    /* the same folder again, and only what is asked for */
    remove(in_folder(folder, "right/1-chi-square.png"));
    expect(VERIFY("glass alpha=.3", "--fixed", "--check", "weak-furnace", "--plot", "right"), 0, "all checks hold", "");
    assert_true(access(in_folder(folder, "right/1-chi-square.png"), F_OK) != 0);
    expect(VERIFY("--plugin", plugin("sampler_alpha"), "--samples", "20000", "--plot", "wrong"), 1, "fail", "");
    assert_true(coloured_share("wrong/3-chi-square.png", 1320, 1065) > 0.3);
    expect(VERIFY("--plugin", plugin("crash"), "--plot", "wrong"), 3, "", "was ended by signal 11");
}

static void measurements_are_drawn(void **state)
{
    (void)state;
    need_cairo();
    write_merl(in_folder(folder, "white.binary"));
    expect(VERIFY("merl file=white.binary", "--plot", "measured"), 0, "the albedo is 1", "");
    assert_true(coloured_share("measured/1-furnace.png", 1200, 500) > 0.02);
    assert_true(access(in_folder(folder, "measured/1-chi-square.png"), F_OK) != 0); /* it has no sampler */
}

static void pictures_need_a_folder(void **state)
{
    (void)state;
    need_cairo();
    write_text(in_folder(folder, "text"), "no folder\n");
    expect(VERIFY("ggx", "--plot", "text"), 4, "", "text: is not a folder");
    expect(VERIFY("ggx", "--plot", "absent/folder"), 4, "", "absent/folder: the folder cannot be made: No such file");
    assert_int_equal(mkdir(in_folder(folder, "closed"), 0500), 0);
    if (access(in_folder(folder, "closed"), W_OK)) /* not by root */
        expect(VERIFY("ggx", "--plot", "closed"), 4, "", "closed: the folder cannot be written to");
    expect(VERIFY("ggx", "--search", "--plot", "pictures"), 2, "", "--plot: does not go with --search");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_published_mistake_fails),
        cmocka_unit_test(the_rest_of_a_mistaken_model_holds),
        cmocka_unit_test(the_example_holds),
        cmocka_unit_test(plugins_that_fail_end_with_a_line),
        cmocka_unit_test(huge_values_are_measured_or_overflow),
        cmocka_unit_test(measurements_are_of_their_format),
        cmocka_unit_test(materials_are_verified),
        cmocka_unit_test(errors_against_tables_are_those_in_the_documents),
        cmocka_unit_test(what_was_verified_is_drawn),
        cmocka_unit_test(measurements_are_drawn),
        cmocka_unit_test(pictures_need_a_folder),
    };
    return cmocka_run_group_tests(tests, make_test_folder, remove_test_folder);
}
