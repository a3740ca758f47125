/* cmd_render.c: `facet render`, a scene to pictures.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/checkpointing.h"
#include "cli/commands.h"
#include "cli/events.h"
#include "cli/interruption.h"
#include "cli/layers.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/ranks.h"
#include "cli/render_job.h"
#include "cli/render_watch.h"
#include "cli/report.h"

enum { DEFAULT_DEPTH = 8, DEFAULT_INTERVAL = 60 };

/* What the callbacks of a render need. */
typedef struct watch {
    progress progress;
    saver saver;
    event_log *events;
    render_watch *page;
    double checkpoint_due; /* in seconds of the render */
    uint64_t n_kept;       /* the paths of the last checkpoint */
    bool is_page_waiting;  /* for a picture */
} watch;

static void keep_checkpoint(watch *w, const render_state *state)
{
    save_checkpoint(&w->saver, state);
    w->n_kept = state->n_paths;
    w->checkpoint_due = state->seconds + w->saver.options->checkpoint_interval.value;
}

/* Whether the page wants a picture. */
static bool on_question(void *user)
{
    watch *w = user;
    w->is_page_waiting |= watch_wants_picture(w->page);
    return w->is_page_waiting;
}

/* Comes for a checkpoint, for a picture or at the end. */
static void on_save(void *user, const render_state *state)
{
    watch *w = user;
    if (w->is_page_waiting) watch_show(w->page, &state->film);
    if (w->saver.options->checkpoint && (!w->is_page_waiting || state->seconds >= w->checkpoint_due))
        keep_checkpoint(w, state);
    w->is_page_waiting = false;
}

static bool on_progress(void *user, const render_progress *state)
{
    watch *w = user;
    progress_show(&w->progress, state);
    events_progress(w->events, state);
    watch_progress(w->page, state);
    return !is_interrupted() && watch_asked(w->page) == WISH_GO_ON;
}

/* Without -o: the scene's base name in the current folder, as PNG. */
static int name_output(render_options *o)
{
    const char *path = o->scene_path ? o->scene_path : "facet";
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
    const size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    o->default_output = malloc(length + sizeof ".png");
    if (!o->default_output) return fail_memory();
    snprintf(o->default_output, length + sizeof ".png", "%.*s.png", (int)length, base);
    o->outputs.items[o->outputs.n++] = o->default_output;
    return 0;
}

static void summarise(const render_options *o, const render_result *result)
{
    char time[32], noise[32] = "", mean[32] = "";
    format_duration(result->seconds, time, sizeof time);
    if (result->noise >= 0) snprintf(noise, sizeof noise, ", noise %.3g %%", 100*result->noise);
    if (result->mean_spp < result->spp) snprintf(mean, sizeof mean, " (mean %.3g)", result->mean_spp);
    for (size_t i = 0; i < o->outputs.n; i++)
        tell("wrote %s: %zux%zu, %" PRIu32 " spp%s, %s%s", o->outputs.items[i], result->picture.width,
             result->picture.height, result->spp, mean, time, noise);
}

/* How far an interrupted render came, and how to go on. */
static void tell_interruption(const render_options *o, const render_result *result)
{
    if (!o->checkpoint) note("interrupted after %" PRIu32 " samples per pixel", result->spp);
    else
        note("interrupted after %" PRIu32 " samples per pixel; `%s%s%s` goes on", result->spp, o->command_line,
             o->resume ? "" : " --resume ", o->resume ? "" : o->checkpoint);
}

