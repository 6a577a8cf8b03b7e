/* Textures: bilinear or nearest, with wrap modes, in linear light; opacity; normal and bump
   maps. */
#include "reference/texture.h"

static bool is_used(const struct scene_material *m, enum scene_slot slot)
{
    return m->textures[slot].texture != SCENE_NONE;
}

static int64_t wrap(int64_t at, int64_t size, enum scene_wrap how)
{
    if (how == SCENE_WRAP_CLAMP)
        return at < 0 ? 0 : at >= size ? size - 1 : at;
    int64_t period = how == SCENE_WRAP_MIRROR ? 2 * size : size;
    int64_t within = (at % period + period) % period;
    return within < size ? within : 2 * size - 1 - within;
}

/* Removes whole periods from a texture coordinate, so that it fits an integer. */
static double reduce(double x, enum scene_wrap how)
{
    double reduced = how == SCENE_WRAP_CLAMP ? fmin(fmax(x, -1.0), 2.0) : fmod(x, 2.0);
    return isfinite(reduced) ? reduced : 0.0;
}

/* A mipmap level of a texture. */
struct level {
    const uint8_t *rgba;
    uint32_t width, height;
};

static struct texel fetch(const struct reference *reference, const struct level *t, int64_t x,
                          int64_t y, bool srgb)
{
    const uint8_t *rgba = &t->rgba[4 * (size_t)(y * (int64_t)t->width + x)];
    const double *linear = reference->linear;
    struct texel out = {.alpha = rgba[3] / 255.0};
    out.rgb = srgb ? d3(linear[rgba[0]], linear[rgba[1]], linear[rgba[2]])
                   : d3(rgba[0] / 255.0, rgba[1] / 255.0, rgba[2] / 255.0);
    return out;
}

static struct texel mix_texels(struct texel a, struct texel b, double part)
{
    return (struct texel){d3_mix(a.rgb, b.rgb, part), a.alpha * (1.0 - part) + b.alpha * part};
}

static struct texel sample_level(const struct reference *reference, const struct level *t,
                                 const struct scene_texture_use *use, const double uv[2], bool srgb)
{
    double x = reduce(uv[0], use->wrap_u) * t->width, y = reduce(uv[1], use->wrap_v) * t->height;
    double shift = use->nearest ? 0.0 : 0.5;
    double left = floor(x - shift), top = floor(y - shift);
    int64_t x0 = wrap((int64_t)left, t->width, use->wrap_u);
    int64_t x1 = wrap((int64_t)left + 1, t->width, use->wrap_u);
    int64_t y0 = wrap((int64_t)top, t->height, use->wrap_v);
    int64_t y1 = wrap((int64_t)top + 1, t->height, use->wrap_v);
    if (use->nearest)
        return fetch(reference, t, x0, y0, srgb);
    double px = x - shift - left, py = y - shift - top;
    struct texel above =
        mix_texels(fetch(reference, t, x0, y0, srgb), fetch(reference, t, x1, y0, srgb), px);
    struct texel below =
        mix_texels(fetch(reference, t, x0, y1, srgb), fetch(reference, t, x1, y1, srgb), px);
    return mix_texels(above, below, py);
}

/* Texture coordinates of the three corners, in the UV set of a texture use; for spheres such that u
   and v are the coordinates themselves. */
static void corner_uvs(const struct surface *s, const struct scene_texture_use *use,
                       double uvs[3][2])
{
    const float *set =
        s->mesh->uvs[use->uv_set != 0] ? s->mesh->uvs[use->uv_set != 0] : s->mesh->uvs[0];
    for (size_t k = 0; k < 3; ++k) {
        uvs[k][0] = s->sphere && k == 1;
        uvs[k][1] = s->sphere && k == 2;
        if (s->sphere || !set)
            continue;
        const float *uv = &set[2 * (size_t)s->mesh->indices[3 * (size_t)s->primitive + k]];
        uvs[k][0] = (double)uv[0];
        uvs[k][1] = (double)uv[1];
    }
}

