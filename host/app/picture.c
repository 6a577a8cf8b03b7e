#include "app/commands.h"

#include <stdlib.h>
#include <string.h>

bool picture_read_aa(struct cli_reader *reader, struct picture *picture)
{
    static const char prefix[] = "adaptive:";
    size_t length = strlen(prefix);
    if (strncmp(reader->value, prefix, length) != 0) {
        picture->adaptive = 0.0;
        return cli_choice_unsigned(reader, &picture->samples);
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
    whit_renderer_params params = whit_renderer_defaults();
    params.width = picture->width;
    params.height = picture->height;
    params.camera = picture->camera;
    params.time_s = job->time_s;
    params.samples = picture->samples;
    params.adaptive = picture->adaptive;
    params.depth = picture->depth;
    params.cancel = &cli_cancel;
    params.time_limit_s = cli_time_left_s();
    params.load_path = job->load_path;
    params.traversal = job->traversal;
    params.numerics = job->numerics;
    return params;
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

struct render_request picture_request_default(void)
{
    const whit_renderer_params usual = whit_renderer_defaults();
    return (struct render_request){.picture = {.width = usual.width,
                                               .height = usual.height,
                                               .samples = usual.samples,
                                               .depth = usual.depth},
                                   .bailout = usual.bailout};
}

whit_renderer_params picture_request_params(const struct render_request *request,
                                            const struct job *job)
{
    whit_renderer_params params = picture_params(&request->picture, job);
    params.bailout = request->bailout;
    params.shadows = request->shadows;
    params.light_samples = request->light_samples;
    params.schlick = request->schlick;
    params.effects = request->effects;
    return params;
}

bool picture_option(struct cli_reader *reader, int id, struct render_request *request)
{
    int choice;
    request->has_shading |= id >= PICTURE_AA && id <= PICTURE_EFFECTS;
    switch (id) {
    case PICTURE_SIZE:
        cli_size(reader, &request->picture.width, &request->picture.height);
        return true;
    case PICTURE_CAMERA:
        request->picture.camera = reader->value;
        return true;
    case PICTURE_AA:
        picture_read_aa(reader, &request->picture);
        return true;
    case PICTURE_DEPTH:
        cli_unsigned(reader, 0, PICTURE_DEPTH_MOST, &request->picture.depth);
        return true;
    case PICTURE_BAILOUT:
        cli_number(reader, 0.0, 1.0, &request->bailout);
        return true;
    case PICTURE_NO_SHADOWS:
        request->shadows = WHIT_SHADOWS_NONE;
        return true;
    case PICTURE_OPAQUE_SHADOWS:
        if (request->shadows != WHIT_SHADOWS_NONE)
            request->shadows = WHIT_SHADOWS_OPAQUE;
        return true;
    case PICTURE_LIGHT_SAMPLES:
        cli_choice_unsigned(reader, &request->light_samples);
        return true;
    case PICTURE_FRESNEL:
        if (cli_choice(reader, &choice))
            request->schlick = choice == 1;
        return true;
    case PICTURE_EFFECTS:
        if (effects_check(reader, reader->value))
            request->effects = reader->value;
        return true;
    case PICTURE_BUDGET:
        cli_number(reader, 1e-3, 1e9, &request->budget_ms);
        return true;
    case PICTURE_MAX_ERROR:
        cli_number(reader, 1e-9, 1e6, &request->max_error);
        return true;
    case PICTURE_VIEW:
        view_read(reader, &request->view);
        return true;
    case PICTURE_VIEW_RAYS:
        view_read_rays(reader, &request->view);
        return true;
    case PICTURE_VIEW_SCALE:
        view_read_scale(reader, &request->view);
        return true;
    default:
        return false;
    }
}

bool picture_check_choice(struct cli_reader *reader, const struct render_request *request)
{
    bool budget = request->budget_ms > 0.0, error = request->max_error > 0.0;
    const char *name = budget ? "--budget-ms" : "--max-error";
    if (budget && error)
        return cli_misuse(reader, "--budget-ms and --max-error: one of them");
    if ((budget || error) && request->has_shading)
        return cli_misuse(reader, "%s chooses --aa, --depth and the like by itself", name);
    if ((budget || error) && (request->view.given || request->frames.given))
        return cli_misuse(reader, "%s is for one picture of colours", name);
    return true;
}
