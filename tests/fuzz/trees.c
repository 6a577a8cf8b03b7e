#include "trees.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/random_fixture.h"
#include "fuzz.h"
#include "scene/shapes.h"
#include "twin/traverse.h"

static uint32_t add_mesh(struct scene *scene, whit_result result, struct scene_mesh *mesh)
{
    fuzz_check(result == WHIT_OK, "no shape");
    uint32_t index = scene_add_mesh(scene, *mesh);
    fuzz_check(index != SCENE_NONE, "out of memory");
    return index;
}

static void add_instance(struct scene *scene, uint32_t mesh, const double scale[3], double shift)
{
    struct scene_node node;
    scene_node_init(&node, "node", SCENE_NONE);
    for (int i = 0; i < 3; i++) {
        node.scale[i] = scale[i];
        node.translation[i] = shift * (i + 1);
    }
    node.rotation[0] = sin(shift);
    node.rotation[3] = cos(shift);
    struct scene_instance instance = {.mesh = mesh, .node = scene_add_node(scene, node)};
    fuzz_check(scene_add_instance(scene, instance) != SCENE_NONE, "out of memory");
}

static void add_plain(struct scene *scene, uint32_t mesh)
{
    struct scene_instance instance = {.mesh = mesh, .node = SCENE_NONE};
    fuzz_check(scene_add_instance(scene, instance) != SCENE_NONE, "out of memory");
}

static void add_needles(struct scene *scene)
{
    enum { COUNT = 24 };
    struct scene_mesh mesh = {.vertex_count = 3 * COUNT, .triangle_count = COUNT};
    mesh.positions = malloc(9 * COUNT * sizeof(float));
    mesh.indices = malloc(3 * COUNT * sizeof(uint32_t));
    mesh.materials = calloc(COUNT, sizeof(uint32_t));
    fuzz_check(mesh.positions && mesh.indices && mesh.materials, "out of memory");
    random_state = 7;
    for (uint32_t i = 0; i < 9 * COUNT; i++) {
        mesh.positions[i] = random_float(&random_state);
        if (i % 9 >= 6)
            mesh.positions[i] = mesh.positions[i - 3] + 0.01f * mesh.positions[i];
    }
    for (uint32_t i = 0; i < 3 * COUNT; i++)
        mesh.indices[i] = i;
    add_plain(scene, add_mesh(scene, WHIT_OK, &mesh));
}

static void add_balls(struct scene *scene)
{
    static const double balls[] = {0, 0, 0, 1,    1.5, 0,   0, 0.5, 1.5, 0.5,  0,  0.5,
                                   0, 2, 0, 1e-3, 0,   0.1, 0, 3,   100, -100, 50, 40};
    struct scene_mesh mesh;
    whit_result result = shape_balls(balls, sizeof balls / sizeof *balls / 4, &mesh);
    add_plain(scene, add_mesh(scene, result, &mesh));
}

static void add_instances(struct scene *scene)
{
    struct scene_mesh mesh;
    whit_result result = shape_torus(1.0, 0.3, 8, 5, &mesh);
    uint32_t torus = add_mesh(scene, result, &mesh);
    result = shape_box((const double[]){1, 2, 3}, &mesh);
    uint32_t box = add_mesh(scene, result, &mesh);
    add_instance(scene, torus, (const double[]){1, 1, 1}, 0.25);
    add_instance(scene, box, (const double[]){1, 0.01, 2}, -1.0);
    add_instance(scene, torus, (const double[]){-1, 1, 1}, 3.0);
}

struct scene *fuzz_scene_make(enum fuzz_scene kind)
{
    struct scene *scene = scene_create(&fuzz_log, "fuzz");
    struct scene_material material;
    struct scene_mesh mesh;
    fuzz_check(scene, "out of memory");
    scene_material_init(&material, "grey");
    fuzz_check(scene_add_material(scene, material) != SCENE_NONE, "out of memory");
    if (kind == FUZZ_SPHERE) {
        whit_result result = shape_sphere(1.0, 6, 4, &mesh);
        add_plain(scene, add_mesh(scene, result, &mesh));
    } else if (kind == FUZZ_NEEDLES) {
        add_needles(scene);
    } else if (kind == FUZZ_BALLS) {
        add_balls(scene);
    } else {
        add_instances(scene);
    }
    fuzz_check(scene_freeze(scene) == WHIT_OK, "a scene that cannot be frozen");
    return scene;
}

