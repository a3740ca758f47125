/* fuzz_csv.c: libFuzzer's way into the reader of CSV files.  The first byte says how many columns have to be there and
 * how many hold words; the rest is the file.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "cli/csv_reader.h"
#include "tests/fuzz/parts/harness.h"

static const char *const columns[] = {"model", "wi_x", "wi_y", "wi_z", "pdf"};
enum { N_COLUMNS = sizeof columns/sizeof *columns };

static int read_rows(int n_required, char **path)
{
    csv_reader reader;
    csv_row row;
    bool is_end = false;
    int status = csv_open(&reader, path[0], columns, N_COLUMNS, (size_t)n_required);
    if (strcmp(path[1], "words") == 0) reader.n_words = 1;
    while (!status && !(status = csv_read(&reader, &row, &is_end)) && !is_end)
        for (size_t i = 0; i < N_COLUMNS; i++) {
            require(isfinite(row.values[i]) && strlen(row.texts[i]) < CSV_FIELD_CAP);
            require(i >= reader.n_words || row.values[i] == 0);
        }
    csv_close(&reader);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const uint8_t first = size ? bytes[0] : 0;
    char path[128];
    strcpy(path, write_input("input.csv", size ? bytes + 1 : bytes, size ? size - 1 : 0));
    run_command(read_rows, first%(N_COLUMNS + 1), (char *[]){path, first & 128 ? "words" : ""});
    return 0;
}
