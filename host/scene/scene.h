/* The scene to draw: meshes, instances on a node tree, materials, textures, lights, cameras,
   environment and animation. Loaders build it, scene_freeze() checks and completes it, and from
   then on nobody changes it. Lengths are world units, angles radians, colours linear RGB. */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/affine.h"
#include "base/key_table.h"
#include "base/log.h"
#include "base/roots.h"
#include "whit/whit_scene.h"

#define SCENE_NONE UINT32_MAX /* no node, no texture, ... */

/* The place where something was defined, for reports and errors. */
struct scene_origin {
    char *file;    /* NULL: made by whit */
    uint32_t line; /* 1-based; 0: not known */
};

/* An 8-bit picture as stored in its file; row 0 is the top. */
struct scene_texture {
    char *name;
    uint32_t width, height;
    uint8_t *rgba;       /* width * height * 4 */
    size_t mapped_bytes; /* length of `rgba` if it is a mapped reply of a child; 0: from malloc() */
};

enum scene_wrap { SCENE_WRAP_REPEAT, SCENE_WRAP_CLAMP, SCENE_WRAP_MIRROR };

/* A use of a texture: sampled at A * (u, v) + b, v growing downwards from the top row. */
struct scene_texture_use {
    uint32_t texture;   /* index, or SCENE_NONE */
    uint32_t uv_set;    /* 0 or 1 */
    float transform[6]; /* 2x3 row-major; identity: 1 0 0 0 1 0 */
    enum scene_wrap wrap_u, wrap_v;
    bool nearest; /* else bilinear */
};

/* Texture slots of a material: which channels are read, and the material's value that they
   scale. */
enum scene_slot {
    SCENE_SLOT_DIFFUSE,        /* RGB sRGB, times diffuse; alpha times opacity */
    SCENE_SLOT_SPECULAR,       /* RGB linear (METAL_ROUGH: sRGB), times specular and reflection */
    SCENE_SLOT_EMISSION,       /* RGB sRGB, times emission */
    SCENE_SLOT_NORMAL,         /* tangent-space normal, OpenGL orientation (green up) */
    SCENE_SLOT_BUMP,           /* height in red */
    SCENE_SLOT_METAL_ROUGH,    /* green roughness, blue metallic; PHONG: red, times shininess */
    SCENE_SLOT_OPACITY,        /* red, or alpha where the picture has one, times opacity */
    SCENE_SLOT_TRANSMISSION,   /* red, times transmission */
    SCENE_SLOT_SPECULAR_LEVEL, /* METAL_ROUGH: alpha, times specular_level */
    SCENE_SLOT_COUNT
};

enum scene_alpha {
    SCENE_ALPHA_OPAQUE, /* opacity is ignored */
    SCENE_ALPHA_MASK,   /* hit where opacity >= alpha_cutoff */
    SCENE_ALPHA_BLEND,  /* passes 1 - opacity of the light straight through */
};

struct scene_material {
    char *name;
    struct scene_origin origin;
    whit_material_model model;
    int32_t illum;         /* MTL class 0..10; -1: not from an MTL */
    float ambient[3];      /* times the scene's ambient light */
    float diffuse[3];      /* albedo (PHONG), base colour (METAL_ROUGH), colour (UNLIT) */
    float specular[3];     /* highlight colour (PHONG); tint of F0 (METAL_ROUGH), default 1 */
    float shininess;       /* Blinn-Phong exponent (PHONG) */
    float emission[3];     /* radiance */
    float reflection[3];   /* mirror weight at normal incidence (PHONG) */
    float transmission[3]; /* weight and filter of the refracted ray; 0: opaque */
    float absorption[3];   /* Beer, per world unit, inside */
    float ior;             /* of the inside, default 1.5 */
    bool fresnel;          /* Fresnel's equations split light into reflected and refracted */
    bool thin_walled;      /* transmits without bending (glTF without a volume) */
    bool two_sided;        /* glTF doubleSided: an emitter lights both its sides */
    bool one_sided;        /* not seen from behind: glTF materials that are not doubleSided */
    bool shadow_catcher;   /* MTL illum 10 */
    uint32_t priority;     /* of the medium inside, 0..255: where media overlap, the one with the
                              highest priority counts, of equal ones the last entered; default 0 */
    float metallic, roughness; /* METAL_ROUGH */
    float specular_level;      /* METAL_ROUGH: KHR_materials_specular factor, default 1 */
    enum scene_alpha alpha;
    float opacity, alpha_cutoff;
    float normal_scale; /* of the normal map, or of bump height in UV-independent units */
    struct scene_texture_use textures[SCENE_SLOT_COUNT];
};

