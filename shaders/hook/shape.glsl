// A shape of the user's: his function intersect() in the box that his file names. It is in no tree. A ray is held
// against the box, and asks the function where it enters that: rays of pictures in kernel/shape.comp, before they
// go through the trees, and those of the user's functions in trace() and visible(), behind that.
#ifndef HOOK_SHAPE_GLSL
#define HOOK_SHAPE_GLSL

// The pixel + 1 in whose name the answers for the ray are checked; 0: they are not.
uint shape_checked = 0u;

// Where a ray is within the box, widened by what answers may be off; and how far from its origin an answer is
// looked at without the box: a function that marches through the void takes long to the end of the world.
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

// What intersect() said.
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

// Holds the answer with the box against that without: without box and trees a ray meets the same, or the
// function is not one of a shape in its box.
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

// The nearest point of the shape, after the distance t <= far along a unit direction. The loop has one turn, and
// one more for rays that are checked: so the function is in the kernel once.
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

// Keeps the shape in `hit`, what the ray has met so far, where the ray meets that first.
void add_shape(vec3 origin, vec3 dir, bool alive, inout Hit hit)
{
    // It may be a function of the user's that traces.
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
