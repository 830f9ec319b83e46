#include "core/scene/pbrt/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/spectra.hpp"
#include "core/scene/textures.hpp"
#include "core/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

constexpr Rgb grey{0.5f, 0.5f, 0.5f};

/// From the parameters of a rough surface; `prefix` as in "conductor.roughness".
Roughness roughness(Parameters& parameters, const MaterialSources& sources, const std::string& prefix = "",
                    float fallback = 0) {
    const auto number = [&](const char* name) { return sources.textures.number(parameters, prefix + name); };
    const float both = number("roughness").value_or(fallback);
    Roughness rough;
    rough.u = std::max(0.0f, number("uroughness").value_or(both));
    rough.v = std::max(0.0f, number("vroughness").value_or(both));
    // pbrt-v4's RoughnessToAlpha
    rough.means = parameters.boolean("remaproughness", true) ? Roughness::Means::root : Roughness::Means::alpha;
    return rough;
}

/// The index of refraction of a dielectric: a number, or a named glass at its green wavelength.
float index(Parameters& parameters, const MaterialSources& sources, const std::string& name, float fallback = 1.5f) {
    const Parameter* given = parameters.find(name);
    if (!given || given->type == Type::number) return parameters.number(name, fallback);
    const auto id = sources.textures.maybe_colour(parameters, name, Use::index);
    const Rgb eta = mean_of(sources.scene.textures[*id]);
    if (eta.r != eta.g || eta.g != eta.b) parameters.warn("dispersion is left out: the index of green light is taken");
    return eta.g > 0 ? eta.g : fallback;
}

ConductorMaterial conductor_of(Parameters& parameters, const MaterialSources& sources, const std::string& prefix,
                               const Roughness& rough) {
    ConductorMaterial model;
    model.roughness = rough;
    const bool reflective = parameters.find("reflectance") != nullptr;
    if (reflective && (parameters.find(prefix + "eta") || parameters.find(prefix + "k")))
        parameters.error("'reflectance' and 'eta' or 'k' exclude each other");
    if (reflective) model.metal.reflectance = sources.textures.colour(parameters, "reflectance", grey);
    const Rgb copper_eta = *named_index("metal-Cu-eta"), copper_k = *named_index("metal-Cu-k");
    model.metal.eta = sources.textures.colour(parameters, prefix + "eta", copper_eta, Use::index);
    model.metal.k = sources.textures.colour(parameters, prefix + "k", copper_k, Use::index);
    return model;
}

template <class Model>
Material made_of(const Model& model) {
    Material material;
    material.model = model;
    return material;
}

Material matte(TextureId reflectance) {
    DiffuseMaterial model;
    model.reflectance = reflectance;
    return made_of(model);
}

Material diffuse(Parameters& parameters, const MaterialSources& sources) {
    return matte(sources.textures.colour(parameters, "reflectance", grey));
}

Material conductor(Parameters& parameters, const MaterialSources& sources) {
    return made_of(conductor_of(parameters, sources, "", roughness(parameters, sources)));
}

Material dielectric(Parameters& parameters, const MaterialSources& sources) {
    DielectricMaterial model;
    model.roughness = roughness(parameters, sources);
    model.eta = index(parameters, sources, "eta");
    return made_of(model);
}

Material thin_dielectric(Parameters& parameters, const MaterialSources& sources) {
    DielectricMaterial model;
    model.eta = index(parameters, sources, "eta");
    model.thin = true;
    return made_of(model);
}

Material coated_diffuse(Parameters& parameters, const MaterialSources& sources) {
    // of pbrt's random walk through the coat
    parameters.ignore({"maxdepth", "nsamples", "thickness", "g"});
    if (const Parameter* albedo = parameters.find("albedo")) {
        const auto colour = albedo->type == Type::texture ? std::nullopt : std::optional(albedo->numbers);
        const bool black = colour && std::all_of(colour->begin(), colour->end(), [](float x) { return x == 0; });
        if (!black) parameters.warn("scattering inside the coat ('albedo') is left out");
    }
    CoatedDiffuseMaterial model;
    model.roughness = roughness(parameters, sources);
    model.reflectance = sources.textures.colour(parameters, "reflectance", grey);
    model.eta = index(parameters, sources, "eta");
    return made_of(model);
}

Material coated_conductor(Parameters& parameters, const MaterialSources& sources) {
    parameters.warn("the coat of a coatedconductor is left out: taken as a conductor");
    parameters.ignore({"maxdepth", "nsamples", "thickness", "g", "albedo", "interface.eta", "interface.roughness",
                       "interface.uroughness", "interface.vroughness"});
    return made_of(conductor_of(parameters, sources, "conductor.", roughness(parameters, sources, "conductor.")));
}

Material diffuse_transmission(Parameters& parameters, const MaterialSources& sources) {
    parameters.warn("the light through a diffusetransmission is left out: taken as diffuse");
    parameters.ignore({"transmittance"});
    const auto id = sources.textures.colour(parameters, "reflectance", {0.25f, 0.25f, 0.25f});
    Texture scaled = sources.scene.textures[id];
    scaled.scale *= parameters.number("scale", 1);
    return matte(sources.textures.add(scaled));
}

