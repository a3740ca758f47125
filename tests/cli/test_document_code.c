/* test_document_code.c: the scripts and the code in the documents run.
 *
 * Scripts run in a folder with what their documents speak of: the headers, the examples, a small scene.glb.  In front
 * of the programs that they name stand others, so that a run takes no minutes: `facet render` makes pictures of 8 x 4
 * pixels, mpirun starts two ranks, make looks whether it has the target, pkg-config names the library of this build,
 * and cc is its compiler.
 *
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
#include <glob.h>
#include <unistd.h>

#include "tests/document_blocks.h"
#include "tests/run_program.h"

static char *folder; /* of the test */

/* Writes a script into the test's bin, before all others in PATH. */
static void stand_in(const char *name, const char *text)
{
    char place[64];
    snprintf(place, sizeof place, "bin/%s", name);
    const char *path = in_folder(folder, place);
    char script[4096];
    snprintf(script, sizeof script, "#!/bin/sh\n%s\n", text);
    write_text(path, script);
    const char *const mode[] = {"/bin/chmod", "+x", path, NULL};
    program_run run = run_program(folder, NULL, NULL, mode);
    assert_int_equal(run.status, 0);
    program_run_free(&run);
}

/* Each script has a folder of its own, like a checkout with a scene. */
static program_run run_script(const char *script)
{
    char *whole = malloc(strlen(script) + 256);
    assert_non_null(whole);
    sprintf(whole, "PATH=\"$PWD/bin:$PATH\"; export PATH; rm -rf place; cp -RP template place; cd place\n%s", script);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-euc", whole, NULL});
    free(whole);
    return run;
}

/* Gives `facet render` another --size. */
static const char small_pictures[] = "if [ \"$1\" = render ]; then\n"
                                     "    last=''\n"
                                     "    for a; do\n"
                                     "        shift; [ \"$last\" != --size ] || a=8x4; set -- \"$@\" \"$a\"; last=$a\n"
                                     "    done\n"
                                     "    case \" $* \" in *' --size '*) ;; *) set -- \"$@\" --size 8x4 ;; esac\n"
                                     "fi";

