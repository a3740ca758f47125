/* test_serve.c: `facet render --serve` as browsers, scripts and strangers meet it, over raw HTTP; and the server of
 * folders.  Skipped where facet was built without civetweb.
 * SPDX-License-Identifier: MIT */
#include <arpa/inet.h>
#include <netinet/in.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "cli/web_server.h"
#include "io/image_file.h"
#include "tests/picture_bytes.h"
#include "tests/program_folder.h"

static int setup(void **state)
{
    make_scene_folder(state);
    write_text(in_folder(folder, "token"), "0123456789abcdef-Z\n");
    return 0;
}

static void skip_without_server(void)
{
    if (!FACET_HAS_WEB) {
        print_message("skipped: facet was built without civetweb\n");
        skip();
    }
}

/* ---- HTTP ---------------------------------------------------------------------------------------------------- */

/* Sends text to a port of this machine and returns all that comes, up to `until` (NULL: to the end); the caller frees.
 * NULL: nobody listens. */
static char *talk(unsigned port, const char *text, size_t n_text, const char *until, size_t *n_got)
{
    const struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr = {htonl(INADDR_LOOPBACK)}};
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    assert_true(s >= 0);
    const struct timeval patience = {30, 0}; /* a hang fails the test instead of lasting for ever */
    setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(s, (const struct sockaddr *)&address, sizeof address) != 0) {
        close(s);
        return NULL;
    }
    if (send(s, text, n_text, MSG_NOSIGNAL) < 0) n_text = 0;
    size_t n = 0, most = 1 << 16;
    char *got = malloc(most + 1);
    for (ssize_t more; got && (more = recv(s, got + n, most - n, 0)) > 0;) {
        got[n += (size_t)more] = 0;
        if (until && strstr(got, until)) break;
        if (n == most) got = realloc(got, (most *= 2) + 1);
    }
    assert_non_null(got);
    got[n] = 0;
    close(s);
    if (n_got) *n_got = n;
    return got;
}

/* The answer to a request, whose connection it closes. */
static char *ask(unsigned port, const char *request, const char *headers)
{
    char text[2048];
    const int n = snprintf(text, sizeof text, "%s HTTP/1.1\r\n%sConnection: close\r\n\r\n", request, headers);
    return talk(port, text, (size_t)n, NULL, NULL);
}

static void expect_answer(unsigned port, const char *request, const char *headers, const char *beginning)
{
    char *answer = ask(port, request, headers);
    if (!answer || strncmp(answer, beginning, strlen(beginning)) != 0)
        fail_msg("%s\n%s\nanswer, expected `%s`:\n%s", request, headers, beginning, answer ? answer : "(none)");
    free(answer);
}

/* The Host header of this machine at that port. */
static const char *own_host(unsigned port)
{
    static char header[64];
    snprintf(header, sizeof header, "Host: 127.0.0.1:%u\r\n", port);
    return header;
}

/* ---- Renders ------------------------------------------------------------------------------------------------- */

/* Starts a render that lasts until it is stopped, and returns its server's port. */
static unsigned start(pid_t *pid, const char *address, const char *token, const char *time)
{
    const char *argv[] = {
        FACET_PROGRAM, "render", "scene.gltf", "--size", "48x24",        "--time", time,
        "-o",          "s.exr",  "--serve",    address,  "--checkpoint", "s.ckpt", token ? "--serve-token" : NULL,
        token,         NULL};
    unlink(in_folder(folder, "stderr"));
    *pid = start_program(folder, NULL, NULL, argv);
    for (;; usleep(2000)) {
        char *text = read_bytes(in_folder(folder, "stderr"), NULL);
        const char *url = text ? strstr(text, "note: http://") : NULL;
        unsigned port = 0;
        if (url && strstr(url, " shows the picture\n")) port = (unsigned)strtoul(strchr(url + 12, ':') + 1, NULL, 10);
        free(text);
        if (port) return port;
    }
}

