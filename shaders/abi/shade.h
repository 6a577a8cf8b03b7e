/* Data that shading reads, and the state of a pixel's ray tree. One buffer, the shading rows, holds
   materials, texture uses, lights and data per triangle; gpu_frame names the first row of each. */
#ifndef ABI_SHADE_H
#define ABI_SHADE_H

#include "base.h"

/* Rows of 16 bytes. */
#define MATERIAL_ROWS 10u
#define TEXTURE_ROWS  3u
#define LIGHT_ROWS    6u
/* Three normals of three floats, zeros where the mesh is flat; w of each row is the material. Where
   all meshes are flat there is only one row, for its w. */
#define TRIANGLE_SHADE_ROWS 3u
#define TRIANGLE_FLAT_ROWS  1u
/* u and v of three vertices, then two unused words. */
#define TRIANGLE_UV_ROWS 2u
/* Three colours of four 16-bit channels, then two unused words. */
#define TRIANGLE_COLOR_ROWS 2u

#define TEXTURE_NONE 0xffffffffu

#define MATERIAL_MODEL_PHONG       0u
#define MATERIAL_MODEL_METAL_ROUGH 1u
#define MATERIAL_MODEL_UNLIT       2u

#define MATERIAL_FRESNEL        1u
#define MATERIAL_THIN           2u
#define MATERIAL_MASK           4u
#define MATERIAL_BLEND          8u
#define MATERIAL_OPACITY_ALPHA  16u /* opacity is the alpha of its texture, not the red */
#define MATERIAL_CATCHER        32u /* shows nothing but the shadows that fall on it */
#define MATERIAL_PRIORITY_SHIFT 8u  /* bits 8..15: of the medium inside */

/* See struct scene_material for meaning and units. */
struct gpu_material {
    gpu_vec3 diffuse;
    gpu_uint model; /* MATERIAL_MODEL_* */
    gpu_vec3 ambient;
    gpu_float shininess;
    gpu_vec3 specular;
    gpu_float ior;
    gpu_vec3 emission;
    gpu_uint flags; /* MATERIAL_* */
    gpu_vec3 reflection;
    gpu_float roughness;
    gpu_vec3 transmission;
    gpu_float metallic;
    gpu_vec3 absorption;
    gpu_float opacity;
    gpu_float normal_scale;
    gpu_float alpha_cutoff;
    gpu_float specular_level;
    gpu_uint tex_specular_level;
    gpu_uint tex_diffuse; /* index of a gpu_texture, or TEXTURE_NONE */
    gpu_uint tex_specular;
    gpu_uint tex_emission;
    gpu_uint tex_normal;
    gpu_uint tex_bump;
    gpu_uint tex_metal_rough;
    gpu_uint tex_opacity;
    gpu_uint tex_transmission;
};
GPU_ASSERT_SIZE(gpu_material, 160)

#define WRAP_REPEAT 0u
#define WRAP_CLAMP  1u
#define WRAP_MIRROR 2u

/* Texels are one word each, 8-bit RGBA as in the file. In front of them stand TEXEL_TABLE_WORDS:
   the linear values (float bits) of the 256 sRGB codes, then the LEVEL_PIECES pieces of mip_level,
   two floats each. A texture with mipmap levels (host/picture/mipmap.h) has level 0 first, then a
   word for each other level, the place of its first texel, then these levels. */
#define TEXEL_TABLE_WORDS 288u
#define TEXEL_CODES       256u
#define LEVEL_PIECES      16u

#define TEXTURE_LEVELS_SHIFT 4u

/* A use of a texture by a material. */
struct gpu_texture {
    gpu_vec4 matrix; /* uv' = (x u + y v, z u + w v) + offset */
    gpu_vec2 offset;
    gpu_uint first; /* word of its first texel */
    gpu_uint size;  /* width | height << 16 */
    gpu_uint wrap;  /* WRAP_* of u | of v << 2 | levels besides level 0 << TEXTURE_LEVELS_SHIFT */
    gpu_uint nearest;
    gpu_uint uv_set;
    gpu_uint srgb; /* 1: red, green and blue are decoded by the table */
};
GPU_ASSERT_SIZE(gpu_texture, 48)

