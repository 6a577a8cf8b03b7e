/* Decodes picture files in a child process: its replies, and the checks of these in the parent. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/foreign.h"
#include "image/formats.h"
#include "image/image_reply.h"

/* --- the child's side ----------------------------------------------------------------------- */

/* Indices in foreign_answer.numbers: for pictures, and for texts. */
enum { WIDTH, HEIGHT, CHANNELS, IS_INTEGERS, TEXT_COUNT = 0 };

/* The child's name for the file in errors. The parent's errors have the real path instead. */
static const char name[] = "picture";

static void keep_reason(void *user, whit_log_level level, const char *message)
{
    struct foreign_answer *answer = user;
    const char *reason =
        strncmp(message, name, sizeof name - 1) == 0 ? strstr(message, ": ") : NULL;
    if (level == WHIT_LOG_ERROR && !answer->reason[0])
        snprintf(answer->reason, sizeof answer->reason, "%s", reason ? reason + 2 : message);
}

static whit_result answer_image(void *user, void *to, child_write write,
                                struct foreign_answer *answer)
{
    struct image_source source = *(const struct image_source *)user;
    const whit_log log = {.fn = keep_reason, .user = answer, .level = WHIT_LOG_ERROR};
    struct image image;
    source.log = &log;
    source.path = name;
    whit_result result = image_decode(&source, &image);
    if (result != WHIT_OK)
        return result;
    answer->numbers[WIDTH] = image.width;
    answer->numbers[HEIGHT] = image.height;
    answer->numbers[CHANNELS] = image.channels;
    answer->numbers[IS_INTEGERS] = image.words != NULL;
    (void)write(to, image.words ? (const void *)image.words : (const void *)image.pixels,
                (size_t)image.width * image.height * image.channels * sizeof(float));
    image_finish(&image);
    return WHIT_OK;
}

static whit_result answer_texts(void *user, void *to, child_write write,
                                struct foreign_answer *answer)
{
    struct image_source source = *(const struct image_source *)user;
    const whit_log log = {.fn = keep_reason, .user = answer, .level = WHIT_LOG_ERROR};
    struct text_list list = {0};
    source.log = &log;
    source.path = name;
    whit_result result = image_decode_texts(&source, &list);
    answer->numbers[TEXT_COUNT] = list.count;
    for (uint32_t i = 0; result == WHIT_OK && i < list.count; ++i) {
        (void)write(to, list.texts[i].key, strlen(list.texts[i].key) + 1);
        (void)write(to, list.texts[i].value, strlen(list.texts[i].value) + 1);
    }
    text_list_finish(&list);
    return result;
}

/* --- the parent's side ---------------------------------------------------------------------- */

/* A file, and the child's reply to it. */
struct reading {
    const whit_log *log;
    const struct roots *roots;
    const char *path;
    struct child_reply reply;
    struct foreign_answer answer;
};

static whit_result ask(struct reading *reading, const struct foreign_params *params, foreign_fn fn)
{
    const whit_log *log = reading->log;
    uint8_t *data = NULL;
    struct image_source source = {0};
    whit_result result =
        file_read(log, reading->roots, reading->path, IMAGE_BYTES_MAX, &data, &source.size_bytes);
    if (result != WHIT_OK)
        return result;
    source.data = data;
    const struct child_limits limits =
        foreign_limits(params, "decoder", source.size_bytes, IMAGE_BYTES_MAX);
    result = foreign_ask(log, &limits, fn, &source, &reading->reply, &reading->answer);
    if (result != WHIT_OK)
        log_error(log, "%s: %s", reading->path, reading->answer.reason);
    free(data);
    return result;
}

static whit_result no_good(struct reading *reading, whit_result result)
{
    log_error(reading->log, "%s: %s", reading->path,
              result == WHIT_ERROR_MEMORY ? "no memory for what is in it"
                                          : "the decoder's reply is damaged");
    child_reply_free(&reading->reply);
    return result;
}

whit_result image_load(const whit_log *log, const struct roots *roots, const char *path,
                       const struct foreign_params *params, struct image *image)
{
    struct reading reading = {.log = log, .roots = roots, .path = path};
    const uint32_t *numbers = reading.answer.numbers;
    *image = (struct image){0};
    whit_result result = ask(&reading, params, answer_image);
    if (result != WHIT_OK)
        return result;
    uint64_t pixels = (uint64_t)numbers[WIDTH] * numbers[HEIGHT];
    size_t bytes = reading.reply.size_bytes - sizeof reading.answer;
    if (pixels == 0 || numbers[CHANNELS] - 1 > 3 || numbers[IS_INTEGERS] > 1 ||
        pixels > IMAGE_BYTES_MAX || bytes != pixels * numbers[CHANNELS] * sizeof(float))
        return no_good(&reading, WHIT_ERROR_INPUT);
    result =
        image_init(image, numbers[WIDTH], numbers[HEIGHT], numbers[CHANNELS], numbers[IS_INTEGERS]);
    if (result != WHIT_OK)
        return no_good(&reading, result);
    memcpy(image->words ? (void *)image->words : (void *)image->pixels, reading.reply.data, bytes);
    child_reply_free(&reading.reply);
    return WHIT_OK;
}

/* Copies the strings of a reply into one block, behind a list of them. NULL: no memory, or
 *damaged: the reply is not as it should be. */
static whit_text *pack_texts(const struct reading *reading, bool *damaged)
{
    size_t count = reading->answer.numbers[TEXT_COUNT];
    size_t bytes = reading->reply.size_bytes - sizeof reading->answer;
    *damaged = count > bytes / 2;
    whit_text *packed = *damaged ? NULL : malloc(count * sizeof(whit_text) + bytes + 1);
    if (!packed)
        return NULL;
    char *at = (char *)(packed + count), *end = at + bytes;
    memcpy(at, reading->reply.data, bytes);
    *end = 0;
    for (size_t i = 0; i < count && at < end; ++i) {
        packed[i].key = at;
        at += strlen(at) + 1;
        packed[i].value = at <= end ? at : end;
        at += at < end ? strlen(at) + 1 : 0;
        *damaged = i + 1 < count && at >= end;
    }
    return packed;
}

whit_result image_load_texts(const whit_log *log, const char *path,
                             const struct foreign_params *params, whit_text **texts,
                             uint32_t *text_count)
{
    struct reading reading = {.log = log, .path = path};
    bool damaged;
    *texts = NULL;
    *text_count = 0;
    whit_result result = ask(&reading, params, answer_texts);
    if (result != WHIT_OK)
        return result;
    whit_text *packed = pack_texts(&reading, &damaged);
    if (!packed || damaged) {
        free(packed);
        return no_good(&reading, damaged ? WHIT_ERROR_INPUT : WHIT_ERROR_MEMORY);
    }
    *texts = packed;
    *text_count = reading.answer.numbers[TEXT_COUNT];
    child_reply_free(&reading.reply);
    return WHIT_OK;
}
