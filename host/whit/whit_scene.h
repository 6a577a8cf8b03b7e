/* Part of whit.h: scenes, and what is in them. */
#ifndef WHIT_SCENE_H
#define WHIT_SCENE_H

#include "whit_types.h"

WHIT_C_BEGIN

/* The axis of a model that points up, after an axis that its format or file states (FBX, COLLADA,
   3MF) was turned to y. */
typedef enum whit_up {
    WHIT_UP_Y = 0, /* coordinates stay as the file or its format defines them */
    WHIT_UP_X,
    WHIT_UP_Z,
    WHIT_UP_MINUS_X,
    WHIT_UP_MINUS_Y,
    WHIT_UP_MINUS_Z,
    WHIT_UP_AUTO, /* y; for OBJ, PLY, STL and OFF, which do not define it, guessed from the shape of
                     the model */
} whit_up;

/* The lights that a scene has. */
typedef enum whit_lights {
    WHIT_LIGHTS_AUTO = 0, /* the file's lights; lights made by whit where those light nothing that
                             is seen */
    WHIT_LIGHTS_FILE,     /* only the file's lights and emissive surfaces */
    WHIT_LIGHTS_NONE,     /* only ambient light */
    WHIT_LIGHTS_KEY,      /* lights made by whit in place of the file's */
} whit_lights;

typedef struct whit_load_params {
    whit_up up; /* for models; scene files define it for theirs */
    whit_lights lights;
    /* The one animation of a glTF that is played, by name or number from 0. NULL: the first, and of
       the others those for nodes that no played one moves. */
    const char *clip;
    /* Replaces the file's environment, which rays see that hit nothing: the path of a panorama
       picture, as in scene files (NULL: none), or one sRGB colour (where has_background). */
    const char *environment;
    bool has_background;
    uint8_t background[3];
    /* For each importer and decoder of pictures that is not whit's own; one that takes longer has
       failed at its file, as at a damaged one: */
    double import_limit_s; /* processor time, not below 0; 0: 8, plus 4 per 10 MB, at most 60 */
    double time_limit_s;   /* wall clock, not below 0; 0: ten times import_limit_s */
    bool require_sandbox;  /* WHIT_ERROR_USAGE where importers cannot be run in a sandbox; false:
                              only a warning */
    /* Limit on the memory for the scene on host and device together, estimated before it is
       allocated; exceeding it is an error. A foreign importer gets half of it. 0: half of the
       machine's memory. */
    uint64_t memory_limit_bytes;
    uint32_t texture_limit;      /* longest side in texels, larger textures are halved until they
                                    fit; 0: 4096 */
    const volatile bool *cancel; /* polled; NULL: never */
    /* A scene may refer to files below its own folder (with links resolved) and below these
       folders. Other files are refused with a note, or with an error where the scene cannot be
       loaded without them. */
    const char *const *allowed_folders;
    uint32_t allowed_count;
    whit_refused *refused; /* filled in, on failure too; NULL: not wanted */
    /* Called from this thread with the path of each file that is read, or is missing, the scene's
       own among them; perhaps more than once for a file. NULL: never. */
    void (*found)(void *user, const char *path);
    void *found_user;
} whit_load_params;

/* .json scene files and .obj .gltf .glb .ply .stl .fbx .dae .3mf .off models. `-` is standard
   input, of at most 256 MiB: it is read once and kept for further calls. Its first bytes tell its
   format; files that it refers to are searched only in `allowed_folders`. WHIT_ERROR_INPUT for a
   file that is missing, damaged or refused, or takes more memory than params allow;
   WHIT_ERROR_USAGE for params out of range, and where `require_sandbox` is set and there is no
   sandbox; WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_scene_load(const char *path, const whit_load_params *params,
                                       const whit_log *log, whit_scene **out);
/* A small built-in scene, without a file, whose picture has rays of every kind.
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_scene_small(const whit_log *log, whit_scene **out);
void whit_scene_destroy(whit_scene *scene);
/* Frees the texels that the scene holds on the host, for programs that make no further renderer
   from it: making one afterwards is WHIT_ERROR_USAGE. Existing renderers are not affected. */
