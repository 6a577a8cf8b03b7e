// A shape of your own, in a box that `//@ box` gives by its least and largest corner, world space. After the
// corners comes how far from the shape an answer may be, and optionally the name of a material of the scene.
// The shape is in the scene beside its meshes: it is shaded, is mirrored and casts shadows as they do.
//
// origin, dir: the ray, from where it enters the box or starts in it; world space, dir is unit
// far:         the largest t that matters: nothing behind it need be found
// t, normal:   where the ray meets the shape first, origin + t * dir, and the normal to the outside there
// gives:       whether it does. The answer may depend on the ray alone: for camera rays whit asks a
//              second time, as if there were neither box nor scene, and another answer is an error.
float ball(vec3 p) // distance of p from the shape, below 0 inside
{
    return length(p - vec3(0.0, 1.0, 0.0)) - 0.9;
}

//@ box -1 0 -1  1 2 1  0.001
bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal)
{
    t = 0.0;
    normal = vec3(0.0);
    for (int i = 0; i < 128 && t <= far; i++) {
        vec3 p = origin + t * dir;
        float d = ball(p);
        if (d < 0.001) {
            vec2 e = vec2(0.0005, 0.0);
            normal = vec3(ball(p + e.xyy) - ball(p - e.xyy), ball(p + e.yxy) - ball(p - e.yxy),
                          ball(p + e.yyx) - ball(p - e.yyx));
            return true;
        }
        t += d;
    }
    return false;
}
