#include "app/picture.h"

#include <stdlib.h>
#include <string.h>

bool picture_read_samples(struct cli_reader *reader, uint32_t *samples)
{
    static const char *const choices[] = {"1", "4", "16", "64", NULL};
    uint32_t choice;
    if (!cli_choice(reader, choices, &choice))
        return false;
    *samples = 1u << (2 * choice);
    return true;
}

bool picture_read_aa(struct cli_reader *reader, struct picture *picture)
{
    static const char prefix[] = "adaptive:";
    size_t length = strlen(prefix);
    if (strncmp(reader->value, prefix, length) != 0) {
        picture->adaptive = 0.0;
        return picture_read_samples(reader, &picture->samples);
    }
    char *end;
    double contrast = strtod(reader->value + length, &end);
    if (end == reader->value + length || *end || !(contrast > 0.0 && contrast <= 1.0))
        return cli_misuse(reader, "--aa `%s`: after adaptive: a number above 0, up to 1, is needed",
                          reader->value);
    picture->adaptive = contrast;
    return true;
}

whit_renderer_params picture_params(const struct picture *picture, const struct job *job)
{
    return (whit_renderer_params){
        .width = picture->width,
        .height = picture->height,
        .camera = picture->camera,
        .time_s = job->time_s,
        .samples = picture->samples,
        .adaptive = picture->adaptive,
        .depth = picture->depth,
        .no_bounces = picture->depth == 0,
        .cancel = &cli_cancel,
        .time_limit_s = cli_time_left_s(),
        .load_path = job->load_path,
        .traversal = job->traversal,
        .numerics = job->numerics,
    };
}

void picture_describe(const struct picture *picture, const struct job *job, json_t *object)
{
    document_count(object, "width", picture->width);
    document_count(object, "height", picture->height);
    document_text(object, "camera", picture->camera);
    document_number(object, "time_s", job->time_s);
    if (picture->adaptive > 0.0)
        document_number(object, "adaptive", picture->adaptive);
    else
        document_count(object, "samples", picture->samples);
    document_count(object, "depth", picture->depth);
}
