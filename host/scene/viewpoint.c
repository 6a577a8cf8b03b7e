/* A view is judged by drawing it very small: the more of what is seen is the front of surfaces (by
   their winding), the better. A closed object shows its front from everywhere, an open box only
   through its opening, a room only from inside. */
#include "scene/viewpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"

#define ACROSS         64
#define DOWN           48
#define FOV_Y          0.69813170079773183 /* 40 degrees */
#define FOV_Y_INSIDE   1.2217304763960306  /* 70 degrees */
#define FILL           0.93                /* of the picture's height or width, by what is seen */
#define TRIANGLES_MOST 400000u
#define CELLS          16
#define MOMENTS        9     /* of an animation that the picture is fitted to */
#define MOVING_MOST    10000 /* instances */
/* Share of fronts from which a view is kept as it is, and what another must be better by. */
#define SHARE_ENOUGH   0.8
#define SHARE_BETTER   0.15
/* A room: its walls fill this much of the rectangle around them from every side, most of them not
   deeper than a share of the way to the middle, and whoever stands
   in it sees this share of fronts on all four sides, and no more sky than this at eye level. */
#define WALLS_FILL     0.9
#define WALLS_CLOSE    0.7
#define WALLS_DEPTH    0.6
#define SHARE_INSIDE   0.7
#define SKY_INSIDE     0.1
#define BOARD_DEPTH    0.15 /* of width and height */

/* Triangles in a space where the scene is around the origin and its bounding sphere is 1. */
struct soup {
    float *corners;    /* 9 per triangle */
    uint8_t *pictured; /* 1 per triangle: shows a picture */
    uint32_t count;
    uint32_t fit_count; /* with those that only the fit looks at: where things are later on */
    bool whole;         /* else boxes around the instances stand for them */
    double centre[3], radius, half[3];
    /* The farthest corner in each of some directions: enough for a first fit. */
    float outline[6 * CELLS * CELLS][3];
    uint32_t outline_count;
};

struct view {
    double eye[3], right[3], up[3], forward[3];
    double tan_x, tan_y;
};

struct sketch {
    float nearness[DOWN][ACROSS]; /* 1 / depth; 0: nothing */
    bool front[DOWN][ACROSS];
    bool pictured[DOWN][ACROSS];
};

struct verdict {
    double share; /* of fronts in what is seen; of a board: in what shows pictures, if anything */
    double fill;  /* of the rectangle around what is seen */
    double close; /* share of what is seen that is nearer than 1 / the nearness asked for */
    double level; /* share of the middle row that shows anything */
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; length > 0.0 && i < 3; ++i)
        v[i] /= length;
}

/* fmin and fmax without their care for NaN, which costs a call each. */
static double least(double a, double b)
{
    return a < b ? a : b;
}

static double most(double a, double b)
{
    return a > b ? a : b;
}

/* --- triangles ------------------------------------------------------------------------------ */

static void put_corner(const struct soup *soup, const struct affine *matrix, const double p[3],
                       float out[3])
{
    double world[3];
    affine_point(matrix, p, world);
    for (int i = 0; i < 3; ++i)
        out[i] = (float)((world[i] - soup->centre[i]) / soup->radius);
}

static void add_triangles(struct soup *soup, const struct scene *scene,
                          const struct scene_mesh *mesh, const struct affine *matrix)
{
    bool mirrored = affine_determinant(matrix) < 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const struct scene_material *material = &scene->materials[mesh->materials[t]];
        soup->pictured[soup->count] = material->textures[SCENE_SLOT_DIFFUSE].texture != SCENE_NONE;
        float *out = soup->corners + 9 * (size_t)soup->count++;
        for (int i = 0; i < 3; ++i) {
            const float *p = mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)t + (size_t)i];
            int at = mirrored ? 2 - i : i;
            put_corner(soup, matrix, (double[]){(double)p[0], (double)p[1], (double)p[2]},
                       out + 3 * at);
        }
    }
}

