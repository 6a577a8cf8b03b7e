/* Part of whit.h: scenes, and what is in them. */
#ifndef WHIT_SCENE_H
#define WHIT_SCENE_H

#include "whit_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Which axis of a model points up. */
typedef enum whit_up {
    WHIT_UP_Y = 0, /* numbers stay as the file has them, or as its format turns them */
    WHIT_UP_X,
    WHIT_UP_Z,
    WHIT_UP_MINUS_X,
    WHIT_UP_MINUS_Y,
    WHIT_UP_MINUS_Z,
    WHIT_UP_AUTO, /* y; of OBJ, PLY and STL, which do not say, by their shape */
} whit_up;

/* What lights a scene. */
typedef enum whit_lights {
    WHIT_LIGHTS_AUTO = 0, /* the file's; whit's where they light nothing of what is seen */
    WHIT_LIGHTS_FILE,     /* the file's, emissive surfaces among them, and no other */
    WHIT_LIGHTS_NONE,     /* no light but the ambient one */
    WHIT_LIGHTS_KEY,      /* whit's in place of the file's */
} whit_lights;

typedef struct whit_load_params {
    whit_up up; /* of a model; scene files say how they place theirs */
    whit_lights lights;
    /* What rays see that meet nothing, in place of what the file says: a picture all around, as of
       scene files (NULL: none), or one colour of sRGB. */
    const char *environment;
    bool has_background;
    uint8_t background[3];
    /* For each importer and decoder of pictures that is not whit's own: */
    double import_limit_s; /* of the processor; 0: 8, and 4 for each 10 MB, at most 60 */
    double time_limit_s;   /* by the clock; 0: ten times that */
    bool require_sandbox;  /* WHIT_ERROR_USAGE where these cannot be locked in; else a warning */
    /* Memory for the scene on host and device together, estimated before it is allocated: taking
       more is an error. A foreign importer gets half of it. 0: half of what the machine has. */
    uint64_t memory_limit_bytes;
    uint32_t texture_limit;      /* longest side, larger ones are halved; 0: 4096 */
    const volatile bool *cancel; /* polled; NULL: never */
    /* A scene may name files below its own folder, links resolved, and below these: others are
       refused with a note, or an error where the scene cannot do without. */
    const char *const *allowed_folders;
    uint32_t allowed_count;
    whit_refused *refused; /* filled in, on failure too; NULL: not wanted */
} whit_load_params;

/* .json scene files and .obj .gltf .glb .ply .stl .fbx .dae .3mf .off models. `-` is standard
   input, of at most 256 MiB: it is read once, and kept for further calls; its first bytes tell what
   it is, and files that it names are found in `allowed_folders` alone. WHIT_ERROR_INPUT for a file
   that is missing, damaged or refused, or takes more memory than params allow; WHIT_ERROR_USAGE
   where `require_sandbox` cannot be kept; WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_scene_load(const char *path, const whit_load_params *params,
                                       const whit_log *log, whit_scene **out);
/* A small scene of whit's own, with no file behind it, that has a ray of every kind.
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_scene_small(const whit_log *log, whit_scene **out);
void whit_scene_destroy(whit_scene *scene);
/* Frees the texels that the scene holds on the host, for programs that make no further renderer
   from it: making one is WHIT_ERROR_USAGE afterwards. Renderers made before are not touched. */
void whit_scene_drop_pictures(whit_scene *scene);

/* What rays see that meet nothing. */
typedef enum whit_environment_kind {
    WHIT_ENVIRONMENT_GRADIENT = 0,
    WHIT_ENVIRONMENT_MAP, /* a picture all around */
} whit_environment_kind;
/* "gradient", "map" */
const char *whit_environment_kind_name(whit_environment_kind kind);

