/* web_server.c: the web server, on civetweb.
 * SPDX-License-Identifier: MIT */
#include "cli/web_server.h"

#include <civetweb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "cli/report.h"

struct web_server {
    struct mg_context *context;
    web_place place;
    char token[WEB_TOKEN_MOST + 1]; /* "": none */
    char url[256];
    char reason[256]; /* what civetweb said last: why it did not start */
    web_handler *handle;
    void *user;
    int is_stopping, n_busy; /* atomic: whether handlers should end; how many run */
};

struct web_request {
    struct mg_connection *connection;
    const struct mg_request_info *information;
    const web_server *server;
};

/* ---- Who may ask --------------------------------------------------------------------------------------------- */

/* Whether a Host header names this server: on loopback, where no token guards it, by an address or localhost.  With a
 * token any name will do: a page that is led here by a name of its own does not know the token. */
static bool is_own_host(const web_server *s, const char *host)
{
    if (!host) return false;
    if (s->token[0]) return true;
    static const char *const names[] = {"127.0.0.1", "localhost", "[::1]"};
    char expected[96];
    for (size_t i = 0; i <= sizeof names/sizeof *names; i++) {
        const bool is_named = i < sizeof names/sizeof *names;
        snprintf(expected, sizeof expected, "%s:%u", is_named ? names[i] : s->place.host, s->place.port);
        if (strcasecmp(host, expected) == 0) return true;
    }
    return false;
}

/* Whether the request comes from a page of this server, or from no page. */
static bool is_own_origin(struct mg_connection *c, const char *host)
{
    const char *from = mg_get_header(c, "Origin"), *site = mg_get_header(c, "Sec-Fetch-Site");
    if (site && strcmp(site, "same-origin") != 0 && strcmp(site, "none") != 0) return false;
    return !from || (strncasecmp(from, "http://", 7) == 0 && strcasecmp(from + 7, host) == 0);
}

/* Takes as long for a wrong token as for the right one. */
static bool is_same_token(const char *a, const char *b)
{
    size_t difference = strlen(a) ^ strlen(b);
    for (size_t i = 0; a[i] && b[i]; i++) difference |= (size_t)(a[i] ^ b[i]);
    return difference == 0;
}

static bool has_token(const web_server *s, struct mg_connection *c, const struct mg_request_info *r)
{
    char given[WEB_TOKEN_MOST + 2] = "";
    if (!s->token[0]) return true;
    const char *header = mg_get_header(c, "Authorization");
    if (header && strncasecmp(header, "Bearer ", 7) == 0) return is_same_token(header + 7, s->token);
    if (!r->query_string || mg_get_var(r->query_string, strlen(r->query_string), "token", given, sizeof given) < 0)
        return false;
    return is_same_token(given, s->token);
}

static int on_request(struct mg_connection *c)
{
    const struct mg_request_info *r = mg_get_request_info(c);
    web_server *s = r->user_data;
    web_request request = {c, r, s};
    const char *host = mg_get_header(c, "Host");
    __atomic_fetch_add(&s->n_busy, 1, __ATOMIC_ACQ_REL);
    if (!is_own_host(s, host) || !is_own_origin(c, host)) web_send_text(&request, 403, "not from another site\n");
    else if (!has_token(s, c, r)) web_send_text(&request, 401, "the token is missing or wrong\n");
    else if (!r->local_uri) web_send_text(&request, 400, "not a path\n");
    else s->handle(s->user, &request);
    __atomic_fetch_sub(&s->n_busy, 1, __ATOMIC_ACQ_REL);
    return 200;
}

/* ---- Server -------------------------------------------------------------------------------------------------- */

static int keep_reason(const struct mg_connection *c, const char *message)
{
    web_server *s = mg_get_user_data(mg_get_context(c));
    if (s && !s->context) snprintf(s->reason, sizeof s->reason, "%s", message);
    return 1; /* nothing is printed */
}

