// A user's shape: the function intersect() in the box that the file names. It is in no tree. A ray
// is tested against the box, and intersect() is called for it from where it enters the box: for
// rays of pictures in kernel/shape.comp, before they go through the trees; for rays of the user's
// functions in trace() and visible(), after the trees.
#ifndef HOOK_SHAPE_GLSL
#define HOOK_SHAPE_GLSL

// 1 + the pixel for which the ray's answers are checked; 0: they are not checked.
uint shape_checked = 0u;

// Where a ray enters and leaves the box, which is widened by `error`. `far_bare`: how far from its
// origin the ray is followed without the box; limited, since a function that marches through empty
// space would take long.
void enter_shape_box(vec3 origin, vec3 dir, out float enter, out float leave, out float slack, out float far_bare)
{
    vec3 lo, hi;
    float error;
    shape_box(lo, hi, error);
    dir = mix(dir, vec3(1e-20), lessThan(abs(dir), vec3(1e-20)));
    vec3 a = (lo - error - origin) / dir, b = (hi + error - origin) / dir;
    vec3 near = min(a, b), far = max(a, b);
    enter = max(max(near.x, near.y), max(near.z, 0.0));
    leave = min(far.x, min(far.y, far.z));
    slack = error + rounding_bound(64.0) * abs(leave);
    far_bare = length(0.5 * (lo + hi) - origin) + 2.0 * length(hi - lo);
}

// The answer of intersect().
struct ShapeAnswer {
    bool met;
    float t;
    vec3 normal;
};

bool is_number(ShapeAnswer answer)
{
    float sum = answer.t + answer.normal.x + answer.normal.y + answer.normal.z;
    return !answer.met || (floatBitsToUint(sum) & 0x7f800000u) != 0x7f800000u;
}

// Compares the answer with the box to that without it: without box and trees a ray must meet the
// same, else the function depends on more than the ray, or the shape is not in its box.
void check_shape(ShapeAnswer boxed, ShapeAnswer bare, float far, float leave, bool enters)
{
    bool outside = bare.met && bare.t >= 0.0 && (!enters || bare.t > leave);
    bool expected = bare.met && bare.t >= 0.0 && bare.t <= far;
    bool other = enters && (expected != boxed.met || (expected && bare.t != boxed.t));
    uint reason = !is_number(boxed) || !is_number(bare) ? SHAPE_NOT_A_NUMBER
                  : outside                             ? SHAPE_OUTSIDE
                  : other                               ? SHAPE_BY_REACH
                                                        : 0u;
    uint told = reason << SHAPE_REASON_SHIFT | (SHAPE_PIXEL_MASK - (shape_checked - 1u));
    hook_shape = reason != 0u ? max(hook_shape, told) : hook_shape;
}

// The nearest point of the shape, at a distance t <= far along a unit direction. The loop has one
// iteration, and a second one for rays that are checked, so that the user's function is in the
// kernel only once.
ShapeAnswer ask_shape(vec3 origin, vec3 dir, float far, bool alive)
{
    float enter, leave, slack, far_bare;
    enter_shape_box(origin, dir, enter, leave, slack, far_bare);
    bool enters = alive && enter <= leave, checked = alive && shape_checked != 0u, more = false;
    vec3 start = enters ? origin + dir * enter : origin;
    float reach = min(far, leave) - enter;
    ShapeAnswer boxed = ShapeAnswer(false, 0.0, vec3(0.0)), bare = boxed;
    bool records = hook_records;
    do {
        hook_records = records && !more;
        bool wanted = more || (enters && reach >= 0.0);
        ShapeAnswer answer = ShapeAnswer(false, 0.0, vec3(0.0));
        if (wanted) {
            begin_hook();
            answer.met = intersect(start, dir, more ? far_bare : reach, answer.t, answer.normal);
            end_hook(true);
        }
        if (more)
            bare = answer;
        else
            boxed = answer;
        more = checked && !more;
    } while (another_iteration(more));
    hook_records = records;
    bool fine = is_number(boxed);
    boxed.met = boxed.met && (!fine || (boxed.t >= 0.0 && boxed.t <= reach));
    if (checked)
        check_shape(boxed, bare, reach, leave - enter + slack, enters);
    boxed.met = boxed.met && fine;
    boxed.t += enter;
    return boxed;
}

// Makes the shape the ray's hit where it is nearer than `hit`, the hit so far.
void add_shape(vec3 origin, vec3 dir, bool alive, inout Hit hit)
{
    // The caller may be a user's function, whose fuel must stay as it is.
    uint fuel = whit_fuel, fuel_loop = whit_fuel_loop;
    float size = sqrt(dot(dir, dir));
    ShapeAnswer answer = ask_shape(origin, dir / size, min(hit.t * size, FLOAT_LARGEST), alive);
    whit_fuel = fuel;
    whit_fuel_loop = fuel_loop;
    float t = answer.t / size;
    if (!answer.met || (hit.primitive != HIT_NONE && t >= hit.t))
        return;
    put_shape_in(hit, t, square_from_dir(normalize_or(answer.normal, -dir)));
}

#endif
