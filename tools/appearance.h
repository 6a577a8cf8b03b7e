/* Whether a model looks right at once: figures of its picture, and of the same shape in clay. */
#ifndef TOOLS_APPEARANCE_H
#define TOOLS_APPEARANCE_H

#include "whit.h"

/* What a file itself wants to be white or black is told by a shader: two more pictures, of what
   each surface sends by itself, and of what it would send if light of 1 came from everywhere. */
struct appearance_shader {
    whit_shader_compiler *compiler;
    whit_shader *shader;
};
/* Zeroed on failure. WHIT_ERROR_OUTPUT: no file for temporary use could be written. */
WHIT_CHECK whit_result appearance_shader_init(const whit_log *log, struct appearance_shader *out);
void appearance_shader_finish(struct appearance_shader *shader);

/* This tells how the pixels look that show a surface. */
struct appearance {
    double burnt; /* share with a channel displayed as 255, that does not glow white by itself: with
                     1, and no more */
    double black; /* share displayed as 0 in all channels, but not so under light of 1 */
    double relief; /* in clay: mean luminance of the brightest tenth over the darkest fifth */
    bool is_flat;  /* no relief was measured: no surface is seen, or the model is a board */
};

/* `renderer` has drawn `scene` as `accel` has it, and `color` is what it gave. Clay is every
   triangle as grey matte surface under whit's own light, seen by the scene's first camera where
   that is a pinhole. */
struct appearance_of {
    whit_device *device;
    const whit_scene *scene;
    whit_accel *accel;
    whit_renderer *renderer;
    const whit_renderer_params *params;
    const whit_image *color;
};
WHIT_CHECK whit_result appearance_measure(const struct appearance_shader *shader,
                                          const struct appearance_of *of, struct appearance *out);
/* At most a tenth burnt or black, and relief of 2 at least. */
bool appearance_is_right(const struct appearance *appearance);

#endif
