#include "core/readers/pbrt/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/dispersion.hpp"
#include "core/readers/common/spectra.hpp"
#include "core/readers/pbrt/hair.hpp"
#include "core/readers/pbrt/media.hpp"

namespace lightnet::pbrt {
namespace {

constexpr Rgb grey{0.5f, 0.5f, 0.5f};

Material model(decltype(Material::model) what) {
    Material material;
    material.model = std::move(what);
    return material;
}

/// One texture may vary both roughnesses; what the numbers are multiplied with stands beside it.
Roughness textured(Textures& textures, TextureId u, TextureId v, const Parameters& parameters) {
    const auto along_u = textures.constant_value(u), along_v = textures.constant_value(v);
    if (along_u && along_v) return {along_u->r, along_v->r, std::nullopt, Roughness::Means::alpha};
    if (u != v)
        parameters.warn(along_u || along_v ? "a roughness that varies along one direction only varies along both"
                                           : "of two textures of roughness the first is taken for both");
    return {1, 1, along_u ? v : u, Roughness::Means::alpha};
}

/// The parameters of a rough surface; `prefix` as in "conductor.roughness". pbrt-v4 takes GGX α = √roughness, unless
/// told that the numbers are α.
Roughness roughness(Parameters& parameters, const MaterialSources& sources, const std::string& prefix = "",
                    float fallback = 0) {
    auto& textures = sources.textures;
    const auto number = [&](const char* name) { return textures.maybe_number(parameters, prefix + name); };
    const auto both = number("roughness"), u = number("uroughness"), v = number("vroughness");
    const auto means = parameters.boolean("remaproughness", true) ? Roughness::Means::root : Roughness::Means::alpha;
    const TextureId other = both ? *both : textures.constant({fallback, fallback, fallback});
    Roughness rough = textured(textures, u.value_or(other), v.value_or(other), parameters);
    rough.u = std::max(rough.u, 0.0f), rough.v = std::max(rough.v, 0.0f);
    rough.means = means;
    return rough;
}

/// The index of refraction of a dielectric for each colour: a number, or that of a named glass.
Rgb indices(Parameters& parameters, const MaterialSources& sources, const std::string& name, float fallback = 1.5f) {
    const auto alike = [](float eta) { return Rgb{eta, eta, eta}; };
    const Parameter* given = parameters.find(name);
    if (!given || given->type == Type::number) {
        const float eta = parameters.number(name, fallback);
        if (eta > 0) return alike(eta);
        parameters.error(fmt::format("'{}' must be above 0", name));
        return alike(fallback);
    }
    const auto id = sources.textures.maybe_colour(parameters, name, Use::index);
    const auto eta = sources.textures.constant_value(*id);
    if (!eta) parameters.warn(fmt::format("'{}' can't change over the surface: {} is taken", name, fallback));
    return !eta || !(eta->g > 0) ? alike(fallback) : *eta;
}

/// That of green light alone.
float index(Parameters& parameters, const MaterialSources& sources, const std::string& name, float fallback = 1.5f) {
    const Rgb eta = indices(parameters, sources, name, fallback);
    if (eta.r != eta.g || eta.g != eta.b) parameters.warn(std::string(one_index));
    return eta.g;
}

Metal metal_of(Parameters& parameters, const MaterialSources& sources, const std::string& prefix) {
    Metal metal;
    const bool reflective = parameters.find("reflectance") != nullptr;
    if (reflective && (parameters.find(prefix + "eta") || parameters.find(prefix + "k")))
        parameters.error("'reflectance' and 'eta' or 'k' exclude each other");
    if (reflective) metal.reflectance = sources.textures.colour(parameters, "reflectance", grey);
    const Rgb copper_eta = named_index("metal-Cu-eta")->rgb, copper_k = named_index("metal-Cu-k")->rgb;
    metal.eta = sources.textures.colour(parameters, prefix + "eta", copper_eta, Use::index);
    metal.k = sources.textures.colour(parameters, prefix + "k", copper_k, Use::index);
    return metal;
}

/// Of pbrt's random walk through a coat: its medium absorbs even where it doesn't scatter, and the walk ends after
/// `maxdepth` layers, of which every other one is the base.
CoatLayer walk_through_coat(Parameters& parameters) {
    parameters.ignore({"nsamples", "g"});
    CoatLayer layer;
    layer.thickness = std::max(0.0f, parameters.number("thickness", 0.01f));
    layer.bounces = std::uint32_t(std::clamp(parameters.integer("maxdepth", 10), 1, 1 << 20) + 1) / 2;
    if (const Parameter* albedo = parameters.find("albedo")) {
        const auto colour = albedo->type == Type::texture ? std::nullopt : std::optional(albedo->numbers);
        const bool black = colour && std::all_of(colour->begin(), colour->end(), [](float x) { return x == 0; });
        if (!black) parameters.warn("scattering inside the coat ('albedo') is left out: the coat is clear");
    }
    return layer;
}

Material diffuse(Parameters& parameters, const MaterialSources& sources) {
    return model(DiffuseMaterial{sources.textures.colour(parameters, "reflectance", grey), 0, std::nullopt});
}

Material conductor(Parameters& parameters, const MaterialSources& sources) {
    const Roughness rough = roughness(parameters, sources);
    return model(ConductorMaterial{metal_of(parameters, sources, ""), rough, std::nullopt});
}

Material dielectric(Parameters& parameters, const MaterialSources& sources) {
    const Rgb eta = indices(parameters, sources, "eta");
    const Roughness rough = roughness(parameters, sources);
    if (const auto glass = dispersing_glass(eta, rough, sources.textures.constant({1, 1, 1}))) {
        parameters.warn(std::string(three_indices));
        return model(*glass);
    }
    DielectricMaterial glass;
    glass.eta = eta.g;
    glass.roughness = rough;
    return model(glass);
}

Material thin_dielectric(Parameters& parameters, const MaterialSources& sources) {
    DielectricMaterial glass;
    glass.eta = index(parameters, sources, "eta");
    glass.thin = true;
    return model(glass);
}

Material coated_diffuse(Parameters& parameters, const MaterialSources& sources) {
    CoatedDiffuseMaterial coated;
    coated.layer = walk_through_coat(parameters);
    coated.roughness = roughness(parameters, sources);
    coated.reflectance = sources.textures.colour(parameters, "reflectance", grey);
    coated.eta = index(parameters, sources, "eta");
    return model(coated);
}

Material coated_conductor(Parameters& parameters, const MaterialSources& sources) {
    CoatedConductorMaterial coated;
    coated.layer = walk_through_coat(parameters);
    coated.roughness = roughness(parameters, sources, "conductor.");
    coated.metal = metal_of(parameters, sources, "conductor.");
    coated.coat_eta = index(parameters, sources, "interface.eta");
    coated.coat = roughness(parameters, sources, "interface.");
    return model(coated);
}

Material diffuse_transmission(Parameters& parameters, const MaterialSources& sources) {
    constexpr Rgb quarter{0.25f, 0.25f, 0.25f};
    auto& textures = sources.textures;
    const float scale = parameters.number("scale", 1);
    const TextureId reflectance = textures.scaled(textures.colour(parameters, "reflectance", quarter), scale);
    return model(
        DiffuseMaterial{reflectance, 0, textures.scaled(textures.colour(parameters, "transmittance", quarter), scale)});
}

/// The albedo of a medium of which a half-space has that colour. Chiang, Kutz & Burley 2016, "Practical and
/// Controllable Subsurface Scattering for Production Path Tracing", equation 1.
float albedo_of(float colour) {
    const float a = std::clamp(colour, 0.0f, 1.0f);
    return std::min(1 - std::exp(a * (-5.09406f + a * (2.61188f - 4.31805f * a))), 0.9999f);
}

/// Extinction and scattering per metre, of what lies below the surface.
Substance below_surface(Parameters& parameters, const MaterialSources& sources) {
    const auto colour = [&](const char* name, Rgb fallback) {
        const TextureId texture = sources.textures.colour(parameters, name, fallback, Use::index);
        const auto value = sources.textures.constant_value(texture);
        if (!value) parameters.warn(fmt::format("'{}' can't change over the surface: one value is taken", name));
        return value.value_or(fallback);
    };
    if (const auto name = parameters.text("name", ""); !name.empty())
        return substance_named(name, parameters).value_or(usual_substance());
    if (!parameters.find("reflectance") || parameters.find("sigma_a")) {
        const Substance usual = usual_substance();
        return {colour("sigma_s", usual.scattered), colour("sigma_a", usual.absorbed)};
    }
    const Rgb reflectance = colour("reflectance", {0.8f, 0.8f, 0.8f}), path = colour("mfp", {1, 1, 1});
    const auto per_metre = [](float length) { return 1 / std::max(length, 1e-6f); };
    const Rgb extinction{per_metre(path.r), per_metre(path.g), per_metre(path.b)};
    const Rgb albedo{albedo_of(reflectance.r), albedo_of(reflectance.g), albedo_of(reflectance.b)};
    return {extinction * albedo, extinction - extinction * albedo};
}

/// A random walk below glass: the shape is full of a medium.
Material subsurface(Parameters& parameters, const MaterialSources& sources) {
    const Substance below = below_surface(parameters, sources);
    const float scale = parameters.number("scale", 1), g = parameters.number("g", 0);
    Medium medium;
    medium.name = "below the surface";
    medium.where = parameters.where();
    medium.extinction.value = (below.scattered + below.absorbed) * scale;
    medium.albedo.value = below.scattered * scale;
    medium.albedo_scatters = true;
    if (g != 0) medium.phase = {PhaseFunction::Law::henyey_greenstein, g};
    if (const auto fault = medium.fault(); !fault.empty()) parameters.error(fault);
    if (sources.fill) sources.fill(std::move(medium));
    DielectricMaterial glass;
    glass.eta = index(parameters, sources, "eta", 1.33f);
    glass.roughness = roughness(parameters, sources);
    return model(glass);
}

Material hair(Parameters& parameters, const MaterialSources& sources) {
    return model(hair_material(parameters, sources));
}

Material measured(Parameters& parameters, const MaterialSources& sources) {
    const std::string file = parameters.file("filename");
    if (file.empty()) parameters.error("parameter 'filename' is missing");
    const auto found = file.empty() ? nullptr : sources.measured(file, parameters.where());
    if (found) return model(MeasuredMaterial{found});
    return model(DiffuseMaterial{sources.textures.constant(grey), 0, std::nullopt});
}

Material mix(Parameters& parameters, const MaterialSources& sources) {
    MixtureMaterial mixture;
    const auto amount = sources.textures.maybe_number(parameters, "amount");
    mixture.amount = amount ? *amount : sources.textures.constant(grey);
    const Parameter* names = parameters.find("materials", Type::text);
    if (!names || names->texts.size() != 2) {
        parameters.error("parameter 'materials' must name two materials");
        return diffuse(parameters, sources);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        const auto part = sources.named(names->texts[i]);
        if (!part) parameters.error(fmt::format("there is no material '{}' above", names->texts[i]));
        (i == 0 ? mixture.first : mixture.second) = part.value_or(0);
    }
    return model(mixture);
}

Material nothing(Parameters&, const MaterialSources&) { return model(NoMaterial{}); }

using MaterialMaker = Material (*)(Parameters&, const MaterialSources&);

const std::map<std::string, MaterialMaker, std::less<>>& material_makers() {
    static const std::map<std::string, MaterialMaker, std::less<>> table{{"", nothing},
                                                                         {"none", nothing},
                                                                         {"interface", nothing},
                                                                         {"diffuse", diffuse},
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
    for (const auto& [name, maker] : material_makers())
        if (!name.empty()) known.push_back(name);
    return did_you_mean(type, known);
}

}  // namespace

Material make_material(const std::string& type, Parameters& parameters, const MaterialSources& sources) {
    const auto maker = material_makers().find(type);
    if (maker == material_makers().end()) {
        parameters.error(fmt::format("unknown material '{}'{}", type, hint(type)));
        parameters.ignore_all();
        return model(DiffuseMaterial{sources.textures.constant(grey), 0, std::nullopt});
    }
    Material material = maker->second(parameters, sources);
    material.bump_map = sources.textures.maybe_number(parameters, "displacement");
    if (const std::string file = parameters.file("normalmap"); !file.empty())
        if (const auto map = sources.textures.linear_image(file, parameters.where()))
            material.normal_map = NormalMap{*map, 1, NormalMap::Green::across};
    return material;
}

}  // namespace lightnet::pbrt