Material subsurface(Parameters& parameters, const MaterialSources& sources) {
    parameters.warn("subsurface scattering is left out: taken as coateddiffuse");
    parameters.ignore({"mfp", "name", "sigma_a", "sigma_s", "scale", "g"});
    CoatedDiffuseMaterial model;
    model.roughness = roughness(parameters, sources);
    model.reflectance = sources.textures.colour(parameters, "reflectance", {0.8f, 0.8f, 0.8f});
    model.eta = index(parameters, sources, "eta", 1.33f);
    return made_of(model);
}

Material hair(Parameters& parameters, const MaterialSources& sources) {
    parameters.warn("scattering by hair is left out: taken as diffuse");
    parameters.ignore({"eumelanin", "pheomelanin", "sigma_a", "eta", "beta_m", "beta_n", "alpha", "color"});
    const char* colour = parameters.find("color") ? "color" : "reflectance";
    return matte(sources.textures.colour(parameters, colour, {0.25f, 0.15f, 0.1f}));
}

Material measured(Parameters& parameters, const MaterialSources& sources) {
    parameters.warn("measured materials are not supported: grey diffuse is taken");
    parameters.ignore({"filename"});
    Texture constant;
    constant.scale = grey;
    return matte(sources.textures.add(constant));
}

/// Two constant diffuse colours mix into one exactly, if not pointwise; of others the heavier stands for both.
Material mix(Parameters& parameters, const MaterialSources& sources) {
    const Parameter* names = parameters.find("materials", Type::text);
    const float amount = std::clamp(sources.textures.number(parameters, "amount").value_or(0.5f), 0.0f, 1.0f);
    std::vector<const Material*> parts;
    if (!names || names->texts.size() != 2) {
        parameters.error("parameter 'materials' must name two materials");
        return diffuse(parameters, sources);
    }
    for (const auto& name : names->texts) {
        parts.push_back(sources.named(name));
        if (!parts.back()) parameters.error(fmt::format("there is no material '{}' above", name));
    }
    if (!parts[0] || !parts[1]) return diffuse(parameters, sources);
    const auto constant = [&](const Material& material) -> std::optional<Rgb> {
        const auto* model = std::get_if<DiffuseMaterial>(&material.model);
        if (!model || !is_constant(sources.scene.textures[model->reflectance])) return std::nullopt;
        return mean_of(sources.scene.textures[model->reflectance]);
    };
    const auto a = constant(*parts[0]), b = constant(*parts[1]);
    if (a && b) {
        Texture mean;
        mean.scale = *a * (1 - amount) + *b * amount;
        return matte(sources.textures.add(mean));
    }
    const std::size_t heavier = amount > 0.5f ? 1 : 0;
    parameters.warn(
        fmt::format("materials are not mixed: '{}', the larger part, is taken alone", names->texts[heavier]));
    return *parts[heavier];
}

using Maker = Material (*)(Parameters&, const MaterialSources&);

const std::map<std::string, Maker, std::less<>>& makers() {
    static const std::map<std::string, Maker, std::less<>> table{{"diffuse", diffuse},
                                                                 {"conductor", conductor},
                                                                 {"dielectric", dielectric},
                                                                 {"thindielectric", thin_dielectric},
                                                                 {"coateddiffuse", coated_diffuse},
                                                                 {"coatedconductor", coated_conductor},
                                                                 {"diffusetransmission", diffuse_transmission},
                                                                 {"subsurface", subsurface},
                                                                 {"hair", hair},
                                                                 {"measured", measured},
                                                                 {"mix", mix}};
    return table;
}

std::string hint(const std::string& type) {
    static const std::map<std::string, std::string, std::less<>> older{
        {"matte", "diffuse"},           {"plastic", "coateddiffuse"},
        {"substrate", "coateddiffuse"}, {"uber", "coateddiffuse"},
        {"glass", "dielectric"},        {"metal", "conductor"},
        {"mirror", "conductor"},        {"translucent", "diffusetransmission"}};
    if (const auto newer = older.find(type); newer != older.end())
        return fmt::format(" (of older versions; pbrt-v4 says '{}')", newer->second);
    std::vector<std::string> known;
    for (const auto& [name, maker] : makers()) known.push_back(name);
    return did_you_mean(type, known);
}

}  // namespace

bool is_interface(const std::string& type) { return type == "interface" || type.empty() || type == "none"; }

Material make_material(const std::string& type, Parameters& parameters, const MaterialSources& sources) {
    if (parameters.find("displacement")) parameters.warn("bumps by 'displacement' are left out");
    if (parameters.find("normalmap")) parameters.warn("bumps by 'normalmap' are left out");
    if (const auto maker = makers().find(type); maker != makers().end()) return maker->second(parameters, sources);
    parameters.error(fmt::format("unknown material '{}'{}", type, hint(type)));
    parameters.ignore_all();
    parameters.ignore({"reflectance"});
    Texture constant;
    constant.scale = grey;
    return matte(sources.textures.add(constant));
}

}  // namespace lightnet::pbrt
