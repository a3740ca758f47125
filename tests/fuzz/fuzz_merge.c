/* fuzz_merge.c: libFuzzer's way into `facet merge`: two bytes say where the second of two checkpoints begins
 * (parts/checkpoint_bytes.h), which are merged to a picture.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "tests/fuzz/parts/checkpoint_bytes.h"
#include "tests/fuzz/parts/harness.h"

static void write_checkpoint(const char *name, const uint8_t *bytes, size_t size, char path[128])
{
    size_t file_size;
    uint8_t *file = checkpoint_bytes(bytes, size, &file_size);
    strcpy(path, write_input(name, file, file_size));
    free(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size < 2) return 0;
    const size_t wanted = (size_t)bytes[0] | (size_t)bytes[1] << 8, n = wanted < size - 2 ? wanted : size - 2;
    char first[128], second[128], output[128];
    write_checkpoint("first.ckpt", bytes + 2, n, first);
    write_checkpoint("second.ckpt", bytes + 2 + n, size - 2 - n, second);
    strcpy(output, own_path("output.png"));
    /* Without a second one, the first alone. */
    const int status = size - 2 - n
                           ? run_command(merge_command.run, 5, (char *[]){"merge", first, second, "-o", output})
                           : run_command(merge_command.run, 4, (char *[]){"merge", first, "-o", output});
    count_taken(status == 0);
    require((access(output, F_OK) == 0) == (status == 0));
    unlink(output);
    return 0;
}
