/* test_cli_events.c: `facet render --events`: lines of JSON that tell a render's whole story.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>
#include <jansson.h>

#include "tests/program_folder.h"

#define RENDER(...) run_program(folder, NULL, NULL, (const char *const[]){FACET_PROGRAM, "render", __VA_ARGS__, NULL})

static void expect_status(program_run run, int status)
{
    if (run.status != status) fail_msg("status %d, expected %d\n%s", run.status, status, run.err);
    program_run_free(&run);
}

/* The events of a text, each line one object, as an array. */
static json_t *parse_lines(char *text)
{
    json_t *events = json_array();
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        json_error_t why;
        json_t *event = json_loads(line, JSON_REJECT_DUPLICATES, &why);
        if (!event) fail_msg("%s in %s", why.text, line);
        assert_true(json_is_number(json_object_get(event, "time")));
        json_array_append_new(events, event);
    }
    return events;
}

static json_t *read_events(const char *name)
{
    char *text = read_bytes(in_folder(folder, name), NULL);
    assert_non_null(text);
    json_t *events = parse_lines(text);
    free(text);
    return events;
}

static const char *name_of(const json_t *events, size_t i)
{
    return json_string_value(json_object_get(json_array_get(events, i), "event"));
}

static size_t count(const json_t *events, const char *name)
{
    size_t n = 0;
    for (size_t i = 0; i < json_array_size(events); i++) n += strcmp(name_of(events, i), name) == 0;
    return n;
}

static long long whole(const json_t *events, size_t i, const char *key)
{
    const json_t *value = json_object_get(json_array_get(events, i), key);
    if (!json_is_integer(value)) fail_msg("event %zu has no whole number `%s`", i, key);
    return json_integer_value(value);
}

static void a_render_tells_its_start_progress_checkpoints_and_end(void **state)
{
    (void)state;
    expect_status(RENDER("scene.gltf", "--size", "64x32", "--time", "1.2", "-o", "a.exr", "--events", "a.jsonl",
                         "--checkpoint", "a.ckpt"),
                  0);
    json_t *events = read_events("a.jsonl");
    const size_t last = json_array_size(events) - 1;
    assert_string_equal(name_of(events, 0), "start");
    assert_string_equal(name_of(events, last), "done");
    assert_true(count(events, "progress") >= 1 && count(events, "progress") <= 3);
    assert_int_equal(count(events, "checkpoint"), 1);
    assert_int_equal(whole(events, 0, "width"), 64);
    assert_int_equal(whole(events, 0, "resumed_spp"), 0);
    assert_int_equal(whole(events, 1, "samples_total"), 64*32*65536);
    assert_int_equal(whole(events, last, "status"), 0);
    const long long spp = whole(events, last, "spp");
    assert_true(spp >= 1);
    json_decref(events);
    /* A run that goes on appends. */
    expect_status(RENDER("scene.gltf", "--size", "64x32", "--time", "0.01", "-o", "a.exr", "--events", "a.jsonl",
                         "--resume", "a.ckpt"),
                  0);
    events = read_events("a.jsonl");
    assert_int_equal(count(events, "start"), 2);
    assert_int_equal(whole(events, last + 1, "resumed_spp"), spp);
    json_decref(events);
}

static void warnings_and_failures_are_events(void **state)
{
    (void)state;
    expect_status(RENDER("scene.gltf", "--size", "8x8", "--spp", "1", "-o", "b.png", "--half", "--events", "b.jsonl"),
                  0);
    json_t *events = read_events("b.jsonl");
    assert_int_equal(count(events, "warning"), 1);
    json_decref(events);
    expect_status(RENDER("none.gltf", "-o", "c.png", "--events", "c.jsonl"), 3);
    events = read_events("c.jsonl");
    assert_int_equal(json_array_size(events), 1);
    assert_int_equal(whole(events, 0, "status"), 3);
    json_decref(events);
    expect_status(RENDER("scene.gltf", "-o", "c.png", "--events", "none/c.jsonl"), 4);
}

static void a_dash_is_stderr(void **state)
{
    (void)state;
    program_run run = RENDER("scene.gltf", "--size", "8x8", "--spp", "1", "-o", "d.png", "--quiet", "--events", "-");
    assert_int_equal(run.status, 0);
    json_t *events = parse_lines(run.err);
    assert_int_equal(count(events, "start") + count(events, "done"), 2);
    json_decref(events);
    program_run_free(&run);
    /* A watcher that is gone, or a disk that is full, costs no picture. */
    run = RENDER("scene.gltf", "--size", "8x8", "--spp", "1", "-o", "e.png", "--events", "/dev/full");
    const char *warning = strstr(run.err, "facet: warning: /dev/full: events cannot be written: No space left");
    if (run.status || !warning || strstr(warning + 1, "facet: warning")) fail_msg("not one warning: %s", run.err);
    program_run_free(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_render_tells_its_start_progress_checkpoints_and_end),
        cmocka_unit_test(warnings_and_failures_are_events),
        cmocka_unit_test(a_dash_is_stderr),
    };
    return cmocka_run_group_tests_name("cli_events", tests, make_scene_folder, remove_test_folder);
}
