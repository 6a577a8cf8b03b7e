/* Searches for the largest errors of the float filter of NUMERICS_EXACT, relative to its bounds, by
   hill climbing over triangles, spheres and rays. Quotients are off by up to 2.5 ulp, as Vulkan
   allows. The errors that the search finds are measured in fractions. */
#include "hard_fixture.h"

#include "fraction_fixture.h"
#include "twin/exact_sphere.h"

enum { VERTICES = 3, STEPS_MAX = 5 };

/* A ray with a triangle or a sphere. `steps`: number of floats by which each of the ray's three
   quotients is moved, unless that is more than 2.5 ulp. */
struct subject {
    float at[15]; /* origin, direction, vertices; or centre and radius */
    int steps[3];
};

/* ---- Answers of the filter on a device whose divisions have the largest error allowed ---- */

struct view {
    struct ray_setup ray;
    struct vec3 origin, dir, v[VERTICES]; /* as given */
    struct exact_bounds bounds;
    float edge[VERTICES];
    float radius;
    struct sphere_bounds of_sphere;
    struct foot foot;
};

static float moved_quotient(float quotient, double exact, int steps)
{
    int exponent;
    frexp(exact, &exponent);
    float moved = quotient;
    for (int i = 0; i < abs(steps); ++i)
        moved = nextafterf(moved, steps < 0 ? -INFINITY : INFINITY);
    double off = fabs((double)moved - exact);
    return off <= 2.5 * ldexp(1.0, exponent - FLT_MANT_DIG) ? moved : quotient;
}

static void look_at(const struct subject *s, struct view *out)
{
    out->origin = vec3_load(s->at);
    out->dir = vec3_load(s->at + 3);
    struct ray_setup *ray = &out->ray;
    *ray = make_ray_setup(out->origin, out->dir);
    struct vec3 d = turn_dominant(ray, out->dir), relative[VERTICES], turned[VERTICES];
    ray->shear.x = moved_quotient(ray->shear.x, (double)d.x / (double)d.z, s->steps[0]);
    ray->shear.y = moved_quotient(ray->shear.y, (double)d.y / (double)d.z, s->steps[1]);
    ray->shear.z = moved_quotient(ray->shear.z, 1.0 / (double)d.z, s->steps[2]);
    bound_ray_setup(ray);
    for (int i = 0; i < VERTICES; ++i) {
        out->v[i] = vec3_load(s->at + 6 + 3 * i);
        relative[i] = vec3_sub(out->v[i], out->origin);
        turned[i] = turn_dominant(ray, relative[i]);
    }
    exact_filter(ray, relative[0], relative[1], relative[2], &out->bounds);
    struct sheared sheared = shear_triangle(ray, turned[0], turned[1], turned[2]);
    out->edge[0] = sheared.ea;
    out->edge[1] = sheared.eb;
    out->edge[2] = sheared.ec;
    out->radius = fabsf(s->at[9]);
    bound_sphere(ray, out->v[0], out->radius, &out->of_sphere);
    out->foot = drop_perpendicular(ray, out->v[0], out->radius);
}

/* ---- The errors to maximize, in double, which is accurate to some 2^-40 of the bounds ---- */

enum aim {
    EDGE_ERROR, /* error of an edge function, as a share of its bound */
    WRONG_SIGN, /* size of an edge function with the wrong sign, as a share of its bound */
    T_ERROR,    /* error of t, as a share of half the interval of the key */
    ROOM_ERROR, /* error of a sphere's room, as a share of its bound */
    MISSED_BY,  /* size of the room with the wrong sign, as a share of its bound */
    END_ERROR,  /* error of the t of an end, as a share of half the interval of its key */
};

struct truth {
    double edge[VERTICES], t;
};

static struct truth truth_in_double(const struct view *view)
{
    struct vec3 d = turn_dominant(&view->ray, view->dir);
    struct vec3 o = turn_dominant(&view->ray, view->origin);
    double x[VERTICES], y[VERTICES], z[VERTICES], sum = 0.0, weighted = 0.0;
    struct truth truth;
    for (int i = 0; i < VERTICES; ++i) {
        struct vec3 v = turn_dominant(&view->ray, view->v[i]);
        z[i] = (double)v.z - (double)o.z;
        x[i] = (double)v.x - (double)o.x - (double)d.x / (double)d.z * z[i];
        y[i] = (double)v.y - (double)o.y - (double)d.y / (double)d.z * z[i];
    }
    for (int i = 0; i < VERTICES; ++i) {
        int j = (i + 1) % VERTICES, k = (i + 2) % VERTICES;
        truth.edge[i] = x[k] * y[j] - y[k] * x[j];
        sum += truth.edge[i];
        weighted += truth.edge[i] * z[i];
    }
    truth.t = weighted / sum / (double)d.z;
    return truth;
}

