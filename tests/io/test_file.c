/* test_file.c: whole files in, atomic files out.
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
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "io/file.h"

static char folder[64]; /* a fresh one for each test */

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/facet-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

/* Names in the folder, "." and ".." left out; removes them if asked to. */
static size_t count_entries(int is_removing)
{
    size_t n = 0;
    DIR *directory = opendir(folder);
    for (struct dirent *e = readdir(directory); e; e = readdir(directory)) {
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            n++;
            if (is_removing) {
                char path[400];
                snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
                remove(path);
            }
        }
    }
    closedir(directory);
    return n;
}

static int remove_folder(void **state)
{
    (void)state;
    chmod(folder, 0700);
    count_entries(1);
    return rmdir(folder);
}

static const char *path_of(const char *name)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
    assert_int_equal(fclose(f), 0);
}

static void assert_content(const char *path, const char *text)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_error why = {0};
    assert_int_equal(file_read(path, &bytes, &size, &why), FACET_OK);
    assert_int_equal(size, strlen(text));
    assert_memory_equal(bytes, text, size + 1); /* the 0 byte after the end too */
    free(bytes);
}

static void assert_refused(const char *path, facet_status status, const char *part)
{
    unsigned char *bytes = (unsigned char *)folder;
    size_t size = 77;
    facet_error why = {0};
    assert_int_equal(file_read(path, &bytes, &size, &why), status);
    assert_int_equal(why.status, status);
    assert_non_null(strstr(why.text, part));
    assert_ptr_equal(bytes, folder); /* outputs untouched */
    assert_int_equal(size, 77);
}

static void a_file_is_read_whole(void **state)
{
    (void)state;
    write_text(path_of("a"), "some bytes\n");
    assert_content(path_of("a"), "some bytes\n");
    write_text(path_of("a"), "");
    assert_content(path_of("a"), "");
}

static void what_is_not_a_regular_file_is_refused(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(path_of("pipe"), 0600), 0);
    assert_refused(path_of("pipe"), FACET_IO, "not a regular file"); /* and does not wait for a writer */
    assert_refused(folder, FACET_IO, "is a directory");
    assert_refused("/dev/zero", FACET_IO, "not a regular file");
    assert_refused(path_of("missing"), FACET_IO, "No such file");
}

static void a_huge_file_is_refused_before_memory_is_taken(void **state)
{
    (void)state;
    write_text(path_of("huge"), "");
    if (truncate(path_of("huge"), (off_t)FILE_SIZE_CAP + 1) != 0) {
        skip(); /* the file system cannot hold such a sparse file */
    }
    assert_refused(path_of("huge"), FACET_UNSUPPORTED, "2147483649");
}

static void a_commit_replaces_the_old_file_and_leaves_nothing_else(void **state)
{
    (void)state;
    file_writer w;
    facet_error why = {0};
    write_text(path_of("a"), "old");
    assert_int_equal(file_writer_open(&w, path_of("a"), &why), FACET_OK);
    fputs("new and longer", w.stream);
    fflush(w.stream);
    assert_content(path_of("a"), "old"); /* nobody sees half a file */
    assert_int_equal(file_writer_commit(&w, &why), FACET_OK);
    assert_content(path_of("a"), "new and longer");
    assert_int_equal(count_entries(0), 1);
}

static void a_discard_leaves_the_old_file(void **state)
{
    (void)state;
    file_writer w;
    facet_error why = {0};
    write_text(path_of("a"), "old");
    assert_int_equal(file_writer_open(&w, path_of("a"), &why), FACET_OK);
    fputs("new", w.stream);
    file_writer_discard(&w);
    assert_content(path_of("a"), "old");
    assert_int_equal(count_entries(0), 1);
}

static void a_temporary_left_by_a_killed_run_is_no_obstacle(void **state)
{
    (void)state;
    char name[32];
    snprintf(name, sizeof name, "a.tmp-%ld-0", (long)getpid());
    write_text(path_of(name), "stale");
    file_writer w;
    facet_error why = {0};
    assert_int_equal(file_writer_open(&w, path_of("a"), &why), FACET_OK);
    fputs("new", w.stream);
    assert_int_equal(file_writer_commit(&w, &why), FACET_OK);
    assert_content(path_of("a"), "new");
    assert_content(path_of(name), "stale");
}

/* Once with what fits the stream's buffer, which fails at the flush, once with more, which fails before. */
static void a_full_disk_is_an_error(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0) {
        print_message("/dev/full is missing\n");
        skip();
    }
    static const size_t SIZES[] = {1, 1 << 20};
    for (size_t i = 0; i < 2; i++) {
        file_writer w;
        facet_error why = {0};
        assert_int_equal(file_writer_open(&w, "/dev/full", &why), FACET_OK);
        for (size_t k = 0; k < SIZES[i]; k++) {
            putc('x', w.stream);
        }
        assert_int_equal(file_writer_commit(&w, &why), FACET_IO);
        assert_non_null(strstr(why.text, "no space left"));
        assert_null(w.stream);
    }
}