/* What comes after rendering: warnings, files, the summary. */
static int finish(const render_options *o, const saver *saved, const render_state *state, const render_result *result,
                  warning_list *warnings, watch_wish wish)
{
    if (result->n_bad)
        keep_warning(warnings,
                     "%" PRIu64 " samples were not finite and count as black; the first is pixel %" PRIu32 ",%" PRIu32
                     ", sample %" PRIu32,
                     result->n_bad, result->bad[0].x, result->bad[0].y, result->bad[0].sample);
    if (result->n_clamped)
        keep_warning(warnings, "%" PRIu64 " samples were beyond a radiance of %.2g and count as that",
                     result->n_clamped, (double)FILM_MOST);
    const bool is_stopped = (result->is_stopped && wish != WISH_FINISH) || is_interrupted();
    provenance p;
    picture_set pictures = {0};
    int status = picture_set_create(o, &state->film, &result->picture, &pictures);
    if (!status) {
        provenance_collect(&p, o, saved->scene, saved->settings, state, pictures.denoiser);
        status = write_outputs(o, &p, &pictures);
    }
    picture_set_destroy(&pictures);
    if (!status && !o->quiet) summarise(o, result);
    if (saved->why.status) status = fail_with(FROM_OUTPUT, o->checkpoint, &saved->why);
    if (is_stopped && !o->quiet) tell_interruption(o, result);
    if (o->json) {
        print_render_json(o, saved->settings, result, warnings, is_stopped);
        status = finish_stdout(status);
    }
    return status ? status : is_stopped ? EXIT_INTERRUPTED : 0;
}

/* Everything up to rendering, by each rank for itself but for what the leader alone reads. */
static int prepare(render_options *o, warning_list *warnings, int status, const char *error, scene **s,
                   render_settings *r, render_state *state)
{
    const crew *c = o->crew;
    size_t i_camera = 0;
    struct {
        char isa[16];
        bool keeps_features;
    } shared = {"", false};
    if (!status) status = prepare_scene(o, warnings, s, &i_camera);
    if (!status) status = prepare_settings(o, *s, i_camera, r);
    if (!status) r->keeps_features = layers_need_features(o->layers);
    if (!status && o->resume && (!c || c->rank == 0)) status = resume_checkpoint(o, *s, r, state);
    if (!c) return status;
    status = ranks_agree(c, status, error);
    if (status) return status;
    r->crew = c;
    if (!r->n_threads) r->n_threads = ranks_threads();
    if (r->isa) snprintf(shared.isa, sizeof shared.isa, "%s", r->isa);
    shared.keeps_features = r->keeps_features;
    crew_share(c, &shared, sizeof shared);
    r->isa = shared.isa[0] ? static_isa(shared.isa) : NULL;
    r->keeps_features = shared.keeps_features;
    return 0;
}

/* The last part of the render that one process does, and the first in which it fails if `status` says so already. */
static int render_scene(render_options *o, warning_list *warnings, int status, const char *error)
{
    facet_error why = {0};
    scene *s = NULL;
    render_settings r = {0};
    render_state state = {0};
    render_result result = {0};
    watch w = {.progress = progress_start(o->quiet), .events = warnings->events};
    if (!status) status = watch_start(o, &w.page);
    status = prepare(o, warnings, status, error, &s, &r, &state);
    if (!status) {
        r.progress = on_progress;
        r.save = o->checkpoint || w.page ? on_save : NULL;
        r.save_interval = o->checkpoint ? o->checkpoint_interval.value : HUGE_VAL;
        r.wants_save = w.page ? on_question : NULL;
        r.user = &w;
        w.checkpoint_due = state.seconds + o->checkpoint_interval.value;
        w.saver = (saver){.options = o, .scene = s, .settings = &r, .events = warnings->events};
        events_start(warnings->events, o, &r, &state);
        catch_signals();
        const facet_status failed = render_continue(s, &r, &state, &result, &why);
        progress_end(&w.progress);
        ranks_part();
        if (!failed && o->checkpoint && w.n_kept != state.n_paths) keep_checkpoint(&w, &state);
        if (failed && state.film.pixels && !o->isa && strcmp(why.place, "isa") == 0)
            status = fail(EXIT_INPUT, o->resume, NULL, "was made with --isa %s, which this processor lacks", r.isa);
        else if (failed) status = fail_with(FROM_INPUT, o->scene_path, &why);
        else if (!o->crew || o->crew->rank == 0)
            status = finish(o, &w.saver, &state, &result, warnings, watch_asked(w.page));
        watch_end(w.page, failed ? "failed" : status == EXIT_INTERRUPTED ? "cancelled" : "finished", &state.film);
    }
    events_done(warnings->events, o, &result, status);
    if (!status) watch_stay(w.page);
    watch_stop(w.page);
    render_result_destroy(&result);
    render_state_destroy(&state);
    scene_destroy(s);
    return status;
}