struct chord_truth {
    double room, near, far;
};

static struct chord_truth chord_in_double(const struct view *view)
{
    const double d[3] = {(double)view->dir.x, (double)view->dir.y, (double)view->dir.z};
    const double m[3] = {(double)view->v[0].x - (double)view->origin.x,
                         (double)view->v[0].y - (double)view->origin.y,
                         (double)view->v[0].z - (double)view->origin.z};
    double dd = 0.0, md = 0.0, off2 = 0.0, r = (double)view->radius;
    for (int k = 0; k < 3; ++k) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double cross = m[i] * d[j] - m[j] * d[i];
        off2 += cross * cross;
        dd += d[k] * d[k];
        md += m[k] * d[k];
    }
    struct chord_truth truth = {.room = r * r - off2 / dd};
    double half = sqrt(fmax(truth.room, 0.0) / dd);
    truth.near = md / dd - half;
    truth.far = md / dd + half;
    return truth;
}

static double end_error(double t, float lo, float hi)
{
    return fabs(t - 0.5 * ((double)lo + (double)hi)) / (0.5 * ((double)hi - (double)lo));
}

static double sphere_score(const struct view *view, enum aim aim)
{
    const struct sphere_bounds *said = &view->of_sphere;
    struct chord_truth truth = chord_in_double(view);
    double error = fabs((double)view->foot.room - truth.room);
    if (aim == END_ERROR)
        return said->inside ? fmax(end_error(truth.near, said->near_lo, said->near_hi),
                                   end_error(truth.far, said->far_lo, said->far_hi))
                            : -INFINITY;
    return (aim == ROOM_ERROR ? error : error - fabs(truth.room)) / (double)said->room_error;
}

static double score_of(const struct subject *s, enum aim aim)
{
    struct view view;
    look_at(s, &view);
    if (aim >= ROOM_ERROR)
        return sphere_score(&view, aim);
    struct truth truth = truth_in_double(&view);
    if (aim == T_ERROR) {
        double half = 0.5 * ((double)view.bounds.hi - (double)view.bounds.lo);
        return view.bounds.inside ? fabs((double)view.bounds.t - truth.t) / half : -INFINITY;
    }
    double max = -INFINITY;
    for (int i = 0; i < VERTICES; ++i) {
        double error = fabs((double)view.edge[i] - truth.edge[i]);
        max = fmax(max, aim == EDGE_ERROR ? error : error - fabs(truth.edge[i]));
    }
    return max / (double)view.bounds.edge_error;
}

static float either_sign(float x)
{
    return either(x, -x);
}

/* A random coordinate, often just above a power of two, where roundings are relatively largest. */
static float coordinate(void)
{
    uint32_t kind = random_below(&random_state, 3);
    float mantissa = random_below(&random_state, 2) ? 1.0f : 1.0f + random_float(&random_state);
    return kind == 0   ? random_within(1.0f)
           : kind == 1 ? either_sign(mantissa)
                       : either_sign(ldexpf(mantissa, (int)random_below(&random_state, 6) - 3));
}

/* A ray along a diagonal of space, with a triangle across it that is far away for its size. The
   quotients of such a ray are 1, where 2.5 ulp are relatively largest, and the errors of both ends
   of an edge may add up. */
static void start_across(struct subject *s)
{
    int smaller = (int)random_below(&random_state, 6);
    float size = ldexpf(1.0f + random_float(&random_state), -6 - smaller);
    int nearer = (int)random_below(&random_state, 12);
    float away = 1.0f + ldexpf(random_float(&random_state), -nearer);
    for (int k = 0; k < 3; ++k) {
        float sign = either_sign(1.0f);
        s->at[k] = either_sign(ldexpf(random_float(&random_state), -24));
        s->at[3 + k] = sign;
        s->at[6 + k] = sign * (k < 2 ? away + size : away);
        s->at[9 + k] = sign * (k < 2 ? away - size : away);
        s->at[12 + k] = sign * (k < 2 ? away + random_within(size) : away);
        s->steps[k] = random_below(&random_state, 2) ? STEPS_MAX : -STEPS_MAX;
    }
}