static void place_uv(const struct surface *s, const struct scene_texture_use *use, double uv[2])
{
    double corners[3][2], at[2];
    const float *m = use->transform;
    corner_uvs(s, use, corners);
    for (int i = 0; i < 2; ++i)
        at[i] = corners[0][i] * (1.0 - s->u - s->v) + corners[1][i] * s->u + corners[2][i] * s->v;
    for (int i = 0; i < 2; ++i)
        uv[i] = (double)m[3 * i] * at[0] + (double)m[3 * i + 1] * at[1] +
                (double)scene_texture_offset(use, i);
}

/* The size of the ray's footprint in texels of level 0: mean of the squared lengths of its two
   sides. */
static double footprint_texels(const struct surface *s, const struct scene_texture_use *use,
                               const struct scene_texture *t)
{
    double uv[3][2], sum = 0.0;
    const float *m = use->transform;
    const double size[2] = {t->width, t->height};
    corner_uvs(s, use, uv);
    for (int side = 0; side < 2; ++side) {
        double moved[2];
        for (int i = 0; i < 2; ++i)
            moved[i] = s->footprint[side][0] * (uv[1][i] - uv[0][i]) +
                       s->footprint[side][1] * (uv[2][i] - uv[0][i]);
        for (int i = 0; i < 2; ++i) {
            double texels =
                ((double)m[3 * i] * moved[0] + (double)m[3 * i + 1] * moved[1]) * size[i];
            sum += 0.5 * texels * texels;
        }
    }
    return sum;
}

/* Samples the texture in a slot at coordinates uv of its UV set. */
static struct texel sample_at(const struct reference *reference, const struct surface *s,
                              enum scene_slot slot, const double uv[2])
{
    const struct scene_texture_use *use = &s->material->textures[slot];
    const struct scene_texture *t = &reference->scene->textures[use->texture];
    enum mipmap_kind kind = mipmap_kind_of(s->material, slot);
    const uint8_t *behind = reference->levels[use->texture][kind];
    bool srgb = scene_slot_is_srgb(slot, s->material->model);
    double level = behind ? fmin(mipmap_level(reference->level_pieces, footprint_texels(s, use, t)),
                                 mipmap_levels(t->width, t->height))
                          : 0.0;
    struct texel texels[2];
    uint32_t first = (uint32_t)level, last = (uint32_t)ceil(level);
    for (uint32_t k = first; k <= last; ++k) {
        uint64_t skipped = mipmap_first(t->width, t->height, k) - (uint64_t)t->width * t->height;
        const struct level from = {k ? behind + 4 * skipped : t->rgba, mipmap_side(t->width, k),
                                   mipmap_side(t->height, k)};
        texels[k - first] = sample_level(reference, &from, use, uv, srgb);
    }
    return first == last ? texels[0] : mix_texels(texels[0], texels[1], level - first);
}

struct texel texture_sample(const struct reference *reference, const struct surface *s,
                            enum scene_slot slot)
{
    const struct scene_texture_use *use = &s->material->textures[slot];
    double uv[2];
    if (!is_used(s->material, slot))
        return (struct texel){d3_all(1.0), 1.0};
    place_uv(s, use, uv);
    return sample_at(reference, s, slot, uv);
}

/* By the opacity texture, its alpha if it has one, else its red; without one, by the alpha of the
   diffuse texture. */
double texture_opacity(const struct reference *reference, const struct surface *s)
{
    const struct scene_material *m = s->material;
    uint32_t own = m->textures[SCENE_SLOT_OPACITY].texture;
    uint32_t diffuse = m->textures[SCENE_SLOT_DIFFUSE].texture;
    double opacity = (double)m->opacity;
    if (own != SCENE_NONE) {
        struct texel texel = texture_sample(reference, s, SCENE_SLOT_OPACITY);
        return opacity * (reference->alphas[own] ? texel.alpha : texel.rgb.x);
    }
    if (diffuse != SCENE_NONE && reference->alphas[diffuse])
        opacity *= texture_sample(reference, s, SCENE_SLOT_DIFFUSE).alpha;
    return opacity;
}

