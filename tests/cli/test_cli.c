/* test_cli.c: the program as its users meet it: help, mistakes, exit statuses.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>
#include <jansson.h>

#include "tests/program_folder.h"

/* ---- Help -------------------------------------------------------------------------------------- */

static void no_arguments_print_the_usage_and_fail(void **state)
{
    (void)state;
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){FACET_PROGRAM, NULL});
    program_run_check(&run, 2, "", "Usage: facet COMMAND");
    assert_int_equal(strlen(run.out), 0);
    program_run_free(&run);
}

/* What each command's help must show: its options, examples, exit statuses. */
static const struct {
    const char *name, *options; /* separated by blanks */
} helps[] = {
    {"render",
     "--output --spp --size --camera --env --env-scale --depth --threads --seed --crop --time --noise "
     "--aov --denoise --oidn "
     "--material --strategy --sampler --gradients --isa --checkpoint --checkpoint-interval --resume --shard --exposure "
     "--view --half --quiet --events --json --help -o -s -t -h"},
    {"merge", "--output --aov --denoise --oidn --exposure --view --half --quiet --help -o"},
    {"compare", "--metric --max --exposure --view --diff --json --help"},
    {"eval", "--wi --wo --csv --double --help"},
    {"sample", "--wo --count --seed --double --help -n"},
    {"terms", "--csv --double --help"},
    {"albedo", "--cos --phi --inside --average --help"},
    {"materials", "--json --help"},
    {"scenes", "--help"},
    {"info", "--json --help"},
    {"explore", "--port --help"},
};
enum { N_HELPS = sizeof helps/sizeof *helps };

static void help_of_each_command_is_complete(void **state)
{
    (void)state;
    for (size_t i = 0; i < N_HELPS; i++) {
        program_run run = RUN(helps[i].name, "--help"), again = RUN("help", helps[i].name);
        program_run_check(&run, 0, "Examples:", "");
        program_run_check(&run, 0, "Exit status:", "");
        program_run_check(&run, 0, "Usage: facet ", "");
        assert_string_equal(run.out, again.out);
        char *options = strdup(helps[i].options);
        for (char *name = strtok(options, " "); name; name = strtok(NULL, " ")) program_run_check(&run, 0, name, "");
        free(options);
        program_run_free(&run);
        program_run_free(&again);
    }
}

/* A long list of choices goes on below the first. */
static void choices_in_help_are_complete_and_fit(void **state)
{
    (void)state;
    program_run run = RUN("verify", "--help");
    program_run_check(&run, 0,
                      "      --check positive|normalisation|projected-area|weak-furnace|furnace|\n"
                      "              reciprocity|isotropy|pdf-normalisation|chi-square|weight|\n"
                      "              efficiency   one check alone\n",
                      "");
    program_run_free(&run);
}

/* The other way round: every option that help shows is accepted, or asks for its value. */
static void every_option_in_help_is_known(void **state)
{
    (void)state;
    size_t n = 0;
    for (size_t i = 0; i < N_HELPS; i++) {
        program_run run = RUN(helps[i].name, "--help");
        for (const char *p = strstr(run.out, "Options:"); (p = strstr(p, "--")) != NULL; n++) {
            char name[64];
            snprintf(name, sizeof name, "%.*s", (int)strspn(p, "-abcdefghijklmnopqrstuvwxyz"), p);
            p += strlen(name);
            if (strstr(p, "Examples:") == NULL) break;
            if (strcmp(name, "--help") == 0) continue;
            program_run use = RUN(helps[i].name, name, "--help");
            if (strstr(use.err, "has no option")) fail_msg("%s %s: %s", helps[i].name, name, use.err);
            program_run_free(&use);
        }
        program_run_free(&run);
    }
    assert_true(n >= 35); /* options and the mentions of options in the help of others */
}