int web_server_start(const web_place *place, const char *token, web_handler *handle, void *user, web_server **server)
{
    *server = NULL;
    if (!place->is_loopback && !(token && *token))
        return fail(EXIT_USAGE, NULL, NULL,
                    "other machines reach %s: a token must guard it; give one, or a port alone for this machine",
                    place->host);
    web_server *s = calloc(1, sizeof *s);
    if (!s) return fail_memory();
    s->place = *place;
    snprintf(s->token, sizeof s->token, "%s", token ? token : "");
    s->handle = handle;
    s->user = user;
    const bool is_v6 = strchr(place->host, ':');
    char where[96];
    snprintf(where, sizeof where, is_v6 ? "[%s]:%u" : "%s:%u", place->host, place->port);
    const char *options[] = {"listening_ports",
                             where,
                             "num_threads",
                             "12",
                             "request_timeout_ms",
                             "5000",
                             "enable_directory_listing",
                             "no",
                             "enable_keep_alive",
                             "yes",
                             "keep_alive_timeout_ms",
                             "500",
                             "tcp_nodelay",
                             "1",
                             NULL};
    const struct mg_callbacks callbacks = {.begin_request = on_request, .log_message = keep_reason};
    mg_init_library(0);
    s->context = mg_start(&callbacks, s, options);
    struct mg_server_port port;
    if (!s->context || mg_get_server_ports(s->context, 1, &port) < 1) {
        const int status = fail(EXIT_WORLD, NULL, NULL,
                                "cannot listen on %s; another program may: try another port, "
                                "or 0 for any free one",
                                where);
        web_server_stop(s);
        return status;
    }
    s->place.port = (uint16_t)port.port;
    snprintf(s->url, sizeof s->url, is_v6 ? "http://[%s]:%u/%s%s" : "http://%s:%u/%s%s", s->place.host, s->place.port,
             s->token[0] ? "?token=" : "", s->token);
    *server = s;
    return 0;
}

/* Handlers can send their last words for so long [10 ms]; mg_stop cuts them off. */
enum { MOST_WAITS = 200 };

void web_server_stop(web_server *server)
{
    if (!server) return;
    __atomic_store_n(&server->is_stopping, 1, __ATOMIC_RELAXED);
    for (int i = 0; i < MOST_WAITS && __atomic_load_n(&server->n_busy, __ATOMIC_ACQUIRE) > 0; i++) usleep(10000);
    if (server->context) mg_stop(server->context);
    mg_exit_library();
    free(server);
}

const char *web_server_url(const web_server *server)
{
    return server->url;
}

/* ---- Requests ------------------------------------------------------------------------------------------------ */

bool web_is_method(const web_request *request, const char *method)
{
    return strcmp(request->information->request_method, method) == 0;
}

const char *web_path(const web_request *request)
{
    return request->information->local_uri_raw ? request->information->local_uri_raw : request->information->local_uri;
}

static const char *reason_of(int status)
{
    return status == 200   ? "OK"
           : status == 400 ? "Bad Request"
           : status == 401 ? "Unauthorized"
           : status == 403 ? "Forbidden"
           : status == 404 ? "Not Found"
           : status == 405 ? "Method Not Allowed"
           : status == 503 ? "Service Unavailable"
                           : "Error";
}

/* What every answer carries: nothing is kept, guessed, framed or loaded from elsewhere, and addresses with a token do
 * not leave. */
#define HEADERS                                                                                                        \
    "Cache-Control: no-store\r\n"                                                                                      \
    "X-Content-Type-Options: nosniff\r\n"                                                                              \
    "Referrer-Policy: no-referrer\r\n"                                                                                 \
    "Cross-Origin-Resource-Policy: same-origin\r\n"                                                                    \
    "Content-Security-Policy: default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "      \
    "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; frame-ancestors 'none'; base-uri 'none'\r\n"

void web_send(web_request *request, int status, const char *type, const void *bytes, size_t n)
{
    const bool has_body = !web_is_method(request, "HEAD");
    mg_printf(request->connection, "HTTP/1.1 %d %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\n" HEADERS "\r\n",
              status, reason_of(status), type, n);
    if (has_body && n) mg_write(request->connection, bytes, n);
}

void web_stream_begin(web_request *request)
{
    mg_printf(request->connection,
              "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nConnection: close\r\n" HEADERS "\r\n");
}

bool web_stream_event(web_request *request, const char *data)
{
    return mg_printf(request->connection, "data: %s\n\n", data) > 0;
}

bool web_is_open(const web_request *request)
{
    return !__atomic_load_n(&request->server->is_stopping, __ATOMIC_RELAXED);
}
