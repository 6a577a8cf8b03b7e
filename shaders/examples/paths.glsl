//@ whit 1
// A path tracer: diffuse surfaces send a ray on too, at random. Needs many samples: --aa 256, or the
// viewer, which goes on by itself; and --shadows opaque, as rays bring what comes through glass.
//@ slider bounce 0 1 1 "share of the indirect light"

vec3 cosine_direction(vec3 n, float u, float v)
{
    float turn = 6.2831853 * u, z = 2.0 * v - 1.0, r = sqrt(max(1.0 - z * z, 0.0));
    vec3 dir = n + vec3(r * cos(turn), r * sin(turn), z);
    return dot(dir, dir) > 1e-6 ? normalize(dir) : n;
}

// Whether a diffuse surface sends its ray on, for 1 / TURNS of its light. The next surface asks again: the answer
// depends on pixel, sample and number of bounces alone.
const float TURNS = 0.8;
bool is_turn(uint bounce_number)
{
    uint path = hash(pixel().x ^ hash(pixel().y ^ hash(sample_number() ^ hash(bounce_number))));
    return float(path >> 8) < TURNS * 16777216.0;
}

// Whit's own direct light, without the ambient term: the rays bring that light. The direct light of surfaces that
// glow is in it too, so only rays from mirrors and glass, which go on at all turns, see them glow.
vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    Optics direct = o;
    direct.ambient = vec3(0.0);
    if (bounces() > 0u)
        direct.emission *= is_turn(bounces() - 1u) ? 0.0 : 1.0 / (1.0 - TURNS);
    return whit_shade(s, direct, to_eye);
}

void scatter(Surface s, Optics o, inout Rays rays)
{
    whit_scatter(s, o, rays);
    float mirror = max(rays.reflected.r, max(rays.reflected.g, rays.reflected.b));
    float diffuse = max(o.diffuse.r, max(o.diffuse.g, o.diffuse.b)) * bounce * (1.0 - o.straight);
    float sum = mirror + diffuse;
    if (o.unlit || !(diffuse > 0.0) || !is_turn(bounces()))
        return;
    // One ray stands for both, chosen in proportion to the light that each brings.
    if (random(0u) * sum < diffuse) {
        rays.reflected = o.diffuse * (bounce * (1.0 - o.straight) * sum / (diffuse * TURNS));
        rays.reflected_dir = cosine_direction(s.ns, random(1u), random(2u));
    } else {
        rays.reflected *= sum / mirror;
    }
}