static void devices_are_written_in_place(void **state)
{
    (void)state;
    file_writer w;
    facet_error why = {0};
    assert_int_equal(file_writer_open(&w, "/dev/null", &why), FACET_OK);
    fputs("gone", w.stream);
    assert_int_equal(file_writer_commit(&w, &why), FACET_OK);
    struct stat info;
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
}

/* /dev/shm is a folder like any other, though its name is that of a device's. */
static void a_file_in_shared_memory_is_created_and_replaced(void **state)
{
    (void)state;
    if (access("/dev/shm", W_OK) != 0) {
        print_message("/dev/shm is missing\n");
        skip();
    }
    char path[64];
    snprintf(path, sizeof path, "/dev/shm/facet-test-%ld", (long)getpid());
    for (int i = 0; i < 2; i++) {
        file_writer w;
        facet_error why = {0};
        assert_int_equal(file_writer_open(&w, path, &why), FACET_OK);
        assert_non_null(w.temporary);
        fputs(i ? "second" : "first", w.stream);
        assert_int_equal(file_writer_commit(&w, &why), FACET_OK);
    }
    assert_content(path, "second");
    unlink(path);
}

static void expect_resolved(const char *root, const char *path, bool is_inside, const char *end)
{
    char *resolved = NULL;
    bool found = !is_inside;
    facet_error why = {0};
    assert_int_equal(file_resolve(root, path_of(path), &resolved, &found, &why), FACET_OK);
    assert_int_equal(found, is_inside);
    assert_string_equal(resolved + strlen(resolved) - strlen(end), end);
    free(resolved);
}

static void links_are_followed_before_a_place_is_judged(void **state)
{
    (void)state;
    char root[400];
    snprintf(root, sizeof root, "%s", path_of("in"));
    assert_int_equal(mkdir(root, 0700), 0);
    assert_int_equal(mkdir(path_of("inside"), 0700), 0); /* a folder whose name only begins so */
    write_text(path_of("in/a"), "a");
    write_text(path_of("inside/b"), "b");
    assert_int_equal(symlink("../inside/b", path_of("in/out")), 0);
    assert_int_equal(symlink("../in/a", path_of("inside/back")), 0);
    expect_resolved(root, "in/a", true, "/in/a");
    expect_resolved(root, "in/../in/a", true, "/in/a");
    expect_resolved(root, "inside/back", true, "/in/a");
    expect_resolved(root, "in/out", false, "/inside/b");
    expect_resolved(root, "inside/b", false, "/inside/b");
    expect_resolved("/", "inside/b", true, "/inside/b");
    char *resolved = NULL;
    bool is_inside;
    facet_error why = {0};
    assert_int_equal(file_resolve(root, path_of("in/none"), &resolved, &is_inside, &why), FACET_IO);
    assert_null(resolved);
    static const char *const made[] = {"in/a", "in/out", "inside/b", "inside/back", "in", "inside"};
    for (size_t i = 0; i < sizeof made/sizeof *made; i++) assert_int_equal(remove(path_of(made[i])), 0);
}

/* Names of up to NAME_MAX bytes, in ASCII and in characters of two and three bytes. */
static void every_name_that_the_system_takes_can_be_written(void **state)
{
    (void)state;
    static const char *const letters[] = {"a", "\xc3\xa9", "\xe2\x82\xac"};
    for (size_t k = 0; k < 3; k++)
        for (size_t length = 225; length <= 256; length++) {
            char name[300] = "";
            while (strlen(name) + strlen(letters[k]) <= length) strcat(name, letters[k]);
            while (strlen(name) < length) strcat(name, "x");
            file_writer w;
            facet_error why = {0};
            const facet_status status = file_writer_open(&w, path_of(name), &why);
            assert_int_equal(status, length <= 255 ? FACET_OK : FACET_IO);
            if (status) continue;
            const char *temporary = strrchr(w.temporary, '/') + 1, *end = strstr(temporary, ".tmp-");
            assert_memory_equal(temporary, name, (size_t)(end - temporary));
            assert_int_not_equal((unsigned char)name[end - temporary] & 0xc0, 0x80); /* no part of a character */
            fputs("long", w.stream);
            assert_int_equal(file_writer_commit(&w, &why), FACET_OK);
            char cut[300];
            snprintf(cut, sizeof cut, "%.*s.tmp-999999917-3", length < 232 ? (int)length : 231, name);
            if (k == 0) write_text(path_of(cut), "stale");
            file_remove_leftovers(path_of(name));
            assert_content(path_of(name), "long");
            assert_int_equal(count_entries(1), 1);
        }
}

