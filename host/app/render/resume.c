#include "app/render/resume.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/arguments.h"
#include "app/render/recipe.h"
#include "app/render/render_command.h"
#include "base/file.h"
#include "base/text.h"

/* ---- Options ---- */

/* Whether the picture's file holds its recipe: PFM files do not, unless they are parts of a
   picture. */
static bool has_recipe(const struct render_request *request)
{
    return part_is_given(&request->part) || !request->output || !path_is(request->output, "pfm");
}

bool resume_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request)
{
    if (!request->resume)
        return true;
    if (!has_recipe(request))
        return cli_misuse(reader,
                          "--resume: %s has no recipe that would tell whether it is finished: "
                          ".png and .exr have",
                          request->output);
    const char *other = render_asks(&job->settings, request, "--refine", "--thumbnail");
    return !other ||
           cli_misuse(reader, "--resume and %s: another run may draw another picture", other);
}

/* ---- What is finished ---- */

/* Whether a text of the recipe must match. Those on the device, and its counters, were not asked
   for by the user. */
static bool decides(const char *key)
{
    return strcmp(key, "whit:device") != 0 && strcmp(key, "whit:driver") != 0 &&
           strcmp(key, "whit:counters") != 0;
}

static bool same_recipe(const struct recipe *wanted, const whit_text *texts, uint32_t count)
{
    for (uint32_t i = 0; i < wanted->count; ++i) {
        const char *text = text_value(texts, count, wanted->texts[i].key);
        if (decides(wanted->texts[i].key) && (!text || strcmp(text, wanted->texts[i].value) != 0))
            return false;
    }
    /* A part has all texts of the whole picture, and one more. */
    return text_value(wanted->texts, wanted->count, PART_KEY) ||
           !text_value(texts, count, PART_KEY);
}

static bool holds_ids(const whit_image *image)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    return info.integers;
}

/* Whether the file holds the colours, or the hit identities, of that recipe. A damaged file is not
   an error: it is drawn again. */
static bool is_finished(const struct job *job, const char *path, const struct recipe *wanted,
                        bool ids)
{
    const char *folders[SETTING_FOLDERS_MAX];
    whit_load_params load = settings_load(&job->settings, folders);
    whit_text *texts = NULL;
    whit_image *image = NULL;
    uint32_t count;
    load.cancel = &cli_cancel;
    if (!file_exists(path))
        return false;
    cli_hush(true);
    bool finished = part_load_texts(path, &load, &texts, &count) == WHIT_OK &&
                    same_recipe(wanted, texts, count) &&
                    whit_image_load(path, &load, &cli_log, &image) == WHIT_OK &&
                    holds_ids(image) == ids;
    cli_hush(false);
    whit_memory_destroy(texts);
    whit_image_destroy(image);
    return finished;
}

static whit_result find_finished(const struct job *job, const struct render_request *single,
                                 bool *finished)
{
    const whit_device_info device = {0};
    const whit_stats stats = {0};
    struct recipe wanted;
    if (!recipe_init(&wanted, &job->settings, job->scene, job->shader, &device, &stats,
                     single->output, NULL))
        return WHIT_ERROR_MEMORY;
    recipe_add_part(&wanted, &single->part, &job->settings);
    *finished = is_finished(job, single->output, &wanted, false) &&
                (!single->ids || is_finished(job, single->ids, &wanted, true));
    recipe_finish(&wanted);
    return job_still_wanted();
}

whit_result resume_begin(const struct job *job, const struct render_request *single,
                         enum resume_state *state, struct lock *lock)
{
    bool finished = false;
    enum lock_end end = lock_take(&cli_log, single->output, lock);
    *state = RESUME_OTHERS;
    if (end == LOCK_FAILED)
        return WHIT_ERROR_OUTPUT;
    if (end == LOCK_OTHERS)
        return WHIT_OK;
    /* Checked only after locking: the process that held the lock before may just have finished the
       file. */
    whit_result result = find_finished(job, single, &finished);
    *state = finished ? RESUME_KEPT : RESUME_DRAW;
    if (result != WHIT_OK || finished)
        lock_give_back(lock);
    return result;
}

whit_result resume_wait(void)
{
    const struct timespec moment = {.tv_nsec = 50 * 1000 * 1000};
    nanosleep(&moment, NULL);
    return job_still_wanted();
}

/* ---- The line that goes on ---- */

bool resume_keeps(const struct render_request *request)
{
    return has_recipe(request) && !request->cameras.file && !request->thumbnail;
}

bool resume_leaves_files(const struct render_request *request)
{
    bool parts = (request->frames.given && !request->cameras.file) ||
                 part_is_given(&request->part) || request->resume;
    return parts && has_recipe(request);
}

void resume_keep_line(bool resumed, int argc, char **argv)
{
    static char line[4096];
    char *words = cli_line(argc, argv);
    const char *more = resumed ? "" : " --resume";
    if (words && snprintf(line, sizeof line, "%s%s\n", words, more) < (int)sizeof line)
        cli_set_next(line);
    free(words);
}