/* A named range of triangles: OBJ group, glTF primitive. For reports and picking. */
struct scene_group {
    char *name;
    uint32_t first_triangle, triangle_count;
};

/* Triangles, or spheres, in object space. Arrays are owned by the scene; optional ones may be NULL.
   A mesh with spheres has no vertices and no triangles; its primitives are the spheres. */
struct scene_mesh {
    char *name;
    uint32_t vertex_count, triangle_count, group_count;
    uint32_t sphere_count;
    float *spheres;      /* 4 per sphere: centre, radius > 0 */
    float *positions;    /* 3 per vertex */
    float *normals;      /* 3 per vertex; NULL: flat faces (scene_freeze drops needless normals) */
    float *uvs[2];       /* 2 per vertex (v downwards), or NULL */
    float *colors;       /* 4 per vertex linear RGBA, or NULL */
    float *tangents;     /* 4 per vertex, w = sign of the bitangent, or NULL */
    uint32_t *indices;   /* 3 per triangle */
    uint32_t *materials; /* 1 per primitive: index into the scene's materials */
    struct scene_group *groups;
    float lo[3], hi[3]; /* bounds, set by scene_freeze; lo > hi when empty */
};

static inline uint32_t scene_mesh_primitives(const struct scene_mesh *mesh)
{
    return mesh->sphere_count ? mesh->sphere_count : mesh->triangle_count;
}

/* The corners of a triangle in object space. */
static inline void scene_mesh_corners(const struct scene_mesh *mesh, uint32_t triangle,
                                      double out[3][3])
{
    const uint32_t *index = mesh->indices + 3 * (size_t)triangle;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            out[i][k] = (double)mesh->positions[3 * (size_t)index[i] + (size_t)k];
}

/* The same behind `matrix`. */
static inline void scene_mesh_placed_corners(const struct scene_mesh *mesh, uint32_t triangle,
                                             const struct affine *matrix, double out[3][3])
{
    scene_mesh_corners(mesh, triangle, out);
    for (int i = 0; i < 3; ++i)
        affine_point(matrix, out[i], out[i]);
}

/* One node of the tree. The parent's index is smaller than its own. */
struct scene_node {
    char *name;
    uint32_t parent; /* or SCENE_NONE */
    bool has_matrix; /* else translation, rotation, scale */
    struct affine matrix;
    double translation[3], rotation[4], scale[3]; /* quaternion x, y, z, w */
};

/* The matrix from the node to the space of its parent. */
static inline struct affine scene_node_matrix(const struct scene_node *node)
{
    return node->has_matrix ? node->matrix
                            : affine_from_trs(node->translation, node->rotation, node->scale);
}

enum scene_path { SCENE_PATH_TRANSLATION, SCENE_PATH_ROTATION, SCENE_PATH_SCALE };
/* LINEAR is slerp for rotations. CUBIC is glTF's Hermite spline, with tangents per second. */
enum scene_interpolation { SCENE_STEP, SCENE_LINEAR, SCENE_CUBIC };

/* Keys of one property of one node. Before the first key and after the last one the value is held.
 */
struct scene_channel {
    uint32_t node;
    enum scene_path path;
    enum scene_interpolation interpolation;
    uint32_t key_count;
    float *times_s; /* increasing */
    float *values;  /* 3 (4: rotation) per key; SCENE_CUBIC: in-tangent, value, out-tangent */
};

/* Numbers in `values` for each key. */
static inline uint32_t scene_channel_width(const struct scene_channel *channel)
{
    return (channel->path == SCENE_PATH_ROTATION ? 4u : 3u) *
           (channel->interpolation == SCENE_CUBIC ? 3u : 1u);
}

struct scene_instance {
    char *name;
    uint32_t mesh;
    uint32_t node;  /* or SCENE_NONE: identity */
    bool has_local; /* `local` applies below the node (EXT_mesh_gpu_instancing) */
    struct affine local;
};

/* `position` and `direction` are in the space of `node`. For flat emitters scene_freeze sets
   `direction` to the normal edge_u x edge_v. */