whit_accel_params fuzz_tree_params(uint32_t which)
{
    static const whit_accel_params params[] = {
        {.build = WHIT_BUILD_BINNED, .leaf_limit = 2},
        {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 1},
        {.build = WHIT_BUILD_SWEEP, .optimize = true},
        {.build = WHIT_BUILD_SPATIAL,
         .spatial_alpha = 1e-9f,
         .spatial_budget = 2.0f,
         .leaf_limit = 1},
        {.build = WHIT_BUILD_NONE},
    };
    whit_accel_params out = params[which % (sizeof params / sizeof *params)];
    out.threads = 1;
    return out;
}

/* docs/numerics-method.md, "Bad rays": they hit nothing. */
static bool is_bad(const struct gpu_ray *ray)
{
    bool bad = !(ray->t_min <= ray->t_max || isnan(ray->t_max)) || isnan(ray->t_min);
    for (int i = 0; i < 3; i++)
        bad |= !isfinite(ray->origin[i]) || !isfinite(ray->dir[i]);
    return bad || (ray->dir[0] == 0.0f && ray->dir[1] == 0.0f && ray->dir[2] == 0.0f);
}

/* Neither products with the matrices of instances nor quotients leave the range of floats: beyond
   it a tree may lose what brute force finds. */
static bool is_ordinary(const struct gpu_ray *ray)
{
    bool ordinary = true;
    for (int i = 0; i < 3; i++) {
        float origin = fabsf(ray->origin[i]), dir = fabsf(ray->dir[i]);
        ordinary &= origin <= 1e12f && (dir == 0.0f || (dir >= 1e-12f && dir <= 1e12f));
    }
    return ordinary;
}

void fuzz_check_ray(const struct accel *accel, const struct gpu_ray *ray)
{
    struct gpu_hit brute;
    bool bad = is_bad(ray), same = bad || is_ordinary(ray);
    struct traverse_params params = {.brute = true};
    uint32_t status = 0;
    traverse_ray(accel, &params, ray, &brute, NULL, &status);
    fuzz_check(!bad || brute.primitive == HIT_NONE, "a bad ray hits primitive %u at %a",
               brute.primitive, (double)brute.t);
    for (uint32_t order = ORDER_DISTANCE; order <= ORDER_BASIC; order++) {
        struct gpu_hit closest, any;
        params = (struct traverse_params){.order = order};
        traverse_ray(accel, &params, ray, &closest, NULL, &status);
        params.any = true;
        traverse_ray(accel, &params, ray, &any, NULL, &status);
        fuzz_check(status == 0, "status %#x", status);
        if (!same)
            continue;
        fuzz_check(closest.primitive == brute.primitive && closest.instance == brute.instance,
                   "order %u: primitive %u of instance %u at %a, brute force %u of %u at %a", order,
                   closest.primitive, closest.instance, (double)closest.t, brute.primitive,
                   brute.instance, (double)brute.t);
        fuzz_check(memcmp(&closest, &brute, sizeof brute) == 0, "order %u: t %a, brute force %a",
                   order, (double)closest.t, (double)brute.t);
        fuzz_check((any.primitive == HIT_NONE) == (brute.primitive == HIT_NONE),
                   "order %u: any hit: %u, brute force %u", order, any.primitive, brute.primitive);
    }
}

void fuzz_check_rays(const struct accel *accel)
{
    enum { COUNT = 24 };
    random_state = 1;
    for (uint32_t i = 0; i < COUNT; i++) {
        struct gpu_ray ray = {.t_max = INFINITY};
        for (uint32_t k = 0; k < 3; k++) {
            ray.origin[k] = 6.0f * random_float(&random_state) - 3.0f;
            float target = i % 3 ? random_float(&random_state)
                                 : 0.5f * (float)random_below(&random_state, 5) - 1.0f;
            ray.dir[k] = i % 4 == 0 && k != i % 3 ? 0.0f : target - ray.origin[k];
        }
        fuzz_check_ray(accel, &ray);
    }
}
