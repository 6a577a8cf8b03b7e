// Reflection, refraction and highlights.
#ifndef LIB_OPTICS_GLSL
#define LIB_OPTICS_GLSL

// Share of unpolarised light that a smooth dielectric reflects. `cos_in` in [0, 1]; `eta`: index of
// the side the ray comes from over that of the other. 1 under total reflection. The difference
// cos_in^2 terms are kept exact near the critical angle by testing the squared sine itself.
float fresnel_dielectric(float cos_in, float eta)
{
    float sin2_out = eta * eta * (1.0 - cos_in * cos_in);
    if (!(sin2_out < 1.0))
        return 1.0;
    float cos_out = sqrt(1.0 - sin2_out);
    float parallel = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
    float perpendicular = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Snell. False under total reflection. `n` on the ray's side, `dir` unit.
bool refract_dir(vec3 dir, vec3 n, float eta, out vec3 refracted)
{
    float cos_in = min(-dot(dir, n), 1.0);
    float sin2_out = eta * eta * (1.0 - cos_in * cos_in);
    if (!(sin2_out < 1.0)) {
        refracted = vec3(0.0);
        return false;
    }
    refracted = normalize(eta * dir + (eta * cos_in - sqrt(1.0 - sin2_out)) * n);
    return true;
}

// (1 - cos)^5 by multiplication: pow() is off by tens of ulp.
float schlick_weight(float cos_in)
{
    float x = clamp(1.0 - cos_in, 0.0, 1.0);
    float x2 = x * x;
    return x2 * x2 * x;
}

// Blinn's highlight, as MTL defines it: (n . h)^shininess.
float blinn_highlight(float cos_half, float shininess)
{
    return cos_half > 0.0 ? pow(cos_half, shininess) : 0.0;
}

// GGX times visibility (Heitz 2014, height-correlated, the usual approximation), times pi: lights
// carry irradiance over pi. `alpha` is roughness squared.
float ggx_highlight(float cos_half, float cos_light, float cos_view, float alpha)
{
    float a2 = alpha * alpha;
    float d = cos_half * cos_half * (a2 - 1.0) + 1.0;
    float spread = mix(2.0 * cos_light * cos_view, cos_light + cos_view, alpha);
    return a2 / (d * d) * 0.5 / max(spread, 1e-7);
}

#endif