/* Each material that help shows between quotes is one that the library knows. */
static void materials_in_help_are_valid(void **state)
{
    (void)state;
    size_t n = 0;
    for (size_t i = 0; i <= N_HELPS; i++) {
        program_run run = RUN("help", i < N_HELPS ? helps[i].name : NULL);
        for (const char *p = run.out; (p = strchr(p, '\'')) != NULL;) {
            char spec[128];
            const size_t length = strcspn(++p, "'\n");
            snprintf(spec, sizeof spec, "%.*s", (int)length, p);
            p += length + (p[length] != 0);
            if (!strchr(spec, '=') || strchr(spec, '\\')) continue; /* SPEC, or the text of a CSV file */
            program_run use = RUN("albedo", spec, "--cos", "1");
            program_run_check(&use, 0, "", "");
            program_run_free(&use);
            n++;
        }
        program_run_free(&run);
    }
    assert_true(n >= 10);
}

static void overview_lists_every_command_and_status(void **state)
{
    (void)state;
    program_run run = RUN("--help"), again = RUN("help");
    for (size_t i = 0; i < N_HELPS; i++) program_run_check(&run, 0, helps[i].name, "");
    program_run_check(&run, 0, "130  interrupted", "");
    assert_string_equal(run.out, again.out);
    program_run_free(&again);
    again = RUN("help", "help"); /* the overview is its help */
    assert_string_equal(run.out, again.out);
    program_run_free(&run);
    program_run_free(&again);
    run = RUN("--version");
    program_run_check(&run, 0, "facet 0.", "");
    program_run_free(&run);
}

/* ---- Mistakes ---------------------------------------------------------------------------------- */

typedef struct mistake {
    int status;
    const char *text; /* in the one line on stderr */
    const char *arguments[10];
} mistake;

