/* A view is judged by drawing it very small: the more of what is seen is the front of surfaces (by
   their winding), the better. A closed object shows its front from everywhere, an open box only
   through its opening, a room only from inside. */
#include "scene/viewpoint.h"

#include <math.h>
#include <string.h>

#include "base/same.h"
#include "base/vec.h"
#include "scene/sketch.h"

#define FOV_Y_INSIDE 1.2217304763960306 /* 70 degrees */
/* The default view is kept if this share of it shows fronts; another must have SHARE_BETTER
   more. */
#define SHARE_ENOUGH 0.8
#define SHARE_BETTER 0.15
/* A scene is a room where, from each of four sides, its walls cover WALLS_FILL of the rectangle
   around them, with WALLS_CLOSE of the pixels no deeper than WALLS_DEPTH of the way to the middle;
   and where from inside all four sides show SHARE_INSIDE of fronts, and at most SKY_INSIDE of sky
   in the middle row. */
#define WALLS_FILL   0.9
#define WALLS_CLOSE  0.7
#define WALLS_DEPTH  0.6
#define SHARE_INSIDE 0.7
#define SKY_INSIDE   0.1
/* A small part is shown alone if nothing hides this share of it. */
#define SHOWN_ENOUGH 0.5
#define LAMP_AHEAD   0.45 /* share of the free distance ahead at which the lamp hangs */
#define BOARD_DEPTH  0.15 /* a scene is a board if this share of its width and height is deeper */

/* --- outside -------------------------------------------------------------------------------- */

/* Directions from the scene's middle to the eye; the first is the default. */
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
    view_fit(soup, ways[*way], false, view);
    bool board = *way >= STRAIGHT_FIRST;
    double share = soup->whole && soup->count ? view_judge(soup, view, 0.0, board).share : 1.0;
    double best = share;
    uint32_t best_way = *way;
    for (uint32_t i = 0; share < SHARE_ENOUGH && i < 8; ++i) {
        uint32_t tried = board ? (i + STRAIGHT_FIRST) % 8 : i;
        view_fit(soup, ways[tried], false, &other);
        double found = view_judge(soup, &other, 0.0, board).share;
        if (found > best + 1e-9)
            best = found, best_way = tried;
    }
    if (best >= share + SHARE_BETTER)
        *way = best_way;
    view_fit(soup, ways[*way], true, view);
}

/* --- inside --------------------------------------------------------------------------------- */

static bool has_walls(const struct soup *soup)
{
    bool walls = soup->whole && soup->count;
    for (uint32_t i = STRAIGHT_FIRST; walls && i < 8; ++i) {
        struct view view;
        view_fit(soup, ways[i], false, &view);
        double half = fabs(double3_dot(soup->half, view.forward));
        double inner_face = -double3_dot(view.eye, view.forward) - half + WALLS_DEPTH * half;
        struct verdict verdict = view_judge(soup, &view, 1.0 / inner_face, false);
        walls = verdict.fill >= WALLS_FILL && verdict.close >= WALLS_CLOSE;
    }
    return walls;
}

/* Whether all four views from `eye` show mostly fronts and no sky: not so inside a wall or a
   solid. */
static bool is_enclosed(const struct soup *soup, const double eye[3])
{
    for (uint32_t i = STRAIGHT_FIRST; i < 8; ++i) {
        struct view view;
        view_make(ways[i], FOV_Y_INSIDE, &view);
        memcpy(view.eye, eye, sizeof view.eye);
        struct verdict verdict = view_judge(soup, &view, 0.0, false);
        if (verdict.share < SHARE_INSIDE || verdict.level < 1.0 - SKY_INSIDE)
            return false;
    }
    return true;
}

/* Scores a view, 0..1, by its share of fronts that are far enough away; sky counts a quarter.
 *ahead: depth in the middle of the view, at most `length`. */