#define LIGHT_POINT       0u
#define LIGHT_DIRECTIONAL 1u
#define LIGHT_SPOT        2u
#define LIGHT_AREA_SAMPLE 3u /* Lambertian emitter around `direction` */
/* Flat emitters of radiance `color`: corner `position`, edges `edge_u` and `edge_v`, unit normal
   `direction`. Each takes frame.light_samples iterations of the loop over lights. */
#define LIGHT_RECTANGLE 4u
#define LIGHT_TRIANGLE  5u
#define LIGHT_FLAT_BITS (1u << LIGHT_RECTANGLE | 1u << LIGHT_TRIANGLE)

/* A light, in world space. */
/* A shadow ray ends before its light by at most this share of its length; and before an emitter by
   at least this share of the coordinates of its ends, divided by the cosine at the emitter. */
#define LIGHT_END_SHARE_MAX (1.0 / 4096.0)
#define LIGHT_END_ROUNDING  (1.0 / 65536.0)
struct gpu_light {
    gpu_vec3 position;
    gpu_uint kind;
    gpu_vec3 direction; /* unit, the direction in which the light travels */
    gpu_float per_range; /* 1 / range; 0: no limit */
    gpu_vec3 color;
    gpu_uint falloff; /* 1: 1 / distance^2 */
    gpu_float spot_edge;  /* 1 - cosine of a spot's outer cone */
    gpu_float spot_slope; /* 1 / (that - the same of its inner cone) */
    gpu_uint two_sided; /* of emitters */
    gpu_float end; /* where shadow rays end: see accel_light_end */
    gpu_vec3 edge_u;
    gpu_float area_share; /* of a flat emitter: area / (pi * light_samples) */
    gpu_vec3 edge_v;
    gpu_uint pad1;
};
GPU_ASSERT_SIZE(gpu_light, 96)

/* Data that all pixels of a picture share. A camera ray starts at `eye` (orthographic: moved in the
   picture plane) and goes along forward + x * right + y * up, with x and y in -1..1. For a panorama
   all three vectors have unit length, x is the longitude in units of pi, and y the latitude in
   units of pi / 2. */
struct gpu_frame {
    gpu_vec3 eye;
    gpu_uint width;
    gpu_vec3 right;
    gpu_uint height;
    gpu_vec3 up;
    gpu_uint light_count;
    gpu_vec3 forward;
    gpu_uint environment_size; /* side of the octahedral map; 0: gradient */
    gpu_vec3 zenith;
    gpu_uint root; /* ref where traversal starts */
    gpu_vec3 horizon;
    gpu_uint shade_base; /* of the only mesh, without instances */
    gpu_vec3 ground;
    gpu_uint depth; /* most bounces */
    gpu_vec3 ambient;
    gpu_uint use_row; /* of the shading rows: first texture use; materials are at 0 */
    gpu_float texel_area; /* area of a texel for the middle pixel, across its ray at distance 1 from
                             the eye: camera_pixel_area / MIPMAP_PIXEL_TEXELS */
    gpu_float bailout;   /* rays that can add less than this to a pixel are not traced */
    gpu_uint light_row;  /* first row of the lights */
    gpu_uint triangle_row; /* of triangle 0: TRIANGLE_SHADE_ROWS or TRIANGLE_FLAT_ROWS each */
    gpu_uint uv0_row;   /* of triangle 0, uv set 0: TRIANGLE_UV_ROWS each */
    gpu_uint uv1_row;   /* of uv set 1; uv0_row where there is none */
    gpu_uint color_row; /* of triangle 0: TRIANGLE_COLOR_ROWS each */
    gpu_float contact;  /* surfaces of two media within this distance touch */
    gpu_uint eye_media0, eye_media1; /* media that camera rays start in, see MEDIA_MAX */
    gpu_uint eye_media2, eye_media3;
    gpu_float lens_radius;    /* CAMERA_LENS, world units: lens_xy is computed from it */
    gpu_float focus_distance; /* along `forward` */
    gpu_uint light_samples;   /* of a flat emitter: 1, 4, 16 or 64; 1 where there is none */
    gpu_uint nested;          /* 1: media of the scene may meet or overlap */
    gpu_float inv_width, inv_height; /* 1 / width, 1 / height: so that no kernel divides by them */
    gpu_uint root8;     /* root of the tree with eight children per node, see accel_bvh8 */
    gpu_uint shape_material; /* of a user's shape; SHAPE_IS_GLASS: light passes through it */
    gpu_float shape_error; /* how far from the user's shape answers may be, world units */
    gpu_uint slot_shift; /* where the pixel's slot starts in the state of a queued ray */
    gpu_float bailout_shadow; /* shadow rays that can add no more than this share of their light are
                                 not traced */
    gpu_uint iterations; /* 2: of a loop whose length compilers must not know, in report_hooks() */
    gpu_vec3 scene_center; /* a sphere around all instances */
    gpu_float scene_radius;
};
GPU_ASSERT_SIZE(gpu_frame, 240)

