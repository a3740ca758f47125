/* gltf_material.c: glTF materials into scene materials.  [gltf, sections 3.9, 5.19, 5.22]
 *
 * Read besides the core: KHR_materials_emissive_strength, _ior, _specular, _transmission, _unlit, and
 * FACET_materials_bsdf, which puts any libfacet model in place of metallic-roughness.  Factors out of the
 * range that the specification gives are errors.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"
#include "io/material_json.h"

/* KHR_materials_ior: 0 stands for a Fresnel term of 1 in every direction.  An index so large that
 * ((ior - 1)/(ior + 1))^2 rounds to 1 is the same, and safe to compute with. */
#define IOR_FOR_ZERO 1e9f

/* ---- What is not rendered as asked --------------------------------------------------------------- */

void gltf_note_material(gltf *g, size_t material_number, const char *what, const char *effect)
{
    for (size_t i = 0; i < g->n_notes; i++)
        if (strcmp(g->notes[i].what, what) == 0) {
            g->notes[i].count++;
            return;
        }
    if (g->n_notes == GLTF_MAX_NOTES) return;
    gltf_note *const note = &g->notes[g->n_notes++];
    snprintf(note->what, sizeof note->what, "%s", what);
    note->effect = effect;
    note->first = material_number;
    note->count = 1;
}

void gltf_report_notes(gltf *g)
{
    for (size_t i = 0; i < g->n_notes; i++) {
        const gltf_note *const note = &g->notes[i];
        char others[40] = "";
        if (note->count > 1) snprintf(others, sizeof others, " and %zu more", note->count - 1);
        gltf_warn(g, &g->root, "materials[%zu]%s: %s not supported: %s", note->first, others, note->what, note->effect);
    }
}

/* A material extension that is not rendered, and the member that switches it off when it is 0 (or
 * {0,0,0}, the default), so that only materials that really look different are reported. */
typedef struct unrendered {
    const char *name, *strength, *effect;
} unrendered;

static const unrendered unrendered_extensions[] = {
    {"KHR_materials_anisotropy", "anisotropyStrength", "rendered with isotropic highlights"},
    {"KHR_materials_clearcoat", "clearcoatFactor", "rendered without the coat"},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", "rendered without light through the surface"},
    {"KHR_materials_dispersion", "dispersion", "rendered with one index of refraction for all colours"},
    {"KHR_materials_iridescence", "iridescenceFactor", "rendered without thin-film colours"},
    {"KHR_materials_pbrSpecularGlossiness", NULL, "rendered from pbrMetallicRoughness instead"},
    {"KHR_materials_sheen", "sheenColorFactor", "rendered without sheen"},
    {"KHR_materials_volume_scatter", NULL, "rendered without scattering inside"},
};

static bool is_rendered(const char *name)
{
    static const char *const names[] = {
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_materials_unlit",
        "FACET_materials_bsdf",
    };
    for (size_t i = 0; i < sizeof names/sizeof *names; i++)
        if (strcmp(names[i], name) == 0) return true;
    return false;
}

/* Whether a factor (a number or colour, 0 by default) is other than 0. */
static bool is_switched_on(const json_place *extension, const char *strength)
{
    const json_place place = json_member(extension, strength);
    double value = 0;
    if (json_kind_here(&place) == JSON_KIND_NUMBER) return json_number_here(&place, -DBL_MAX, DBL_MAX, &value) && value;
    for (size_t i = 0; i < json_count(&place); i++) {
        const json_place element = json_element(&place, i);
        if (json_kind_here(&element) != JSON_KIND_NUMBER) continue;
        if (json_number_here(&element, -DBL_MAX, DBL_MAX, &value) && value) return true;
    }
    return false;
}

static bool note_unrendered(gltf *g, const json_place *place, size_t number)
{
    json_place list, extension;
    void *iterator = NULL;
    if (!json_read_object(place, "extensions", &list)) return false;
    while (json_next(&list, &iterator, &extension)) {
        if (is_rendered(extension.key)) continue;
        if (!json_want_object(&extension)) return false;
        const char *effect = "rendered without it";
        bool is_on = true;
        for (size_t i = 0; i < sizeof unrendered_extensions/sizeof *unrendered_extensions; i++) {
            const unrendered *const u = &unrendered_extensions[i];
            if (strcmp(u->name, extension.key) != 0) continue;
            effect = u->effect;
            is_on = !u->strength || is_switched_on(&extension, u->strength);
        }
        char what[sizeof g->notes->what];
        snprintf(what, sizeof what, "%.80s is", extension.key);
        if (is_on) gltf_note_material(g, number, what, effect);
    }
    return true;
}