static double judge_inside(const struct soup *soup, const struct view *view, double length,
                           double *ahead)
{
    struct sketch sketch;
    double score = 0.0;
    sketch_draw(soup, view, &sketch);
    for (int y = 0; y < SKETCH_DOWN; ++y) {
        for (int x = 0; x < SKETCH_ACROSS; ++x) {
            double near = (double)sketch.nearness[y][x];
            if (near <= 0.0)
                score += 0.25;
            else if (sketch.front[y][x])
                score += fmin(1.0, 2.0 / (near * length));
        }
    }
    double middle = (double)sketch.nearness[SKETCH_DOWN / 2][SKETCH_ACROSS / 2];
    *ahead = middle > 0.0 ? fmin(1.0 / middle, length) : length;
    return score / (SKETCH_ACROSS * SKETCH_DOWN);
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
        view_make(toward_eye, FOV_Y_INSIDE, &view);
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

static void place_view(const struct soup *soup, const struct view *view, double distance,
                       struct viewpoint *out)
{
    for (int i = 0; i < 3; ++i) {
        out->eye[i] = soup->centre[i] + soup->radius * view->eye[i];
        out->target[i] = out->eye[i] + soup->radius * distance * view->forward[i];
    }
}

/* Distance from `from` along `dir` to the nearest surface, or to the side of the scene's box. */
static double free_way(const struct soup *soup, const double from[3], const double dir[3],
                       const double up[3])
{
    struct view view = {.tan_x = 0.1, .tan_y = 0.1};
    struct sketch sketch;
    double side = 0.0;
    memcpy(view.eye, from, sizeof view.eye);
    memcpy(view.forward, dir, sizeof view.forward);
    memcpy(view.up, up, sizeof view.up);
    double3_cross(dir, up, view.right);
    sketch_draw(soup, &view, &sketch);
    for (int k = 0; k < 3; ++k)
        side += soup->half[k] * fabs(dir[k]) - from[k] * dir[k];
    double nearness = (double)sketch.nearness[SKETCH_DOWN / 2][SKETCH_ACROSS / 2];
    return nearness > 0.0 ? fmin(1.0 / nearness, side) : side;
}

static void place_lamp(const struct soup *soup, const struct view *view, double ahead,
                       double lamp[3])
{
    double left[3], step;
    for (int k = 0; k < 3; ++k) {
        left[k] = -view->right[k];
        lamp[k] = view->eye[k] + LAMP_AHEAD * ahead * view->forward[k];
    }
    step = 0.5 * free_way(soup, lamp, left, view->up);
    for (int k = 0; k < 3; ++k)
        lamp[k] += step * left[k];
    step = 0.5 * free_way(soup, lamp, view->up, left);
    for (int k = 0; k < 3; ++k)
        lamp[k] += step * view->up[k];
}

/* The share of a part's pixels that nothing in front of it hides. */
static double shown_share(const struct soup *narrow, const struct view *view)
{
    struct soup alone = *narrow;
    struct sketch part, all;
    uint32_t covered = 0, shown = 0;
    alone.count = narrow->fit_count;
    sketch_draw(&alone, view, &part);
    sketch_draw(narrow, view, &all);
    for (int y = 0; y < SKETCH_DOWN; ++y) {
        for (int x = 0; x < SKETCH_ACROSS; ++x) {
            covered += part.nearness[y][x] > 0.0f;
            shown += part.nearness[y][x] > 0.0f && part.nearness[y][x] == all.nearness[y][x];
        }
    }
    return covered ? (double)shown / covered : 0.0;
}

/* Chooses a view from outside of a small part of the scene. False: something hides the part. */
static bool choose_part(const struct soup *narrow, uint32_t *way, struct view *view)
{
    if (!narrow->count)
        return false;
    choose_outside(narrow, way, view);
    return shown_share(narrow, view) >= SHOWN_ENOUGH;
}

/* `seen`: the scene, or the small part of it that the view is fitted to. */
static void look_from_outside(const struct soup *seen, uint32_t way, const struct view *view,
                              struct viewpoint *out)
{
    out->kind = way >= STRAIGHT_FIRST ? VIEWPOINT_STRAIGHT
                : way                 ? VIEWPOINT_TURNED
                                      : VIEWPOINT_CORNER;
    out->fov_y = VIEW_FOV_Y;
    double distance = -double3_dot(view->eye, view->forward);
    place_view(seen, view, distance, out);
    for (int i = 0; out->part && i < 3; ++i) {
        out->lo[i] = seen->centre[i] - seen->radius * seen->half[i];
        out->hi[i] = seen->centre[i] + seen->radius * seen->half[i];
    }
    for (int i = 0; i < 3; ++i)
        out->lamp[i] = out->eye[i] + 0.5 * seen->radius * distance * (view->up[i] - view->right[i]);
}

static void look_from_inside(const struct soup *soup, const struct view *view, double ahead,
                             struct viewpoint *out)
{
    double lamp[3];
    out->kind = VIEWPOINT_INSIDE;
    out->fov_y = FOV_Y_INSIDE;
    place_view(soup, view, ahead, out);
    place_lamp(soup, view, ahead, lamp);
    /* A view that is fitted to this cube, from where the eye is, has the eye there. */
    double half = soup->radius * ahead * same_sin(0.5 * FOV_Y_INSIDE) / sqrt(3.0);
    for (int i = 0; i < 3; ++i) {
        out->lamp[i] = soup->centre[i] + soup->radius * lamp[i];
        out->lo[i] = out->target[i] - half;
        out->hi[i] = out->target[i] + half;
    }
}

/* A room is seen from inside, and what hovers in a box of sky is not in a room. */
static void choose(const struct soup *soup, const struct soup *narrow, struct viewpoint *out)
{
    struct view view;
    uint32_t way = 0;
    double ahead = 0.0;
    bool part = choose_part(narrow, &way, &view);
    if (!(part && narrow->in_box) && has_walls(soup) && choose_inside(soup, &view, &ahead)) {
        look_from_inside(soup, &view, ahead, out);
        return;
    }
    out->part = part;
    out->under_sky = part && narrow->under_sky;
    if (!part)
        choose_outside(soup, &way, &view);
    look_from_outside(part ? narrow : soup, way, &view, out);
}

whit_result viewpoint_choose(const struct scene *scene, const struct scene_pose *pose,
                             struct viewpoint *out)
{
    struct soup soup, narrow;
    *out = (struct viewpoint){0};
    double3_no_box(out->lo, out->hi);
    whit_result result = soup_init(scene, pose, &soup);
    if (result != WHIT_OK)
        return result;
    result = soup_narrow(&soup, &narrow);
    if (result == WHIT_OK)
        choose(&soup, &narrow, out);
    soup_finish(&narrow);
    soup_finish(&soup);
    return result;
}
