/* driven_browser.c: commands and answers are JSON objects with a zero byte behind each.
 * SPDX-License-Identifier: MIT */
#include "tests/driven_browser.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/run_program.h"

/* ---- Messages ---------------------------------------------------------------------------------- */

/* The next message; the caller frees. */
static char *receive(const driven_browser *b)
{
    size_t n = 0, size = 1 << 12;
    char *text = malloc(size);
    for (;;) {
        assert_non_null(text);
        if (read(b->from, text + n, 1) != 1) fail_msg("the browser has ended");
        if (!text[n]) return text;
        if (++n == size) text = realloc(text, size *= 2);
    }
}

/* The answer to a command, whose parameters are the inside of a JSON object; the caller frees. */
static char *ask(driven_browser *b, const char *method, const char *parameters)
{
    const unsigned id = ++b->n_sent;
    const bool has_session = b->session[0] != 0;
    const size_t size = strlen(parameters) + 300;
    char *text = malloc(size), head[32];
    assert_non_null(text);
    const int n = snprintf(text, size, "{\"id\":%u,\"method\":\"%s\",%s%s%s\"params\":{%s}}", id, method,
                           has_session ? "\"sessionId\":\"" : "", b->session, has_session ? "\"," : "", parameters);
    assert_true(n > 0 && (size_t)n < size && write(b->to, text, (size_t)n + 1) == n + 1);
    free(text);
    snprintf(head, sizeof head, "{\"id\":%u,", id);
    for (;;) { /* what comes without this id are events */
        char *answer = receive(b);
        if (strncmp(answer, head, strlen(head)) == 0) {
            if (strstr(answer, "\"error\":{") || strstr(answer, "\"exceptionDetails\":"))
                fail_msg("%s: %s", method, answer);
            return answer;
        }
        free(answer);
    }
}

/* The text of a member in an answer, cut out where it stands. */
static char *member(char *answer, const char *name)
{
    char key[40];
    snprintf(key, sizeof key, "\"%s\":\"", name);
    char *value = strstr(answer, key);
    if (!value) fail_msg("no %s in %.300s", name, answer);
    value += strlen(key);
    char *const end = strchr(value, '"');
    assert_non_null(end);
    *end = 0;
    return value;
}

/* ---- The browser ------------------------------------------------------------------------------- */

static void run_browser(const char *chromium, const char *folder, int commands, int answers)
{
    char data[1300];
    snprintf(data, sizeof data, "--user-data-dir=%s", in_folder(folder, "browser"));
    const int nothing = open(in_folder(folder, "browser-messages"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    /* Above what they are copied to. */
    const int in = fcntl(commands, F_DUPFD, 10), out = fcntl(answers, F_DUPFD, 10);
    if (nothing < 0 || dup2(nothing, 0) < 0 || dup2(nothing, 1) < 0 || dup2(nothing, 2) < 0) _exit(127);
    if (dup2(in, 3) < 0 || dup2(out, 4) < 0) _exit(127);
    for (int file = 5; file < 64; file++) close(file);
    execl(chromium, chromium, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--window-size=1000,700",
          "--remote-debugging-pipe", data, "about:blank", (char *)NULL);
    _exit(127);
}

driven_browser browser_start(const char *chromium, const char *folder, const char *url)
{
    int commands[2], answers[2];
    assert_int_equal(pipe(commands), 0);
    assert_int_equal(pipe(answers), 0);
    driven_browser b = {.pid = fork(), .to = commands[1], .from = answers[0]};
    assert_true(b.pid >= 0);
    if (b.pid == 0) run_browser(chromium, folder, commands[0], answers[1]);
    close(commands[0]);
    close(answers[1]);
    char parameters[1400];
    snprintf(parameters, sizeof parameters, "\"url\":\"%s\"", url);
    char *answer = ask(&b, "Target.createTarget", parameters);
    snprintf(parameters, sizeof parameters, "\"targetId\":\"%s\",\"flatten\":true", member(answer, "targetId"));
    free(answer);
    answer = ask(&b, "Target.attachToTarget", parameters);
    snprintf(b.session, sizeof b.session, "%s", member(answer, "sessionId"));
    free(answer);
    return b;
}

void browser_stop(driven_browser *b)
{
    b->session[0] = 0;
    free(ask(b, "Browser.close", ""));
    wait_for_program(b->pid);
    close(b->to);
    close(b->from);
}

/* ---- The page ---------------------------------------------------------------------------------- */

void browser_prefer(driven_browser *b, bool is_dark)
{
    char parameters[100];
    snprintf(parameters, sizeof parameters, "\"features\":[{\"name\":\"prefers-color-scheme\",\"value\":\"%s\"}]",
             is_dark ? "dark" : "light");
    free(ask(b, "Emulation.setEmulatedMedia", parameters));
}

char *browser_value(driven_browser *b, const char *expression)
{
    char parameters[1000];
    const int n = snprintf(parameters, sizeof parameters, "\"expression\":\"String(%s)\"", expression);
    assert_true(n > 0 && n < (int)sizeof parameters);
    char *answer = ask(b, "Runtime.evaluate", parameters);
    char *value = strdup(member(answer, "value"));
    free(answer);
    return value;
}

void browser_wait(driven_browser *b, const char *expression)
{
    for (;; usleep(10000)) {
        char *value = browser_value(b, expression);
        const bool is_true = strcmp(value, "true") == 0;
        free(value);
        if (is_true) return;
    }
}

void browser_click(driven_browser *b, const char *id)
{
    char expression[200], parameters[200];
    snprintf(expression, sizeof expression,
             "(r => [r.x + r.width/2, r.y + r.height/2])(document.getElementById('%s').getBoundingClientRect())", id);
    char *place = browser_value(b, expression); /* "x,y" */
    char *comma = strchr(place, ',');
    assert_non_null(comma);
    *comma = 0;
    static const char *const types[] = {"mousePressed", "mouseReleased"};
    for (int k = 0; k < 2; k++) {
        snprintf(parameters, sizeof parameters,
                 "\"type\":\"%s\",\"x\":%s,\"y\":%s,\"button\":\"left\",\"clickCount\":1", types[k], place, comma + 1);
        free(ask(b, "Input.dispatchMouseEvent", parameters));
    }
    free(place);
}

void browser_screenshot(driven_browser *b, const char *path)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *answer = ask(b, "Page.captureScreenshot", "\"format\":\"png\"");
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    unsigned bits = 0, n_bits = 0;
    for (const char *at = member(answer, "data"); *at && *at != '='; at++) {
        const char *digit = strchr(digits, *at);
        assert_non_null(digit);
        bits = (bits << 6 | (unsigned)(digit - digits)) & 0xffff;
        n_bits += 6;
        if (n_bits < 8) continue;
        n_bits -= 8;
        fputc((int)(bits >> n_bits & 0xff), stream);
    }
    assert_int_equal(fclose(stream), 0);
    free(answer);
}
