/* Any answer of the children that read models and pictures: what they say is not believed. The
   first byte says who asked, the rest is the answer. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "base/child.h"
#include "image/image.h"
#include "image/image_reply.h"
#include "load/picture.h"

static struct {
    const uint8_t *data;
    size_t size_bytes;
} answer;

/* The child's own answer is as long as its file makes it: it is thrown away. */
static void give_answer(struct child_reply *reply)
{
    free(reply->data);
    reply->data = malloc(answer.size_bytes ? answer.size_bytes : 1);
    fuzz_check(reply->data, "out of memory");
    memcpy(reply->data, answer.data, answer.size_bytes);
    reply->size_bytes = answer.size_bytes;
    reply->exit_code = 0;
}

static void prepare(void)
{
    static const char model[] = "solid a\nendsolid a\n", picture[] = "Pf\n1 1\n-1.0\n\0\0\x80\x3f";
    fuzz_file("model.stl", model, strlen(model));
    fuzz_file("picture.pfm", picture, sizeof picture - 1);
    fuzz_reply = give_answer;
}

/* Its memory may have run out, for all that it says. */
static void check_errors(whit_result result, const char *path)
{
    fuzz_check_errors(result == WHIT_ERROR_MEMORY ? WHIT_ERROR_INPUT : result, path);
}

static void ask_for_image(const char *path)
{
    struct image image;
    whit_result result = image_load(&fuzz_log, NULL, path, NULL, &image);
    check_errors(result, path);
    fuzz_check((result == WHIT_OK) == (image.pixels || image.words), "a result, no picture");
    if (result == WHIT_OK) {
        size_t words = (size_t)image.width * image.height * image.channels;
        fuzz_check(words * 4 <= answer.size_bytes, "%zu words of %zu bytes", words,
                   answer.size_bytes);
    }
    image_finish(&image);
}

static void ask_for_texts(const char *path)
{
    whit_text *texts;
    uint32_t count;
    size_t bytes = 0;
    check_errors(image_load_texts(&fuzz_log, path, NULL, &texts, &count), path);
    for (uint32_t i = 0; i < count; i++)
        bytes += strlen(texts[i].key) + strlen(texts[i].value);
    fuzz_check(bytes <= answer.size_bytes, "texts of %zu bytes", bytes);
    free(texts);
}

static void ask_for_texture(void)
{
    struct picture picture;
    char reason[FOREIGN_REASON_BYTES];
    const uint8_t file[1] = {0};
    whit_result result =
        picture_read(&fuzz_log, NULL, UINT64_MAX, file, sizeof file, &picture, reason);
    fuzz_check(result == WHIT_OK || *reason, "no reason for %d", (int)result);
    if (result == WHIT_OK && picture.width < 4096 && picture.height < 4096)
        fuzz_check(picture_shrink(&picture, 1), "a picture that cannot be halved");
    picture_finish(&picture);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    if (size_bytes == 0)
        return;
    answer.data = data + 1;
    answer.size_bytes = size_bytes - 1;
    const char *image = fuzz_file("picture.pfm", "", 0);
    fuzz_log_clear();
    switch (data[0] % 4) {
    case 0:
        ask_for_image(image);
        break;
    case 1:
        ask_for_texts(image);
        break;
    case 2:
        ask_for_texture();
        break;
    default:
        fuzz_load(fuzz_file("model.stl", "solid a\nendsolid a\n", 19));
        break;
    }
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(64) << 20};
