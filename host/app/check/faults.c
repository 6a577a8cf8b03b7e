#include "app/check/faults.h"

#include "base/random.h"

enum { SEEDS_MAX = 24 };

double fault_strong(whit_fault_kind kind)
{
    static const double amounts[WHIT_FAULT_KINDS] = {
        [WHIT_FAULT_VERTEX] = 0.1, [WHIT_FAULT_IOR] = 0.5,       [WHIT_FAULT_LIGHT] = 1.0,
        [WHIT_FAULT_TEXELS] = 1.0, [WHIT_FAULT_MATERIALS] = 1.0,
    };
    return amounts[kind];
}

whit_result fault_draw(const struct fault_case *item, const whit_fault *faults, uint32_t count,
                       enum fault_end *end, whit_scene **made)
{
    struct job input = item->input;
    struct drawing trial;
    *end = FAULT_NONE;
    if (made)
        *made = NULL;
    cli_hush(true);
    whit_result result = whit_scene_fault(item->input.scene, faults, count, &input.scene);
    bool fits = result == WHIT_OK;
    if (fits) {
        result = trial_draw(&trial, &input);
        bool same = result == WHIT_OK && drawing_same(&trial, item->was);
        *end = same ? FAULT_SAME : FAULT_SEEN;
        trial_finish(&trial);
    }
    cli_hush(false);
    if (made && fits)
        *made = input.scene;
    else if (fits)
        whit_scene_destroy(input.scene);
    return trial_ends_all(result) ? result : WHIT_OK;
}

whit_result fault_find(const struct fault_case *item, whit_fault_kind kind, uint64_t *random,
                       whit_fault *fault, bool *found)
{
    whit_result result = WHIT_OK;
    *found = false;
    for (int i = 0; result == WHIT_OK && !*found && i < SEEDS_MAX; ++i) {
        enum fault_end end;
        *fault = (whit_fault){kind, splitmix64(random), fault_strong(kind)};
        result = fault_draw(item, fault, 1, &end, NULL);
        if (result != WHIT_OK || end == FAULT_NONE)
            return result;
        *found = end == FAULT_SEEN;
    }
    return result;
}
