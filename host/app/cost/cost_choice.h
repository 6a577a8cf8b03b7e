/* Settings that `whit render` chooses. */
#ifndef APP_COST_COST_CHOICE_H
#define APP_COST_COST_CHOICE_H

#include "app/render/render_command.h"

/* Settings for budget_ms or max_error, by figures of `whit cost`, which are measured when none are
   kept; says which, and makes their renderer. What is within budget_ms is tried
   before, for the device may be slower at this moment. The device is open.
   WHIT_ERROR_FAILED: none does it. The renderer is the caller's, also after a failure. */
WHIT_CHECK whit_result render_choose(struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

#endif
