/* Reflection, refraction and highlights of a surface, after its textures (docs/effects.md, "The
   model" and "glTF metallic-roughness"). */
#include "reference/optics.h"
#include "base/same.h"
#include "reference/texture.h"

#define SCHLICK_POWER 5.0

/* Squared cosine of the refracted ray by Snell's law; negative: total reflection. */
static double refracted_cos2(double cos_in, double eta)
{
    double sine2 = (1.0 - cos_in) * (1.0 + cos_in);
    return 1.0 - eta * eta * sine2;
}

static double schlick_weight(double cos_in)
{
    return same_pow(clamp_unit(1.0 - cos_in), SCHLICK_POWER);
}

/* Share of unpolarised light that a smooth surface reflects; 1: total reflection. By Fresnel's sine
   and tangent laws for angles; near normal incidence, where these divide by 0, by the limit. */
static double fresnel(double cos_in, double eta)
{
    double cos2 = refracted_cos2(cos_in, eta);
    if (eta == 1.0)
        return 0.0;
    if (!(cos2 > 0.0))
        return 1.0;
    double in = same_acos(cos_in), out = same_acos(sqrt(cos2));
    if (in < 1e-3) { /* near normal incidence the reflectance is constant */
        double r = (eta - 1.0) / (eta + 1.0);
        return r * r;
    }
    double sine = same_sin(in - out) / same_sin(in + out);
    double tangent = same_tan(in - out) / same_tan(in + out);
    return 0.5 * (sine * sine + tangent * tangent);
}

static double schlick_reflectance(double cos_in, double eta)
{
    double cos2 = refracted_cos2(cos_in, eta), r = (eta - 1.0) / (eta + 1.0), f0 = r * r;
    if (eta == 1.0)
        return 0.0;
    if (!(cos2 > 0.0))
        return 1.0;
    return f0 + (1.0 - f0) * schlick_weight(eta > 1.0 ? sqrt(cos2) : cos_in);
}

bool optics_refract(struct dvec3 dir, struct dvec3 n, double eta, struct dvec3 *out)
{
    double cos_in = clamp_unit(-dvec3_dot(dir, n)), cos2 = refracted_cos2(cos_in, eta);
    *out = dir;
    if (!(cos2 > 0.0))
        return false;
    /* The tangential part is scaled by eta; the normal part makes the length 1. */
    struct dvec3 across = dvec3_along(dir, n, -dvec3_dot(dir, n));
    *out = d3_unit_or(dvec3_along(d3_scale(across, eta), n, -sqrt(cos2)), dir);
    return true;
}

struct dvec3 optics_reflect(struct dvec3 dir, struct dvec3 n)
{
    return dvec3_along(dir, n, -2.0 * dvec3_dot(dir, n));
}

/* GGX (Walter et al. 2007) times the height-correlated visibility in its usual approximation (Heitz
   2014; Hammon 2017), times pi, since lights carry irradiance / pi. */
static double ggx(double cos_half, double cos_light, double cos_view, double alpha)
{
    double a2 = alpha * alpha, d = cos_half * cos_half * (a2 - 1.0) + 1.0;
    double spread = 2.0 * cos_light * cos_view * (1.0 - alpha) + (cos_light + cos_view) * alpha;
    return a2 / (d * d) * 0.5 / fmax(spread, 1e-7);
}

struct dvec3 optics_highlight(const struct optics *o, struct dvec3 n, struct dvec3 to_light,
                              struct dvec3 view)
{
    struct dvec3 middle = d3_unit_or(d3_add(to_light, view), n);
    double cos_half = clamp_unit(dvec3_dot(middle, n)), cos_light = dvec3_dot(to_light, n);
    if (o->metal_rough) {
        double cos_view = fmax(dvec3_dot(view, n), 0.0);
        return d3_scale(o->highlight, cos_light * ggx(cos_half, cos_light, cos_view, o->alpha));
    }
    return d3_scale(o->highlight, cos_half > 0.0 ? same_pow(cos_half, o->shininess) : 0.0);
}

/* Material values after textures. */
struct finish {
    double metallic, roughness, level;
    struct dvec3 transmission, mirror;
};

static struct finish take_textures(const struct reference *reference, const struct surface *s,
                                   struct optics *o)
{
    const struct scene_material *m = s->material;
    struct dvec3 color = d3_times(s->color, texture_sample(reference, s, SCENE_SLOT_DIFFUSE).rgb);
    struct dvec3 tint = texture_sample(reference, s, SCENE_SLOT_SPECULAR).rgb;
    struct dvec3 metal = texture_sample(reference, s, SCENE_SLOT_METAL_ROUGH).rgb;
    o->diffuse = d3_times(d3_load(m->diffuse), color);
    o->ambient = d3_times(d3_load(m->ambient), color);
    o->highlight = d3_times(d3_load(m->specular), tint);
    o->emission =
        d3_times(d3_load(m->emission), texture_sample(reference, s, SCENE_SLOT_EMISSION).rgb);
    o->shininess = (double)m->shininess * metal.x;
    return (struct finish){
        .metallic = (double)m->metallic * metal.z,
        .roughness = (double)m->roughness * metal.y,
        .level = (double)m->specular_level *
                 texture_sample(reference, s, SCENE_SLOT_SPECULAR_LEVEL).alpha,
        .transmission = d3_scale(d3_load(m->transmission),
                                 texture_sample(reference, s, SCENE_SLOT_TRANSMISSION).rgb.x),
        .mirror = d3_times(d3_load(m->reflection), tint),
    };
}