typedef struct whit_scene_info {
    uint32_t mesh_count, instance_count, node_count, material_count, texture_count, light_count,
        camera_count, note_count, effect_count;
    uint64_t mesh_triangle_count; /* each mesh once */
    uint64_t triangle_count;      /* over all instances */
    uint64_t sphere_count;        /* likewise */
    uint64_t file_bytes;          /* of all files read */
    uint64_t hash;
    uint32_t channel_count; /* animated properties of nodes */
    double time_end_s;      /* 0: nothing moves */
    bool one_tree; /* what WHIT_INSTANCES_AUTO takes it for: no mesh but a ball is there twice,
                      nothing moves with time, objects are no farther from the origin than 256 of
                      their longest sides, spheres are not turned, mirrored or stretched, memory is
                      enough, and it is not one instance that is where its mesh is */
    double lo[3], hi[3];                 /* world bounds at time 0; lo > hi when empty */
    double objects_lo[3], objects_hi[3]; /* the same, without a floor that is much wider than what
                                            stands on it */
    whit_environment_kind environment;
    bool environment_made_by_whit;
    double exposure_ev; /* half stops that suit what the first camera sees of a model; 0 where much
                           of it is neither burnt out nor black, and of scene files */
} whit_scene_info;
void whit_scene_get_info(const whit_scene *scene, whit_scene_info *info);

