/* cmd_merge.c: `facet merge`, the checkpoints of shards to the picture of the whole.
 *
 * Heads are read and compared before any film is, so that a refusal comes at once; films are then added one by one.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/layers.h"
#include "cli/provenance.h"
#include "cli/render_job.h"
#include "cli/report.h"
#include "io/checkpoint.h"

enum { MOST_SHARDS = 4096 };

/* A checkpoint without its film. */
typedef struct shard {
    const char *path;
    checkpoint head;
    uint32_t number, n_shards;
    uint32_t n_samples; /* of each pixel, when finished */
} shard;

typedef struct merging {
    shard *shards;
    size_t n;
} merging;

static int read_shard(shard *s, const char *path)
{
    facet_error why = {0};
    uint32_t samples = 0, first;
    *s = (shard){.path = path};
    if (checkpoint_read(path, false, &s->head, &why)) return fail_with(FROM_INPUT, path, &why);
    const char *name = checkpoint_text(&s->head, "facet:shard"), *all = checkpoint_text(&s->head, "facet:samples");
    if (!name || !all || sscanf(name, "%" SCNu32 "/%" SCNu32, &s->number, &s->n_shards) != 2 ||
        sscanf(all, "%" SCNu32, &samples) != 1 || s->number < 1 || s->number > s->n_shards || s->n_shards > samples)
        return fail(EXIT_INPUT, path, NULL, "is not a checkpoint of facet render");
    render_share(samples, s->number, s->n_shards, &first, &s->n_samples);
    return 0;
}

/* Against the first: a stranger, another division, a duplicate. */
static int check_shard(const merging *m, size_t i)
{
    const shard *s = &m->shards[i], *first = &m->shards[0];
    char other[512];
    snprintf(other, sizeof other, "%s has", first->path);
    const int status = provenance_compare(s->path, &s->head, first->head.texts, first->head.n_texts, other, true);
    if (status) return status;
    if (s->n_shards != first->n_shards)
        return fail(EXIT_INPUT, s->path, NULL, "is a shard of %" PRIu32 "; %s is one of %" PRIu32, s->n_shards,
                    first->path, first->n_shards);
    for (size_t k = 0; k < i; k++)
        if (m->shards[k].number == s->number)
            return fail(EXIT_INPUT, s->path, NULL, "is shard %" PRIu32 "/%" PRIu32 ", and so is %s; leave one out",
                        s->number, s->n_shards, m->shards[k].path);
    return 0;
}

/* A whole render may have ended at its time or noise; a shard may not. */
static int check_finished(const shard *s)
{
    const char *line = checkpoint_text(&s->head, "facet:command");
    const bool has_resume = line && strstr(line, " --resume");
    if (s->n_shards == 1 || s->head.state.spp == s->n_samples) return 0;
    return fail(EXIT_INPUT, s->path, NULL,
                "shard %" PRIu32 "/%" PRIu32 " has %" PRIu32 " of its %" PRIu32 " samples per pixel; finish it: %s%s%s",
                s->number, s->n_shards, s->head.state.spp, s->n_samples, line ? line : "",
                has_resume ? "" : " --resume ", has_resume ? "" : s->path);
}

static int check_gaps(const merging *m)
{
    const uint32_t n_shards = m->shards[0].n_shards;
    for (uint32_t number = 1; number <= n_shards; number++) {
        bool is_there = false;
        for (size_t i = 0; i < m->n; i++) is_there |= m->shards[i].number == number;
        if (!is_there)
            return fail(EXIT_INPUT, NULL, NULL,
                        "shard %" PRIu32 "/%" PRIu32 " is missing; %zu of %" PRIu32 " are given", number, n_shards,
                        m->n, n_shards);
    }
    return 0;
}

/* Adds a shard's film to the sum, which the first one becomes. */
static int add_shard(const shard *s, render_state *sum)
{
    checkpoint c;
    facet_error why = {0};
    if (checkpoint_read(s->path, true, &c, &why)) return fail_with(FROM_INPUT, s->path, &why);
    render_state *part = &c.state;
    const film *f = &part->film;
    bool is_even = f->width == s->head.state.film.width && f->height == s->head.state.film.height;
    for (size_t i = 0; s->n_shards > 1 && is_even && i < f->width*f->height; i++)
        is_even = f->pixels[i].n == s->n_samples;
    if (!is_even) {
        checkpoint_destroy(&c);
        return fail(EXIT_INPUT, s->path, NULL, "does not have the samples that it tells of; render it again");
    }
    if (!sum->film.pixels) {
        *sum = *part;
        *part = (render_state){0};
    } else {
        render_state_merge(sum, part);
    }
    checkpoint_destroy(&c);
    return 0;
}