/* Options that need each other, or exclude each other. */
static int check_checkpointing(const render_options *o)
{
    if (o->shard && !o->checkpoint)
        return fail(EXIT_USAGE, NULL, "--shard", "needs --checkpoint FILE, which is its result");
    if (o->shard && (o->time.is_given || o->noise.is_given))
        return fail(EXIT_USAGE, NULL, "--shard", "does not go with --time or --noise; give --spp");
    if (o->checkpoint_interval.is_given && !o->checkpoint)
        return fail(EXIT_USAGE, NULL, "--checkpoint-interval", "needs --checkpoint FILE");
    return o->checkpoint ? check_checkpoint(o->checkpoint) : 0;
}

/* Options that have no effect on the outputs named are told, not obeyed in silence. */
static void warn_of_useless(const render_options *o, warning_list *warnings)
{
    size_t n_png = 0;
    for (size_t i = 0; i < o->outputs.n; i++) n_png += has_extension(o->outputs.items[i], "png");
    const bool is_kept = o->checkpoint && layers_need_features(o->layers); /* for `facet merge --aov` */
    if (o->aov && n_png == o->outputs.n && !is_kept)
        keep_warning(warnings, "--aov has no effect: no output is an .exr file");
    if (o->half && n_png == o->outputs.n) keep_warning(warnings, "--half has no effect: no output is an .exr file");
    if (o->exposure.is_given && n_png == 0)
        keep_warning(warnings, "--exposure has no effect: .exr files keep the scene's own radiance");
}

/* The leader's files; the others neither read checkpoints nor write anything. */
static int check_files(render_options *o, warning_list *warnings)
{
    const char *const inputs[] = {o->scene_path, o->env, o->oidn, o->serve_token};
    int status = o->outputs.n == 0 && !o->shard ? name_output(o) : 0;
    if (!status) status = check_apart(o, inputs, sizeof inputs/sizeof *inputs);
    if (!status) status = check_outputs(o);
    if (!status) status = check_checkpointing(o);
    if (!status) status = events_open(warnings->events, o->events);
    if (!status) warn_of_useless(o, warnings);
    return status;
}

static int render_with(render_options *o, int argc, char **argv, warning_list *warnings, const char *error)
{
    int status = 0;
    if (o->scene_path && strcmp(o->scene_path, "demo") == 0) o->scene_path = NULL;
    o->command_line = quote_command(argc, argv);
    if (!o->command_line) status = fail_memory();
    layer_choice layers = {0};
    o->layers = &layers;
    if (!status) status = choose_layers(o, &layers);
    if (!status && (!o->crew || o->crew->rank == 0)) status = load_denoiser(o, &layers);
    if (!status && (!o->crew || o->crew->rank == 0)) status = check_files(o, warnings);
    else if (o->crew) {
        o->checkpoint = o->resume = o->serve = o->serve_token = NULL;
        o->serve_stay = false;
        o->quiet = true;
    }
    if (!status || o->crew) status = render_scene(o, warnings, status, error);
    layer_choice_destroy(&layers);
    o->layers = NULL;
    return status;
}

static int run(int argc, char **argv)
{
    render_options o = {.depth = DEFAULT_DEPTH,
                        .strategy = "mis",
                        .sampler = "sobol",
                        .gradients = "auto",
                        .view = "filmic",
                        .mpi = "auto",
                        .checkpoint_interval = {.value = DEFAULT_INTERVAL}};
    event_log events = {0};
    warning_list warnings = {.events = &events};
    crew c;
    launch by;
    char error[1024] = "";
    const bool is_launched = find_launch(&by);
    if (is_launched && by.rank > 0) keep_silent(error, sizeof error);
    int status = options_parse(&render_command, argc, argv, &o, &o.scene_path);
    if (status != PARSE_GO) return status;
    status = 0;
    if (strcmp(o.mpi, "off") == 0) keep_silent(NULL, 0);
    else if (is_launched || strcmp(o.mpi, "on") == 0) {
        status = ranks_start(&c, &by);
        if (!status) o.crew = &c;
    }
    if (!status || o.crew) status = render_with(&o, argc, argv, &warnings, error);
    events_close(&events);
    warning_list_destroy(&warnings);
    free(o.default_output);
    free(o.command_line);
    ranks_end(status);
    return o.crew && o.crew->rank > 0 ? 0 : status; /* of mpirun, which takes any other: the leader's */
}

