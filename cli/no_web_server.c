/* no_web_server.c: a build without civetweb has no web server.
 * SPDX-License-Identifier: MIT */
#include "cli/report.h"
#include "cli/web_server.h"

int web_server_start(const web_place *place, const char *token, web_handler *handle, void *user, web_server **server)
{
    (void)place, (void)token, (void)handle, (void)user;
    *server = NULL;
    return fail(EXIT_USAGE, NULL, NULL,
                "facet was built without its web server; build it with Debian's libcivetweb-dev");
}

void web_server_stop(web_server *server)
{
    (void)server;
}

const char *web_server_url(const web_server *server)
{
    (void)server;
    return "";
}

bool web_is_method(const web_request *request, const char *method)
{
    (void)request, (void)method;
    return false;
}

const char *web_path(const web_request *request)
{
    (void)request;
    return "/";
}

void web_send(web_request *request, int status, const char *type, const void *bytes, size_t n)
{
    (void)request, (void)status, (void)type, (void)bytes, (void)n;
}

void web_stream_begin(web_request *request)
{
    (void)request;
}

bool web_stream_event(web_request *request, const char *data)
{
    (void)request, (void)data;
    return false;
}

bool web_is_open(const web_request *request)
{
    (void)request;
    return false;
}
