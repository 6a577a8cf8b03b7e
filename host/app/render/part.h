/* Parts of a picture that are drawn separately, on any machines and in any order, and merge to the
   bytes of a single run: `whit render --tile I/N --samples-part I/N`. */
#ifndef APP_RENDER_PART_H
#define APP_RENDER_PART_H

#include "app/arguments.h"
#include "app/job.h"

struct recipe;
struct render_request;

/* Tile `tile` of `tiles`, and block `set` of `sets` equal blocks of the samples; both count from 1.
   `tiles` or `sets` 0: the option was not given, and the part has the whole picture or all
   samples. */
struct part {
    uint32_t tile, tiles;
    uint32_t set, sets;
};

bool part_is_given(const struct part *part);
/* setting.read of --tile and --samples-part, into a render_request. */
bool part_read_tile(const struct setting *setting, const char *value, void *request,
                    char why[SETTING_WHY_BYTES]);
bool part_read_samples(const struct setting *setting, const char *value, void *request,
                       char why[SETTING_WHY_BYTES]);
/* Checks that the other options go with --tile and --samples-part. */
bool part_check(struct cli_reader *reader, const struct job *job,
                const struct render_request *request);
/* Checks that the functions of the job's shader go with a part: the merged picture could not have
   all images of aovs beside its colours, nor post() of all samples. */
bool part_check_shader(const struct job *job, const struct render_request *request);

/* The rows of the part's tile: `count` rows from `first` on. */
void part_rows(const struct part *part, uint32_t height, uint32_t *first, uint32_t *count);
/* Limits `params` of the whole picture to what the part draws. */
void part_take(const struct part *part, whit_renderer_params *params);
/* The part's name in messages, such as "tile 2/4, samples 1/16"; gives `text`. */
const char *part_name(const struct part *part, char text[64]);

/* Colours times `factor`; alpha stays. */
void part_scale(float factor, whit_image *image);

/* A part as its recipe describes it: which part it is, and of which picture. */
struct part_place {
    struct part part;
    uint32_t width, height, samples; /* of the whole picture */
};
#define PART_KEY "whit:part"
/* A part_place as JSON. */
struct json_t;
struct json_t *part_document(const struct part *part, const struct settings *settings);
/* Reads this JSON, in one line. False: it was not written by whit. */
bool part_of_line(const char *line, struct part_place *place);

/* A PFM has no room for a recipe: it is kept in NAME.pfm.part beside it, with a hash of the
   picture's file. */
WHIT_CHECK whit_result part_save_beside(const char *path, const struct recipe *recipe);
/* Loads the recipe of a part, from the picture or from the file beside it; *texts is for
   whit_memory_destroy. WHIT_ERROR_INPUT, with a message: it is missing, damaged, or belongs to
   another version of the picture's file. */
WHIT_CHECK whit_result part_load_texts(const char *path, const whit_load_params *params,
                                       whit_text **texts, uint32_t *count);

#endif