/* Three triangles that touch all eight corners: only good for fitting a picture around them. */
static void add_box(struct soup *soup, const struct scene_mesh *mesh, const struct affine *matrix)
{
    for (uint32_t i = 0; i < 9; ++i) {
        double p[3];
        for (uint32_t k = 0; k < 3; ++k)
            p[k] = (double)((i >> k & 1) ? mesh->hi[k] : mesh->lo[k]);
        put_corner(soup, matrix, p, soup->corners + 9 * (size_t)soup->fit_count + 3 * i);
    }
    soup->fit_count += 3;
}

static void add_boxes(const struct scene *scene, const struct scene_pose *pose, struct soup *soup)
{
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        if (scene_mesh_primitives(mesh))
            add_box(soup, mesh, &pose->instances[i]);
    }
}

static void measure(const double lo[3], const double hi[3], struct soup *soup)
{
    double radius2 = 0.0;
    bool empty = lo[0] > hi[0];
    for (int i = 0; i < 3; ++i) {
        soup->half[i] = empty ? 0.0 : 0.5 * (hi[i] - lo[i]);
        soup->centre[i] = empty ? 0.0 : lo[i] + soup->half[i];
        radius2 += soup->half[i] * soup->half[i];
    }
    soup->radius = radius2 > 0.0 && isfinite(radius2) ? sqrt(radius2) : 1.0;
    for (int i = 0; i < 3; ++i)
        soup->half[i] /= soup->radius;
}

/* The scene at even steps of its animation; the first is `now`, borrowed. */
struct moments {
    struct scene_pose poses[MOMENTS];
    uint32_t count;
    double lo[3], hi[3];
};

static void moments_finish(struct moments *moments)
{
    for (uint32_t i = 1; i < moments->count; ++i)
        scene_pose_finish(&moments->poses[i]);
}

static whit_result moments_init(const struct scene *scene, const struct scene_pose *now,
                                struct moments *out)
{
    bool moves = scene->time_end_s > 0.0f && scene->instance_count <= MOVING_MOST;
    out->poses[0] = *now;
    out->count = 1;
    memcpy(out->lo, now->lo, sizeof out->lo);
    memcpy(out->hi, now->hi, sizeof out->hi);
    for (uint32_t i = 1; moves && i < MOMENTS; ++i) {
        double time_s = (double)scene->time_end_s * i / (MOMENTS - 1);
        whit_result result = scene_pose_init(scene, time_s, &out->poses[i]);
        if (result != WHIT_OK) {
            moments_finish(out);
            return result;
        }
        ++out->count;
        for (int k = 0; k < 3; ++k) {
            out->lo[k] = fmin(out->lo[k], out->poses[i].lo[k]);
            out->hi[k] = fmax(out->hi[k], out->poses[i].hi[k]);
        }
    }
    return WHIT_OK;
}

/* The cell of a cube map. */
static uint32_t direction_cell(const float p[3])
{
    float size[3] = {fabsf(p[0]), fabsf(p[1]), fabsf(p[2])};
    uint32_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (!(size[axis] > 0.0f))
        return 0;
    float scale = 0.5f * CELLS / size[axis];
    uint32_t x = (uint32_t)(p[u] * scale + 0.5f * CELLS),
             y = (uint32_t)(p[v] * scale + 0.5f * CELLS);
    x = x < CELLS ? x : CELLS - 1;
    y = y < CELLS ? y : CELLS - 1;
    return ((2 * axis + (p[axis] < 0.0f)) * CELLS + y) * CELLS + x;
}

static void find_outline(struct soup *soup)
{
    float farthest[6 * CELLS * CELLS];
    for (uint32_t i = 0; i < 6 * CELLS * CELLS; ++i)
        farthest[i] = -1.0f;
    for (size_t i = 0; i < 3 * (size_t)soup->fit_count; ++i) {
        const float *p = soup->corners + 3 * i;
        uint32_t cell = direction_cell(p);
        float length2 = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        if (length2 > farthest[cell]) {
            farthest[cell] = length2;
            memcpy(soup->outline[cell], p, 3 * sizeof *p);
        }
    }
    for (uint32_t i = 0; i < 6 * CELLS * CELLS; ++i) {
        if (farthest[i] >= 0.0f)
            memmove(soup->outline[soup->outline_count++], soup->outline[i],
                    sizeof soup->outline[i]);
    }
}