/* Waits until the render has a whole picture to save: an event with a noise. */
static void wait_for_samples(unsigned port)
{
    char request[256];
    snprintf(request, sizeof request, "GET /events HTTP/1.1\r\n%s\r\n", own_host(port));
    char *answer = talk(port, request, strlen(request), "\"noise\": 0.", NULL);
    assert_non_null(answer);
    assert_non_null(strstr(answer, "Content-Type: text/event-stream\r\n"));
    assert_non_null(strstr(answer, "\"noise\": 0."));
    assert_non_null(strstr(answer, "data: {\"phase\": \"rendering\", \"scene\": \"scene.gltf\", "));
    free(answer);
}

static void expect_saved(void)
{
    program_run run = RUN("merge", "s.ckpt", "-o", "merged.exr");
    assert_int_equal(run.status, 0);
    program_run_free(&run);
    assert_same_pixels(folder, "s.exr", "merged.exr");
}

static void people_can_watch_and_finish(void **state)
{
    (void)state;
    skip_without_server();
    pid_t pid;
    const unsigned port = start(&pid, "0", NULL, "600");
    const char *host = own_host(port);
    wait_for_samples(port);
    char *page = ask(port, "GET /", host);
    assert_non_null(strstr(page, "HTTP/1.1 200 OK\r\nContent-Type: text/html"));
    assert_non_null(strstr(page, "Content-Security-Policy: default-src 'self'"));
    assert_non_null(strstr(page, "<title>facet</title>"));
    assert_null(strstr(page, "https://")); /* nothing comes from elsewhere */
    free(page);
    char request[256];
    size_t n;
    snprintf(request, sizeof request, "GET /picture.png?v=1 HTTP/1.1\r\n%sConnection: close\r\n\r\n", host);
    char *answer = talk(port, request, strlen(request), NULL, &n);
    const char *body = strstr(answer, "\r\n\r\n");
    assert_non_null(body);
    image shown;
    facet_error why = {0};
    if (image_decode((const unsigned char *)body + 4, n - (size_t)(body + 4 - answer), &shown, &why))
        fail_msg("%s\n%.300s", why.text, answer);
    assert_true(shown.width == 48 && shown.height == 24 && shown.type == PIXEL_U8);
    image_destroy(&shown);
    free(answer);
    expect_answer(port, "GET /state", host, "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n");
    expect_answer(port, "POST /finish", host, "HTTP/1.1 200 OK\r\n");
    assert_int_equal(wait_for_program(pid), 0);
    char *err = read_bytes(in_folder(folder, "stderr"), NULL);
    assert_non_null(strstr(err, "facet: wrote s.exr"));
    assert_null(strstr(err, "interrupted"));
    free(err);
    expect_saved();
    assert_null(talk(port, "", 0, NULL, NULL)); /* the server has stopped with the render */
}

/* A front end may ask for the picture now and then instead of following events. */
static void the_picture_comes_to_those_who_poll(void **state)
{
    (void)state;
    skip_without_server();
    for (int polls_state = 0; polls_state < 2; polls_state++) {
        pid_t pid;
        const unsigned port = start(&pid, "0", NULL, "600");
        bool is_there = false;
        while (!is_there) { /* ends by the test's own time limit */
            char *answer = ask(port, polls_state ? "GET /state" : "GET /picture.png", own_host(port));
            assert_non_null(answer);
            is_there = polls_state ? strstr(answer, "\"width\": 48") != NULL : strstr(answer, "image/png") != NULL;
            free(answer);
            if (!is_there) usleep(20000);
        }
        expect_answer(port, "POST /cancel", own_host(port), "HTTP/1.1 200 OK\r\n");
        assert_int_equal(wait_for_program(pid), 130);
    }
}

static void people_can_cancel_and_what_is_rendered_is_saved(void **state)
{
    (void)state;
    skip_without_server();
    pid_t pid;
    const unsigned port = start(&pid, "127.0.0.1:0", NULL, "600");
    wait_for_samples(port);
    expect_answer(port, "POST /cancel", own_host(port), "HTTP/1.1 200 OK\r\n");
    assert_int_equal(wait_for_program(pid), 130);
    char *err = read_bytes(in_folder(folder, "stderr"), NULL);
    assert_non_null(strstr(err, "facet: note: interrupted after"));
    free(err);
    expect_saved();
}

