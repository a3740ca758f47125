/* web_place.c: where a web server is, and the token that guards it, as users give them.
 * SPDX-License-Identifier: MIT */
#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "cli/web_server.h"

static bool parse_port(const char *text, uint16_t *port)
{
    char *end;
    const unsigned long number = strtoul(text, &end, 10);
    if (!isdigit((unsigned char)text[0]) || *end || number > 65535) return false;
    *port = (uint16_t)number;
    return true;
}

/* An address in numbers, since a name could come to mean another machine. */
static bool is_address(const char *host, bool *is_loopback)
{
    struct in_addr v4;
    struct in6_addr v6;
    if (inet_pton(AF_INET, host, &v4) == 1) {
        *is_loopback = ntohl(v4.s_addr) >> 24 == 127;
        return true;
    }
    if (inet_pton(AF_INET6, host, &v6) != 1) return false;
    *is_loopback = IN6_IS_ADDR_LOOPBACK(&v6);
    return true;
}

int web_place_parse(const char *option, const char *text, uint16_t default_port, web_place *place)
{
    *place = (web_place){.host = "127.0.0.1", .port = default_port, .is_loopback = true};
    if (!*text || parse_port(text, &place->port)) return 0;
    const char *colon = strrchr(text, ':');
    size_t length = colon ? (size_t)(colon - text) : 0;
    const char *host = text;
    if (length > 2 && host[0] == '[' && host[length - 1] == ']') {
        host++;
        length -= 2;
    } else if (length && memchr(host, ':', length)) {
        length = 0; /* a bare IPv6 address: which colon is the port's? */
    }
    snprintf(place->host, sizeof place->host, "%.*s", (int)(length < sizeof place->host ? length : 0), host);
    if (strcmp(place->host, "localhost") == 0) snprintf(place->host, sizeof place->host, "127.0.0.1");
    if (!length || !parse_port(colon + 1, &place->port) || !is_address(place->host, &place->is_loopback))
        return fail(EXIT_USAGE, NULL, option,
                    "`%s` is not PORT or ADDRESS:PORT, such as 8080, 192.168.1.5:8080 or [::1]:8080", text);
    return 0;
}

int web_token_read(const char *path, char token[WEB_TOKEN_MOST + 1])
{
    FILE *file = fopen(path, "r");
    if (!file) return fail(EXIT_INPUT, path, NULL, "cannot open: %s", strerror(errno));
    char line[WEB_TOKEN_MOST + 3];
    const bool has_line = fgets(line, sizeof line, file) != NULL;
    fclose(file);
    if (!has_line) line[0] = 0;
    line[strcspn(line, "\r\n")] = 0;
    const size_t length = strlen(line);
    bool is_good = length >= WEB_TOKEN_LEAST && length <= WEB_TOKEN_MOST;
    for (const char *c = line; *c; c++) is_good &= isalnum((unsigned char)*c) || *c == '-' || *c == '_';
    if (!is_good)
        return fail(EXIT_INPUT, path, NULL,
                    "its first line is not a token of %d to %d letters, digits, - or _; make one: "
                    "od -An -N16 -tx1 /dev/urandom | tr -d ' ' > %s",
                    WEB_TOKEN_LEAST, WEB_TOKEN_MOST, path);
    memcpy(token, line, length + 1);
    return 0;
}
