/* Refuses settings that the double reference cannot draw in place of a device. */
#include "app/check/draw.h"

whit_result reference_check(const struct job *job)
{
    const struct settings *settings = &job->settings;
    const whit_overlay over = settings_overlay(settings);
    const struct {
        bool asked;
        const char *option;
    } refused[] = {
        {settings->shader[0], "--shader"},
        {settings->paint != PAINT_COLOR, "--view"},
        {over.grid, "--grid"},
        {over.edges_of_instances || over.edges_of_primitives, "--edges"},
        {settings->picture.sampling.kind == WHIT_SAMPLING_ADAPTIVE, "--aa adaptive"},
        {settings->picture.effects_removed, "--effects without some"},
    };
    for (size_t i = 0; !job->device && i < sizeof refused / sizeof *refused; ++i) {
        if (!refused[i].asked)
            continue;
        cli_error("%s: the reference does not draw it, a device does", refused[i].option);
        return WHIT_ERROR_USAGE;
    }
    return WHIT_OK;
}