static void strangers_are_refused(void **state)
{
    (void)state;
    skip_without_server();
    pid_t pid;
    const unsigned port = start(&pid, "0", NULL, "600");
    const char *own = own_host(port);
    char headers[256], rebound[96], another[96];
    snprintf(rebound, sizeof rebound, "Host: attacker.example:%u\r\n", port);
    snprintf(another, sizeof another, "Host: 127.0.0.1:%u\r\n", port + 1);
    static const char forbidden[] = "HTTP/1.1 403 ";
    expect_answer(port, "GET /", rebound, forbidden); /* DNS rebinding */
    expect_answer(port, "GET /events", rebound, forbidden);
    expect_answer(port, "GET /", another, forbidden);
    expect_answer(port, "GET /", "Host: 127.0.0.1\r\n", forbidden);
    static const char *const foreign[] = {"Origin: http://attacker.example", "Origin: null",
                                          "Origin: https://127.0.0.1", "Sec-Fetch-Site: cross-site",
                                          "Sec-Fetch-Site: same-site"};
    for (size_t i = 0; i < sizeof foreign/sizeof *foreign; i++) {
        snprintf(headers, sizeof headers, "%s%s\r\n", own, foreign[i]);
        expect_answer(port, "POST /cancel", headers, forbidden);
        expect_answer(port, "GET /picture.png", headers, forbidden);
    }
    snprintf(headers, sizeof headers, "%sOrigin: http://127.0.0.1:%u\r\nSec-Fetch-Site: same-origin\r\n", own, port);
    expect_answer(port, "GET /state", headers, "HTTP/1.1 200 ");
    snprintf(headers, sizeof headers, "Host: localhost:%u\r\n", port);
    expect_answer(port, "GET /state", headers, "HTTP/1.1 200 ");
    expect_answer(port, "GET /cancel", own, "HTTP/1.1 405 "); /* a link cannot cancel */
    expect_answer(port, "POST /", own, "HTTP/1.1 405 ");
    expect_answer(port, "DELETE /state", own, "HTTP/1.1 405 ");
    expect_answer(port, "GET /none", own, "HTTP/1.1 404 ");
    expect_answer(port, "GET /../../etc/passwd", own, "HTTP/1.1 4");
    /* What is not HTTP gets an error or nothing, and the next one is answered. */
    static const char *const noise[] = {"\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "\x16\x03\x01\x02\r\n\r\n",
                                        "POST /cancel HTTP/1.1\r\nContent-Length: -5\r\n\r\n"};
    for (size_t i = 0; i < sizeof noise/sizeof *noise; i++) {
        char *answer = talk(port, noise[i], strlen(noise[i]), "\r\n\r\n", NULL);
        assert_null(strstr(answer, " 200 "));
        free(answer);
    }
    char *endless = malloc(1 << 17);
    memset(endless, 'a', 1 << 17);
    memcpy(endless, "GET /", 5);
    free(talk(port, endless, 1 << 17, "\r\n\r\n", NULL));
    free(endless);
    expect_answer(port, "GET /state", own, "HTTP/1.1 200 "); /* still rendering */
    kill(pid, SIGINT);
    assert_int_equal(wait_for_program(pid), 130);
}