/* A ray along a diagonal of space through the middle of a sphere, or at its edge. */
static void start_at_sphere(struct subject *s)
{
    int farther = (int)random_below(&random_state, 4);
    float away = ldexpf(1.0f + random_float(&random_state), farther);
    for (int k = 0; k < 3; ++k) {
        float sign = either_sign(1.0f);
        int nearer = (int)random_below(&random_state, 8);
        float aside = ldexpf(random_within(1.0f), -nearer);
        s->at[k] = either_sign(ldexpf(1.0f + random_float(&random_state), -24));
        s->at[3 + k] = sign;
        s->at[6 + k] = sign * away + aside;
        s->steps[k] = random_below(&random_state, 2) ? STEPS_MAX : -STEPS_MAX;
    }
    for (int i = 9; i < 15; ++i) {
        int smaller = (int)random_below(&random_state, 4);
        s->at[i] = ldexpf(1.0f + random_float(&random_state), -smaller);
    }
}

static void start_anywhere(struct subject *s)
{
    for (int i = 0; i < 15; ++i)
        s->at[i] = coordinate();
    for (int k = 0; k < 3; ++k)
        s->steps[k] = (int)random_below(&random_state, 2 * STEPS_MAX + 1) - STEPS_MAX;
    if (random_below(&random_state, 2)) /* the ray goes to the middle of the triangle */
        for (int k = 0; k < 3; ++k)
            s->at[3 + k] = (s->at[6 + k] + s->at[9 + k] + s->at[12 + k]) / 3.0f - s->at[k];
}

static void change_number(struct subject *s, int i)
{
    uint32_t bits, how = random_below(&random_state, 8);
    if (how == 0)
        s->at[i] = -s->at[i];
    else if (how == 1)
        s->at[i] = either_sign(s->at[random_below(&random_state, 15)]);
    else if (how == 2)
        s->at[i] *= random_below(&random_state, 2) ? 2.0f : 0.5f;
    else if (how == 3)
        s->at[i] = coordinate();
    else { /* moves the number by a few floats */
        uint32_t by = random_below(&random_state, 1u << random_bits(&random_state) % 23) + 1;
        memcpy(&bits, &s->at[i], sizeof bits);
        bits += random_below(&random_state, 2) ? by : 0u - by;
        memcpy(&s->at[i], &bits, sizeof bits);
    }
    float size = fabsf(s->at[i]); /* from 2^-40 to 16 double is accurate enough */
    if (!(size >= 0x1p-40f && size <= 16.0f))
        s->at[i] = either_sign(1.0f);
}

static struct subject changed(const struct subject *s, bool ieee)
{
    struct subject other = *s;
    for (uint32_t n = random_below(&random_state, 3) + 1; n > 0; --n) {
        uint32_t i = random_below(&random_state, 18);
        if (i < 15)
            change_number(&other, (int)i);
        else if (!ieee)
            other.steps[i - 15] = (int)random_below(&random_state, 2 * STEPS_MAX + 1) - STEPS_MAX;
    }
    return other;
}

static void climb(struct subject *s, enum aim aim, bool ieee, uint32_t steps)
{
    double score = score_of(s, aim);
    for (uint32_t i = 0; i < steps; ++i) {
        struct subject other = changed(s, ieee);
        double there = score_of(&other, aim);
        if (there >= score) {
            *s = other;
            score = there;
        }
    }
}

/* ---- Errors in fractions ---- */

/* The exact edge functions of the triangle, in the filter's units: d.(p x q) / d.z for vertices p
   and q relative to the origin, where z is the dominant axis. */
static void edges_in_fractions(const struct view *view, mpq_t edge[VERTICES])
{
    mpq_t p[VERTICES][3], d[3], o[3];
    for (int k = 0; k < 3; ++k)
        mpq_inits(p[0][k], p[1][k], p[2][k], d[k], o[k], NULL);
    set_vector(d, turn_dominant(&view->ray, view->dir));
    set_vector(o, turn_dominant(&view->ray, view->origin));
    for (int i = 0; i < VERTICES; ++i) {
        set_vector(p[i], turn_dominant(&view->ray, view->v[i]));
        for (int k = 0; k < 3; ++k)
            mpq_sub(p[i][k], p[i][k], o[k]);
    }
    for (int i = 0; i < VERTICES; ++i) {
        set_triple(edge[i], d, p[(i + 2) % VERTICES], p[(i + 1) % VERTICES]);
        mpq_div(edge[i], edge[i], d[2]);
    }
    for (int k = 0; k < 3; ++k)
        mpq_clears(p[0][k], p[1][k], p[2][k], d[k], o[k], NULL);
}

