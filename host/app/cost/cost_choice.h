/* Chooses settings for `whit render`. */
#ifndef APP_COST_COST_CHOICE_H
#define APP_COST_COST_CHOICE_H

#include "app/render/render_command.h"

/* Chooses settings for budget_ms or max_error by figures of `whit cost`, which are measured where
   none are kept; prints the choice and makes its renderer. Choices for budget_ms are tried first,
   because the device may be slower at this moment. The device must be open. WHIT_ERROR_FAILED: no
   settings meet the goal. The renderer is the caller's, also after a failure. */
WHIT_CHECK whit_result render_choose(struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

#endif
