/* words.c: text as a canvas draws it.
 * SPDX-License-Identifier: MIT */
#include "plot/words.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Bytes of the UTF-8 character at text; 0 if there is none (RFC 3629). */
static size_t character_length(const unsigned char *text)
{
    static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
    if (text[0] < 0x80) return 1;
    const size_t n = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    if (text[0] < 0xc2 || text[0] > 0xf4) return 0;
    uint32_t code = text[0] & (0x7fu >> n);
    for (size_t i = 1; i < n; i++) {
        if ((text[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (text[i] & 0x3fu);
    }
    return code < least[n] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000) ? 0 : n;
}

void words_clean(const char *text, char clean[WORDS_CAP])
{
    size_t n = 0;
    while (*text) {
        const size_t length = character_length((const unsigned char *)text), step = length ? length : 1;
        if (n + step >= WORDS_CAP) break;
        if (length > 1 || (length == 1 && (unsigned char)*text >= 32 && *text != 127)) memcpy(clean + n, text, length);
        else clean[n] = '?';
        n += step;
        text += step;
    }
    clean[n] = 0;
}

static void copy(char *stretch, const char *text, size_t n)
{
    memcpy(stretch, text, n);
    stretch[n] = 0;
}

int words_next(const char **text, bool is_formula, char stretch[WORDS_CAP])
{
    const char *start = *text;
    if (!is_formula || (*start != '_' && *start != '^') || !start[1]) {
        size_t n = is_formula ? strcspn(start, "_^") : strlen(start);
        if (n == 0) n = 1; /* a mark at the end stands for itself */
        copy(stretch, start, n);
        *text = start + n;
        return 0;
    }
    const int level = *start++ == '^' ? 1 : -1;
    const char *end = *start == '{' ? strchr(start, '}') : NULL;
    if (end) {
        copy(stretch, start + 1, (size_t)(end - start - 1));
        *text = end + 1;
    } else {
        const size_t n = character_length((const unsigned char *)start);
        copy(stretch, start, n);
        *text = start + n;
    }
    return level;
}
