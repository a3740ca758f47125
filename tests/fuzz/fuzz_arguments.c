/* fuzz_arguments.c: libFuzzer's way into the command line: the options of every command, parsed without doing their
 * work, and for `render` completed to settings, too.  The first byte chooses the command, lines are arguments.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/render_job.h"
#include "tests/fuzz/parts/harness.h"

enum { MOST_ARGUMENTS = 256 };

static const command *chosen;

static size_t value_size(option_kind kind)
{
    switch (kind) {
    case OPTION_FLAG: return sizeof(bool);
    case OPTION_TEXT:
    case OPTION_PLACE:
    case OPTION_CHOICE: return sizeof(char *);
    case OPTION_TEXTS: return sizeof(text_list);
    case OPTION_INTEGER:
    case OPTION_BYTES: return sizeof(uint64_t);
    case OPTION_NUMBER: return sizeof(option_number);
    case OPTION_NUMBERS: return sizeof(number_list);
    case OPTION_SIZE: return 2*sizeof(size_t);
    case OPTION_RECT: return 4*sizeof(size_t);
    case OPTION_VECTOR: return sizeof(option_vector);
    }
    abort();
}

/* Into memory that ends behind the last value, so that one too large for its place is seen. */
static int parse_values(int argc, char **argv, const char **operands)
{
    size_t size = 1;
    for (size_t k = 0; k < chosen->n_options; k++) {
        const size_t end = chosen->options[k].offset + value_size(chosen->options[k].kind);
        size = end > size ? end : size;
    }
    void *values = calloc(size, 1);
    require(values != NULL);
    const int status = options_parse(chosen, argc, argv, values, operands);
    free(values);
    return status;
}

static int parse_render(int argc, char **argv, const char **operands)
{
    render_options o = {.depth = 8, .strategy = "mis", .sampler = "sobol", .gradients = "auto", .view = "filmic"};
    camera eye = {0};
    const scene s = {.cameras = &eye, .n_cameras = 1};
    render_settings settings;
    const int status = options_parse(chosen, argc, argv, &o, operands);
    if (status != PARSE_GO) return status;
    const int refused = prepare_settings(&o, &s, 0, &settings);
    if (refused) return refused;
    require(settings.width >= 1 && settings.height >= 1 && settings.spp >= 1);
    require(settings.crop_w <= settings.width && settings.crop_x <= settings.width - settings.crop_w);
    require(settings.crop_h <= settings.height && settings.crop_y <= settings.height - settings.crop_h);
    require(settings.n_shards ? settings.shard >= 1 && settings.shard <= settings.n_shards : settings.shard == 0);
    return PARSE_GO;
}

static int parse(int argc, char **argv)
{
    const char **operands = calloc(chosen->max_operands + 1, sizeof *operands);
    require(operands != NULL);
    const int status = chosen == &render_command ? parse_render(argc, argv, operands)
                                                 : parse_values(argc, argv, operands);
    for (size_t k = 0; status == PARSE_GO && k < chosen->min_operands; k++) require(operands[k] != NULL);
    free(operands);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char *argv[MOST_ARGUMENTS + 2] = {"command"};
    int argc = 1;
    chosen = commands[(size ? bytes[0] : 0)%n_commands];
    for (size_t at = 1; at < size && argc <= MOST_ARGUMENTS; at++) {
        const size_t start = at;
        while (at < size && bytes[at] != '\n') at++;
        argv[argc] = malloc(at - start + 1);
        require(argv[argc] != NULL);
        memcpy(argv[argc], bytes + start, at - start);
        argv[argc++][at - start] = 0;
    }
    run_command(parse, argc, argv);
    for (int i = 1; i < argc; i++) free(argv[i]);
    return 0;
}