/* Unit directions in the surface, orthogonal to the normal, in which u and v of the texture
   grow; where the normal is turned, their reverse. */
static void tangents(const struct surface *s, const struct scene_texture_use *use,
                     struct dvec3 *right, struct dvec3 *down)
{
    double uv[3][2], d[2][2];
    const float *m = use->transform;
    corner_uvs(s, use, uv);
    for (int k = 0; k < 2; ++k) {
        double du = uv[k + 1][0] - uv[0][0], dv = uv[k + 1][1] - uv[0][1];
        for (int i = 0; i < 2; ++i)
            d[k][i] = (double)m[3 * i] * du + (double)m[3 * i + 1] * dv;
    }
    double det = d[0][0] * d[1][1] - d[0][1] * d[1][0], inv = det != 0.0 ? 1.0 / det : 0.0;
    if (s->turned) /* the bent normal is the reverse of that in front */
        inv = -inv;
    struct dvec3 t = d3_scale(dvec3_along(d3_scale(s->e1, d[1][1]), s->e2, -d[0][1]), inv);
    struct dvec3 b = d3_scale(dvec3_along(d3_scale(s->e2, d[0][0]), s->e1, -d[1][0]), inv);
    t = dvec3_along(t, s->ns, -dvec3_dot(s->ns, t));
    b = dvec3_along(b, s->ns, -dvec3_dot(s->ns, b));
    *right = d3_unit_or(t, d3_all(0.0));
    *down = d3_unit_or(b, d3_all(0.0));
}

/* Slope of a height map, by differences to the texels on the right and below. Heights are in 1/32
   of the texture's side. */
static void bump_slope(const struct reference *reference, const struct surface *s,
                       const double uv[2], double slope[2])
{
    uint32_t texture = s->material->textures[SCENE_SLOT_BUMP].texture;
    const struct scene_texture *t = &reference->scene->textures[texture];
    const double size[2] = {t->width, t->height};
    double here = sample_at(reference, s, SCENE_SLOT_BUMP, uv).rgb.x;
    for (int i = 0; i < 2; ++i) {
        double on[2] = {uv[0], uv[1]};
        on[i] += 1.0 / size[i];
        double rise = sample_at(reference, s, SCENE_SLOT_BUMP, on).rgb.x - here;
        slope[i] = rise * size[i] * (double)s->material->normal_scale / 32.0;
    }
}

void texture_bend_normal(const struct reference *reference, struct surface *s)
{
    bool is_map = is_used(s->material, SCENE_SLOT_NORMAL);
    const struct scene_texture_use *use =
        &s->material->textures[is_map ? SCENE_SLOT_NORMAL : SCENE_SLOT_BUMP];
    if (use->texture == SCENE_NONE)
        return;
    struct dvec3 right, down, bent;
    double uv[2], slope[2];
    tangents(s, use, &right, &down);
    place_uv(s, use, uv);
    if (is_map) {
        struct dvec3 rgb = sample_at(reference, s, SCENE_SLOT_NORMAL, uv).rgb;
        double scale = (double)s->material->normal_scale;
        bent = d3_scale(s->ns, 2.0 * rgb.z - 1.0);
        bent = dvec3_along(bent, right, scale * (2.0 * rgb.x - 1.0));
        bent = dvec3_along(bent, down, -scale * (2.0 * rgb.y - 1.0));
    } else {
        bump_slope(reference, s, uv, slope);
        bent = dvec3_along(dvec3_along(s->ns, right, -slope[0]), down, -slope[1]);
    }
    s->ns = d3_unit_or(bent, s->ns);
}