static void a_token_guards_the_page(void **state)
{
    (void)state;
    skip_without_server();
    pid_t pid;
    const unsigned port = start(&pid, "0.0.0.0:0", "token", "600");
    const char *own = own_host(port);
    char headers[256];
    static const char no_token[] = "HTTP/1.1 401 ";
    expect_answer(port, "GET /", own, no_token);
    expect_answer(port, "GET /?token=", own, no_token);
    expect_answer(port, "GET /?token=0123456789abcdef-z", own, no_token);
    expect_answer(port, "GET /?token=0123456789abcdef-", own, no_token);
    expect_answer(port, "GET /?token=0123456789abcdef-ZZ", own, no_token);
    expect_answer(port, "POST /cancel?token=x", own, no_token);
    snprintf(headers, sizeof headers, "%sAuthorization: Bearer wrong\r\n", own);
    expect_answer(port, "GET /?token=0123456789abcdef-Z", headers, no_token);
    expect_answer(port, "GET /?token=0123456789abcdef-Z", own, "HTTP/1.1 200 ");
    snprintf(headers, sizeof headers, "%sAuthorization: Bearer 0123456789abcdef-Z\r\n", own);
    expect_answer(port, "GET /state", headers, "HTTP/1.1 200 ");
    expect_answer(port, "POST /cancel?token=0123456789abcdef-Z", own, "HTTP/1.1 200 ");
    assert_int_equal(wait_for_program(pid), 130);
    char *info = read_bytes(in_folder(folder, "s.exr"), NULL);
    assert_non_null(info);
    free(info);
    program_run run = RUN("info", "s.exr");
    assert_null(strstr(run.out, "0123456789abcdef")); /* the secret is not in the picture's metadata */
    program_run_free(&run);
}

static void wrong_places_and_tokens_are_told(void **state)
{
    (void)state;
    skip_without_server();
    write_text(in_folder(folder, "short"), "0123456789\n");
    write_text(in_folder(folder, "strange"), "0123456789abcdef?&\n");
    static const struct {
        const char *address, *token, *reason;
        int status;
    } cases[] = {
        {"0.0.0.0:0", NULL, "--serve: other machines reach 0.0.0.0; guard it by --serve-token FILE", 2},
        {"[::]:0", NULL, "other machines reach ::", 2},
        {"10.1.2.3:0", NULL, "other machines reach 10.1.2.3", 2},
        {"--serve=example.org:80", NULL, "`example.org:80` is not PORT or ADDRESS:PORT", 2},
        {"99999", NULL, "`99999` is not PORT or ADDRESS:PORT", 2},
        {"::1:80", NULL, "`::1:80` is not PORT or ADDRESS:PORT", 2},
        {"0", "none", "none: cannot open", 3},
        {"0", "short", "short: its first line is not a token of 16 to 128", 3},
        {"0", "strange", "strange: its first line is not a token", 3},
        {"203.0.113.9:0", "token", "cannot listen on 203.0.113.9:0", 4},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const bool is_whole = strncmp(cases[i].address, "--", 2) == 0;
        const char *argv[] = {FACET_PROGRAM,    "render",
                              "scene.gltf",     "-o",
                              "x.exr",          is_whole ? "--quiet" : "--serve",
                              cases[i].address, cases[i].token ? "--serve-token" : NULL,
                              cases[i].token,   NULL};
        program_run run = run_program(folder, NULL, NULL, argv);
        if (run.status != cases[i].status || !strstr(run.err, cases[i].reason))
            fail_msg("%s: status %d, %s", cases[i].address, run.status, run.err);
        program_run_free(&run);
    }
    program_run run = RUN("render", "scene.gltf", "--serve-stay", "-o", "x.exr");
    assert_int_equal(run.status, 2);
    assert_non_null(strstr(run.err, "--serve-stay: needs --serve"));
    program_run_free(&run);
    assert_int_equal(access(in_folder(folder, "x.exr"), F_OK), -1);
}

static void serve_takes_no_scene_for_its_port(void **state)
{
    (void)state;
    skip_without_server();
    program_run run = RUN("render", "--serve=0", "scene.gltf", "--size", "9x9", "--spp", "1", "-o", "x.exr");
    assert_int_equal(run.status, 0);
    program_run_free(&run);
}

/* ---- Folders ------------------------------------------------------------------------------------------------- */