#define AT(member) offsetof(render_options, member)

static const option options[] = {
    {"output", 'o', OPTION_TEXTS, AT(outputs), "FILE",
     "picture to write, .exr (linear) or .png (as a screen shows it); may be repeated (default: the scene's name "
     "with .png, in the current folder)",
     0, 0, NULL},
    {"spp", 's', OPTION_INTEGER, AT(spp), "N",
     "samples per pixel (default 64; 65536 where --time or --noise ends the render)", 1, 1 << 24, NULL},
    {"size", 0, OPTION_SIZE, AT(size), "WxH",
     "size of the picture [pixel] (default: 540 rows in the camera's aspect, 960x540 if it has none)", 0, 0, NULL},
    {"camera", 0, OPTION_TEXT, AT(camera), "NAME", "camera to look through (default: the first)", 0, 0, NULL},
    {"env", 0, OPTION_TEXT, AT(env), "FILE|R,G,B",
     "light from all around: an .hdr or .exr picture in latitude-longitude form, or a constant radiance", 0, 0, NULL},
    {"env-scale", 0, OPTION_NUMBER, AT(env_scale), "X", "multiply the environment by X (default 1)", 0, 1e30, NULL},
    {"depth", 0, OPTION_INTEGER, AT(depth), "N", "most scattering events on a path (default 8)", 0, 4096, NULL},
    {"threads", 't', OPTION_INTEGER, AT(threads), "N",
     "threads (of each process); the picture does not depend on them (default: one per processor)", 1, 1024, NULL},
    {"seed", 0, OPTION_INTEGER, AT(seed), "N", "seed of the samples (default 0)", 0, UINT32_MAX, NULL},
    {"crop", 0, OPTION_RECT, AT(crop), "X,Y,W,H", "render only this part of the picture [pixel]", 0, 0, NULL},
    {"time", 0, OPTION_NUMBER, AT(time), "SECONDS", "stop after this time", 1e-3, 1e9, NULL},
    {"noise", 0, OPTION_NUMBER, AT(noise), "TARGET",
     "stop at this estimated relative error, such as 0.01, and leave parts of the picture that have it before", 1e-6, 1,
     NULL},
    {"aov", 0, OPTION_TEXT, AT(aov), "LIST",
     ".exr: further channels, of albedo, normal, distance [m], samples (how many a pixel has) and noisy (the picture "
     "before --denoise), with commas",
     0, 0, NULL},
    {"denoise", 0, OPTION_FLAG, AT(denoise), NULL, "remove the noise that is left by Intel Open Image Denoise", 0, 0,
     NULL},
    {"oidn", 0, OPTION_TEXT, AT(oidn), "FILE",
     "the denoiser's library, libOpenImageDenoise.so.2 (default: $FACET_OIDN, else where the system finds it)", 0, 0,
     NULL},
    {"material", 0, OPTION_TEXTS, AT(materials), "NAME='SPEC'",
     "give the scene's material NAME another reflection, such as body='ggx alpha=.2'; may be repeated", 0, 0, NULL},
    {"strategy", 0, OPTION_CHOICE, AT(strategy), NULL,
     "find light by rays towards lights, by rays that happen to hit them, or by both (default mis)", 0, 0,
     "explicit|implicit|mis"},
    {"sampler", 0, OPTION_CHOICE, AT(sampler), NULL, "where samples lie (default sobol)", 0, 0, "sobol|random"},
    {"gradients", 0, OPTION_CHOICE, AT(gradients), NULL,
     "share light between neighbouring pixels (default auto: where it pays)", 0, 0, "auto|on|off"},
    {"isa", 0, OPTION_CHOICE, AT(isa), NULL,
     "instruction set of the ray tracer, on which the last bits of a picture depend (default avx2 where there is one)",
     0, 0, "sse2|sse4.2|avx|avx2|avx512"},
    {"checkpoint", 0, OPTION_TEXT, AT(checkpoint), "FILE",
     "keep what has been rendered in FILE, written now and then, when interrupted and at the end", 0, 0, NULL},
    {"checkpoint-interval", 0, OPTION_NUMBER, AT(checkpoint_interval), "SECONDS",
     "time between two checkpoints (default 60)", 0, 1e9, NULL},
    {"resume", 0, OPTION_TEXT, AT(resume), "FILE",
     "go on from this checkpoint, to the same bits as without a stop; if it is the file of --checkpoint, too, it need "
     "not exist yet",
     0, 0, NULL},
    {"shard", 0, OPTION_TEXT, AT(shard), "K/N",
     "render only the K-th of N parts of the samples, as --checkpoint FILE; `facet merge` adds them up", 0, 0, NULL},
    {"mpi", 0, OPTION_CHOICE, AT(mpi), NULL,
     "whether processes that mpirun or srun started render together: auto (default) where there are several, on, off "
     "(each on its own)",
     0, 0, "auto|on|off"},
    {"exposure", 0, OPTION_NUMBER, AT(exposure), "EV", ".png: brighten by 2^EV (default 0)", -50, 50, NULL},
    {"view", 0, OPTION_CHOICE, AT(view), NULL, ".png: how radiance becomes display values (default filmic)", 0, 0,
     "standard|filmic|agx"},
    {"allow-outside", 0, OPTION_FLAG, AT(allow_outside), NULL, "let the scene refer to files outside its own folder", 0,
     0, NULL},
    {"max-memory", 0, OPTION_BYTES, AT(max_memory), "SIZE",
     "refuse a scene or an environment that takes more memory to read, such as 512M (default 8G)", 0, 0, NULL},
    {"half", 0, OPTION_FLAG, AT(half), NULL, ".exr: 16-bit floats instead of 32-bit ones", 0, 0, NULL},
    {"quiet", 0, OPTION_FLAG, AT(quiet), NULL, "no progress and no notes; errors and warnings stay", 0, 0, NULL},
    {"events", 0, OPTION_TEXT, AT(events), "FILE",
     "append what happens (start, progress, checkpoints, warnings, the end) to FILE as it does, one JSON object a "
     "line; - is stderr",
     0, 0, NULL},
    {"serve", 0, OPTION_PLACE, AT(serve), "[[ADDRESS:]PORT]",
     "show the picture as it refines on a page, for this machine alone at http://127.0.0.1:8642/ unless told "
     "otherwise; 0 is any free port",
     0, 0, NULL},
    {"serve-token", 0, OPTION_TEXT, AT(serve_token), "FILE",
     "let only those see the page who have the token in FILE; an ADDRESS that other machines reach needs it", 0, 0,
     NULL},
    {"serve-stay", 0, OPTION_FLAG, AT(serve_stay), NULL, "keep the page when the picture is finished, until Ctrl-C", 0,
     0, NULL},
    {"json", 0, OPTION_FLAG, AT(json), NULL, "print one JSON object about the render on stdout at the end", 0, 0, NULL},
};