void whit_scene_drop_pictures(whit_scene *scene);

/* The environment, which rays see that hit nothing. */
typedef enum whit_environment_kind {
    WHIT_ENVIRONMENT_GRADIENT = 0,
    WHIT_ENVIRONMENT_MAP, /* a picture all around */
} whit_environment_kind;
/* "gradient", "map" */
const char *whit_environment_kind_name(whit_environment_kind kind);

typedef struct whit_scene_info {
    uint32_t mesh_count, instance_count, node_count, material_count, texture_count, light_count,
        camera_count, note_count, effect_count;
    uint32_t textures_missing;    /* pictures that could not be read; magenta takes their place */
    uint64_t mesh_triangle_count; /* counts each mesh once */
    uint64_t triangle_count;      /* over all instances */
    uint64_t sphere_count;        /* over all instances */
    uint64_t file_bytes;          /* of all files read */
    uint64_t hash;
    uint32_t channel_count;          /* animated properties of nodes */
    double time_begin_s, time_end_s; /* first and last key; both 0: nothing moves */
    bool one_tree; /* whether WHIT_INSTANCES_AUTO makes a single tree. It does where no mesh but a
                      ball is instanced twice, nothing is animated, objects are no farther from the
                      origin than 256 times their longest side, spheres are not rotated, mirrored or
                      scaled unevenly, memory suffices, and the scene is not just one instance
                      without a transformation */
    double lo[3], hi[3];                 /* world bounds at time 0; lo > hi when empty */
    double objects_lo[3], objects_hi[3]; /* the bounds without a floor that is much wider than the
                                            objects on it */
    double home_lo[3], home_hi[3]; /* likewise, or bounds of the part that whit's own camera shows,
                                      if the file has none and that part is small; in a room a cube
                                      in it */
    whit_environment_kind environment;
    bool environment_made_by_whit;
    double exposure_ev; /* a suitable exposure for the first camera's view of a model, in steps of
                           half a stop; 0 for scene files, and where much of the view is neither
                           overexposed nor black */
} whit_scene_info;
void whit_scene_get_info(const whit_scene *scene, whit_scene_info *info);

/* The functions whit_scene_get_* below describe item `index` of a kind; where there is no such
   item, numbers are 0 and strings "". Strings live as long as the scene; names and notes are as the
   files have them, so show them by whit_text_show. */
