/* The arguments of `whit bench`: whit checks them, and the program whit-bench (tools/bench/), which
   does the work, reads them once more by the same table. */
#ifndef APP_BENCH_REQUEST_H
#define APP_BENCH_REQUEST_H

#include "app/arguments.h"

enum bench_which {
    BENCH_REPORT,
    BENCH_BUILD,
    BENCH_VIEW,
    BENCH_RAYS,
    BENCH_FRAME,
    BENCH_START,
    BENCH_SHADERS,
    BENCH_VIEWS,
    BENCH_LOOK,
    BENCH_COUNT
};
struct bench_kind {
    const char *name, *summary;
    uint32_t width, height; /* of its pictures */
    bool has_goals;         /* rows have verdicts, which --plot draws */
    bool takes_names;       /* takes names of models or scenes */
    bool is_single;         /* one sample, no bounces */
};
extern const struct bench_kind bench_kinds[BENCH_COUNT];
extern const struct setting bench_options[];

struct bench_request {
    enum bench_which which;   /* BENCH_COUNT: none is named */
    const char *scenes;       /* the folder, or NULL: where whit finds it */
    const char *json;         /* NULL: text only */
    const char *const *names; /* models or scenes that were asked for */
    uint32_t name_count;
    const char *against, *plot, *keep;
    bool quick;
    uint32_t runs, width, height;
    struct settings settings; /* device, cache, quiet */
};
/* `reader` outlives the request. False: exit with its status. */
bool bench_read(struct cli_reader *reader, struct bench_request *request);

#endif
