// Materials of pbrt-v3 in whose place the nearest stands, which is named.
#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "core/readers/common/spectra.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/pbrt/older.hpp"

namespace lightnet::pbrt {
// Ashikhmin and Shirley's model
Material Older::substrate() {
    parameters_.warn("'substrate' is taken as a diffuse base below a reflection that is Ks head-on");
    PrincipledMaterial coated;
    coated.base_colour = colour("Kd", older_half);
    const TextureId ks = colour("Ks", older_half);
    constexpr float f0 = 0.04f;  // of the index 1.5
    if (const auto everywhere = textures_.constant_value(ks))
        coated.specular_colour = *everywhere / f0;
    else
        coated.specular_colour = older_white / f0, coated.specular_colour_texture = ks;
    coated.roughness = roughness();
    return made(coated);
}

namespace {

/// "roughgold_alpha_0.2.bsdf": 0.2
float alpha_in(const std::string& name, float fallback) {
    const auto at = name.find("alpha_");
    float value = fallback;
    if (at != std::string::npos) std::from_chars(name.data() + at + 6, name.data() + name.size(), value);
    return std::clamp(value, 0.0f, 1.0f);
}

}  // namespace

// A measured or computed table, of which its name tells a little.
Material Older::fourier() {
    const std::string name = stem_of(parameters_.file("bsdffile"));
    const float alpha = alpha_in(name, 0.1f);
    const Roughness rough{alpha, alpha, std::nullopt, Roughness::Means::alpha};
    const auto taken_as = [&](const char* what) {
        parameters_.warn(fmt::format(
            "the table of the material 'fourier' is not read: '{}' is taken as {}, by its name", name, what));
    };
    const std::map<std::string, std::string> metals{{"gold", "Au"}, {"copper", "Cu"}, {"silver", "Ag"}, {"alum", "Al"}};
    for (const auto& [word, symbol] : metals) {
        if (name.find(word) == std::string::npos) continue;
        taken_as(("rough " + word).c_str());
        return made(ConductorMaterial{{textures_.constant(named_index("metal-" + symbol + "-eta")->rgb),
                                       textures_.constant(named_index("metal-" + symbol + "-k")->rgb), std::nullopt},
                                      rough,
                                      std::nullopt});
    }
    if (name.find("glass") != std::string::npos) {
        taken_as("rough glass");
        return made(DielectricMaterial{1.5f, rough});
    }
    taken_as("grey below a coat");
    return made(CoatedDiffuseMaterial{textures_.constant(older_half), 1.5f, rough});
}

Material Older::subsurface(const char* kd, Rgb fallback) {
    parameters_.warn("subsurface scattering is not supported: taken as a diffuse base below a coat");
    parameters_.ignore(
        {"name", "sigma_a", "sigma_prime_s", "sigma_s", "scale", "g", "mfp", "meanfreepath", "Kr", "Kt"});
    const float eta = number(parameters_.find("index") ? "index" : "eta", 1.33f);
    return made(CoatedDiffuseMaterial{kd ? colour(kd, fallback) : textures_.constant(fallback), eta > 0 ? eta : 1.33f,
                                      roughness(0)});
}

Material Older::disney() {
    parameters_.warn(
        "'disney' is taken as the principled surface of glTF: its sheen, tints, flatness, anisotropy and "
        "scattering below the surface are left out");
    parameters_.ignore(
        {"anisotropic", "difftrans", "flatness", "scatterdistance", "sheen", "sheentint", "speculartint"});
    PrincipledMaterial disney;
    disney.base_colour = colour("color", older_half);
    disney.metallic = std::clamp(number("metallic", 0), 0.0f, 1.0f);
    disney.transmission = std::clamp(number("spectrans", 0), 0.0f, 1.0f);
    disney.eta = std::max(1.0f, number("eta", 1.5f));
    disney.roughness.u = disney.roughness.v = std::clamp(number("roughness", 0.5f), 0.0f, 1.0f);
    disney.clearcoat = 0.25f * std::clamp(number("clearcoat", 0), 0.0f, 1.0f);
    const float gloss = std::clamp(number("clearcoatgloss", 1), 0.0f, 1.0f);
    disney.clearcoat_roughness = {0.1f + (0.001f - 0.1f) * gloss, 0.1f + (0.001f - 0.1f) * gloss, std::nullopt,
                                  Roughness::Means::alpha};
    disney.thin = parameters_.boolean("thin", false);
    return made(disney);
}

// Of version 2
Material Older::shiny_metal() {
    parameters_.warn("'shinymetal' reflects the same from all directions here");
    const TextureId ks = colour("Ks", older_white), kr = colour("Kr", older_white);
    const Roughness rough = roughness();
    const auto metal = [&](TextureId tint, Roughness how) {
        return Reflection{most_of(tint), false, [this, tint, how](float gain) {
                              ConductorMaterial material = smooth_metal(tint);
                              material.roughness = how, material.strength = 0.5f * gain;
                              return made(material);
                          }};
    };
    return sum_of(lit({metal(ks, rough), metal(kr, {})}), parameters_, sources_);
}

Material Older::measured() {
    parameters_.warn("measured materials are not supported: grey diffuse is taken");
    parameters_.ignore({"filename"});
    return made(DiffuseMaterial{textures_.constant(older_half), 0, std::nullopt});
}

}  // namespace lightnet::pbrt
