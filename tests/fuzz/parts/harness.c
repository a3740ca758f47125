/* harness.c: see harness.h.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/harness.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void require(bool is_true)
{
    if (!is_true) abort();
}

int n_taken = -1;

void count_taken(bool is_taken)
{
    n_taken = (n_taken < 0 ? 0 : n_taken) + is_taken;
}

void require_finite(const void *floats, size_t n)
{
    const float *numbers = floats;
    for (size_t i = 0; numbers && i < n; i++) require(isfinite(numbers[i]));
}

/* ---- Files ------------------------------------------------------------------------------------- */

static char folder[64];

static void remove_own_folder(void)
{
    DIR *entries = opendir(folder);
    for (const struct dirent *e; entries && (e = readdir(entries)) != NULL;) unlinkat(dirfd(entries), e->d_name, 0);
    if (entries) closedir(entries);
    rmdir(folder);
}

const char *own_path(const char *name)
{
    static char paths[4][128];
    static int next;
    if (!folder[0]) {
        snprintf(folder, sizeof folder, "%s/facet-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
        require(mkdtemp(folder) != NULL);
        atexit(remove_own_folder);
    }
    char *path = paths[next++ & 3];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

const char *write_input(const char *name, const uint8_t *bytes, size_t size)
{
    const char *path = own_path(name);
    FILE *file = fopen(path, "wb");
    require(file != NULL);
    require(fwrite(bytes, 1, size, file) == size);
    require(fclose(file) == 0);
    return path;
}

uint8_t *copy_bytes(const uint8_t *bytes, size_t size)
{
    uint8_t *copy = malloc(size ? size : 1);
    require(copy != NULL);
    if (size) memcpy(copy, bytes, size);
    return copy;
}

/* ---- Commands ---------------------------------------------------------------------------------- */

/* Whole lines, each begun by the program's name; the number of those that tell an error. */
static int count_errors(const char *text)
{
    int n_errors = 0;
    for (const char *line = text; *line;) {
        const char *end = strchr(line, '\n');
        require(end && strncmp(line, "facet: ", 7) == 0);
        for (const char *c = line; c < end; c++) require((unsigned char)*c >= 32 && *c != 127);
        n_errors += strncmp(line, "facet: error: ", 14) == 0;
        line = end + 1;
    }
    return n_errors;
}

int run_command(int (*run)(int argc, char **argv), int argc, char **argv)
{
    char *said = NULL, *printed = NULL;
    size_t said_size, printed_size;
    FILE *const own_error = stderr, *const own_output = stdout;
    FILE *const error = open_memstream(&said, &said_size), *const output = open_memstream(&printed, &printed_size);
    require(error && output);
    stderr = error; /* glibc's streams are variables */
    stdout = output;
    const int status = run(argc, argv);
    stderr = own_error;
    stdout = own_output;
    require(fclose(error) == 0 && fclose(output) == 0);
    const int n_errors = count_errors(said);
    require(status >= -1 && status <= 4);
    require(n_errors == (status >= 2));
    free(said);
    free(printed);
    return status;
}