/* ---- The parts of a material ---------------------------------------------------------------------- */

static bool read_metallic_roughness(gltf *g, const json_place *place, size_t number, material *m)
{
    json_place pbr;
    return json_read_object(place, "pbrMetallicRoughness", &pbr) &&
           json_read_floats(&pbr, "baseColorFactor", 4, 0, 1, m->base_color) &&
           json_read_float(&pbr, "metallicFactor", 0, 1, &m->metallic) &&
           json_read_float(&pbr, "roughnessFactor", 0, 1, &m->roughness) &&
           gltf_read_texture(g, &pbr, "baseColorTexture", true, number, &m->base_color_texture) &&
           gltf_read_texture(g, &pbr, "metallicRoughnessTexture", false, number, &m->metallic_roughness_texture);
}

static bool read_alpha(const json_place *place, material *m)
{
    const json_place mode_place = json_member(place, "alphaMode");
    const char *mode = "OPAQUE";
    if (!json_read_string(place, "alphaMode", &mode)) return false;
    if (strcmp(mode, "OPAQUE") == 0) m->alpha = ALPHA_OPAQUE;
    else if (strcmp(mode, "MASK") == 0) m->alpha = ALPHA_MASK;
    else if (strcmp(mode, "BLEND") == 0) m->alpha = ALPHA_BLEND;
    else return json_fail(&mode_place, FACET_BAD_VALUE, "is \"%.20s\"; must be OPAQUE, MASK or BLEND", mode);
    return json_read_float(place, "alphaCutoff", 0, FLT_MAX, &m->alpha_cutoff) &&
           json_read_bool(place, "doubleSided", &m->is_double_sided);
}

static bool read_normal_map(gltf *g, const json_place *place, size_t number, material *m)
{
    json_place info;
    return json_read_object(place, "normalTexture", &info) &&
           json_read_float(&info, "scale", -GLTF_EXTENT_CAP, GLTF_EXTENT_CAP, &m->normal_scale) &&
           gltf_read_texture(g, place, "normalTexture", false, number, &m->normal_texture);
}

static bool read_emission(gltf *g, const json_place *place, size_t number, material *m)
{
    gltf_extension e;
    float factor[3] = {0, 0, 0}, strength = 1;
    if (!gltf_read_extension(place, "KHR_materials_emissive_strength", &e)) return false;
    if (!json_read_floats(place, "emissiveFactor", 3, 0, 1, factor) ||
        !json_read_float(&e.body, "emissiveStrength", 0, GLTF_RADIANCE_CAP, &strength) ||
        !gltf_read_texture(g, place, "emissiveTexture", true, number, &m->emissive_texture))
        return false;
    for (int k = 0; k < 3; k++) m->emission[k] = factor[k]*strength;
    return true;
}

static bool read_ior(const json_place *place, material *m)
{
    gltf_extension e;
    if (!gltf_read_extension(place, "KHR_materials_ior", &e)) return false;
    if (!json_read_float(&e.body, "ior", 0, FLT_MAX, &m->ior)) return false;
    const json_place ior_place = json_member(&e.body, "ior");
    if (m->ior == 0) m->ior = IOR_FOR_ZERO;
    if (m->ior < 1) return json_fail(&ior_place, FACET_BAD_VALUE, "is %.9g; must be 0 or at least 1", (double)m->ior);
    if (m->ior > IOR_FOR_ZERO) m->ior = IOR_FOR_ZERO;
    return true;
}

