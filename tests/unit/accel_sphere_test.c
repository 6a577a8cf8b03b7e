/* Rays that start on a sphere and hit it again, and spheres in one tree for all instances.
   hard_tree_test.c tests that trees find spheres, and accel_oracle_test.c tests the t of hits. */
#include "accel_fixture.h"
#include "sphere_fixture.h"
#include "unit.h"

struct own {
    uint32_t met, missed, wrong;
    double worst; /* largest error of t, as a share of its bound */
};

/* Computes in double where a ray from about the surface of a sphere hits it again: the far end of
   its chord. `deep`: the square of half the chord over that of the radius, < 0 for a miss. */
static bool meets_own(const float *sphere, const struct gpu_ray *ray, double *t, double *error,
                      double *cosine, double *deep)
{
    double dd = 0.0, cd = 0.0, cc = 0.0, rr = (double)sphere[3] * (double)sphere[3], size = 0.0;
    for (int k = 0; k < 3; ++k) {
        double c = (double)sphere[k] - (double)ray->origin[k], d = (double)ray->dir[k];
        dd += d * d;
        cd += c * d;
        cc += c * c;
        size = fmax(size, fabs((double)sphere[k]));
    }
    double half2 = rr - (cc - cd * cd / dd);
    double half = sqrt(fmax(half2, 0.0) / dd), u = 0x1p-24;
    *t = cd / dd + half;
    *cosine = cd / sqrt(dd * cc);
    *deep = half2 / rr;
    /* The error of the perpendicular is 8 roundings of the radius; that of the chord is larger
       where the chord is short. */
    *error = 8.0 * u * sqrt(rr / dd) * (2.0 + sqrt(rr) / (half * sqrt(dd)));
    return cd > 0.0 && half2 >= 0.0;
}

static void leave(const struct accel *accel, const float *sphere, uint32_t primitive, int side,
                  struct own *own)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    double n[3], length = 0.0, t, error, cosine, deep;
    for (int k = 0; k < 3; ++k) {
        n[k] = sphere_random();
        length += n[k] * n[k];
    }
    for (int k = 0; k < 3; ++k) {
        double arm = (double)sphere[3] * n[k] / sqrt(length);
        /* On the surface as rounded, or moved off it by the bound of shaders/bind/surface.glsl. */
        double off = side * (15.0 * fabs(arm) + fabs((double)sphere[k])) * 0x1p-24;
        ray.origin[k] = (float)((double)sphere[k] + arm + (n[k] > 0.0 ? off : -off));
        ray.dir[k] = (float)sphere_random();
    }
    const struct gpu_hit start = {.primitive = primitive};
    struct gpu_hit hit = trace_with(accel, (struct traverse_params){.own = &start}, &ray, NULL);
    bool wanted = meets_own(sphere, &ray, &t, &error, &cosine, &deep);
    /* So close to 0 the sign of the cosine, a sum of three rounded products, is not certain. */
    if (fabs(cosine) < 8.0 * 0x1p-24)
        return;
    bool met = hit.primitive == primitive;
    /* A ray that grazes the sphere on its way inwards may meet it or miss it. */
    bool grazes = cosine > 0.0 && fabs(deep) <= 64.0 * 0x1p-24;
    own->wrong += met != wanted && !grazes;
    own->met += met;
    own->missed += !met;
    if (met && wanted && !grazes)
        own->worst = fmax(own->worst, fabs((double)hit.t - t) / error);
}

static void check_own(const char *label, double at, double radius)
{
    const uint32_t rays = cases_of(100000);
    struct own own = {0};
    const double sphere[4] = {at, -0.5 * at, 0.25 * at, radius};
    own_world world =
        world_of(sphere_scene(&silent, mesh_balls(sphere, 1), false), (whit_accel_params){0});
    for (uint32_t i = 0; i < rays; ++i)
        leave(world.accel, world.scene->meshes[0].spheres, 0, (int)(i % 3) - 1, &own);
    print_message("  %s: %u met again, %u left, %u wrong; t at worst %.2f of its bound\n", label,
                  own.met, own.missed, own.wrong, own.worst);
    assert_int_equal(own.wrong, 0);
    assert_true(own.worst <= 1.0);
    assert_true(own.met > rays / 3 && own.missed > rays / 3);
}

TEST(rays_leave_their_sphere)
{
    random_state = 4;
    check_own("radius 1", 0.0, 1.0);
    check_own("radius 1, at 3", 3.0, 1.0);
    check_own("radius 1e-6", 1e-6, 1e-6);
    check_own("radius 1e6", 1e6, 1e6);
    check_own("radius 0.1, at 10", 10.0, 0.1);
}

TEST(flat_keeps_spheres_that_stay_spheres)
{
    const whit_accel_params flat = {
        .instances = WHIT_INSTANCES_OFF, .validate = true, .build = WHIT_BUILD_SPATIAL};
    random_state = 5;
    for (int turned = 0; turned < 2; ++turned) {
        own_scene *scene = sphere_scene(&silent, scattered_spheres(50, 1.0, 0.3), false);
        const double t[3] = {0.25, -1.5, 0.5}, q[4] = {0, turned, 0, 1}, s[3] = {2, 2, 2};
        const struct affine matrix = affine_from_trs(t, q, s);
        scene_put_again(scene, 0, &(struct put){.name = "second", .matrix = &matrix});
        scene_ready(scene);
        own_accel *one = NULL;
        whit_result result = accel_create(&silent, scene, &flat, &one);
        assert_int_equal(result, turned ? WHIT_ERROR_INPUT : WHIT_OK);
        if (turned)
            assert_non_null(
                strstr(messages.last_error, "instance 1 `second`: spheres that are turned"));
        own_accel *many = accel_of(scene, (whit_accel_params){0});
        uint32_t same = 0;
        for (uint32_t i = 0; !turned && i < 10000; ++i) {
            struct gpu_ray ray = ray_at_spheres(&scene->meshes[0], 4 * i + 1, 20.0);
            struct gpu_hit a = trace(one, &ray), b = trace(many, &ray);
            same += same_ids(&a, &b);
        }
        /* Scaled by 2 and moved by few bits: all but grazing rays and ties meet the same. */
        assert_true(turned || same > 9990);
    }
}