struct scene_light {
    char *name;
    struct scene_origin origin;
    whit_light_kind kind;
    uint32_t node; /* or SCENE_NONE: world */
    double position[3];
    double direction[3]; /* the way the light travels; unit */
    float color[3];      /* radiant intensity; irradiance when directional or without falloff */
    float stated[3];     /* `color` before scene_freeze scaled it; set by scene_freeze */
    bool falloff;        /* 1 / distance^2 */
    float range;         /* 0: without limit */
    /* SPOT: full light inside the inner cone, none outside the outer; 1 - cosine of the angles to
       the middle, as cosines of narrow cones are all alike in floats. */
    float versine_inner, versine_outer;
    /* RECTANGLE, TRIANGLE: edges from the corner `position`, in the space of `node`. Light goes out
       on the side of edge_u x edge_v. */
    double edge_u[3], edge_v[3];
    bool two_sided; /* flat emitters: light goes out on the other side too */
    bool made_by_whit;
};

/* RECTANGLE or TRIANGLE. */
static inline bool scene_light_is_flat(const struct scene_light *light)
{
    return light->kind == WHIT_LIGHT_RECTANGLE || light->kind == WHIT_LIGHT_TRIANGLE;
}

/* eye, target and up are in the space of `node`. */
struct scene_camera {
    char *name;
    whit_camera_kind kind;
    uint32_t node;
    double eye[3], target[3], up[3];
    float fov_y;              /* PERSPECTIVE: full vertical angle */
    float height;             /* ORTHOGRAPHIC: full height of the picture, world units */
    float lens_radius;        /* PERSPECTIVE: radius of a thin lens, world units; 0: pinhole */
    float focus_distance;     /* along the view, world units; 0: the distance of `target` */
    float aspect;             /* width / height the file asks for; 0: any */
    bool target_is_direction; /* the file says where the camera looks, but not how far */
    bool made_by_whit;
};

/* The light that arrives along rays that hit nothing. GRADIENT runs from horizon to zenith above
   and to ground below (+y is up); all three equal are a constant colour. MAP is equirectangular,
   row 0 up, its middle towards -z. */
struct scene_environment {
    whit_environment_kind kind;
    float zenith[3], horizon[3], ground[3];
    float scale[3]; /* factor on map or gradient */
    uint32_t width, height;
    float *rgb;    /* width * height * 3, or NULL */
    float rgb_max; /* of rgb; set by scene_freeze, kept by scene_drop_pictures */
    char *name;    /* file of the map */
    bool made_by_whit;
};

/* defaults.c: the sky where a file states none, and of colours that a file does not state. */
extern const struct scene_environment scene_sky;

/* names.c: names of the enumerators here and in whit_scene.h, by value. The lists of alpha, wrap
   and interpolation end with NULL. */
extern const char *const scene_model_names[],
    *const scene_alpha_names[], *const scene_wrap_names[],
                                    *const scene_interpolation_names[],
                                        *const scene_light_kind_names[],
                                            *const scene_camera_kind_names[],
                                                *const scene_environment_kind_names[];

enum scene_note_level { SCENE_NOTE_INFO, SCENE_NOTE_WARNING };

/* A message about something that a loader or scene_freeze noticed, dropped or made up. */
struct scene_note {
    enum scene_note_level level;
    char *text;
};

struct scene {
    whit_log log;
    char *name; /* path or label */
    struct scene_mesh *meshes;
    struct scene_node *nodes;
    struct scene_instance *instances;
    struct scene_material *materials;
    struct scene_texture *textures;
    struct scene_light *lights;
    struct scene_camera *cameras;
    struct scene_channel *channels;
    struct scene_note *notes;
    uint32_t mesh_count, node_count, instance_count, material_count, texture_count, light_count,
        camera_count, channel_count, note_count;
    uint32_t mesh_capacity, node_capacity, instance_capacity, material_capacity, texture_capacity,
        light_capacity, camera_capacity, channel_capacity, note_capacity;
    struct scene_environment environment;
    bool has_environment; /* a file states it; false: scene_freeze makes one */
    float ambient[3];     /* ambient light, times each material's `ambient` */
    bool has_ambient;     /* likewise */
    float contact; /* surfaces of two media that are at most this far apart, in world units, count
                      as one; 0: only surfaces that touch within rounding do */
    uint64_t triangle_total, sphere_total; /* over instances; set by scene_freeze */
    float time_begin_s, time_end_s;        /* first, last key; both 0: nothing moves */
    uint32_t textures_missing;             /* of texture_count: magenta in place of a picture */
    uint64_t file_bytes;                   /* of all files read */
    uint64_t memory_limit, memory_taken;   /* see afford.h; 0: no limit */
    struct key_table texture_keys;         /* texture index by name, or by a loader's own key */
    struct texture_ahead *ahead;           /* pictures decoded ahead, while a model is loaded */
    struct roots roots;                    /* folders in which the scene's files may name others */
    uint64_t hash;                         /* of everything above; set by scene_freeze */
    /* The part that whit's own camera shows, if it is the scene's; lo > hi: it shows everything. */
    double shown_lo[3], shown_hi[3];
    bool is_model; /* by another program: may need more lights */
    whit_lights lights_wanted;
    double exposure_ev; /* suits what a model's first camera sees; set by scene_freeze */
    bool lacks_memory;  /* a name or a note could not be allocated: scene_freeze will fail */
    bool frozen;
    bool pictures_dropped; /* by scene_drop_pictures */
};