static whit_result gather(const struct scene *scene, const struct scene_pose *pose,
                          struct soup *soup)
{
    struct moments moments;
    uint64_t total = 0;
    *soup = (struct soup){0};
    whit_result result = moments_init(scene, pose, &moments);
    if (result != WHIT_OK)
        return result;
    measure(moments.lo, moments.hi, soup);
    bool spheres = false;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        total += scene->meshes[scene->instances[i].mesh].triangle_count;
        spheres |= scene->meshes[scene->instances[i].mesh].sphere_count > 0;
    }
    soup->whole = total <= TRIANGLES_MOST && !spheres;
    uint64_t room = (soup->whole ? total : 0) + 3ull * moments.count * scene->instance_count;
    soup->corners = array_alloc((size_t)room, 9 * sizeof *soup->corners);
    soup->pictured = array_alloc((size_t)room, sizeof *soup->pictured);
    if (!soup->corners || !soup->pictured) {
        free(soup->corners);
        free(soup->pictured);
        moments_finish(&moments);
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; soup->whole && i < scene->instance_count; ++i)
        add_triangles(soup, scene, &scene->meshes[scene->instances[i].mesh], &pose->instances[i]);
    soup->fit_count = soup->count;
    for (uint32_t i = soup->whole ? 1 : 0; i < moments.count; ++i)
        add_boxes(scene, &moments.poses[i], soup);
    moments_finish(&moments);
    find_outline(soup);
    return WHIT_OK;
}

/* --- drawing -------------------------------------------------------------------------------- */

static void make_view(const double toward_eye[3], double fov_y, struct view *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < 3; ++i)
        out->forward[i] = -toward_eye[i];
    unit(out->forward);
    cross(out->forward, (const double[]){0, 1, 0}, out->right);
    unit(out->right);
    cross(out->right, out->forward, out->up);
    out->tan_y = tan(0.5 * fov_y);
    out->tan_x = out->tan_y * ACROSS / DOWN;
}

static void corner_in_view(const float corner[3], const struct view *view, double out[3])
{
    const double p[3] = {(double)corner[0], (double)corner[1], (double)corner[2]};
    out[0] = dot(p, view->right);
    out[1] = dot(p, view->up);
    out[2] = dot(p, view->forward);
}

/* Puts the eye as near to the origin on the ray along `way` as it can be with everything in the
   picture. With x, y, z a corner and c the eye along right, up, forward, each side of the picture
   is one bound, such as x - c.x <= tan_x * (z - c.z). */
static void fit_distance(const float *corners, uint32_t count, const double way[3],
                         struct view *view)
{
    double tx = FILL * view->tan_x, ty = FILL * view->tan_y;
    double side = dot(way, view->right), rise = dot(way, view->up), back = -dot(way, view->forward);
    double right = 0.0, left = 0.0, top = 0.0, bottom = 0.0;
    for (size_t i = 0; i < count; ++i) {
        double p[3];
        corner_in_view(corners + 3 * i, view, p);
        right = most(right, p[0] - tx * p[2]), left = most(left, -p[0] - tx * p[2]);
        top = most(top, p[1] - ty * p[2]), bottom = most(bottom, -p[1] - ty * p[2]);
    }
    double distance = fmax(right / (tx * back + side), left / (tx * back - side));
    distance = fmax(distance, top / (ty * back + rise));
    distance = fmax(distance, bottom / (ty * back - rise));
    if (!(distance > 0.0) || !isfinite(distance))
        distance = 1.0 / sin(FOV_Y / 2.0);
    for (int i = 0; i < 3; ++i)
        view->eye[i] = distance * way[i];
}

/* Turns the view so that what is seen is in the middle of the picture. */
static void aim(const struct soup *soup, struct view *view)
{
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, back[3], eye[3];
    for (int i = 0; i < 3; ++i)
        eye[i] = view->eye[i];
    const double c[3] = {dot(eye, view->right), dot(eye, view->up), dot(eye, view->forward)};
    for (size_t i = 0; i < soup->outline_count; ++i) {
        double p[3];
        corner_in_view(soup->outline[i], view, p);
        for (int k = 0; k < 2; ++k) {
            double slope = (p[k] - c[k]) / fmax(p[2] - c[2], 1e-9);
            lo[k] = least(lo[k], slope), hi[k] = most(hi[k], slope);
        }
    }
    for (int i = 0; i < 3; ++i)
        back[i] = -(view->forward[i] + 0.5 * (lo[0] + hi[0]) * view->right[i] +
                    0.5 * (lo[1] + hi[1]) * view->up[i]);
    make_view(back, FOV_Y, view);
    memcpy(view->eye, eye, sizeof eye);
}

