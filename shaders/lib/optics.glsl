// Reflection, refraction and highlights.
#ifndef LIB_OPTICS_GLSL
#define LIB_OPTICS_GLSL

// The square of the cosine behind the surface; negative under total reflection. It is 1 - (eta
// sin)^2, in differences that are exact near 0: cos_in^2 itself where eta is 1, and nearly so where
// eta is nearly 1.
float refracted_cos2(float cos_in, float eta)
{
    return cos_in * cos_in + (1.0 - cos_in) * (1.0 + cos_in) * (1.0 - eta) * (1.0 + eta);
}

// The share of unpolarised light that a smooth dielectric reflects. `cos_in` in [0, 1]; `eta`:
// index of refraction of the side that the ray comes from over that of the other. 1 under total
// reflection, and for cos_in 0.
float fresnel_dielectric(float cos_in, float eta)
{
    float cos2_out = refracted_cos2(cos_in, eta);
    if (eta == 1.0)
        return 0.0;
    if (!(cos2_out > 0.0))
        return 1.0;
    float cos_out = sqrt(cos2_out);
    float parallel = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
    float perpendicular = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Snell's law. False under total reflection. `n` is on the ray's side, `dir` is unit.
bool refract_dir(vec3 dir, vec3 n, float eta, out vec3 refracted)
{
    float cos_in = clamp(-dot(dir, n), 0.0, 1.0);
    float cos2_out = refracted_cos2(cos_in, eta);
    if (!(cos2_out > 0.0)) {
        refracted = vec3(0.0);
        return false;
    }
    refracted = normalize(eta * dir + (eta * cos_in - sqrt(cos2_out)) * n);
    return true;
}

// (1 - cos)^5 by multiplication, since pow() is off by tens of ulp.
float schlick_weight(float cos_in)
{
    float x = clamp(1.0 - cos_in, 0.0, 1.0);
    float x2 = x * x;
    return x2 * x2 * x;
}

// Schlick's approximation (1994) of fresnel_dielectric(), with the cosine on the side of the
// smaller index, where the angle goes up to 90 degrees. Off by up to 0.060 (index 1.33), 0.036
// (1.5) or 0.076 (2.42).
float schlick_dielectric(float cos_in, float eta)
{
    float cos2_out = refracted_cos2(cos_in, eta);
    if (eta == 1.0)
        return 0.0;
    if (!(cos2_out > 0.0))
        return 1.0;
    float r = (1.0 - eta) / (1.0 + eta);
    float f0 = r * r;
    return f0 + (1.0 - f0) * schlick_weight(eta > 1.0 ? sqrt(cos2_out) : cos_in);
}

// Blinn's highlight, as MTL defines it: (n . h)^shininess.
float blinn_highlight(float cos_half, float shininess)
{
    return cos_half > 0.0 ? pow(cos_half, shininess) : 0.0;
}

// GGX times visibility (Heitz 2014, height-correlated, in the usual approximation), times pi, since
// lights carry irradiance over pi. `alpha` is roughness squared.
float ggx_highlight(float cos_half, float cos_light, float cos_view, float alpha)
{
    float a2 = alpha * alpha;
    // cos^2 (a2 - 1) + 1, rearranged: as written, its difference would lose the tip of a sharp
    // highlight.
    float d = (1.0 - cos_half) * (1.0 + cos_half) + cos_half * cos_half * a2;
    float spread = mix(2.0 * cos_light * cos_view, cos_light + cos_view, alpha);
    return a2 / (d * d) * 0.5 / max(spread, 1e-7);
}

#endif
