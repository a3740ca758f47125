/* provenance.c: texts that say how a render was made.
 * SPDX-License-Identifier: MIT */
#include "cli/provenance.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"

static void add_text(provenance *p, const char *key, const char *value)
{
    p->pairs[p->n++] = (image_text){key, value};
}

__attribute__((format(printf, 3, 4))) static void add_printed(provenance *p, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(p->values[p->n], PROVENANCE_TEXT_SIZE, format, arguments);
    va_end(arguments);
    add_text(p, key, p->values[p->n]);
}

static void add_matrix(provenance *p, const char *key, const float m[16])
{
    char text[PROVENANCE_TEXT_SIZE] = "";
    size_t length = 0;
    for (int i = 0; i < 16; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%.9g", i ? " " : "", (double)m[i]);
    add_printed(p, key, "%s", text);
}

/* 9 digits give the same floats back. */
static void read_matrix(const char *text, float m[16])
{
    char *end = (char *)text;
    for (int i = 0; i < 16; i++) m[i] = strtof(end, &end);
}

/* What a render reaches, and what every continuation of it changes. */
static void add_figures(provenance *p, const render_state *state, const char *denoiser)
{
    add_printed(p, "facet:spp", "%" PRIu32, state->spp);
    add_printed(p, "facet:time_seconds", "%.3f", state->seconds);
    add_printed(p, "facet:clamped", "%" PRIu64, state->film.n_clamped);
    add_printed(p, "facet:dropped", "%" PRIu64, state->n_bad);
    if (denoiser) add_text(p, "facet:denoiser", denoiser);
}

static void add_matrices_and_view(provenance *p, const render_options *o)
{
    p->n_exr = p->n;
    add_matrix(p, "facet:world_to_camera", p->world_to_camera);
    add_matrix(p, "facet:world_to_ndc", p->world_to_ndc);
    p->n_checkpoint = p->n;
    add_printed(p, "facet:view", "%s, exposure %g", o->view, o->exposure.value);
}

void provenance_collect(provenance *p, const render_options *o, const scene *s, const render_settings *settings,
                        const render_state *state, const char *denoiser)
{
    const camera *c = &s->cameras[settings->camera];
    p->n = 0;
    add_text(p, "facet:version", facet_version());
    add_text(p, "facet:command", o->command_line);
    add_printed(p, "facet:scene_hash", "%016" PRIx64, s->hash);
    add_printed(p, "facet:seed", "%" PRIu32, settings->seed);
    add_printed(p, "facet:samples", "%" PRIu32, settings->spp);
    add_printed(p, "facet:shard", "%" PRIu32 "/%" PRIu32, settings->n_shards ? settings->shard : 1,
                settings->n_shards ? settings->n_shards : 1);
    add_text(p, "facet:isa", state->isa);
    add_text(p, "facet:strategy", o->strategy);
    add_text(p, "facet:sampler", o->sampler);
    add_text(p, "facet:gradients", o->gradients);
    add_printed(p, "facet:depth", "%" PRIu32, settings->depth);
    add_text(p, "facet:features", settings->keeps_features ? "kept" : "not kept");
    add_text(p, "facet:camera", c->name);
    add_printed(p, "facet:size", "%zux%zu", settings->width, settings->height);
    add_printed(p, "facet:crop", "%zu,%zu,%zu,%zu", settings->crop_x, settings->crop_y, state->film.width,
                state->film.height);
    add_figures(p, state, denoiser);
    camera_matrices(c, settings->width, settings->height, p->world_to_camera, p->world_to_ndc);
    add_matrices_and_view(p, o);
}

/* ---- Of checkpoints ------------------------------------------------------------------------------ */

/* What must agree, and how users say it.  The hash comes last: a setting is the better reason. */
static const struct {
    const char *key, *name;
} identity[] = {
    {"facet:version", "facet"},
    {"facet:size", "--size"},
    {"facet:crop", "--crop"},
    {"facet:camera", "--camera"},
    {"facet:samples", "--spp"},
    {"facet:seed", "--seed"},
    {"facet:strategy", "--strategy"},
    {"facet:sampler", "--sampler"},
    {"facet:gradients", "--gradients"},
    {"facet:depth", "--depth"},
    {"facet:isa", "--isa"},
    {"facet:features", "features (--aov, --denoise)"},
    {"facet:shard", "--shard"},
    {"facet:world_to_camera", "a camera at"},
    {"facet:world_to_ndc", "a camera of"},
    {"facet:scene_hash", "a scene (with its files, --env and --material) of hash"},
};
enum { N_IDENTITY = sizeof identity/sizeof *identity };

static const char *find_text(const image_text *texts, size_t n_texts, const char *key)
{
    for (size_t i = 0; i < n_texts; i++)
        if (strcmp(texts[i].key, key) == 0) return texts[i].value;
    return "";
}

int provenance_compare(const char *path, const checkpoint *c, const image_text *texts, size_t n_texts,
                       const char *other, bool any_shard)
{
    for (size_t i = 0; i < N_IDENTITY; i++) {
        const char *key = identity[i].key, *made = checkpoint_text(c, key);
        const char *now = find_text(texts, n_texts, key);
        if (any_shard && strcmp(key, "facet:shard") == 0) continue;
        if (!made) return fail(EXIT_INPUT, path, NULL, "is not a checkpoint of facet render: it has no %s", key);
        if (strcmp(made, now) != 0)
            return fail(EXIT_INPUT, path, NULL, "was made with %s %s; %s %s %s", identity[i].name, made, other,
                        identity[i].name, now);
    }
    return 0;
}

/* Keys whose values are not those of one shard. */
static bool is_of_all(const char *key)
{
    static const char *const keys[] = {"facet:command",      "facet:spp",     "facet:shard",
                                       "facet:time_seconds", "facet:clamped", "facet:dropped"};
    for (size_t i = 0; i < sizeof keys/sizeof *keys; i++)
        if (strcmp(key, keys[i]) == 0) return true;
    return strncmp(key, "facet:world_to_", 15) == 0;
}

void provenance_recollect(provenance *p, const render_options *o, const checkpoint *c, const render_state *state,
                          const char *denoiser)
{
    p->n = 0;
    for (size_t i = 0; i < N_IDENTITY; i++)
        if (!is_of_all(identity[i].key)) add_text(p, identity[i].key, find_text(c->texts, c->n_texts, identity[i].key));
    add_text(p, "facet:command", o->command_line);
    add_text(p, "facet:shard_command", find_text(c->texts, c->n_texts, "facet:command"));
    add_text(p, "facet:shard", "1/1");
    add_figures(p, state, denoiser);
    read_matrix(find_text(c->texts, c->n_texts, "facet:world_to_camera"), p->world_to_camera);
    read_matrix(find_text(c->texts, c->n_texts, "facet:world_to_ndc"), p->world_to_ndc);
    add_matrices_and_view(p, o);
}