static const mistake mistakes[] = {
    {2, "there is no command `rendr`; did you mean `render`?", {"rendr"}},
    {2, "there is no command `zzzzzzzz`; `facet --help`", {"zzzzzzzz"}},
    {2, "there is no command `evl`", {"help", "evl"}},
    {2, "unexpected argument `extra`; usage: facet --version", {"--version", "extra"}},
    {2, "unexpected argument `extra`; usage: facet --help", {"-h", "extra"}},
    {2, "unexpected argument `extra`; usage: facet help", {"help", "render", "extra"}},
    {2, "unexpected argument `extra`; usage: facet help", {"help", "--json", "extra"}},
    {2, "no option `--sp`; did you mean `--spp`?", {"render", "--sp", "4"}},
    {2, "no option `--zzzzzzzz`; ", {"render", "--zzzzzzzz", "4"}},
    {2, "no option `-q`", {"render", "-q"}},
    {2, "`--spp` needs a value: --spp N", {"render", "--spp"}},
    {2, "`--output` needs a value", {"render", "--output", "--quiet"}},
    {2, "--spp: `zero` is not a whole number from 1 to 16777216", {"render", "--spp", "zero"}},
    {2, "--spp: `0` is not", {"render", "--spp=0"}},
    {2, "--spp: `-4` is not", {"render", "-s-4"}},
    {2, "--spp: `99999999999999999999` is not", {"render", "-s", "99999999999999999999"}},
    {2, "--spp is given twice", {"render", "--spp", "4", "-s", "5"}},
    {2, "--quiet takes no value", {"render", "--quiet=yes"}},
    {2, "--size: `64` is not WIDTHxHEIGHT", {"render", "--size", "64"}},
    {2, "--size: `0x5` is not", {"render", "--size", "0x5"}},
    {2, "--crop: `1,2,3` is not X,Y,WIDTH,HEIGHT", {"render", "--crop", "1,2,3"}},
    {2, "--strategy: `best` is not one of explicit|implicit|mis", {"render", "--strategy", "best"}},
    {2, "--strategy: `mis|` is not", {"render", "--strategy", "mis|"}},
    {2, "--time: `soon` is not a number from", {"render", "--time", "soon"}},
    {2, "--time: `nan` is not a number from", {"render", "--time", "nan"}},
    {2, "picture.jpg: is neither an .exr nor a .png", {"render", "-o", "picture.jpg"}},
    {2, "a.png: is named twice", {"render", "-o", "a.png", "-o", "a.png"}},
    {2, "unexpected argument `c.glb`; usage: facet render", {"render", "b.glb", "c.glb"}},
    {2, "eval needs SPEC; usage", {"eval"}},
    {2, "eval needs directions", {"eval", "lambert"}},
    {2, "eval needs directions", {"eval", "lambert", "--wi", "0,0,1"}},
    {2, "exclude each other", {"eval", "lambert", "--wi", "0,0,1", "--csv", "x"}},
    {2, "--wi: is not a unit vector", {"eval", "lambert", "--wi", "0,0,2", "--wo", "0,0,1"}},
    {2, "--wo: `0,0` is not three finite numbers", {"eval", "lambert", "--wi", "0,0,1", "--wo", "0,0"}},
    {2, "--wo: `0,0,inf` is not", {"eval", "lambert", "--wi", "0,0,1", "--wo", "0,0,inf"}},
    {2, "did you mean `ggx`?", {"albedo", "gggx"}},
    {2, "SPEC:alpha", {"albedo", "ggx alpha=-1"}},
    {2, "did you mean `alpha`?", {"albedo", "ggx alhpa=.1"}},
    {2, "--cos: `2` is not a list of numbers from", {"albedo", "ggx", "--cos", "2"}},
    {2, "sample needs a direction of view", {"sample", "ggx"}},
    {2, "--count: `0` is not", {"sample", "ggx", "--wo", "0,0,1", "-n", "0"}},
    {2, "terms needs --csv", {"terms", "ggx"}},
    {2, "there is no model `gggx`; did you mean `ggx`?", {"materials", "gggx"}},
    {2, "unexpected argument `x`", {"scenes", "x"}},
    {2, "--port: `70000` is not", {"explore", "--port", "70000"}},
    {2, "compare needs A B", {"compare", "a.png"}},
    {2, "--metric: `ssim` is not one of mse|", {"compare", "a.png", "b.png", "--metric", "ssim"}},
    {2, "--diff: `d.exr` is not the name of a .png", {"compare", "a.png", "b.png", "--diff", "d.exr"}},
    {3, "missing.png: ", {"compare", "missing.png", "missing.png"}},
    {3, "missing.exr: ", {"info", "missing.exr"}},
    {3, "missing.gltf: ", {"info", "missing.gltf"}},
    {3, "missing.glb: ", {"render", "missing.glb"}},
    {3, "missing.csv: cannot be opened", {"eval", "lambert", "--csv", "missing.csv"}},
    {3, ".: is a folder", {"eval", "lambert", "--csv", "."}},
    {3, "missing.hdr: ", {"render", "--env", "missing.hdr", "--size", "4x4"}},
    {4, "no/picture.exr: the folder `no` cannot be used", {"render", "-o", "no/picture.exr"}},
    {2, "--env: `1,-1,1` is not a radiance", {"render", "--env", "1,-1,1", "--size", "4x4"}},
    {2, "--crop: 3,0,2,1 does not lie inside", {"render", "--size", "4x4", "--crop", "3,0,2,1"}},
    {2, "--size: 2147483647x2147483647 is too large", {"render", "--size", "2147483647x2147483647"}},
    {2, "--size: 1x65537 is too large", {"render", "--size", "1x65537"}},
    {2, "--material: `body` is not NAME='SPEC'", {"render", "--material", "body"}},
    {2, "--material: the scene has no material `no such`", {"render", "--material", "no such=ggx"}},
    {2, "--camera: the scene has no camera `no such`", {"render", "--camera", "no such"}},
};

static void mistakes_give_one_kind_line_and_their_status(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof mistakes/sizeof *mistakes; i++) {
        const char *argv[12] = {FACET_PROGRAM};
        for (size_t k = 0; k < 10; k++) argv[k + 1] = mistakes[i].arguments[k];
        program_run run = run_program(folder, NULL, NULL, argv);
        program_run_check(&run, mistakes[i].status, "", mistakes[i].text);
        const char *line = strstr(run.err, "facet: error: ");
        if (!line || strchr(line, '\n') != line + strlen(line) - 1 || (line != run.err && line[-1] != '\n'))
            fail_msg("not one line of error at the end: %s", run.err);
        if (strlen(run.out)) fail_msg("something on stdout beside `%s`: %s", run.err, run.out);
        program_run_free(&run);
    }
}

