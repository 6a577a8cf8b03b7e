/* Part of whit.h: handles, and where messages go. */
#ifndef WHIT_TYPES_H
#define WHIT_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "whit_base.h"

WHIT_C_BEGIN

/* The caller owns everything that libwhit hands out. A handle is released by its own function, such
   as whit_scene_destroy; a block of infos, boxes, rays or bytes by whit_memory_destroy. All of
   these functions take NULL. */
void whit_memory_destroy(void *memory);

#define WHIT_NONE           UINT32_MAX /* no primitive, no instance: a miss */
/* The instance of hits on the shape of a user's intersect(); their primitive is 0. */
#define WHIT_INSTANCE_SHAPE UINT32_C(0x7fffffff)
/* The most images beside the colour that a file may have, and aovs of a shader. */
#define WHIT_LAYERS_MAX     64

typedef struct whit_scene whit_scene;       /* geometry, materials, lights, cameras */
typedef struct whit_accel whit_accel;       /* trees over one scene, on the CPU */
typedef struct whit_device whit_device;     /* one Vulkan device */
typedef struct whit_renderer whit_renderer; /* an accel on a device, with settings */
typedef struct whit_image whit_image;       /* pixels in host memory */
typedef struct whit_shader whit_shader;     /* functions in the place of whit's own */

typedef enum whit_camera_kind {
    WHIT_CAMERA_PERSPECTIVE = 0,
    WHIT_CAMERA_ORTHOGRAPHIC,
    WHIT_CAMERA_PANORAMA, /* equirectangular: the middle looks at the target, the picture covers 360
                             x 180 degrees */
} whit_camera_kind;
/* "perspective", "orthographic", "panorama" */
const char *whit_camera_kind_name(whit_camera_kind kind);

/* The camera of a picture. Zeroed: the first camera of the scene. */
typedef struct whit_camera {
    const char *name; /* of a camera of the scene, or its index as text where no camera has that
                         name */
    bool own;         /* true: the fields below define the camera and `name` is not read */
    whit_camera_kind kind;
    double eye[3], target[3], up[3]; /* world space; finite, also as floats */
    double fov_y_degrees;            /* PERSPECTIVE: vertical, between 0 and 180 */
    double height;                   /* ORTHOGRAPHIC: of the picture, world units; above 0 */
    double lens_radius;              /* PERSPECTIVE: radius of a thin lens, world units, at most
                                        2^60 times focus_distance; 0: a pinhole */
    double focus_distance;           /* with a lens: distance of focus along the view direction,
                                        world units; 0: that of the target */
} whit_camera;

/* The trees of a scene: a single one over the triangles of all instances, with each vertex
   transformed to world space in double and rounded once, or one for each mesh and one over
   instances. */
typedef enum whit_instances {
    WHIT_INSTANCES_AUTO = 0, /* a single tree where whit_scene_info.one_tree is true */
    WHIT_INSTANCES_ON,       /* a tree for each mesh and one over instances */
    WHIT_INSTANCES_OFF,      /* always a single tree */
} whit_instances;

/* The use of packets for camera rays and for the shadow rays from their hits. */
typedef enum whit_packets {
    WHIT_PACKETS_AUTO =
        0,           /* where packets are faster: on lavapipe, in a single large tree, and with
                        enough rays to pay for kernels that take longer to make, or with
                        whit_renderer_params.compile_async, whose kernels draw many pictures */
    WHIT_PACKETS_ON, /* on all devices and for all trees that can; see whit_stats.packets */
    WHIT_PACKETS_OFF,
} whit_packets;

/* The number of kernels that draw a picture. One for several stages and materials is compiled
   sooner, one for each draws faster. */
typedef enum whit_classes {
    WHIT_CLASSES_AUTO = 0, /* by the number of rays of the picture that the renderer is created
                              for */
    WHIT_CLASSES_ONE,      /* one kernel for all materials, and one for rays of all generations */
    WHIT_CLASSES_MANY,
} whit_classes;

WHIT_C_END

#endif