typedef struct whit_mesh_info {
    const char *name;
    uint32_t vertex_count, triangle_count, group_count, sphere_count;
    bool has_normals, has_uvs, has_colors;
    float lo[3], hi[3]; /* bounds, object space; lo > hi: it is empty */
} whit_mesh_info;
typedef enum whit_material_model {
    WHIT_MODEL_PHONG = 0,   /* MTL: ambient, diffuse, highlight, mirror, glass */
    WHIT_MODEL_METAL_ROUGH, /* glTF: mapped to the Whitted model, see docs/effects.md */
    WHIT_MODEL_UNLIT,       /* diffuse colour as it is */
} whit_material_model;
/* "phong", "metal-rough", "unlit" */
const char *whit_material_model_name(whit_material_model model);
typedef struct whit_material_info {
    const char *name, *file; /* file: NULL when made by whit */
    uint32_t line;
    whit_material_model model;
    int32_t illum; /* -1: none */
    float diffuse[3], specular[3], emission[3], reflection[3], transmission[3];
    float shininess, ior, opacity, metallic, roughness;
    uint32_t texture_count;
} whit_material_info;
typedef enum whit_light_kind {
    WHIT_LIGHT_POINT = 0,
    WHIT_LIGHT_DIRECTIONAL,
    WHIT_LIGHT_SPOT,
    /* One sample of an emissive surface, made when a scene is loaded: a point whose intensity along
       `direction` (the surface's normal) is `color`, falling with the cosine to it; inverse-square.
       The radiance that leaves a Lambertian surface below is albedo * color * cos * cos /
       distance^2. */
    WHIT_LIGHT_AREA_SAMPLE,
    WHIT_LIGHT_RECTANGLE, /* rectangle and triangle: flat emitters of radiance `color` */
    WHIT_LIGHT_TRIANGLE,
    WHIT_LIGHT_KINDS, /* how many there are */
} whit_light_kind;
/* "point", "directional", "spot", "area-sample", "rectangle", "triangle" */
const char *whit_light_kind_name(whit_light_kind kind);
typedef struct whit_light_info {
    const char *name;
    whit_light_kind kind;
    /* World, at time 0. `position` of a rectangle is its centre, of a triangle a corner. */
    double position[3], direction[3];
    float color[3];
    bool made_by_whit;
} whit_light_info;
typedef struct whit_camera_info {
    const char *name;
    whit_camera_kind kind;
    double eye[3], target[3], up[3]; /* world, at time 0 */
    double fov_y_degrees, height;
    double lens_radius, focus_distance; /* world units. lens_radius 0: a pinhole; focus_distance 0:
                                           that of the target */
    bool target_is_direction; /* the file says where the camera looks, but not how far: the target
                                 is at any distance */
    bool made_by_whit;
} whit_camera_info;
typedef struct whit_instance_info {
    const char *name;
    uint32_t mesh;
    double object_to_world[12]; /* row-major 3x4, at time 0 */
} whit_instance_info;
typedef struct whit_effect_info {
    const char *name;
    bool called;        /* the scene needs it */
    const char *reason; /* why the scene needs it; "" where it does not */
} whit_effect_info;
typedef struct whit_note_info {
    bool warning;
    const char *text;
} whit_note_info;
void whit_scene_get_mesh(const whit_scene *scene, uint32_t index, whit_mesh_info *info);
void whit_scene_get_material(const whit_scene *scene, uint32_t index, whit_material_info *info);
void whit_scene_get_light(const whit_scene *scene, uint32_t index, whit_light_info *info);
void whit_scene_get_camera(const whit_scene *scene, uint32_t index, whit_camera_info *info);
void whit_scene_get_instance(const whit_scene *scene, uint32_t index, whit_instance_info *info);
void whit_scene_get_effect(const whit_scene *scene, uint32_t index, whit_effect_info *info);
void whit_scene_get_note(const whit_scene *scene, uint32_t index, whit_note_info *info);

/* The camera that whit chooses for a scene whose file has none, at time 0. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_scene_choose_camera(const whit_scene *scene, whit_camera *camera);

/* The cameras of a file, for whit_renderer_render_views: a JSON array of cameras as scene files
   have them (docs/scenes.md), or one camera a line. Their names and aspect ratios are not read.
   `cameras`: one block, for whit_memory_destroy. WHIT_ERROR_INPUT, logged with line and column, for
   a file that cannot be read, an animated camera, and an empty list; WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_cameras_load(const char *path, const whit_log *log,
                                         whit_camera **cameras, uint32_t *count);

/* Every world-space triangle at `time_s`, in the order of instance, then primitive. Spheres are not
   among them. */
typedef struct whit_triangle {
    float vertices[9];
    uint32_t instance, primitive;
} whit_triangle;
/* fn returns false to stop (then the result is WHIT_ERROR_CANCELLED). WHIT_ERROR_USAGE for a time
   that is not finite, WHIT_ERROR_INPUT where the scene has no finite pose at that time. */
WHIT_CHECK whit_result whit_scene_triangles(const whit_scene *scene, double time_s,
                                            bool (*fn)(void *user, const whit_triangle *triangle),
                                            void *user);

WHIT_C_END

#endif
