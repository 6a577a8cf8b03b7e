#include "app/commands.h"
#include "app/listing.h"
#include "app/receipt.h"

enum scene_id {
    ID_JSON = JOB_ID_END,
    ID_TRIANGLES,
    ID_ALL,
    ID_EFFECTS,
    ID_KERNELS,
    ID_SIZE,
    ID_CAMERA,
    ID_AA,
    ID_DEPTH,
};

enum { DEPTH_MOST = 32 };

static const struct cli_option options[] = {
    {ID_JSON, "json", NULL, "everything as JSON", NULL},
    {ID_ALL, "all", NULL, "list every item, not only the first of each kind", NULL},
    {ID_TRIANGLES, "triangles", "FILE",
     "write every world-space triangle: little-endian records\n"
     "float v[9]; uint32 instance; uint32 primitive",
     NULL},
    {ID_EFFECTS, "effects", NULL,
     "what each effect costs, measured on the device: times\n"
     "with and without it in turns, and what the picture\n"
     "would lose; --size, --camera, --aa and --depth are those\n"
     "of `whit render`",
     NULL},
    {ID_KERNELS, "kernels", NULL,
     "the kernels of such a picture, what they take to make,\n"
     "and what the device's driver tells of them: subgroup\n"
     "size, registers and the like",
     NULL},
    {ID_SIZE, "size", "WxH", "pixels, for --effects and --kernels (320x240)", NULL},
    {ID_CAMERA, "camera", "NAME|N|numbers", "for the same (the scene's first)", NULL},
    {ID_AA, "aa", "1|4|16|...|4096|adaptive:X", "for the same (1)", values_samples},
    {ID_DEPTH, "depth", "N", "for the same (8)", NULL},
    {JOB_NUMERICS, "numerics", NULL, "for the same (watertight)", values_numerics},
    JOB_OPTION_DEVICE,
    {JOB_TIME, "time", "T", "time of the triangles, or of the picture, in seconds (0)", NULL},
    {JOB_FRAME, "frame", "N", "instead of --time: frame N of the animation", NULL},
    {JOB_FPS, "fps", "F", "frames in a second, for --frame (24)", NULL},
    JOB_OPTION_LOADING,
    {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5", NULL},
    {'q', "quiet", NULL, "print nothing but errors; useful with --triangles", NULL},
    {0},
};

struct scene_request {
    const char *triangles; /* NULL: none */
    bool json, all, effects, kernels;
    struct picture picture; /* of --effects and --kernels */
    bool for_picture;       /* an option that needs one of these was given */
};

static int work(struct job *job, const struct scene_request *request)
{
    whit_scene_info info;
    whit_result result = job_load(job);
    if (result == WHIT_OK && request->triangles)
        result = triangles_write(job, request->triangles);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    if (request->effects)
        return receipt_run(job, &request->picture, request->json);
    if (request->kernels)
        return kernels_run(job, &request->picture, request->json);
    whit_scene_get_info(job->scene, &info);
    if (request->json)
        return listing_print_json(job, &info);
    return job->quiet ? EXIT_FINE : listing_print_text(job, &info, request->all);
}

static void read_option(struct job *job, struct cli_reader *reader, int id,
                        struct scene_request *request)
{
    struct picture *picture = &request->picture;
    request->for_picture |= (id >= ID_SIZE && id <= ID_DEPTH) || id == JOB_NUMERICS;
    switch (id) {
    case ID_JSON:
        request->json = true;
        break;
    case ID_ALL:
        request->all = true;
        break;
    case ID_TRIANGLES:
        request->triangles = reader->value;
        break;
    case ID_EFFECTS:
        request->effects = true;
        break;
    case ID_KERNELS:
        request->kernels = true;
        break;
    case ID_SIZE:
        cli_size(reader, &picture->width, &picture->height);
        break;
    case ID_CAMERA:
        picture->camera = reader->value;
        break;
    case ID_AA:
        picture_read_aa(reader, picture);
        break;
    case ID_DEPTH:
        cli_unsigned(reader, 0, DEPTH_MOST, &picture->depth);
        break;
    default:
        job_option(job, reader, id);
        break;
    }
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct scene_request request = {
        .picture = {
            .width = 320, .height = 240, .samples = 1, .depth = whit_renderer_defaults().depth}};
    job_init(&job);
    cli_reader_init(&reader, command, argc, argv);
    for (int id; (id = cli_next(&reader)) != 0;)
        read_option(&job, &reader, id, &request);
    if (!job_options_done(&job, &reader) ||
        !cli_no_dash(&reader, "--triangles", request.triangles, "for a pipe give /dev/stdout"))
        return reader.status;
    if (request.for_picture && !request.effects && !request.kernels) {
        cli_misuse(&reader,
                   "--size, --camera, --aa, --depth and --numerics are for the pictures of "
                   "--effects and --kernels");
        return reader.status;
    }
    if (request.effects && request.kernels) {
        cli_misuse(&reader, "--effects and --kernels are two listings: give one of them");
        return reader.status;
    }
    if (request.triangles && !cli_can_write(request.triangles))
        return EXIT_USAGE;
    int status = work(&job, &request);
    job_finish(&job);
    return status;
}

const struct cli_command command_scene = {
    .name = "scene",
    .arguments = "SCENE [options]",
    .summary = "Lists what is in a scene, what is wrong with it, and the effects it calls for.",
    .options = options,
    .run = run,
};
