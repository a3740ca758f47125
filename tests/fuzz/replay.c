/* replay.c: runs a fuzzing program's corpus as an ordinary test, without libFuzzer.
 *
 *     replay_NAME FOLDER [CHANGES]
 *
 * Each file is given as it is, cut short at 64 places, and with one byte changed at 256 places (CHANGES, and a
 * quarter of that); so is an empty input.  The places come from a fixed seed: a failure repeats.  Any crash, hang or
 * report of a sanitizer is the failure.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/parts/harness.h"

enum { LARGEST_CHANGED = 1 << 16 };

static int n_changes = 256;

static uint64_t next_random(uint64_t *state)
{
    *state = *state*6364136223846793005u + 1442695040888963407u; /* Knuth's MMIX generator */
    return *state >> 33;
}

/* A copy of exactly `size` bytes, so that reading past the end is a heap overflow. */
static void give(const uint8_t *data, size_t size)
{
    uint8_t *copy = calloc(size ? size : 1, 1);
    if (!copy) abort();
    if (size) memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

static void give_variants(uint8_t *data, size_t size)
{
    uint64_t random = 1;
    give(data, size);
    if (size == 0 || size > LARGEST_CHANGED) return; /* a large file takes too long 320 times */
    for (int i = 0; i < n_changes/4; i++) give(data, next_random(&random)%size);
    for (int i = 0; i < n_changes; i++) {
        const size_t place = next_random(&random)%size;
        const uint8_t kept = data[place];
        data[place] = (uint8_t)next_random(&random);
        give(data, size);
        data[place] = kept;
    }
}

static int give_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) return 0;
    size_t size = 0, capacity = 4096;
    uint8_t *data = malloc(capacity);
    while (data) {
        size += fread(data + size, 1, capacity - size, file);
        if (size < capacity) break;
        capacity *= 2;
        uint8_t *larger = realloc(data, capacity);
        if (!larger) free(data);
        data = larger;
    }
    const int is_read = data && !ferror(file);
    fclose(file);
    if (is_read) give_variants(data, size);
    free(data);
    return is_read;
}

int main(int argc, char **argv)
{
    int n_files = 0;
    DIR *folder = argc >= 2 ? opendir(argv[1]) : NULL;
    if (!folder) {
        fprintf(stderr, "replay: cannot open the folder of inputs %s\n", argc > 1 ? argv[1] : "");
        return 1;
    }
    if (argc > 2) n_changes = atoi(argv[2]);
    give(NULL, 0);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[4096];
        if (entry->d_name[0] == '.') continue;
        if (snprintf(path, sizeof path, "%s/%s", argv[1], entry->d_name) >= (int)sizeof path || !give_file(path)) {
            fprintf(stderr, "replay: cannot read %s/%s\n", argv[1], entry->d_name);
            closedir(folder);
            return 1;
        }
        n_files++;
    }
    closedir(folder);
    printf("%d files replayed\n", n_files);
    if (n_taken == 0) {
        fprintf(stderr, "replay: all inputs of %s are refused; do they follow the format?\n", argv[1]);
        return 1;
    }
    return n_files > 0 ? 0 : 1; /* without inputs nothing is tested */
}