/* KHR_materials_specular clips F0 times the colour at 1: the clip is applied to the colour here. */
static bool read_specular(gltf *g, const json_place *place, size_t number, material *m)
{
    gltf_extension e;
    if (!gltf_read_extension(place, "KHR_materials_specular", &e)) return false;
    if (!json_read_float(&e.body, "specularFactor", 0, 1, &m->specular) ||
        !json_read_floats(&e.body, "specularColorFactor", 3, 0, FLT_MAX, m->specular_color))
        return false;
    const float root = (m->ior - 1)/(m->ior + 1), F0 = root*root;
    for (int k = 0; k < 3; k++)
        if (m->specular_color[k]*F0 > 1) m->specular_color[k] = 1/F0;
    static const char *const maps[] = {"specularTexture", "specularColorTexture"};
    for (int i = 0; i < 2; i++) {
        const json_place map = json_member(&e.body, maps[i]);
        if (!map.value) continue;
        gltf_note_material(g, number,
                           i ? "KHR_materials_specular's specularColorTexture is"
                             : "KHR_materials_specular's specularTexture is",
                           "rendered with the factor alone");
    }
    return true;
}

/* KHR_materials_transmission, and of KHR_materials_volume whether there is an inside at all. */
static bool read_transmission(gltf *g, const json_place *place, size_t number, material *m)
{
    gltf_extension transmission, volume;
    float thickness = 0, distance = INFINITY, colour[3] = {1, 1, 1};
    if (!gltf_read_extension(place, "KHR_materials_transmission", &transmission) ||
        !gltf_read_extension(place, "KHR_materials_volume", &volume) ||
        !json_read_float(&transmission.body, "transmissionFactor", 0, 1, &m->transmission) ||
        !json_read_float(&volume.body, "thicknessFactor", 0, FLT_MAX, &thickness) ||
        !json_read_float(&volume.body, "attenuationDistance", 0, FLT_MAX, &distance) ||
        !json_read_floats(&volume.body, "attenuationColor", 3, 0, 1, colour))
        return false;
    const json_place distance_place = json_member(&volume.body, "attenuationDistance"),
                     map = json_member(&transmission.body, "transmissionTexture");
    if (distance_place.value && !(distance > 0))
        return json_fail(&distance_place, FACET_BAD_VALUE, "is %.9g; must be above 0", (double)distance);
    m->is_thin = m->transmission > 0 && !(thickness > 0);
    if (!(m->transmission > 0)) return true;
    if (map.value)
        gltf_note_material(g, number, "KHR_materials_transmission's transmissionTexture is",
                           "rendered with the factor alone");
    const bool is_tinted = colour[0] < 1 || colour[1] < 1 || colour[2] < 1;
    if (thickness > 0 && distance_place.value && is_tinted)
        gltf_note_material(g, number, "KHR_materials_volume's attenuation is", "rendered with a clear inside");
    return true;
}

static bool read_kind(const json_place *place, material *m)
{
    gltf_extension unlit, bsdf;
    if (!gltf_read_extension(place, "KHR_materials_unlit", &unlit)) return false;
    if (!gltf_read_extension(place, "FACET_materials_bsdf", &bsdf)) return false;
    if (unlit.body.value) m->kind = SURFACE_UNLIT;
    if (!bsdf.body.value) return true;
    m->kind = SURFACE_BSDF;
    return material_json_read(&bsdf.body, &m->bsdf);
}

static bool read_material(gltf *g, const json_place *place, size_t number, material *m)
{
    return read_metallic_roughness(g, place, number, m) && read_alpha(place, m) &&
           read_normal_map(g, place, number, m) && read_emission(g, place, number, m) && read_ior(place, m) &&
           read_specular(g, place, number, m) && read_transmission(g, place, number, m) && read_kind(place, m) &&
           note_unrendered(g, place, number);
}

bool gltf_use_material(gltf *g, size_t material_number, size_t *index)
{
    const bool is_default = material_number == NONE;
    size_t *const known = is_default ? &g->default_material_index : &g->material_index[material_number];
    const json_place place = is_default ? json_member(&g->root, "materials")
                                        : json_element(&g->materials, material_number);
    *index = *known;
    if (*index != NONE) return true;
    char number_name[40];
    const char *name = number_name;
    if (is_default) snprintf(number_name, sizeof number_name, "default");
    else snprintf(number_name, sizeof number_name, "material%zu", material_number);
    if (!is_default && !json_read_string(&place, "name", &name)) return false;
    material m;
    if (material_default(name, &m)) return gltf_no_memory(&place);
    bool is_made = is_default || read_material(g, &place, material_number, &m);
    if (is_made && scene_add_material(g->scene, &m, index)) is_made = gltf_no_memory(&place);
    if (is_made) *known = *index;
    else material_destroy(&m);
    return is_made;
}
