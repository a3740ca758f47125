/* test_serve_browser.c: the page of `facet render --serve` in headless Chromium: what it says and what it looks like,
 * in light and dark, and what its buttons do.  FACET_SCREENSHOTS names a folder for people who want to look.
 * Skipped where there is no Chromium, or facet was built without civetweb.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/image_file.h"
#include "tests/driven_browser.h"
#include "tests/program_folder.h"

static void skip_without_browser(void)
{
    const bool has_web = FACET_HAS_WEB;
    if (has_web && FACET_CHROMIUM[0]) return;
    print_message("skipped: %s\n",
                  has_web ? "chromium was not found: apt-get install chromium" : "facet was built without civetweb");
    skip();
}

/* Starts a render that lasts as long as an option says; returns its page's address, the caller's to free. */
static char *start(pid_t *pid, const char *lasts, const char *much, const char *stay)
{
    const char *const argv[] = {FACET_PROGRAM, "render", "scene.gltf", "--size", "480x240", lasts, much,
                                "-o",          "s.exr",  "--serve",    "0",      stay,      NULL};
    unlink(in_folder(folder, "s.exr"));
    unlink(in_folder(folder, "stderr"));
    *pid = start_program(folder, NULL, NULL, argv);
    for (;; usleep(2000)) {
        char *text = read_bytes(in_folder(folder, "stderr"), NULL);
        char *url = text ? strstr(text, "http://") : NULL;
        char *copy = url && strchr(url, ' ') ? strndup(url, (size_t)(strchr(url, ' ') - url)) : NULL;
        free(text);
        if (copy) return copy;
    }
}

static const unsigned char *pixel_at(const image *screen, size_t x, size_t y)
{
    return (const unsigned char *)screen->pixels + (y*screen->width + x)*screen->n_channels;
}

static void keep_screen(const char *name)
{
    const char *keep = getenv("FACET_SCREENSHOTS");
    if (!keep) return;
    char to[1300];
    snprintf(to, sizeof to, "%s/serve-%s.png", keep, name);
    const char *const argv[] = {"/bin/cp", in_folder(folder, "screen.png"), to, NULL};
    assert_int_equal(wait_for_program(start_program(folder, NULL, "/dev/null", argv)), 0);
}

static void look(const char *url, bool is_dark)
{
    driven_browser b = browser_start(FACET_CHROMIUM, folder, url);
    browser_prefer(&b, is_dark);
    browser_wait(&b, "typeof at == 'function' && at('phase').textContent == 'finished' && at('bar').value == 1");
    browser_wait(&b, "at('picture').naturalWidth == 480 && at('picture').src.includes('/picture.png?v=')");
    browser_wait(&b, "document.body.textContent.includes('scene.gltf, 480 x 240')");
    browser_screenshot(&b, in_folder(folder, "screen.png"));
    browser_stop(&b);
    image s;
    facet_error why = {0};
    if (image_read(in_folder(folder, "screen.png"), &s, &why)) fail_msg("%s", why.text);
    assert_true(s.width == 1000 && s.type == PIXEL_U8 && s.n_channels >= 3);
    const unsigned char *corner = pixel_at(&s, 8, 100);
    assert_true(is_dark ? corner[0] < 64 : corner[0] > 192);
    size_t n_others = 0; /* the picture stands in the middle: pixels that are not the page's background */
    for (size_t y = 200; y < 400; y++)
        for (size_t x = 300; x < 700; x++) n_others += memcmp(pixel_at(&s, x, y), corner, 3) != 0;
    assert_true(n_others > 200*400/2);
    keep_screen(is_dark ? "dark" : "light");
    image_destroy(&s);
}

static void a_browser_shows_the_render_in_light_and_dark(void **state)
{
    (void)state;
    skip_without_browser();
    pid_t pid;
    char *url = start(&pid, "--spp", "40", "--serve-stay");
    look(url, false); /* opened while it renders, waits for its end */
    look(url, true);
    free(url);
    kill(pid, SIGINT);
    assert_int_equal(wait_for_program(pid), 0);
}

static pid_t watched; /* the render that a test has not seen the end of, or 0 */

static int end_watched(void **state)
{
    (void)state;
    if (watched && kill(watched, SIGKILL) == 0) wait_for_program(watched);
    watched = 0;
    return 0;
}

/* Watches a render of ten minutes get on, presses a button, and expects the end of it. */
static void watch_and_press(const char *button, const char *phase, int status)
{
    skip_without_browser();
    char *url = start(&watched, "--time", "600", NULL);
    driven_browser b = browser_start(FACET_CHROMIUM, folder, url);
    browser_wait(&b, "typeof at == 'function' && at('phase').textContent == 'rendering'");
    browser_wait(&b, "at('picture').naturalWidth == 480 && shown > 0");
    char *before = browser_value(
        &b, "[at('picture').src, at('samples').textContent, at('bar').value, at('noise').textContent]");
    browser_wait(&b, "(window.first = window.first || at('picture').src) != at('picture').src"); /* it refines */
    browser_wait(&b, "at('noise').textContent.endsWith('%')");
    char *after = browser_value(
        &b, "[at('picture').src, at('samples').textContent, at('bar').value, at('noise').textContent]");
    assert_string_not_equal(before, after);
    browser_wait(&b, "at('bar').value > 0 && at('bar').value < 1 && !at('finish').disabled && !at('cancel').disabled");
    browser_screenshot(&b, in_folder(folder, "screen.png"));
    keep_screen(button);
    browser_click(&b, button);
    char expression[100];
    snprintf(expression, sizeof expression, "at('phase').textContent == '%s'", phase);
    browser_wait(&b, expression); /* the last thing that the server says */
    browser_wait(&b, "at('finish').disabled && at('cancel').disabled && at('left').textContent == '-'");
    assert_int_equal(wait_for_program(watched), status);
    watched = 0;
    browser_screenshot(&b, in_folder(folder, "screen.png"));
    keep_screen(phase);
    browser_stop(&b);
    free(before);
    free(after);
    free(url);
    image saved;
    facet_error why = {0};
    if (image_read(in_folder(folder, "s.exr"), &saved, &why)) fail_msg("%s", why.text);
    assert_true(saved.width == 480 && saved.height == 240);
    image_destroy(&saved);
}

static void finish_now_ends_the_render_with_its_picture(void **state)
{
    (void)state;
    watch_and_press("finish", "finished", 0);
}

static void cancel_stops_the_render_and_saves_it(void **state)
{
    (void)state;
    watch_and_press("cancel", "cancelled", 130);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_browser_shows_the_render_in_light_and_dark),
        cmocka_unit_test_teardown(finish_now_ends_the_render_with_its_picture, end_watched),
        cmocka_unit_test_teardown(cancel_stops_the_render_and_saves_it, end_watched)};
    return cmocka_run_group_tests_name("serve_browser", tests, make_scene_folder, remove_test_folder);
}