/* The eye stays in the direction `way` from the scene's middle. */
static void fit_view(const struct soup *soup, const double way[3], bool closely, struct view *view)
{
    double toward_eye[3] = {way[0], way[1], way[2]};
    unit(toward_eye);
    make_view(toward_eye, FOV_Y, view);
    fit_distance(soup->outline[0], soup->outline_count, toward_eye, view);
    for (int round = 0; closely && soup->outline_count && round < 4; ++round) {
        aim(soup, view);
        fit_distance(soup->outline[0], soup->outline_count, toward_eye, view);
    }
    if (closely)
        fit_distance(soup->corners, 3 * soup->fit_count, toward_eye, view);
}

/* The first and the last pixel whose centre is inside an interval's ends. */
static int pixel_from(double low)
{
    double at = most(low - 0.5, 0.0);
    int pixel = at < ACROSS ? (int)at : ACROSS;
    return pixel + (pixel < at);
}

static int pixel_to(double high, int count)
{
    double at = least(high - 0.5, count - 1.0);
    return at >= 0.0 ? (int)at : -1;
}

/* a, b, c: pixel x, pixel y, 1 / depth. Of surfaces in one place the front counts. */
static void draw_projected(struct sketch *sketch, const double a[3], const double b[3],
                           const double c[3], bool front, bool pictured)
{
    double area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    int x0 = pixel_from(least(least(a[0], b[0]), c[0])),
        y0 = pixel_from(least(least(a[1], b[1]), c[1]));
    int x1 = pixel_to(most(most(a[0], b[0]), c[0]), ACROSS);
    int y1 = pixel_to(most(most(a[1], b[1]), c[1]), DOWN);
    if (x0 > x1 || y0 > y1 || area == 0.0)
        return;
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            double px = x + 0.5, py = y + 0.5;
            double u = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / area;
            double v = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / area;
            if (u < 0.0 || v < 0.0 || u + v > 1.0)
                continue;
            float near = (float)(a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]));
            float there = sketch->nearness[y][x];
            if (near > there * (front ? 1.0f - 1e-5f : 1.0f + 1e-5f)) {
                sketch->nearness[y][x] = near;
                sketch->front[y][x] = front;
                sketch->pictured[y][x] = pictured;
            }
        }
    }
}

/* The part of a triangle in front of the eye; *out holds up to four corners. */
static uint32_t clip(double corners[3][3], double nearest, double out[4][3])
{
    uint32_t count = 0;
    for (int i = 0; i < 3; ++i) {
        const double *a = corners[i], *b = corners[(i + 1) % 3];
        if (a[2] >= nearest)
            memcpy(out[count++], a, 3 * sizeof *a);
        if ((a[2] >= nearest) != (b[2] >= nearest)) {
            double s = (nearest - a[2]) / (b[2] - a[2]);
            for (int k = 0; k < 3; ++k)
                out[count][k] = a[k] + s * (b[k] - a[k]);
            ++count;
        }
    }
    return count;
}

static void draw_triangle(const struct view *view, const float *corners, bool pictured,
                          struct sketch *sketch)
{
    double seen[3][3], clipped[4][3];
    for (int i = 0; i < 3; ++i) {
        double p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = (double)corners[3 * i + k] - view->eye[k];
        seen[i][0] = dot(p, view->right) / view->tan_x;
        seen[i][1] = dot(p, view->up) / view->tan_y;
        seen[i][2] = dot(p, view->forward);
    }
    /* Counter-clockwise as seen from the eye: right, up, forward are left-handed. */
    double normal[3];
    cross(seen[0], seen[1], normal);
    bool front = dot(normal, seen[2]) > 0.0;
    uint32_t count = clip(seen, 1e-3, clipped);
    for (uint32_t i = 0; i < count; ++i) {
        clipped[i][2] = 1.0 / clipped[i][2];
        clipped[i][0] = 0.5 * ACROSS * (1.0 + clipped[i][0] * clipped[i][2]);
        clipped[i][1] = 0.5 * DOWN * (1.0 - clipped[i][1] * clipped[i][2]);
    }
    for (uint32_t i = 2; i < count; ++i)
        draw_projected(sketch, clipped[0], clipped[i - 1], clipped[i], front, pictured);
}