/* The fields of gpu_frame that differ between the views of a picture (SPEC_VIEWS). Its views lie
   one below the other, each in as many rows of 8x8 pixel blocks as it needs. */
struct gpu_view {
    gpu_vec3 eye;
    gpu_float texel_area;
    gpu_vec3 right;
    gpu_float focus_distance;
    gpu_vec3 up;
    gpu_uint camera; /* CAMERA_* */
    gpu_vec3 forward;
    gpu_float lens_radius; /* lens_xy is computed from it */
    gpu_uint eye_media0, eye_media1, eye_media2, eye_media3;
    gpu_vec2 lens_xy; /* of the current sample, as in gpu_chunk */
    gpu_uint pad0, pad1;
};
GPU_ASSERT_SIZE(gpu_view, 96)

#define SHAPE_IS_GLASS 0x80000000u

/* Behind the frame stand the values of the sliders of a user's file, as floats. */
#define SLIDERS_MAX 64u

/* Each test of a user's file runs for TEST_SEEDS seeds, which are pixels in rows of TEST_ROW. */
#define TEST_SEEDS 4096u
#define TEST_ROW   64u

/* The media that a ray is in, two to a word, the low half first. Each is material + 1; 0: no more
   follow. Lowest priority first, and of equal priorities the one entered first: the last entry is
   the medium that counts. There is one for each ray. */
#define MEDIA_MAX 8u

/* The state of a queued ray: number of surfaces passed unseen in the low bits, above them the
   bounces so far, and above these, from frame.slot_shift on, the slot of its pixel. */
#define STATE_BOUNCES_SHIFT 8u

/* Push constants of the stages: a chunk is a run of 8x8 pixel blocks of a band of rows, or of blocks
   of 64 pixels of a list. A slot is the place of a pixel in its chunk. */
struct gpu_chunk {
    gpu_uint first_block;
    gpu_uint block_count;
    gpu_uint band_y;    /* first row of the band that the pixel buffers hold */
    gpu_uint band_rows;
    gpu_vec2 sample_xy; /* from the middle of the pixel, in half pixels: -1..1 */
    gpu_uint sample_index; /* in the sequence */
    gpu_float sample_weight;
    gpu_vec2 lens_xy; /* CAMERA_LENS: the ray starts at eye + focus_distance * (x * right +
                         y * up) */
    gpu_uint listed;  /* pixels of the list; 0: no list */
    gpu_uint deferred; /* 1: the dispatch works on the list of deferred rays */
    gpu_uint light;   /* that the dispatch is for; in resolve.comp: the generation that must be
                         empty, or GENERATION_NONE */
    gpu_uint generation;                 /* of the dispatch's rays */
    gpu_uint ray_capacity, lit_capacity; /* of the queues between stages */
    gpu_uint list;                       /* LIST_* that the dispatch works on */
    gpu_uint light_index; /* in the sequence: the sample's first point on flat emitters */
    gpu_uint summed, samples; /* of a pixel in this pass: samples summed already, and all */
    gpu_uint sums_row, sums_step; /* in the pixel buffer: first partial sum of the tile's slot 0,
                                     step to its next */
    gpu_uint blocks_x;  /* blocks in a row of the drawn part */
    gpu_uint block_row; /* first_block / blocks_x, set by render_push_chunk() */
    gpu_uint lattice;  /* LATTICE_*: which of the picture's pixels are drawn */
    gpu_uint before_post; /* HOOK_POST: in the pixel buffer, first pixel as it is before post() */
    gpu_uint aovs_alone;  /* 1: writes the aovs of pixels, no colours */
    gpu_uint tile_slot;   /* slot 0 among those of the tile, of which the chunk may be a part */
    gpu_uint lights;      /* how many the dispatch adds, from `light` on */
    gpu_uint pad;
};
GPU_ASSERT_SIZE(gpu_chunk, 120)