/* An empty scene, in which only empty arrays are NULL. NULL when memory runs out. */
struct scene *scene_create(const whit_log *log, const char *name);
void scene_destroy(struct scene *scene);
/* Removes all lights; only before scene_freeze. */
void scene_drop_lights(struct scene *scene);
/* Frees the texels of textures and environment, the only change that a frozen scene allows. Call it
   when every renderer that will be made from the scene has uploaded them. */
void scene_drop_pictures(struct scene *scene);

/* Fill *out with defaults: a grey diffuse PHONG material, opaque, without textures; a texture use
   without a texture; a node with the identity. `name` is copied. */
void scene_material_init(struct scene_material *out, const char *name);
void scene_texture_use_init(struct scene_texture_use *out);
/* The offset of a texture along u (axis 0) or v (axis 1), without whole pairs of its periods, which
   would cost coordinates their digits. */
float scene_texture_offset(const struct scene_texture_use *use, int axis);
/* Whether colours in textures of the slot are sRGB. Other slots have numbers, and alpha always is a
   number. */
bool scene_slot_is_srgb(enum scene_slot slot, whit_material_model model);
void scene_node_init(struct scene_node *out, const char *name, uint32_t parent);

/* Each takes ownership of what its argument points to (on failure too) and gives the new index, or
   SCENE_NONE when memory runs out. */
uint32_t scene_add_mesh(struct scene *scene, struct scene_mesh mesh);
uint32_t scene_add_node(struct scene *scene, struct scene_node node);
uint32_t scene_add_instance(struct scene *scene, struct scene_instance instance);
uint32_t scene_add_material(struct scene *scene, struct scene_material material);
uint32_t scene_add_texture(struct scene *scene, struct scene_texture texture);
/* The first texture that was added under `name`; false: none was. */
bool scene_find_texture(const struct scene *scene, const char *name, uint32_t *index);
uint32_t scene_add_light(struct scene *scene, struct scene_light light);
uint32_t scene_add_camera(struct scene *scene, struct scene_camera camera);
uint32_t scene_add_channel(struct scene *scene, struct scene_channel channel);
/* Whether scene_freeze will keep the channel: its node is there, its times increase, and times and
   values are finite. */
bool scene_can_play(const struct scene *scene, const struct scene_channel *channel);
/* A copy of `text` for one of the scene's records. NULL where `text` is NULL or memory ran out; in
   the latter case scene_freeze will fail. */
char *scene_text(struct scene *scene, const char *text);
/* Adds a note, which is kept for `whit scene` and logged at once. */
void scene_note(struct scene *scene, enum scene_note_level level, const char *format, ...)
    WHIT_PRINTF(3, 4);

/* Sets the cones of a spot light by their angles to its middle, in radians. */
void scene_light_cones(struct scene_light *light, double inner, double outer);
/* The share of its light that a light with a range has at this distance, by KHR_lights_punctual:
   1 - (distance / range)^4, 0 from the range on. */
double scene_light_fade(const struct scene_light *light, double distance);
/* How much the versine grows between the cones of a spot light; above 0, also where they are
   equal. */
double scene_light_cone_width(const struct scene_light *light);

/* Unit vectors of a camera whose `up` is not along its view. */
void scene_camera_axes(const struct scene_camera *camera, double forward[3], double right[3],
                       double up[3]);

