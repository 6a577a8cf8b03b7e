//@ whit 1
// A knot that turns into a ball: a shape by its distance function, in the scene beside the meshes.
//@ slider ball 0 1 0.25 "how much of it is a ball"
//@ slider thick 0.05 0.3 0.14 "radius of the tube, world units"
//@ slider turns 1 7 3 "how often the tube winds"
//@ box -0.75 0.1 0  0.85 1.7 1.6  0.0005 brass

const vec3 MIDDLE = vec3(0.05, 0.9, 0.8);

// The distance of p from the shape, or less; below 0 inside.
float shape(vec3 p)
{
    p -= MIDDLE;
    float around = atan(p.z, p.x), out_of_ring = length(p.xz) - 0.48;
    float angle = 0.5 * around * floor(turns), tube = 1e9;
    for (int i = 0; i < 2; i++) { // the two sides of the strand that winds
        vec2 at = vec2(out_of_ring, p.y) - 0.15 * vec2(cos(angle), sin(angle));
        tube = min(tube, length(at) - thick);
        angle += 3.14159265;
    }
    float round_one = length(p) - 0.7;
    return 0.5 * mix(tube, round_one, ball); // halved, as the strand's value grows faster than the distance
}

vec3 normal_of(vec3 p)
{
    vec2 e = vec2(0.0005, 0.0);
    return normalize(vec3(shape(p + e.xyy) - shape(p - e.xyy), shape(p + e.yxy) - shape(p - e.yxy),
                          shape(p + e.yyx) - shape(p - e.yyx)));
}

bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal)
{
    t = 0.0;
    normal = vec3(0.0);
    for (int i = 0; i < 200 && t <= far; i++) {
        float d = shape(origin + t * dir);
        if (d < 0.0005) {
            normal = normal_of(origin + t * dir);
            return true;
        }
        t += d;
    }
    return false;
}

//@ test
void the_shape_is_in_its_box(uint seed)
{
    vec3 p = 6.0 * vec3(random(3u * seed), random(3u * seed + 1u), random(3u * seed + 2u)) - 3.0 + MIDDLE;
    vec3 out_of_box = abs(p - MIDDLE) - 0.8;
    check(shape(p) > 0.0 || max(out_of_box.x, max(out_of_box.y, out_of_box.z)) <= 0.0);
}