static int write_merged(const render_options *o, const merging *m, const render_state *sum)
{
    facet_error why = {0};
    render_result result = {0};
    provenance p;
    picture_set pictures = {0};
    if (render_develop(sum, &result, &why)) return fail_with(FROM_INPUT, NULL, &why);
    int status = picture_set_create(o, &sum->film, &result.picture, &pictures);
    if (!status) {
        provenance_recollect(&p, o, &m->shards[0].head, sum, pictures.denoiser);
        status = write_outputs(o, &p, &pictures);
    }
    for (size_t i = 0; i < o->outputs.n && !status && !o->quiet; i++)
        tell("wrote %s: %zux%zu, %" PRIu32 " spp of %zu shards", o->outputs.items[i], result.picture.width,
             result.picture.height, result.spp, m->n);
    picture_set_destroy(&pictures);
    render_result_destroy(&result);
    return status;
}

static int merge(render_options *o, merging *m, const char *const *paths)
{
    render_state sum = {0};
    layer_choice layers = {0};
    int status = choose_layers(o, &layers);
    if (!status) status = load_denoiser(o, &layers);
    o->layers = &layers;
    for (; !status && m->n < MOST_SHARDS && paths[m->n]; m->n++) {
        status = read_shard(&m->shards[m->n], paths[m->n]);
        if (!status) status = check_shard(m, m->n);
    }
    for (size_t i = 0; !status && i < m->n; i++) status = check_finished(&m->shards[i]);
    if (!status) status = check_gaps(m);
    if (!status && layers_need_features(&layers) && !m->shards[0].head.has_features)
        status = fail(EXIT_INPUT, m->shards[0].path, NULL,
                      "keeps no features for --aov and --denoise; render it with one of them");
    if (!status) status = check_apart(o, paths, m->n);
    if (!status) status = check_outputs(o);
    for (size_t i = 0; !status && i < m->n; i++) status = add_shard(&m->shards[i], &sum);
    if (!status) status = write_merged(o, m, &sum);
    render_state_destroy(&sum);
    layer_choice_destroy(&layers);
    o->layers = NULL;
    return status;
}

static int run(int argc, char **argv)
{
    render_options o = {.view = "filmic"};
    const char *paths[MOST_SHARDS];
    const int parsed = options_parse(&merge_command, argc, argv, &o, paths);
    if (parsed != PARSE_GO) return parsed;
    if (o.outputs.n == 0) return fail(EXIT_USAGE, NULL, NULL, "merge needs an output: -o FILE.exr or -o FILE.png");
    o.command_line = quote_command(argc, argv);
    merging m = {.shards = calloc(MOST_SHARDS, sizeof *m.shards)};
    const int status = o.command_line && m.shards ? merge(&o, &m, paths) : fail_memory();
    for (size_t i = 0; i < m.n; i++) checkpoint_destroy(&m.shards[i].head);
    free(m.shards);
    free(o.command_line);
    return status;
}

#define AT(member) offsetof(render_options, member)

static const option options[] = {
    {"output", 'o', OPTION_TEXTS, AT(outputs), "FILE",
     "picture to write, .exr (linear) or .png (as a screen shows it); may be repeated", 0, 0, NULL},
    {"aov", 0, OPTION_TEXT, AT(aov), "LIST",
     ".exr: further channels, of albedo, normal, distance, samples, noisy (see `facet render --help`)", 0, 0, NULL},
    {"denoise", 0, OPTION_FLAG, AT(denoise), NULL, "remove the noise that is left by Intel Open Image Denoise", 0, 0,
     NULL},
    {"oidn", 0, OPTION_TEXT, AT(oidn), "FILE", "the denoiser's library (see `facet render --help`)", 0, 0, NULL},
    {"exposure", 0, OPTION_NUMBER, AT(exposure), "EV", ".png: brighten by 2^EV (default 0)", -50, 50, NULL},
    {"view", 0, OPTION_CHOICE, AT(view), NULL, ".png: how radiance becomes display values (default filmic)", 0, 0,
     "standard|filmic|agx"},
    {"half", 0, OPTION_FLAG, AT(half), NULL, ".exr: 16-bit floats instead of 32-bit ones", 0, 0, NULL},
    {"quiet", 0, OPTION_FLAG, AT(quiet), NULL, "no notes; errors stay", 0, 0, NULL},
};

const command merge_command = {
    .name = "merge",
    .summary = "add up the shards of a render",
    .operands = "FILE.ckpt...",
    .min_operands = 1,
    .max_operands = MOST_SHARDS,
    .description =
        "Adds the checkpoints of all shards of a render (`facet render --shard K/N`), in any order, to the picture\n"
        "that one render of all samples gives, bit for bit.  Refuses a shard that is missing, there twice, not\n"
        "finished or of another render.  A single checkpoint without shards becomes a picture as far as it is.\n",
    .examples = "  facet merge part*.ckpt -o scene.exr -o scene.png\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
