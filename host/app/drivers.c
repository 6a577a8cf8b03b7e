#include "app/drivers.h"

#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

/* Mesa's drivers find hardware by the nodes in this folder. */
static const char nodes[] = "/dev/dri";
static const char left_out[] = "VK_LOADER_DRIVERS_DISABLE",
                  patterns[] = "*intel*,*radeon*,*virtio*";

/* Whether the environment chooses drivers, or makes one of them do without hardware. */
static bool is_chosen(void)
{
    static const char *const names[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES",
                                        "VK_ADD_DRIVER_FILES", "VK_LOADER_DRIVERS_SELECT",
                                        "RADV_FORCE_FAMILY"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (getenv(names[i]))
            return true;
    }
    return false;
}

void drivers_prepare(void)
{
    if (!is_chosen() && access(nodes, F_OK) != 0)
        (void)setenv(left_out, patterns, 0);
}