/* Item `index` of a kind, described; zeroed when there is no such item. Strings live as long as
   the scene; names and notes are as the files have them, so show them by whit_text_show. */
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
       A Lambertian surface below leaves albedo * color * cos * cos / distance^2. */
    WHIT_LIGHT_AREA_SAMPLE,
    WHIT_LIGHT_RECTANGLE, /* flat emitters of radiance `color` */
    WHIT_LIGHT_TRIANGLE,
    WHIT_LIGHT_KINDS, /* how many there are */
} whit_light_kind;
/* "point", "directional", "spot", "area-sample", "rectangle", "triangle" */
const char *whit_light_kind_name(whit_light_kind kind);
typedef struct whit_light_info {
    const char *name;
    whit_light_kind kind;
    /* World, at time 0. Of a rectangle the centre, of a triangle a corner. */
    double position[3], direction[3];
    float color[3];
    bool made_by_whit;
} whit_light_info;
typedef enum whit_camera_kind {
    WHIT_CAMERA_PERSPECTIVE = 0,
    WHIT_CAMERA_ORTHOGRAPHIC,
    WHIT_CAMERA_PANORAMA, /* equirectangular: the middle looks at the target, the width is 360
                             degrees, the height 180 */
} whit_camera_kind;
/* "perspective", "orthographic", "panorama" */
const char *whit_camera_kind_name(whit_camera_kind kind);
typedef struct whit_camera_info {
    const char *name;
    whit_camera_kind kind;
    double eye[3], target[3], up[3]; /* world, at time 0 */
    double fov_y_degrees, height;
    double lens_radius, focus_distance; /* world units; 0: a pinhole; 0: the target's distance */
    bool made_by_whit;
} whit_camera_info;
typedef struct whit_instance_info {
    const char *name;
    uint32_t mesh;
    double object_to_world[12]; /* row-major 3x4, at time 0 */
} whit_instance_info;
typedef struct whit_effect_info {
    const char *name;
    bool called;
    const char *reason; /* "" when not called for */
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

/* Where whit looks from at a scene whose file has no camera, at time 0; WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_scene_choose_camera(const whit_scene *scene, whit_camera *camera);

/* The cameras of a file, for whit_renderer_render_views: a JSON array of cameras as scene files
   have them (docs/scenes.md), or one camera a line. Names and aspects are not read. `cameras`: one
   block, for whit_memory_destroy. WHIT_ERROR_INPUT, logged with line and column, for what cannot be
   read, for a camera with an animation, and for none; WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_cameras_load(const char *path, const whit_log *log,
                                         whit_camera **cameras, uint32_t *count);

/* What a picture depends on, piece by piece. */
typedef enum whit_part_kind {
    WHIT_PART_MESH = 0,
    WHIT_PART_MATERIAL,
    WHIT_PART_TEXTURE, /* its decoded texels */
    WHIT_PART_LIGHT,
    WHIT_PART_CAMERA,
    WHIT_PART_ANIMATION,   /* keys of one property of one node */
    WHIT_PART_ENVIRONMENT, /* with ambient light, and what a scene file says of contact */
    WHIT_PART_OBJECTS,     /* nodes and instances: where meshes are; and which parts there are, but
                              for materials and textures, which come with those that name them */
    WHIT_PART_KINDS,
} whit_part_kind;
/* "mesh", "material", ... */
const char *whit_part_kind_name(whit_part_kind kind);
typedef struct whit_part {
    whit_part_kind kind;
    const char *name; /* as the file has it, made unique among its kind by `#2`, `#3`, ..., or its
                         number where it has none; show it by whit_text_show. Meshes are called
                         after the first object that has them, textures after their file without
                         folders; "" of environment and objects, of which there is one */
    uint64_t hash;    /* of what is loaded: of decoded texels and imported meshes, not of files */
} whit_part;
/* The parts of a scene, sorted as the scene has them within each kind. What whit adds to a scene is
   none, since it follows from the others. *parts with its names is one block, for
   whit_memory_destroy. WHIT_ERROR_MEMORY; WHIT_ERROR_USAGE for a scene whose pictures were
   dropped. */
WHIT_CHECK whit_result whit_scene_parts(const whit_scene *scene, whit_part **parts,
                                        uint32_t *count);

/* How the part of `after` differs from the one of that kind and name of `before`: "vertices 2716
   and 2717 moved by up to 0.0013"; "" where it does not, or where one of the two is not there. At
   most `bytes`, which end with a 0. Names in it are as the files have them. WHIT_ERROR_MEMORY,
   WHIT_ERROR_USAGE as of whit_scene_parts. */
WHIT_CHECK whit_result whit_scene_part_change(const whit_scene *before, const whit_scene *after,
                                              whit_part_kind kind, const char *name, char *text,
                                              size_t bytes);
/* A scene of its own that has some parts of `before` and the rest of `after`: `back` says of which
   parts, in the order of whit_scene_parts of `before`, it has those of `before`. Objects bring the
   lists of parts with them: a part that one scene alone has comes and goes with these. What whit
   adds to a scene is made anew. With all or none of `back` it has the hash of `before` or `after`.
   WHIT_ERROR_MEMORY; WHIT_ERROR_INPUT for what does not go together; WHIT_ERROR_USAGE as above. */
WHIT_CHECK whit_result whit_scene_mix(const whit_scene *before, const whit_scene *after,
                                      const bool *back, whit_scene **out);

/* Faults that are put into a scene on purpose, to see whether they are noticed. */
typedef enum whit_fault_kind {
    WHIT_FAULT_VERTEX = 0, /* a vertex, or a sphere, moves by `amount` of its mesh's longest side */
    WHIT_FAULT_IOR,        /* a refractive index grows by `amount` */
    WHIT_FAULT_LIGHT,      /* a light, or what glows where there is none, is brighter by `amount`
                              of what it was */
    WHIT_FAULT_TEXELS,     /* a row of texels goes by `amount` of its range */
    WHIT_FAULT_MATERIALS,  /* two materials have each other's values, and glow by `amount` */
    WHIT_FAULT_ORDER,      /* two objects have each other's place in the file */
    WHIT_FAULT_KINDS,
} whit_fault_kind;
/* "vertex", "ior", ... */
const char *whit_fault_kind_name(whit_fault_kind kind);
typedef struct whit_fault {
    whit_fault_kind kind;
    uint64_t seed; /* draws what is changed; not how much */
    double amount; /* of VERTEX below 0 the other way; of MATERIALS 0 too; of ORDER not read */
} whit_fault;
/* A copy of a scene with faults in it. WHIT_ERROR_USAGE, not logged, where it has nothing that one
   of them could change; else as whit_scene_mix. */
WHIT_CHECK whit_result whit_scene_fault(const whit_scene *scene, const whit_fault *faults,
                                        uint32_t count, whit_scene **out);

/* Every world-space triangle at `time_s`, in the order of instance, then primitive. Spheres are not
   among them. */
typedef struct whit_triangle {
    float vertices[9];
    uint32_t instance, primitive;
} whit_triangle;
/* fn returns false to stop (then the result is WHIT_ERROR_CANCELLED). WHIT_ERROR_INPUT where the
   scene has no finite pose at that time. */
WHIT_CHECK whit_result whit_scene_triangles(const whit_scene *scene, double time_s,
                                            bool (*fn)(void *user, const whit_triangle *triangle),
                                            void *user);

#ifdef __cplusplus
}
#endif

#endif