static void a_folder_is_served_and_nothing_else(void **state)
{
    (void)state;
    skip_without_server();
    mkdir(in_folder(folder, "site"), 0700);
    mkdir(in_folder(folder, "site/sub"), 0700);
    mkdir(in_folder(folder, "site-not"), 0700);
    write_text(in_folder(folder, "site/index.html"), "<p>root</p>");
    write_text(in_folder(folder, "site/sub/index.html"), "<p>sub</p>");
    write_text(in_folder(folder, "site/a b.js"), "1");
    write_text(in_folder(folder, "site/.hidden"), "secret");
    write_text(in_folder(folder, "site-not/x"), "secret");
    assert_int_equal(symlink("../scene.gltf", in_folder(folder, "site/link.gltf")), 0);
    assert_int_equal(symlink("..", in_folder(folder, "site/up")), 0);
    char site[1200];
    snprintf(site, sizeof site, "%s", in_folder(folder, "site"));
    web_place place;
    web_server *server;
    assert_int_equal(web_place_parse("--port", "0", 0, &place), 0);
    assert_int_equal(web_server_start(&place, NULL, web_serve_folder, site, &server), 0);
    const unsigned port = (unsigned)strtoul(strrchr(web_server_url(server), ':') + 1, NULL, 10);
    const char *own = own_host(port);
    static const char *const there[][3] = {{"GET /", "text/html", "<p>root</p>"},
                                           {"GET /index.html", "text/html", "<p>root</p>"},
                                           {"GET /sub/", "text/html", "<p>sub</p>"},
                                           {"GET /a%20b.js?x=1", "text/javascript", "\r\n\r\n1"}};
    for (size_t i = 0; i < sizeof there/sizeof *there; i++) {
        char *answer = ask(port, there[i][0], own);
        assert_non_null(strstr(answer, "HTTP/1.1 200 OK"));
        assert_non_null(strstr(answer, there[i][1]));
        assert_non_null(strstr(answer, there[i][2]));
        free(answer);
    }
    static const char *const not_there[] = {"/../scene.gltf",
                                            "/sub/../../scene.gltf",
                                            "/%2e%2e/scene.gltf",
                                            "/..%2fscene.gltf",
                                            "/%2e%2e%2fscene.gltf",
                                            "/sub/%2e%2e/%2e%2e/scene.gltf",
                                            "/..\\scene.gltf",
                                            "/..%5cscene.gltf",
                                            "/.hidden",
                                            "/%2ehidden",
                                            "/link.gltf",
                                            "/up/scene.gltf",
                                            "/up/site/index.html",
                                            "//etc/passwd",
                                            "/../site-not/x",
                                            "/none",
                                            "/sub",
                                            "/%252e%252e/scene.gltf",
                                            "/....//scene.gltf",
                                            "/sub/./../../scene.gltf"};
    for (size_t i = 0; i < sizeof not_there/sizeof *not_there; i++) {
        char request[256];
        snprintf(request, sizeof request, "GET %s", not_there[i]);
        char *answer = ask(port, request, own);
        if (!answer || strstr(answer, "HTTP/1.1 200") || strstr(answer, "secret") || strstr(answer, "asset"))
            fail_msg("%s: %s", request, answer ? answer : "(none)");
        free(answer);
    }
    expect_answer(port, "POST /", own, "HTTP/1.1 405 ");
    expect_answer(port, "GET /", "Host: attacker.example\r\n", "HTTP/1.1 403 ");
    web_server_stop(server);
    assert_null(talk(port, "", 0, NULL, NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(people_can_watch_and_finish),
        cmocka_unit_test(the_picture_comes_to_those_who_poll),
        cmocka_unit_test(people_can_cancel_and_what_is_rendered_is_saved),
        cmocka_unit_test(strangers_are_refused),
        cmocka_unit_test(a_token_guards_the_page),
        cmocka_unit_test(wrong_places_and_tokens_are_told),
        cmocka_unit_test(serve_takes_no_scene_for_its_port),
        cmocka_unit_test(a_folder_is_served_and_nothing_else),
    };
    return cmocka_run_group_tests_name("serve", tests, setup, remove_test_folder);
}
