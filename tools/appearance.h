/* Whether a model looks right at once: figures of its picture, and of the same shape in clay. */
#ifndef TOOLS_APPEARANCE_H
#define TOOLS_APPEARANCE_H

#include "whit.h"

/* Of the pixels that show a surface. */
struct appearance {
    double burnt;  /* share with a channel displayed as 255 */
    double black;  /* share displayed as 0 in all channels */
    double relief; /* in clay: mean luminance of the brightest tenth over the darkest fifth */
    bool is_flat;  /* no relief was measured: no surface is seen, or the model is a board */
};

/* `renderer` has drawn `scene`, and `color` is what it gave. Clay is every triangle as grey matte
   surface under whit's own light, seen by the scene's first camera where that is a pinhole. */
WHIT_CHECK whit_result appearance_measure(whit_device *device, const whit_scene *scene,
                                          whit_renderer *renderer,
                                          const whit_renderer_params *params,
                                          const whit_image *color, struct appearance *out);
/* At most a tenth burnt or black, and relief of 2 at least. */
bool appearance_is_right(const struct appearance *appearance);

#endif