static void messages_stay_on_one_line_whatever_the_file_is_called(void **state)
{
    (void)state;
    program_run run = RUN("info", "two\nlines\x1b[2J.png");
    program_run_check(&run, 3, "", "facet: error: two?lines?[2J.png: ");
    program_run_free(&run);
    expect_run(RUN("render", "--size", "4x4", "--spp", "1", "-o", "two\nlines.png"), 0,
               "facet: wrote two?lines.png: 4x4, 1 spp");
    char name[3000];
    memset(name, 'a', sizeof name);
    name[sizeof name - 1] = 0;
    expect_run(RUN("info", name), 3, "aaa: cannot open: File name too long\n"); /* what is wrong is not cut off */
}

static void options_end_at_two_dashes(void **state)
{
    (void)state;
    program_run run = RUN("info", "--", "--json");
    program_run_check(&run, 3, "", "facet: error: --json: ");
    program_run_free(&run);
}

/* ---- Listings ---------------------------------------------------------------------------------- */

static void materials_json_holds_the_table(void **state)
{
    (void)state;
    program_run run = RUN("materials", "--json");
    json_error_t why;
    json_t *models = json_loads(run.out, JSON_REJECT_DUPLICATES, &why);
    if (!models) fail_msg("line %d: %s\n%s", why.line, why.text, run.out);
    size_t i, k;
    json_t *model, *parameter;
    bool has_alpha = false;
    json_array_foreach(models, i, model)
    {
        assert_true(json_string_length(json_object_get(model, "summary")) > 0);
        json_array_foreach(json_object_get(model, "parameters"), k, parameter)
        {
            const char *name = json_string_value(json_object_get(parameter, "name"));
            assert_non_null(name);
            assert_non_null(json_object_get(parameter, "default"));
            has_alpha = has_alpha || (strcmp(json_string_value(json_object_get(model, "name")), "ggx") == 0 &&
                                      strcmp(name, "alpha") == 0);
        }
    }
    assert_true(has_alpha);
    json_decref(models);
    program_run_free(&run);
    run = RUN("materials", "ggx");
    program_run_check(&run, 0, "alpha_x", "");
    program_run_free(&run);
    run = RUN("scenes");
    program_run_check(&run, 0, "demo ", "");
    program_run_free(&run);
}

static void a_full_disk_behind_stdout_is_status_4(void **state)
{
    (void)state;
    static const char *const commands[][6] = {
        {FACET_PROGRAM, "--help", NULL},
        {FACET_PROGRAM, "materials", NULL},
        {FACET_PROGRAM, "sample", "lambert", "--wo=0,0,1", "-n100000", NULL},
        {FACET_PROGRAM, "albedo", "lambert", NULL},
    };
    for (size_t i = 0; i < sizeof commands/sizeof *commands; i++) {
        write_text(in_folder(folder, "stdout"), "");
        program_run run = run_program(folder, NULL, "/dev/full", commands[i]);
        program_run_check(&run, 4, "", "facet: error: stdout: No space left on device");
        program_run_free(&run);
    }
}

static void a_reader_that_leaves_is_no_error_message(void **state)
{
    (void)state;
    char command[1024];
    snprintf(command, sizeof command, "'%s' sample lambert --wo 0,0,1 -n 1000000 | head -n 2", FACET_PROGRAM);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
    program_run_check(&run, 0, "u1,u2,u3", "");
    assert_int_equal(strlen(run.err), 0);
    program_run_free(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_arguments_print_the_usage_and_fail),
        cmocka_unit_test(help_of_each_command_is_complete),
        cmocka_unit_test(choices_in_help_are_complete_and_fit),
        cmocka_unit_test(every_option_in_help_is_known),
        cmocka_unit_test(materials_in_help_are_valid),
        cmocka_unit_test(overview_lists_every_command_and_status),
        cmocka_unit_test(mistakes_give_one_kind_line_and_their_status),
        cmocka_unit_test(messages_stay_on_one_line_whatever_the_file_is_called),
        cmocka_unit_test(options_end_at_two_dashes),
        cmocka_unit_test(materials_json_holds_the_table),
        cmocka_unit_test(a_full_disk_behind_stdout_is_status_4),
        cmocka_unit_test(a_reader_that_leaves_is_no_error_message),
    };
    return cmocka_run_group_tests(tests, make_test_folder, remove_test_folder);
}