void scene_mesh_finish(struct scene_mesh *mesh);
/* Makes *out a deep copy; false, with *out empty, where memory ran out. */
bool scene_mesh_copy(const struct scene_mesh *mesh, struct scene_mesh *out);
void scene_material_finish(struct scene_material *material);

/* Checks everything, once: indices in range (else WHIT_ERROR_INPUT), vertices finite and below
   1e18, textures and nodes in order, transforms invertible (a singular instance is dropped by
   name). Bad and zero-area triangles are dropped and counted in notes. Adds a camera, a light and
   an environment where the file has none, with a note; sets bounds, totals and hash. */
WHIT_CHECK whit_result scene_freeze(struct scene *scene);

/* The scene at one time: everything that moves, in world space. */
struct scene_pose {
    double time_s;
    uint32_t instance_count, light_count, camera_count;
    struct affine *instances;     /* object to world */
    struct scene_light *lights;   /* node resolved; name and origin borrowed from the scene */
    struct scene_camera *cameras; /* as lights */
    double lo[3], hi[3];          /* bounds of all instances; lo > hi when empty */
};

/* Effects that a scene may call for. `whit scene` lists them with reasons, and kernels are
   specialized to them. */
enum scene_effect {
    SCENE_EFFECT_SHADOWS,
    SCENE_EFFECT_REFLECTION,
    SCENE_EFFECT_REFRACTION,
    SCENE_EFFECT_FRESNEL,
    SCENE_EFFECT_ABSORPTION,
    SCENE_EFFECT_CUTOUTS, /* alpha mask or blend */
    SCENE_EFFECT_TEXTURES,
    SCENE_EFFECT_NORMAL_MAPS, /* and bump maps */
    SCENE_EFFECT_EMISSION,
    SCENE_EFFECT_HIGHLIGHTS,
    SCENE_EFFECT_POINT_LIGHTS,
    SCENE_EFFECT_DIRECTIONAL_LIGHTS,
    SCENE_EFFECT_SPOT_LIGHTS,
    SCENE_EFFECT_AREA_LIGHTS, /* emissive surfaces, sampled as lights */
    SCENE_EFFECT_ENVIRONMENT_MAP,
    SCENE_EFFECT_SMOOTH_NORMALS,
    SCENE_EFFECT_VERTEX_COLORS,
    SCENE_EFFECT_METAL_ROUGH,
    SCENE_EFFECT_INSTANCES, /* more than one instance, or one that is moved */
    SCENE_EFFECT_ORTHOGRAPHIC,
    SCENE_EFFECT_LENS, /* depth of field */
    SCENE_EFFECT_PANORAMA,
    SCENE_EFFECT_MEDIA, /* refraction with an inside: media, nested by priority */
    SCENE_EFFECT_SPHERES,
    SCENE_EFFECT_TINTED_SHADOWS, /* light passes through glass and blended surfaces */
    SCENE_EFFECT_CULLING,        /* one-sided surfaces */
    SCENE_EFFECT_CATCHERS,       /* MTL illum 10 */
    SCENE_EFFECT_TERMINATOR,     /* smooth normals under lights that cast shadows */
    SCENE_EFFECT_COUNT
};

/* Ways in which textures are sampled. */
enum {
    SCENE_SAMPLING_FILTERED = 1,
    SCENE_SAMPLING_REPEAT = 2, /* from here on: wrap modes, in the order of SCENE_WRAP_* */
    SCENE_SAMPLING_CLAMP = 4,
    SCENE_SAMPLING_MIRROR = 8,
    SCENE_SAMPLING_SRGB = 16,
};

struct scene_effects {
    bool called[SCENE_EFFECT_COUNT];
    char reasons[SCENE_EFFECT_COUNT][160]; /* "material `glass`, illum 7, box.mtl:41" */
    uint32_t texture_slots;                /* bits 1 << SCENE_SLOT_* of slots with a texture */
    uint32_t sampling;                     /* SCENE_SAMPLING_* bits of all these textures */
    bool lit;                              /* some material depends on lights */
    bool on_triangles, on_spheres;         /* primitives of this kind use the materials */
};

enum scene_materials {
    SCENE_MATERIALS_ALL,
    SCENE_MATERIALS_OPAQUE, /* without transmission */
    SCENE_MATERIALS_GLASS,  /* with transmission */
};

#endif