static void draw(const struct soup *soup, const struct view *view, struct sketch *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t t = 0; t < soup->count; ++t)
        draw_triangle(view, soup->corners + 9 * (size_t)t, soup->pictured[t], out);
}

/* `board`: its front is where its pictures are the right way round. */
static struct verdict judge(const struct soup *soup, const struct view *view, double nearness,
                            bool board)
{
    struct sketch sketch;
    int left = ACROSS, right = -1, top = DOWN, bottom = -1;
    uint32_t fronts = 0, seen = 0, level = 0, close = 0, pictures = 0, picture_fronts = 0;
    draw(soup, view, &sketch);
    for (int y = 0; y < DOWN; ++y) {
        for (int x = 0; x < ACROSS; ++x) {
            if (sketch.nearness[y][x] <= 0.0f)
                continue;
            ++seen;
            level += y == DOWN / 2;
            close += (double)sketch.nearness[y][x] >= nearness;
            fronts += sketch.front[y][x];
            pictures += sketch.pictured[y][x];
            picture_fronts += sketch.pictured[y][x] && sketch.front[y][x];
            left = x < left ? x : left, right = x > right ? x : right;
            top = y < top ? y : top, bottom = y;
        }
    }
    /* Next to nothing is seen of a sheet from its edge. */
    if (seen < ACROSS * DOWN / 50)
        return (struct verdict){0};
    double rectangle = (double)(right - left + 1) * (bottom - top + 1);
    double share = board && pictures ? (double)picture_fronts / pictures : (double)fronts / seen;
    return (struct verdict){share, seen / rectangle, (double)close / seen, (double)level / ACROSS};
}

/* --- outside -------------------------------------------------------------------------------- */

/* Ways to the eye, the first being what is taken without reason against it. */
static const double ways[8][3] = {{0.5, 0.35, 1.0},  {1.0, 0.35, -0.5}, {-0.5, 0.35, -1.0},
                                  {-1.0, 0.35, 0.5}, {0.0, 0.0, 1.0},   {1.0, 0.0, 0.0},
                                  {0.0, 0.0, -1.0},  {-1.0, 0.0, 0.0}};

#define STRAIGHT_FIRST 4
#define STRAIGHT_Z     4
#define STRAIGHT_X     5

static uint32_t first_way(const struct soup *soup)
{
    const double *half = soup->half;
    if (half[2] < BOARD_DEPTH * fmin(half[0], half[1]))
        return STRAIGHT_Z;
    if (half[0] < BOARD_DEPTH * fmin(half[2], half[1]))
        return STRAIGHT_X;
    return 0;
}

static void choose_outside(const struct soup *soup, uint32_t *way, struct view *view)
{
    struct view other;
    *way = first_way(soup);
    fit_view(soup, ways[*way], false, view);
    bool board = *way >= STRAIGHT_FIRST;
    double share = soup->whole && soup->count ? judge(soup, view, 0.0, board).share : 1.0;
    double best = share;
    uint32_t best_way = *way;
    for (uint32_t i = 0; share < SHARE_ENOUGH && i < 8; ++i) {
        uint32_t tried = board ? (i + STRAIGHT_FIRST) % 8 : i;
        fit_view(soup, ways[tried], false, &other);
        double found = judge(soup, &other, 0.0, board).share;
        if (found > best + 1e-9)
            best = found, best_way = tried;
    }
    if (best >= share + SHARE_BETTER)
        *way = best_way;
    fit_view(soup, ways[*way], true, view);
}

/* --- inside --------------------------------------------------------------------------------- */

