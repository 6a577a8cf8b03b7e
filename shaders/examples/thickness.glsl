//@ whit 1
// An x-ray picture: what is thick is dark.
//@ slider half_length 0.01 10 0.5 "world units of matter that let half of the light through"
//@ slider layers 1 64 16 "surfaces that a ray may cross"

vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    float inside = 0.0;
    vec3 dir = ray_dir();
    Surface at = s;
    bool within = true; // the ray is inside
    for (uint i = 0u; i < uint(layers); i++) {
        Surface next;
        float distance;
        if (!trace(off_surface(at, dir), dir, next, distance))
            break;
        inside += within ? distance : 0.0;
        within = !within;
        at = next;
    }
    return vec3(exp2(-inside / half_length));
}

void scatter(Surface s, Optics o, inout Rays rays)
{
}

vec3 miss(vec3 dir)
{
    return vec3(1.0);
}