static int set_up(void **state)
{
    (void)state;
    char text[4096];
    folder = make_folder();
    const char *const steps = "mkdir bin template; cd template; ln -s '%s/include' '%s/examples' '%s/tests' .; "
                              "cp '%s/tests/fuzz/corpus/glb/glb_ok_triangle.glb' scene.glb; "
                              "cp examples/01_first_material.c program.c";
    snprintf(text, sizeof text, steps, FACET_SOURCE_DIR, FACET_SOURCE_DIR, FACET_SOURCE_DIR, FACET_SOURCE_DIR);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-euc", text, NULL});
    if (run.status) fail_msg("%s", run.err);
    program_run_free(&run);
    snprintf(text, sizeof text, "%s\nexec '%s' \"$@\"", small_pictures, FACET_PROGRAM);
    stand_in("facet", text);
    snprintf(text, sizeof text, "shift 2\nexec '%s' -n 2 \"$@\"", FACET_MPIRUN);
    stand_in("mpirun", text);
    snprintf(text, sizeof text,
             "[ \"$1\" != -f ] || exec /usr/bin/make \"$@\"\n"
             "for a; do case $a in *=*) ;; *) grep -q \"^$a:\" '%s/Makefile' || exit 1 ;; esac; done",
             FACET_SOURCE_DIR);
    stand_in("make", text);
    snprintf(text, sizeof text, "echo -I '%s/include' '%s' -lm %s", FACET_SOURCE_DIR, FACET_LIBRARY, FACET_LINK_FLAGS);
    stand_in("pkg-config", text);
    stand_in("cc", "exec " FACET_CC " \"$@\"");
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

/* A line that ends with `# fails...` has to fail, all others have to succeed. */
static void check_script(const char *file, char *block)
{
    char script[8192] = "", line[2048];
    for (const char *p = block; *p; p += strcspn(p, "\n") + 1) {
        snprintf(line, sizeof line, "%.*s", (int)strcspn(p, "\n"), p);
        const int fails = strstr(line, "# fails") != NULL;
        const size_t n = strlen(script);
        snprintf(script + n, sizeof script - n, fails ? "if %s\nthen exit 99; fi\n" : "%s\n", line);
    }
    if (strstr(script, "mpirun") && !*FACET_MPIRUN) {
        print_message("%s: skipped: there is no mpirun\n", file);
        return;
    }
    program_run run = run_script(script);
    if (run.status != 0) fail_msg("%s: status %d of\n%s\n%s%s", file, run.status, block, run.err, run.out);
    program_run_free(&run);
}

static void scripts_succeed(void **state)
{
    (void)state;
    assert_true(each_document_block("sh", check_script) >= 8);
}

/* Whether whole lines of an example, which is built and run, are this. */
static int is_of_an_example(const char *block)
{
    glob_t files = {0};
    assert_int_equal(glob(FACET_SOURCE_DIR "/examples/*.c", 0, NULL, &files), 0);
    int is_found = 0;
    for (size_t i = 0; i < files.gl_pathc; i++) {
        char *example = read_bytes(files.gl_pathv[i], NULL);
        assert_non_null(example);
        const char *at = strstr(example, block);
        is_found |= at && (at == example || at[-1] == '\n');
        free(example);
    }
    globfree(&files);
    return is_found;
}

/* What lines of a program that the documents do not show declare. */
static const char around[] = "#include <stdint.h>\n#include \"facet/facet.h\"\n"
                             "void glUniform4uiv(int location, int count, const uint32_t *value);\n"
                             "void fragment(int location);\nvoid fragment(int location)\n{\n(void)location;\n";

/* Lines of an example, or a part of a function that compiles by itself. */
static void check_c(const char *file, char *block)
{
    if (is_of_an_example(block)) return;
    char text[8192];
    snprintf(text, sizeof text, "%s%s}\n", around, block);
    write_text(in_folder(folder, "template/part.c"), text);
    program_run run = run_script("cc -Wall -Wextra -Werror -I include -c part.c -o part.o");
    if (run.status != 0) fail_msg("%s: neither of an example, nor compiled:\n%s\n%s", file, block, run.err);
    program_run_free(&run);
}

static void c_is_of_an_example_or_compiles(void **state)
{
    (void)state;
    assert_true(each_document_block("c", check_c) >= 2);
}

/* fetch() reads this build's facet.wasm; afterwards `facet` has to have models. */
static void check_js(const char *file, char *block)
{
    char text[8192];
    snprintf(text, sizeof text,
             "import { readFileSync } from 'node:fs';\n"
             "globalThis.fetch = async () => new Response(readFileSync('%s'), {headers: {'content-type': "
             "'application/wasm'}});\n%s\nif (!(facet.facet_model_count() > 5)) throw 'no models';\n",
             FACET_WASM, block);
    write_text(in_folder(folder, "template/part.mjs"), text);
    program_run run = run_script("node part.mjs");
    if (run.status != 0) fail_msg("%s:\n%s\n%s", file, block, run.err);
    program_run_free(&run);
}

static void javascript_runs(void **state)
{
    (void)state;
    if (access(FACET_WASM, R_OK) != 0 || system("command -v node >/dev/null 2>&1") != 0) {
        print_message("skipped: node or facet.wasm is missing\n");
        skip();
    }
    assert_true(each_document_block("js", check_js) >= 1);
}

static void check_glsl(const char *file, char *block)
{
    char *ggx = read_bytes(FACET_GLSL "/ggx.glsl", NULL);
    assert_non_null(ggx);
    char *text = malloc(strlen(ggx) + strlen(block) + 64);
    assert_non_null(text);
    sprintf(text, "#version 330\n%s%s", ggx, block);
    write_text(in_folder(folder, "template/part.frag"), text);
    program_run run = run_script("glslangValidator part.frag");
    if (run.status != 0) fail_msg("%s:\n%s\n%s", file, block, run.out);
    program_run_free(&run);
    free(text);
    free(ggx);
}

static void glsl_is_valid(void **state)
{
    (void)state;
    if (access(FACET_GLSL "/ggx.glsl", R_OK) != 0 || system("command -v glslangValidator >/dev/null 2>&1") != 0) {
        print_message("skipped: glslangValidator or ggx.glsl is missing\n");
        skip();
    }
    assert_true(each_document_block("glsl", check_glsl) >= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(scripts_succeed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(c_is_of_an_example_or_compiles, set_up, tear_down),
        cmocka_unit_test_setup_teardown(javascript_runs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(glsl_is_valid, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