/* Converts glTF's metallic-roughness model to Whitted's. Gives the share of the mirror ray that
   roughness leaves. */
static double take_metal_rough(const struct scene_material *m, struct finish *f, double cos_view,
                               struct optics *o)
{
    double r0 = ((double)m->ior - 1.0) / ((double)m->ior + 1.0), smooth = 1.0 - f->roughness;
    double gloss = smooth * smooth, weight = schlick_weight(cos_view);
    double kept[3], f0[3], edge = smooth * (f->level * (1.0 - f->metallic) + f->metallic);
    double specular[3] = {o->highlight.x, o->highlight.y, o->highlight.z};
    double base[3] = {o->diffuse.x, o->diffuse.y, o->diffuse.z};
    double through[3] = {f->transmission.x, f->transmission.y, f->transmission.z}, mirror[3];
    for (int c = 0; c < 3; ++c) {
        double dielectric = fmin(specular[c] * r0 * r0, 1.0) * f->level;
        f0[c] = dielectric * (1.0 - f->metallic) + base[c] * f->metallic;
        mirror[c] = (f0[c] + (fmax(edge, f0[c]) - f0[c]) * weight) * gloss;
        kept[c] = base[c] * (1.0 - f->metallic) * (1.0 - clamp_unit(through[c]));
        through[c] *= base[c] * (1.0 - f->metallic);
    }
    o->diffuse = d3(kept[0], kept[1], kept[2]);
    o->highlight = d3(f0[0], f0[1], f0[2]);
    o->ambient = dvec3_along(o->diffuse, o->highlight, 1.0 - gloss);
    o->alpha = fmax(f->roughness * f->roughness, 0.02);
    o->reflected = d3(mirror[0], mirror[1], mirror[2]);
    f->transmission = d3(through[0], through[1], through[2]);
    return gloss;
}

static void take_glass(const struct reference *reference, const struct scene_material *m,
                       const struct finish *f, double cos_view, double gloss, struct optics *o)
{
    bool total = !o->thin && !(refracted_cos2(cos_view, o->eta) > 0.0);
    double eta = o->thin ? 1.0 / (double)m->ior : o->eta;
    double share = reference->params.picture.schlick ? schlick_reflectance(cos_view, eta)
                                                     : fresnel(cos_view, eta);
    if (o->thin) /* both faces of a sheet, with all reflections between them */
        share = 2.0 * share / (1.0 + share);
    o->refracted = d3_scale(f->transmission, total ? 0.0 : m->fresnel ? 1.0 - share : 1.0);
    if (total)
        o->reflected = d3_all(1.0);
    else if (m->fresnel)
        o->reflected = d3_all(share * gloss);
}

struct optics optics_at(const struct reference *reference, struct surface *s, struct dvec3 dir,
                        double eta)
{
    const struct scene_material *m = s->material;
    struct optics o = {.unlit = m->model == WHIT_MODEL_UNLIT,
                       .metal_rough = m->model == WHIT_MODEL_METAL_ROUGH,
                       .thin = m->thin_walled,
                       .alpha = 1.0,
                       .eta = eta};
    struct finish f = take_textures(reference, s, &o);
    if (m->alpha == SCENE_ALPHA_BLEND)
        o.straight = clamp_unit(1.0 - texture_opacity(reference, s) * s->alpha);
    texture_bend_normal(reference, s);
    double cos_view = clamp_unit(fabs(dvec3_dot(dir, s->ns))), gloss = 1.0;
    o.reflected = f.mirror;
    if (o.metal_rough)
        gloss = take_metal_rough(m, &f, cos_view, &o);
    if (d3_largest(f.transmission) > 0.0)
        take_glass(reference, m, &f, cos_view, gloss, &o);
    else if (m->fresnel && !o.metal_rough && d3_largest(o.reflected) > 0.0)
        o.reflected = d3_mix(o.reflected, d3_all(1.0), schlick_weight(cos_view));
    return o;
}

void optics_make_catcher(struct optics *o)
{
    *o = (struct optics){.diffuse = d3_all(1.0),
                         .straight = 1.0,
                         .shininess = o->shininess,
                         .alpha = o->alpha,
                         .eta = o->eta,
                         .thin = o->thin};
}
