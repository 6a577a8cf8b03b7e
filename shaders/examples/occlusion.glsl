//@ whit 1
// Ambient occlusion: how much of what is above a surface is open, within a distance.
//@ slider reach 0.01 10 1 "world units"
//@ slider rays 1 64 16 "per sample of a pixel"

// A random direction around n, with density cosine / pi; u and v are random numbers.
vec3 cosine_direction(vec3 n, float u, float v)
{
    float turn = 6.2831853 * u, z = 2.0 * v - 1.0, r = sqrt(max(1.0 - z * z, 0.0));
    vec3 dir = n + vec3(r * cos(turn), r * sin(turn), z); // a point of the ball that touches the surface
    return dot(dir, dir) > 1e-6 ? normalize(dir) : n;
}

vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    float open = 0.0;
    uint count = uint(rays);
    for (uint i = 0u; i < count; i++) {
        vec3 dir = cosine_direction(s.ns, random(2u * i), random(2u * i + 1u));
        if (dot(dir, s.ng) > 0.0)
            open += visible(s, dir, reach).g;
    }
    return vec3(open / float(count));
}

void scatter(Surface s, Optics o, inout Rays rays)
{
}

vec3 miss(vec3 dir)
{
    return vec3(1.0);
}