const command render_command = {
    .name = "render",
    .summary = "render a scene",
    .operands = "[SCENE.gltf|.glb]",
    .max_operands = 1,
    .description =
        "Renders a glTF 2.0 scene, or the built-in demo scene if none is named.  A scene without a camera is seen\n"
        "whole; one without any light stands in a uniform white environment.\n"
        "Interrupted (Ctrl-C, SIGTERM or SIGHUP), it writes what it has and exits with status 130; a second signal\n"
        "ends it at once.  With --checkpoint FILE --resume FILE, one command starts a render and goes on with it.\n"
        "Started by mpirun, N processes share the render: the picture has the same bits on any number of them.\n"
        "Outputs are checked before rendering, written beside and renamed, and carry their provenance (version,\n"
        "command line, scene hash, seed, ...) as metadata.\n",
    .examples = "  facet render\n"
                "  facet render scene.glb -o scene.exr -o scene.png --spp 256 --size 1280x720\n"
                "  facet render scene.gltf --env studio.hdr --material body='ggx alpha=.1 ks=.9,.7,.3' --time 60\n"
                "  facet render scene.glb --spp 1024 --checkpoint scene.ckpt --resume scene.ckpt\n"
                "  facet render scene.glb --spp 1024 --shard 3/16 --checkpoint part3.ckpt --resume part3.ckpt\n"
                "  facet render scene.glb --time 600 --serve\n"
                "  mpirun -n 16 facet render scene.glb --spp 1024 -o scene.exr\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