static bool has_walls(const struct soup *soup)
{
    bool walls = soup->whole && soup->count;
    for (uint32_t i = STRAIGHT_FIRST; walls && i < 8; ++i) {
        struct view view;
        fit_view(soup, ways[i], false, &view);
        double half = fabs(dot(soup->half, view.forward));
        double inner_face = -dot(view.eye, view.forward) - half + WALLS_DEPTH * half;
        struct verdict verdict = judge(soup, &view, 1.0 / inner_face, false);
        walls = verdict.fill >= WALLS_FILL && verdict.close >= WALLS_CLOSE;
    }
    return walls;
}

/* Whether fronts are seen from `eye` on all four sides: not so within a wall or a solid. */
static bool is_enclosed(const struct soup *soup, const double eye[3])
{
    for (uint32_t i = STRAIGHT_FIRST; i < 8; ++i) {
        struct view view;
        make_view(ways[i], FOV_Y_INSIDE, &view);
        memcpy(view.eye, eye, sizeof view.eye);
        struct verdict verdict = judge(soup, &view, 0.0, false);
        if (verdict.share < SHARE_INSIDE || verdict.level < 1.0 - SKY_INSIDE)
            return false;
    }
    return true;
}

/* How much of the picture is the front of something far enough away; sky counts a little. *ahead is
   the depth in the middle. */
static double judge_inside(const struct soup *soup, const struct view *view, double length,
                           double *ahead)
{
    struct sketch sketch;
    double score = 0.0;
    draw(soup, view, &sketch);
    for (int y = 0; y < DOWN; ++y) {
        for (int x = 0; x < ACROSS; ++x) {
            double near = (double)sketch.nearness[y][x];
            if (near <= 0.0)
                score += 0.25;
            else if (sketch.front[y][x])
                score += fmin(1.0, 2.0 / (near * length));
        }
    }
    double middle = (double)sketch.nearness[DOWN / 2][ACROSS / 2];
    *ahead = middle > 0.0 ? fmin(1.0 / middle, length) : length;
    return score / (ACROSS * DOWN);
}

static bool choose_inside(const struct soup *soup, struct view *best, double *ahead)
{
    static const double insets[] = {0.06, 0.2}, heights[] = {0.25, 0.5};
    int axis = soup->half[0] > soup->half[2] ? 0 : 2;
    double length = 2.0 * soup->half[axis], best_score = 0.0;
    for (int i = 0; i < 8; ++i) {
        struct view view;
        double toward_eye[3] = {0, 0, 0}, free_ahead, end = i & 1 ? -1.0 : 1.0;
        toward_eye[axis] = end;
        make_view(toward_eye, FOV_Y_INSIDE, &view);
        view.eye[axis] = end * (0.5 - insets[i >> 1 & 1]) * length;
        view.eye[1] = (2.0 * heights[i >> 2 & 1] - 1.0) * soup->half[1];
        double score = judge_inside(soup, &view, length, &free_ahead);
        if (score <= best_score + 1e-9 || !is_enclosed(soup, view.eye))
            continue;
        best_score = score;
        *best = view;
        *ahead = free_ahead;
    }
    return best_score > 0.0;
}

whit_result viewpoint_choose(const struct scene *scene, const struct scene_pose *pose,
                             struct viewpoint *out)
{
    struct soup soup;
    struct view view;
    uint32_t way;
    double ahead = 0.0;
    whit_result result = gather(scene, pose, &soup);
    if (result != WHIT_OK)
        return result;
    choose_outside(&soup, &way, &view);
    bool inside = has_walls(&soup) && choose_inside(&soup, &view, &ahead);
    double distance = inside ? ahead : -dot(view.eye, view.forward);
    out->kind = inside                  ? VIEWPOINT_INSIDE
                : way >= STRAIGHT_FIRST ? VIEWPOINT_STRAIGHT
                : way                   ? VIEWPOINT_TURNED
                                        : VIEWPOINT_CORNER;
    out->fov_y = inside ? FOV_Y_INSIDE : FOV_Y;
    out->free_ahead = ahead * soup.radius;
    for (int i = 0; i < 3; ++i) {
        out->eye[i] = soup.centre[i] + soup.radius * view.eye[i];
        out->target[i] = out->eye[i] + soup.radius * distance * view.forward[i];
    }
    free(soup.corners);
    free(soup.pictured);
    return WHIT_OK;
}