#define GENERATION_NONE 0xffffffffu

/* A listed pixel: x in the low bits, y from this bit on. */
#define LISTED_Y_SHIFT 16u

/* The pixels that are drawn: log2 of the step between pixels of a row, in the low bits; log2 of the
   step between rows; x and y of the first pixel. 0: all pixels. */
#define LATTICE_SHIFT_MASK  15u
#define LATTICE_ROWS_SHIFT  4u
#define LATTICE_X_SHIFT     8u
#define LATTICE_Y_SHIFT     16u
#define LATTICE_FIRST_MASK  255u

/* ---- The rays of one pixel (SPEC_PROBE) ---- */

#define PROBE_RAYS_MAX 16383u /* records; as the number of a record: none */

/* Counts in front of the records. */
struct gpu_probe {
    gpu_uint rays, others; /* rays traced; shadow rays and rays not traced. Both may exceed the
                              number of records */
    gpu_uint pad0, pad1;
};
GPU_ASSERT_SIZE(gpu_probe, 16)

/* gpu_probe_ray.kind: RAY_*, and these bits, of which two say why a ray goes on in the direction of
   the one before it. */
#define PROBE_KIND_MASK 3u
#define PROBE_STRAIGHT  4u /* it goes on behind a surface that blends, or a shadow catcher */
#define PROBE_THROUGH   8u /* it goes on behind a surface with the same medium on both sides */
#define PROBE_INSIDE    16u /* it hits its surface from inside */
#define PROBE_CATCHER   32u /* until the host has read it: `added` is the share that a shadow
                               catcher shows */

/* gpu_probe_ray.end */
#define PROBE_DEFERRED    0u /* deferred: its end is not known yet */
#define PROBE_MISSED   1u
#define PROBE_ABSORBED 2u /* it leaves the scene in a medium that absorbs nearly all of its light */
#define PROBE_HIT      3u
#define PROBE_DEPTH    4u /* not traced: --depth */
#define PROBE_BAILOUT  5u /* not traced: --bailout */
#define PROBE_REACHED  6u /* shadow rays: it reached the light; `added` is the share that passes */
#define PROBE_BLOCKED  7u

/* A ray of the pixel's first sample. Rays that were not traced have no origin. */
struct gpu_probe_ray {
    gpu_vec3 origin;
    gpu_uint kind;
    gpu_vec3 dir; /* unit */
    gpu_uint end;
    gpu_vec3 weight; /* of the light it brings; shadow rays: of the surface that they start from */
    gpu_uint parent; /* record of the ray it comes from; PROBE_RAYS_MAX: none, a camera ray */
    gpu_vec3 added;  /* radiance added to the sample; shadow rays: the share of the light that
                        passes */
    gpu_float t_max;
    gpu_vec3 point; /* where it hit `primitive`, world space */
    gpu_float t;    /* NUMERICS_EXACT: the key */
    gpu_vec3 normal; /* unit, interpolated, on the ray's side; without bump maps */
    gpu_uint material;
    gpu_float u, v;
    gpu_uint primitive, instance; /* HIT_NONE: none, or not known (blocked, without trees) */
    gpu_uint skip_primitive, skip_instance;
    gpu_uint medium; /* material + 1 of the medium it goes through; 0: air */
    gpu_uint light_sample; /* shadow rays: light * light_samples + sample */
};
GPU_ASSERT_SIZE(gpu_probe_ray, 128)

/* ---- What dbg(x) of a user's functions is, for that pixel ---- */

#define DBG_CALLS  64u /* calls of dbg() in a file */
#define DBG_VALUES 64u /* kept for each call; further ones are only counted */

/* gpu_dbg.type: one of these, plus 1, 2 or 3 for a vector of two, three or four */
#define DBG_FLOAT 0u
#define DBG_INT   4u
#define DBG_UINT  8u
#define DBG_BOOL  12u

struct gpu_dbg {
    gpu_uvec4 bits; /* of each component; a bool has 0 or 1 */
    gpu_uint id;    /* of the ray that the function is called for */
    gpu_uint order; /* orders the records of one ray: the kernel from bit 24 up, below it the number
                       of earlier records */
    gpu_uint generation;
    gpu_uint type;
};
GPU_ASSERT_SIZE(gpu_dbg, 32)

#endif
