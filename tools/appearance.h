/* Judges whether a model looks right without any options, by its picture and a picture of the same
   shape in clay. */
#ifndef TOOLS_APPEARANCE_H
#define TOOLS_APPEARANCE_H

#include "whit.h"

/* The bytes of a picture as displayed, 4 a pixel; free() them. */
WHIT_CHECK whit_result appearance_display(const whit_image *color, uint8_t **rgba);

/* A shader that finds surfaces that the file itself makes white or black, by two more pictures: the
   light that each surface emits, and the light that it would send if light of 1 came from all
   directions. */
struct appearance_shader {
    whit_shader_compiler *compiler;
    whit_shader *shader;
};
/* Zeroed on failure. WHIT_ERROR_OUTPUT: no temporary file could be written. */
WHIT_CHECK whit_result appearance_shader_init(const whit_log *log, struct appearance_shader *out);
void appearance_shader_finish(struct appearance_shader *shader);

/* Figures over the pixels that show a surface. */
struct appearance {
    double covered; /* share of all pixels that show a surface */
    bool cropped;   /* a surface is seen at all four borders, by whit's own camera from outside */
    double burnt;   /* share with a channel displayed as 255, without surfaces that are to be white
                       because they emit exactly 1 */
    double black;   /* share displayed as 0 in all channels, without surfaces that would be black
                       under light of 1 too */
    double relief;  /* in clay: mean luminance of the brightest tenth over the darkest fifth */
    bool is_flat;   /* no relief was measured: no surface is seen, or the model is a board */
};

/* `renderer` has drawn `scene` with the trees `accel`, and `color` is its picture. In clay every
   triangle is grey and matte, under whit's own light, and seen by the scene's first camera if that
   is a pinhole. */
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
/* Not cropped and at least a twentieth of the picture, at most a tenth of it burnt or black, and
   relief of 2 at least. */
bool appearance_is_right(const struct appearance *appearance);

#endif
