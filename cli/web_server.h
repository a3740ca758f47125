/* web_server.h: a small web server for the pages of this program.
 *
 * It answers this machine alone, unless it is given another address, which needs a token.  Requests that another site's
 * page made a browser send are refused, by their Host (DNS rebinding) and Origin headers, before any handler sees
 * them; so are those without the token, where there is one.  web_server.c is the only file that uses civetweb;
 * no_web_server.c takes its place in a build without.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct web_server web_server;
typedef struct web_request web_request; /* one request, for as long as its handler runs */

/* Answers a request by one of the web_send functions, on a thread of the server's; several run at once. */
typedef void web_handler(void *user, web_request *request);

typedef struct web_place {
    char host[64];    /* "127.0.0.1", "::1", "192.168.1.5", without brackets */
    uint16_t port;    /* 0: any free one */
    bool is_loopback; /* no other machine reaches it */
} web_place;

enum { WEB_TOKEN_LEAST = 16, WEB_TOKEN_MOST = 128 };

/* Reads "", "PORT", "ADDRESS:PORT" or "[ADDRESS]:PORT".  Returns 0 or, having told the error of that option, the exit
 * status. */
int web_place_parse(const char *option, const char *text, uint16_t default_port, web_place *place);

/* The token in a file's first line: 16 to 128 letters, digits, - or _.  Returns 0 or the exit status. */
int web_token_read(const char *path, char token[WEB_TOKEN_MOST + 1]);

/* token: NULL or "" for none, which only a loopback address may have.  Returns 0 or, having told the error, the exit
 * status.  Needs nothing of `user` after web_server_stop. */
int web_server_start(const web_place *place, const char *token, web_handler *handle, void *user, web_server **server);

/* Waits for handlers that run; those that stream see web_is_open become false. */
void web_server_stop(web_server *server);

/* "http://127.0.0.1:8642/", with the token if there is one; valid as long as the server. */
const char *web_server_url(const web_server *server);

/* ---- In a handler -------------------------------------------------------------------------------------------- */

bool web_is_method(const web_request *request, const char *method);
const char *web_path(const web_request *request); /* decoded, begins with / */

void web_send(web_request *request, int status, const char *type, const void *bytes, size_t n);
void web_send_text(web_request *request, int status, const char *text);

/* Server-sent events: begin, then events until the browser leaves or the server stops. */
void web_stream_begin(web_request *request);
bool web_stream_event(web_request *request, const char *data);
bool web_is_open(const web_request *request);

/* A web_handler that serves the files of a folder, its `user` being the folder's path: nothing outside it, by no
 * spelling and no link, and no file whose name begins with a dot.  A folder means its index.html. */
web_handler web_serve_folder;

#ifdef __cplusplus
}
#endif
