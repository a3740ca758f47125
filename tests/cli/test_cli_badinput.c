/* test_cli_badinput.c: the program on every file of ../shared/assets/badinput: exit status, one line, no crash.
 *
 * Scenes are rendered, everything else is read by `info`.  A file ends with status 0, or with 3 and one line
 * `facet: error: FILE...`; anything else (a signal, a hang past 60 s, more than 2 GiB) fails.
 * crafted/expected.tsv says which of the two for the files there.
 * Skips, and says so, where the collections are absent.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "tests/run_program.h"

static const char collection[] = FACET_SOURCE_DIR "/../shared/assets/badinput";

/* AddressSanitizer reserves terabytes of address space; it has a limit of its own on what is really used. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAS_OWN_LIMIT 1
#endif
#endif
#ifndef HAS_OWN_LIMIT
#define HAS_OWN_LIMIT 0
#endif

static void need_collection(void)
{
    struct stat info;
    if (stat(collection, &info) == 0) return;
    print_message("skipped: %s is absent\n", collection);
    skip();
}

/* Children inherit the limits: CPU time [s], and address space [byte]. */
static void limit_children(void)
{
    const struct rlimit cpu = {60, 60}, space = {(rlim_t)2 << 30, (rlim_t)2 << 30};
    if (HAS_OWN_LIMIT) setenv("ASAN_OPTIONS", "hard_rss_limit_mb=2048:allocator_may_return_null=1:detect_leaks=1", 1);
    else if (setrlimit(RLIMIT_AS, &space)) fail_msg("cannot limit memory");
    if (setrlimit(RLIMIT_CPU, &cpu)) fail_msg("cannot limit time");
}

static bool ends_with(const char *text, const char *end)
{
    const size_t n = strlen(text), k = strlen(end);
    return n >= k && strcmp(text + n - k, end) == 0;
}

/* Runs the program on a file; returns its status after checking what it said. */
static int try_file(const char *folder, const char *path)
{
    const bool is_scene = ends_with(path, ".gltf") || ends_with(path, ".glb");
    const char *const scene[] = {FACET_PROGRAM, "render", path,      "-o",        "out.png", "--size", "8x8",
                                 "--spp",       "1",      "--quiet", "--threads", "1",       NULL};
    const char *const picture[] = {FACET_PROGRAM, "info", path, NULL};
    program_run run = run_program(folder, NULL, NULL, is_scene ? scene : picture);
    const int status = run.status;
    if (status != 0 && status != 3) fail_msg("%s: status %d: %s", path, status, run.err);
    if (status == 3) {
        char start[1200];
        snprintf(start, sizeof start, "facet: error: %s", path);
        const char *error = strstr(run.err, "facet: error: ");
        if (!error || strncmp(error, start, strlen(start)) != 0) fail_msg("%s: says %s", path, run.err);
        const char *end = strchr(error, '\n');
        if (!end || end[1] != 0) fail_msg("%s: not one line: %s", path, error);
    }
    program_run_free(&run);
    return status;
}

/* Every regular file under a folder that a reader may be given. */
static size_t try_folder(const char *folder, const char *path)
{
    struct dirent **entries;
    const int n = scandir(path, &entries, NULL, alphasort);
    size_t n_tried = 0;
    for (int i = 0; i < n; i++) {
        const char *name = entries[i]->d_name;
        char child[1024];
        struct stat info;
        snprintf(child, sizeof child, "%s/%s", path, name);
        if (name[0] != '.' && stat(child, &info) == 0) {
            if (S_ISDIR(info.st_mode)) {
                n_tried += try_folder(folder, child);
            } else if (!ends_with(name, ".json") && !ends_with(name, ".tsv") && !ends_with(name, ".csv") &&
                       !ends_with(name, ".md") && !ends_with(name, ".bin") && strncmp(name, "LICENSE", 7) != 0) {
                try_file(folder, child);
                n_tried++;
            }
        }
        free(entries[i]);
    }
    if (n >= 0) free(entries);
    return n_tried;
}

static void each_collection_is_survived(void **state)
{
    (void)state;
    need_collection();
    limit_children();
    char *folder = make_folder();
    static const char *const names[] = {"gltf-validator", "assimp",          "cgltf-fuzz",  "tinygltf",
                                        "pngsuite",       "openexr-damaged", "openexr-test"};
    for (size_t i = 0; i < sizeof names/sizeof names[0]; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", collection, names[i]);
        const size_t n = try_folder(folder, path);
        print_message("  %-16s %zu files\n", names[i], n);
        assert_true(n > 0);
    }
    remove_folder(folder);
}

static void crafted_files_end_as_expected(void **state)
{
    (void)state;
    need_collection();
    limit_children();
    char path[1024], line[512];
    snprintf(path, sizeof path, "%s/crafted/expected.tsv", collection);
    FILE *table = fopen(path, "r");
    assert_non_null(table);
    char *folder = make_folder();
    size_t n[3] = {0};
    while (fgets(line, sizeof line, table)) {
        char name[200], expected[40];
        if (sscanf(line, "%199[^\t]\t%39[^\t]", name, expected) != 2 || strcmp(name, "file") == 0) continue;
        snprintf(path, sizeof path, "%s/crafted/%s", collection, name);
        const int status = try_file(folder, path);
        const bool must_load = strcmp(expected, "must_load") == 0, must_reject = strcmp(expected, "must_reject") == 0;
        if (must_load && status != 0) fail_msg("%s: refused, but must load", name);
        if (must_reject && status != 3) fail_msg("%s: loaded, but must be refused", name);
        n[must_load ? 0 : must_reject ? 1 : 2]++;
    }
    fclose(table);
    remove_folder(folder);
    print_message("  %zu load, %zu are refused, %zu end either way\n", n[0], n[1], n[2]);
    assert_true(n[0] > 0 && n[1] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crafted_files_end_as_expected),
        cmocka_unit_test(each_collection_is_survived),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
