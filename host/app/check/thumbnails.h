/* Thumbnails beside the golden. */
#ifndef APP_CHECK_THUMBNAILS_H
#define APP_CHECK_THUMBNAILS_H

#include "app/check/check.h"

/* Compares the picture with the kept thumbnail of the case, if there is one. A thumbnail that
   cannot be read is skipped with a warning. WHIT_ERROR_MEMORY, with a message. */
WHIT_CHECK whit_result check_compare_thumbnail(const struct check *check,
                                               const struct drawing *drawing,
                                               struct check_result *result);
/* Writes the thumbnail of a case into the folder, which is created if missing. check_drop_thumbnail
   removes it. */
WHIT_CHECK whit_result check_save_thumbnail(const struct check *check,
                                            const struct check_result *result);
void check_drop_thumbnail(const struct check *check, const char *name);

#endif
