// The interaction of a surface with light, after textures: the Whitted model.
#ifndef BIND_OPTICS_GLSL
#define BIND_OPTICS_GLSL

#include "../lib/optics.glsl"
#include "texels.glsl"

// The share of light that a smooth interface of two media reflects; see fresnel_dielectric().
float reflected_share(float cos_in, float eta)
{
    return SPEC_FRESNEL == FRESNEL_SCHLICK ? schlick_dielectric(cos_in, eta)
                                           : fresnel_dielectric(cos_in, eta);
}

// `eta`: index of refraction of the side that the ray comes from over that of the other.
Optics surface_optics(inout Surface s, gpu_material m, vec3 dir, float eta)
{
    Optics o;
    o.unlit = m.model == MATERIAL_MODEL_UNLIT;
    o.metal_rough = SPEC_METAL_ROUGH != 0u && m.model == MATERIAL_MODEL_METAL_ROUGH;
    o.diffuse = m.diffuse * s.color;
    o.ambient = m.ambient * s.color;
    o.highlight = m.specular;
    o.emission = SPEC_EMISSION != 0u ? m.emission : vec3(0.0);
    o.shininess = m.shininess;
    o.straight = 0.0;
    float opacity = m.opacity * s.color_alpha;
    float metallic = m.metallic, roughness = m.roughness, specular_level = m.specular_level;
    vec3 transmission = m.transmission, mirror = m.reflection;
    if (SPEC_TEXTURES != 0u || SPEC_NORMAL_MAPS != 0u) {
        Texels x = sample_texels_of(s, m);
        if ((SPEC_TEXTURES & TEXTURES_DIFFUSE) != 0u) {
            o.diffuse *= x.diffuse;
            o.ambient *= x.diffuse;
        }
        if ((SPEC_TEXTURES & TEXTURES_SPECULAR) != 0u) {
            o.highlight *= x.specular;
            mirror *= x.specular;
        }
        if ((SPEC_TEXTURES & TEXTURES_EMISSION) != 0u)
            o.emission *= x.emission;
        if ((SPEC_TEXTURES & TEXTURES_METAL_ROUGH) != 0u) {
            o.shininess *= x.metal_rough.r;
            roughness *= x.metal_rough.g;
            metallic *= x.metal_rough.b;
        }
        if ((SPEC_TEXTURES & TEXTURES_SPECULAR_LEVEL) != 0u)
            specular_level *= x.specular_level;
        if ((SPEC_TEXTURES & TEXTURES_TRANSMISSION) != 0u)
            transmission *= x.transmission;
        if (SPEC_CUTOUTS != 0u && (SPEC_TEXTURES & TEXTURES_OPACITY) != 0u)
            opacity = opacity_of(m, x.opacity) * s.color_alpha;
        if (SPEC_NORMAL_MAPS != 0u)
            bend_normal(s, m, x);
    }
    if (SPEC_CUTOUTS != 0u && (m.flags & MATERIAL_BLEND) != 0u)
        o.straight = clamp(1.0 - opacity, 0.0, 1.0);

    float cos_view = clamp(abs(dot(dir, s.ns)), 0.0, 1.0);
    o.eta = eta;
    o.thin = (m.flags & MATERIAL_THIN) != 0u;
    o.reflected = SPEC_REFLECTION != 0u ? mirror : vec3(0.0);
    o.alpha = 1.0;
    bool fresnel = SPEC_FRESNEL != FRESNEL_NONE && (m.flags & MATERIAL_FRESNEL) != 0u;
    float gloss = 1.0; // share that roughness leaves of the mirror ray
    if (o.metal_rough) {
        float r0 = (m.ior - 1.0) / (m.ior + 1.0);
        vec3 f0 = min(o.highlight * (r0 * r0), vec3(1.0)) * specular_level;
        f0 = mix(f0, o.diffuse, metallic);
        gloss = (1.0 - roughness) * (1.0 - roughness);
        vec3 edge = max(vec3(1.0 - roughness) * mix(specular_level, 1.0, metallic), f0);
        vec3 f = f0 + (edge - f0) * schlick_weight(cos_view);
        vec3 kept = SPEC_REFRACTION != 0u ? 1.0 - clamp(transmission, 0.0, 1.0) : vec3(1.0);
        transmission *= o.diffuse * (1.0 - metallic);
        o.diffuse *= (1.0 - metallic) * kept;
        o.ambient = o.diffuse + f0 * (1.0 - gloss);
        o.highlight = f0;
        o.alpha = max(roughness * roughness, 0.02);
        o.reflected = SPEC_REFLECTION != 0u ? f * gloss : vec3(0.0);
    } else if (fresnel && SPEC_REFRACTION == 0u) {
        o.reflected += (vec3(1.0) - o.reflected) * schlick_weight(cos_view) *
                       float(max(o.reflected.r, max(o.reflected.g, o.reflected.b)) > 0.0);
    }
    o.refracted = vec3(0.0);
    if (SPEC_REFRACTION != 0u) {
        bool glass = max(transmission.r, max(transmission.g, transmission.b)) > 0.0;
        float share = 0.0;
        if (SPEC_FRESNEL != FRESNEL_NONE) {
            share = reflected_share(cos_view, o.thin ? 1.0 / m.ior : o.eta);
            if (o.thin) // both faces of a sheet, without interference
                share = 2.0 * share / (1.0 + share);
        }
        bool total = !o.thin && !(refracted_cos2(cos_view, o.eta) > 0.0);
        if (glass) {
            o.refracted = fresnel ? transmission * (1.0 - share) : transmission;
            if (total)
                o.refracted = vec3(0.0);
            if (fresnel || total)
                o.reflected = vec3(total ? 1.0 : share * gloss);
        } else if (fresnel && !o.metal_rough) {
            o.reflected += (vec3(1.0) - o.reflected) * schlick_weight(cos_view) *
                           float(max(o.reflected.r, max(o.reflected.g, o.reflected.b)) > 0.0);
        }
        if (SPEC_REFLECTION == 0u && !total)
            o.reflected = vec3(0.0);
    }
    return o;
}

#endif