/* The largest error of an edge function, as a share of its bound. */
static double worst_edge(const struct view *view)
{
    mpq_t edge[VERTICES], computed;
    double max = 0.0;
    mpq_inits(edge[0], edge[1], edge[2], computed, NULL);
    edges_in_fractions(view, edge);
    for (int i = 0; i < VERTICES; ++i) {
        mpq_set_d(computed, (double)view->edge[i]);
        mpq_sub(computed, computed, edge[i]);
        max = fmax(max, fabs(mpq_get_d(computed)));
    }
    mpq_clears(edge[0], edge[1], edge[2], computed, NULL);
    return max / (double)view->bounds.edge_error;
}

static bool is_within(bool there, float key, float lo, float hi)
{
    return !there || (lo <= key && key <= hi);
}

static bool is_wrong_of_sphere(struct rational *rational, const struct view *view)
{
    const struct sphere_bounds *said = &view->of_sphere;
    struct rational_chord chord;
    bool met =
        rational_meet_sphere(rational, view->origin, view->dir, view->v[0], view->radius, &chord);
    return (said->outside && met) ||
           !is_within(met && chord.near_there, chord.near_key, said->near_lo, said->near_hi) ||
           !is_within(met && chord.far_there, chord.far_key, said->far_lo, said->far_hi);
}

/* Whether the filter is certain of a wrong answer. */
static bool is_wrong(struct rational *rational, const struct view *view)
{
    const struct exact_bounds *said = &view->bounds;
    float key = NAN;
    bool met = rational_meet(rational, view->origin, view->dir, view->v, &key, NULL);
    return (said->outside && met) || (said->inside && !met) ||
           (met && !(said->lo <= key && key <= said->hi));
}

enum { CLIMB_STEPS = 20000 };

struct search {
    const char *name;
    enum aim aim;
    bool worst, ieee; /* the search begins where errors may add up; quotients are rounded right */
    double at_least;  /* the search must reach this share with any seed, else it shows nothing */
};

static const struct search searches[] = {
    {"edge functions", EDGE_ERROR, true, false, 0.4},
    {"edge functions of any ray", EDGE_ERROR, false, false, 0.2},
    {"edge functions, quotients of IEEE", EDGE_ERROR, true, true, 0.2},
    {"signs of edge functions", WRONG_SIGN, true, false, 0.4},
    {"t", T_ERROR, false, false, 0.2},
    {"room", ROOM_ERROR, true, false, 0.7},
    {"room of any ray", ROOM_ERROR, false, false, 0.7},
    {"room, quotients of IEEE", ROOM_ERROR, true, true, 0.7},
    {"sign of the room", MISSED_BY, true, false, 0.05},
    {"ends", END_ERROR, true, false, 0.15},
    {"ends of any ray", END_ERROR, false, false, 0.15},
};

/* Climbs from a random start; towards a wrong sign it first climbs towards a large error. */
static struct subject climb_for(const struct search *search)
{
    struct subject s;
    if (!search->worst)
        start_anywhere(&s);
    else if (search->aim >= ROOM_ERROR)
        start_at_sphere(&s);
    else
        start_across(&s);
    if (search->ieee)
        memset(s.steps, 0, sizeof s.steps);
    if (search->aim == WRONG_SIGN)
        climb(&s, EDGE_ERROR, search->ieee, CLIMB_STEPS);
    if (search->aim == MISSED_BY)
        climb(&s, ROOM_ERROR, search->ieee, CLIMB_STEPS);
    climb(&s, search->aim, search->ieee, CLIMB_STEPS);
    return s;
}

TEST(errors_stay_within_their_bounds)
{
    const uint32_t climbs = cases_of(120);
    own_rational *rational = rational_create(NULL);
    assert_non_null(rational);
    for (size_t k = 0; k < sizeof searches / sizeof *searches; ++k) {
        const struct search *search = &searches[k];
        bool sphere = search->aim >= ROOM_ERROR;
        uint32_t wrong = 0, beyond = 0;
        double max_edge = 0.0, max = 0.0;
        random_state = 1 + sphere;
        for (uint32_t i = 0; i < climbs; ++i) {
            struct view view;
            struct subject s = climb_for(search);
            look_at(&s, &view);
            double edge = sphere ? 0.0 : worst_edge(&view);
            max_edge = fmax(max_edge, edge);
            max = fmax(max, score_of(&s, search->aim));
            beyond += edge > 1.0;
            wrong += sphere ? is_wrong_of_sphere(rational, &view) : is_wrong(rational, &view);
        }
        print_message("%-36s %u errors beyond their bounds, %u wrong answers at the ends of %u "
                      "climbs of %d steps; at most %.3f of the bound, edges %.3f\n",
                      search->name, beyond, wrong, climbs, (int)CLIMB_STEPS, max, max_edge);
        if (beyond + wrong > 0 || !(max >= search->at_least && max <= 1.0))
            fail_msg("%s", search->name);
    }
}
