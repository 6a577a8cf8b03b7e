// A shape of the user's: his function intersect() in the box that his file names. It is in no tree. A ray that
// has been through the trees is held against the box, and asks the function where it enters that before what
// it has met.
#ifndef HOOK_SHAPE_GLSL
#define HOOK_SHAPE_GLSL

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

void add_shape(const uint mode, vec3 origin, vec3 dir, bool alive, inout Hit hit)
{
    bool asks = mode == TRAVERSE_CLOSEST || (mode == TRAVERSE_SHADOW && hit.primitive == HIT_NONE);
    if (mode != TRAVERSE_CLOSEST && mode != TRAVERSE_SHADOW)
        return;
    // It may be a function of the user's that traces.
    uint fuel = whit_fuel, fuel_loop = whit_fuel_loop;
    float size = sqrt(dot(dir, dir));
    ShapeAnswer answer = ask_shape(origin, dir / size, min(hit.t * size, FLOAT_LARGEST), alive && asks);
    whit_fuel = fuel;
    whit_fuel_loop = fuel_loop;
    float t = answer.t / size;
    if (!answer.met || (hit.primitive != HIT_NONE && t >= hit.t))
        return;
    hit.t = hit.lo = hit.hi = t;
    vec2 square = square_from_dir(normalize_or(answer.normal, -dir));
    hit.u = square.x;
    hit.v = square.y;
    hit.triangle = hit.instance = HIT_SHAPE;
    hit.primitive = 0u;
    hit.at_exit = false;
    hit.glass = (frame.shape_material & SHAPE_IS_GLASS) != 0u;
}

void put_on_shape(float t, vec2 square, inout Surface s)
{
    vec3 lo, hi;
    float error;
    shape_box(lo, hi, error);
    s.p = met_origin + met_dir * t;
    s.error = vec3(2.0 * error) + rounding_bound(8.0) * (abs(met_origin) + abs(met_dir * t));
    vec3 n = dir_from_square(square);
    s.ng = n / sqrt(dot(n, n));
    s.ns = s.ng;
    vec3 aside = abs(s.ng.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    s.e1 = normalize(cross(s.ng, aside));
    s.e2 = cross(s.ng, s.e1);
    s.color = vec3(1.0);
    s.color_alpha = 1.0;
    s.shade_index = 0u;
    s.instance = HIT_SHAPE;
    s.on_sphere = true; // nothing of a mesh's vertices counts
    s.material = frame.shape_material & ~SHAPE_IS_GLASS;
    s.u = 0.0;
    s.v = 0.0;
}

#endif
