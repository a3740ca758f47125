/* fuzz_checkpoint.c: libFuzzer's way into checkpoints with right checksums (parts/checkpoint_bytes.h), and on to what
 * is made of them: a picture, their sum, a file with the same bytes.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/checkpoint.h"
#include "tests/fuzz/parts/checkpoint_bytes.h"
#include "tests/fuzz/parts/harness.h"

static void require_same_bytes(const char *path, const uint8_t *bytes, size_t size)
{
    uint8_t *read = copy_bytes(bytes, size);
    FILE *file = fopen(path, "rb");
    require(file && fread(read, 1, size, file) == size && fgetc(file) == EOF);
    require(memcmp(read, bytes, size) == 0);
    fclose(file);
    free(read);
}

static void use(const char *path, checkpoint *c, const uint8_t *bytes, size_t size)
{
    facet_error why = {0};
    checkpoint head;
    render_result picture = {0};
    require(checkpoint_read(path, false, &head, &why) == FACET_OK && head.n_texts == c->n_texts);
    const char *version = checkpoint_text(&head, "facet:version");
    require(!version || strlen(version) < size);
    checkpoint_destroy(&head);

    size_t text_size = 0;
    for (size_t i = 0; i < c->n_texts; i++) text_size += strlen(c->texts[i].key) + strlen(c->texts[i].value) + 2;
    const size_t declared = (size_t)bytes[12] | (size_t)bytes[13] << 8 | (size_t)bytes[14] << 16;
    if (text_size == declared) { /* not if the last text lacks its end */
        const char *again = own_path("again.ckpt");
        require(checkpoint_write(again, &c->state, c->texts, c->n_texts, &why) == FACET_OK);
        require_same_bytes(again, bytes, size);
    }

    require(render_develop(&c->state, &picture, &why) == FACET_OK);
    require_finite(picture.picture.pixels, 3*picture.picture.width*picture.picture.height);
    require(!isnan(picture.noise));
    render_result_destroy(&picture);
    checkpoint other;
    require(checkpoint_read(path, true, &other, &why) == FACET_OK);
    render_state_merge(&c->state, &other.state);
    checkpoint_destroy(&other);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    size_t file_size;
    uint8_t *file = checkpoint_bytes(bytes, size, &file_size);
    const char *path = write_input("input.ckpt", file, file_size);
    checkpoint c;
    facet_error why = {0};
    const bool is_refused = checkpoint_read(path, true, &c, &why) != FACET_OK;
    count_taken(!is_refused);
    if (is_refused) {
        require(why.status && why.text[0]);
    } else {
        use(path, &c, file, file_size);
        checkpoint_destroy(&c);
    }
    free(file);
    return 0;
}