/* A link stays, and what it leads to is replaced, or made. */
static void links_are_written_through(void **state)
{
    (void)state;
    assert_int_equal(mkdir(path_of("folder"), 0700), 0);
    assert_int_equal(symlink("folder/target", path_of("link")), 0);
    assert_int_equal(symlink("link", path_of("twice")), 0);
    static const char *const names[] = {"twice", "link"};
    for (size_t i = 0; i < 2; i++) {
        file_writer w;
        facet_error why = {0};
        write_text(path_of("folder/target.tmp-999999917-0"), "stale");
        file_remove_leftovers(path_of(names[i]));
        assert_int_not_equal(access(path_of("folder/target.tmp-999999917-0"), F_OK), 0);
        assert_int_equal(file_writer_open(&w, path_of(names[i]), &why), FACET_OK);
        fputs(names[i], w.stream);
        assert_int_equal(file_writer_commit(&w, &why), FACET_OK);
        assert_content(path_of("folder/target"), names[i]);
        struct stat info;
        assert_int_equal(lstat(path_of(names[i]), &info), 0);
        assert_true(S_ISLNK(info.st_mode));
    }
    assert_int_equal(unlink(path_of("folder/target")), 0);
    assert_int_equal(rmdir(path_of("folder")), 0); /* nothing else was in it */
    file_writer w;
    facet_error why = {0};
    assert_int_equal(symlink("round", path_of("round")), 0);
    assert_int_equal(file_writer_open(&w, path_of("round"), &why), FACET_IO);
    assert_non_null(strstr(why.text, "symbolic links"));
}

static void expect_same(const char *a, const char *b, bool is_same)
{
    char first[400];
    snprintf(first, sizeof first, "%s", path_of(a));
    if (file_is_same(first, path_of(b)) != is_same) fail_msg("%s and %s", a, b);
    snprintf(first, sizeof first, "%s", path_of(b));
    if (file_is_same(first, path_of(a)) != is_same) fail_msg("%s and %s", b, a);
}

static void names_of_one_file_are_known_as_such(void **state)
{
    (void)state;
    assert_int_equal(mkdir(path_of("in"), 0700), 0);
    write_text(path_of("a"), "a");
    write_text(path_of("b"), "a");
    assert_int_equal(symlink("a", path_of("to a")), 0);
    assert_int_equal(symlink("in/none", path_of("to none")), 0);
    assert_int_equal(symlink("in", path_of("to in")), 0);
    expect_same("a", "a", true);
    expect_same("a", "in/../a", true);
    expect_same("a", "to a", true);
    expect_same("a", "b", false);
    expect_same("a", "none", false);
    expect_same("none", "none", true); /* names of files that are not there yet */
    expect_same("none", "./none", true);
    expect_same("none", "in/none", false);
    expect_same("in/none", "to in/none", true);
    expect_same("in/none", "to none", true);
    expect_same("in/none", "in/nine", false);
    expect_same("nowhere/none", "nowhere/none", false); /* where none can be made */
}

static void a_target_that_cannot_be_is_refused_at_once(void **state)
{
    (void)state;
    file_writer w;
    facet_error why = {0};
    assert_int_equal(file_writer_open(&w, folder, &why), FACET_IO);
    assert_non_null(strstr(why.text, "directory"));
    assert_int_equal(file_writer_open(&w, path_of("missing/a"), &why), FACET_IO);
    assert_non_null(strstr(why.text, "No such file"));
    assert_int_equal(file_writer_open(&w, "", &why), FACET_BAD_ARGUMENT);
}

static void a_folder_without_permission_is_refused(void **state)
{
    (void)state;
    if (geteuid() == 0) {
        print_message("root may write everywhere\n");
        skip();
    }
    file_writer w;
    facet_error why = {0};
    assert_int_equal(chmod(folder, 0500), 0);
    assert_int_equal(file_writer_open(&w, path_of("a"), &why), FACET_IO);
    assert_non_null(strstr(why.text, "ermission denied"));
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_file_is_read_whole),
        TEST(what_is_not_a_regular_file_is_refused),
        TEST(a_huge_file_is_refused_before_memory_is_taken),
        TEST(a_commit_replaces_the_old_file_and_leaves_nothing_else),
        TEST(a_discard_leaves_the_old_file),
        TEST(a_temporary_left_by_a_killed_run_is_no_obstacle),
        TEST(a_full_disk_is_an_error),
        TEST(devices_are_written_in_place),
        TEST(a_file_in_shared_memory_is_created_and_replaced),
        TEST(links_are_followed_before_a_place_is_judged),
        TEST(every_name_that_the_system_takes_can_be_written),
        TEST(links_are_written_through),
        TEST(names_of_one_file_are_known_as_such),
        TEST(a_target_that_cannot_be_is_refused_at_once),
        TEST(a_folder_without_permission_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
