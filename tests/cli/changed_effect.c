/* Linked into whit in the place of whit_renderer_image (--wrap): pictures change with an effect
   that the scene does not call for. WHIT_TEST_CHANGED_EFFECT names the effect; with every kernel
   that has it the first pixel is brighter. */
#include <stdlib.h>
#include <string.h>

#include "../wrapped.h"
#include "whit.h"

static bool has_changed_effect(const whit_renderer *renderer)
{
    const char *wanted = getenv("WHIT_TEST_CHANGED_EFFECT"), *name;
    for (uint32_t i = 0; wanted && (name = whit_effect_name(i)); ++i) {
        if (strcmp(name, wanted) == 0)
            return whit_renderer_compiles(renderer, i);
    }
    return false;
}

WRAPPED(whit_result, whit_renderer_image, whit_renderer *renderer, whit_aov aov, whit_image **out)
{
    whit_result result = __real_whit_renderer_image(renderer, aov, out);
    if (result == WHIT_OK && aov == WHIT_AOV_COLOR && has_changed_effect(renderer))
        *(float *)whit_image_floats(*out) += 0.5f;
    return result;
}
