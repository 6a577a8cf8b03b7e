/* Traces one pixel of a drawing again, by the device or reference that drew it. */
#include <math.h>

#include "app/check/draw.h"

whit_result drawing_probe(const struct drawing *drawing, uint32_t x, uint32_t y,
                          whit_probe_ray *ray)
{
    whit_probe_report *report = NULL;
    whit_probe_ray *rays = NULL;
    uint32_t count = 0;
    whit_result result = drawing->reference
                             ? whit_reference_rays(drawing->reference, x, y, 0, &rays, &count)
                             : whit_probe(drawing->renderer, x, y, 1, &report);
    *ray =
        (whit_probe_ray){.device = {(double)INFINITY, WHIT_NONE, WHIT_NONE}, .material = WHIT_NONE};
    if (count)
        *ray = rays[0];
    else if (report && report->ray_count)
        *ray = report->rays[0];
    whit_memory_destroy(rays);
    whit_probe_report_destroy(report);
    return result;
}
