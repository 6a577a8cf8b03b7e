//@ whit 1
// Glass that bends blue more than red: each sample of a pixel follows one of three wavelengths, at random,
// for three times its light. Needs some samples: --aa 64.
//@ slider spread 0 0.2 0.04 "how much the index of refraction differs from red to blue"

void scatter(Surface s, Optics o, inout Rays rays)
{
    whit_scatter(s, o, rays);
    if (rays.refracted == vec3(0.0))
        return;
    // One choice for all of a camera ray's tree: by pixel and sample, not by ray.
    uint channel = hash(pixel().x ^ hash(pixel().y ^ hash(sample_number()))) % 3u;
    float shift = (float(channel) - 1.0) * spread; // red, green, blue
    bool goes_in = o.eta < 1.0;
    float eta = goes_in ? o.eta / (1.0 + shift) : o.eta * (1.0 + shift);
    vec3 dir;
    if (!o.thin && refract_dir(ray_dir(), s.ns, eta, dir))
        rays.refracted_dir = dir;
    if (bounces() == 0u)
        rays.refracted *= vec3(equal(uvec3(channel), uvec3(0u, 1u, 2u))) * 3.0;
}
