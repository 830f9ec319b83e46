#include "core/readers/pbrt/older_materials.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/suggestion.hpp"
#include "core/readers/common/spectra.hpp"
#include "core/readers/pbrt/older.hpp"

namespace lightnet::pbrt {

/// A number that can't change over the surface.
float Older::number(const char* name, float fallback) {
    const auto given = textures_.maybe_number(parameters_, name);
    const auto value = given ? textures_.constant_value(*given) : std::nullopt;
    if (given && !value)
        parameters_.warn(fmt::format("'{}' can't change over the surface: {} is taken", name, fallback));
    return value ? value->r : fallback;
}

float Older::sigma() {
    const float degrees = std::clamp(number("sigma", 0), 0.0f, 90.0f);
    if (degrees > 0)
        parameters_.warn(
            "Oren and Nayar's model ('sigma') is taken as the newer one that loses no light between facets");
    return degrees * std::numbers::pi_v<float> / 180;
}

float Older::index() {
    const float eta = number(parameters_.find("eta") ? "eta" : "index", 1.5f);
    parameters_.ignore({"index"});
    if (eta > 0) return eta;
    parameters_.error("the index of refraction must be above 0");
    return 1.5f;
}

Roughness Older::roughness_along(TextureId u, TextureId v, bool remapped) {
    const auto alpha = [&](float value) { return std::max(1e-3f, remapped ? older_alpha(value) : value); };
    const auto along_u = textures_.constant_value(u), along_v = textures_.constant_value(v);
    if (along_u && along_v) return {alpha(along_u->r), alpha(along_v->r), std::nullopt, Roughness::Means::alpha};
    if (u != v) parameters_.warn("a roughness that varies along one direction only varies along both");
    const TextureId varying = along_u ? v : u;
    return {1, 1, remapped ? textures_.mapped(varying, older_alpha, parameters_) : varying, Roughness::Means::alpha};
}

Roughness Older::roughness(float fallback) {
    const auto number = [&](const char* name) { return textures_.maybe_number(parameters_, name); };
    const auto both = number("roughness"), u = number("uroughness"), v = number("vroughness");
    const TextureId other = both ? *both : textures_.constant(older_white * fallback), along_u = u.value_or(other);
    return roughness_along(along_u, v.value_or(u ? along_u : other), parameters_.boolean("remaproughness", true));
}

// Of index i: all of the light comes back from any direction.
ConductorMaterial Older::smooth_metal(TextureId tint) {
    return {{textures_.constant({}), textures_.constant(older_white), std::nullopt}, {}, tint};
}

Material Older::metal() {
    const Rgb copper_eta = named_index("metal-Cu-eta")->rgb, copper_k = named_index("metal-Cu-k")->rgb;
    const TextureId eta = colour("eta", copper_eta, Use::index), k = colour("k", copper_k, Use::index);
    return made(ConductorMaterial{{eta, k, std::nullopt}, roughness(0.01f), std::nullopt});
}

Material Older::glass() {
    const TextureId kr = colour("Kr", older_white), kt = colour("Kt", older_white);
    const auto u = textures_.maybe_number(parameters_, "uroughness"),
               v = textures_.maybe_number(parameters_, "vroughness");
    const bool remapped = parameters_.boolean("remaproughness", true);
    const TextureId none = textures_.constant({}), along_u = u.value_or(none), along_v = v.value_or(none);
    const auto is_0 = [&](TextureId t) { return textures_.constant_value(t).value_or(older_white).r == 0; };
    const Roughness rough = is_0(along_u) && is_0(along_v) ? Roughness{} : roughness_along(along_u, along_v, remapped);
    const auto unless_white = [&](TextureId t) {
        return textures_.constant_value(t) == older_white ? std::nullopt : std::optional(t);
    };
    return made(DielectricMaterial{index(), rough, unless_white(kr), unless_white(kt)});
}

Material Older::uber() {
    const float eta = index();
    const TextureId kd = colour("Kd", older_quarter), ks = colour("Ks", older_quarter), kr = colour("Kr", {}),
                    kt = colour("Kt", {});
    std::vector<Reflection> parts{diffuse(kd, 0), facets(ks, eta, roughness())};
    if (most_of(kt) > 0)
        parts.push_back(solid(kr, kt, eta, {}));
    else
        parts.push_back(facets(kr, eta, {}));
    Material whole = sum_of(lit(std::move(parts)), parameters_, sources_);
    const TextureId opacity = colour("opacity", older_white);
    const auto everywhere = textures_.constant_value(opacity);
    if (everywhere && *everywhere != older_white * everywhere->r) {
        parameters_.warn("'opacity' is the same for all colours here: that of red is taken");
    }
    if (!everywhere || everywhere->r < 1) whole.opacity = opacity;
    return whole;
}

Material Older::translucent() {
    const TextureId kd = colour("Kd", older_quarter), ks = colour("Ks", older_quarter),
                    reflect = colour("reflect", older_half), transmit = colour("transmit", older_half);
    const TextureId back = product(kd, reflect), through = product(kd, transmit);
    const Reflection matt{
        most_of(back) + most_of(through), true, [&](float gain) {
            return made(DiffuseMaterial{textures_.scaled(back, gain), 0, textures_.scaled(through, gain)});
        }};
    return sum_of(lit({matt, solid(product(ks, reflect), product(ks, transmit), 1.5f, roughness())}), parameters_,
                  sources_);
}

// 'amount' is the share of the first
Material Older::mix() {
    MixtureMaterial mixture;
    mixture.amount = colour("amount", older_half);
    const auto everywhere = textures_.constant_value(mixture.amount);
    if (everywhere && *everywhere != older_white * everywhere->r)
        parameters_.warn("'amount' is the same for all colours here: that of red is taken");
    const auto part = [&](const char* parameter) -> MaterialId {
        const std::string name = parameters_.text(parameter, "");
        const auto found = sources_.known.named(name);
        if (!found) parameters_.error(fmt::format("there is no material '{}' above, for '{}'", name, parameter));
        return found.value_or(0);
    };
    mixture.second = part("namedmaterial1");
    mixture.first = part("namedmaterial2");
    return made(mixture);
}

namespace {

const std::map<std::string, Material (*)(Older&), std::less<>>& older_makers() {
    static const std::map<std::string, Material (*)(Older&), std::less<>> table{
        {"", [](Older& m) { return m.nothing(); }},
        {"disney", [](Older& m) { return m.disney(); }},
        {"fourier", [](Older& m) { return m.fourier(); }},
        {"glass", [](Older& m) { return m.glass(); }},
        {"kdsubsurface", [](Older& m) { return m.subsurface("Kd", older_half); }},
        {"matte", [](Older& m) { return m.matte(); }},
        {"measured", [](Older& m) { return m.measured(); }},
        {"metal", [](Older& m) { return m.metal(); }},
        {"mirror", [](Older& m) { return m.mirror(); }},
        {"mix", [](Older& m) { return m.mix(); }},
        {"none", [](Older& m) { return m.nothing(); }},
        {"plastic", [](Older& m) { return m.plastic(); }},
        {"shinymetal", [](Older& m) { return m.shiny_metal(); }},
        {"substrate", [](Older& m) { return m.substrate(); }},
        {"subsurface",
         [](Older& m) {
             return m.subsurface(nullptr, {0.8f, 0.8f, 0.8f});
         }},
        {"translucent", [](Older& m) { return m.translucent(); }},
        {"uber", [](Older& m) { return m.uber(); }}};
    return table;
}

}  // namespace

// The polynomial of pbrt-v3's TrowbridgeReitzDistribution::RoughnessToAlpha.
float older_alpha(float roughness) {
    const double x = std::log(std::max(double(roughness), 1e-3));
    return float(1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711))));
}

Material make_older_material(const std::string& type, Parameters& parameters, const OlderSources& sources) {
    if (type == "hair") return make_material(type, parameters, sources.known);
    const auto maker = older_makers().find(type);
    if (maker != older_makers().end()) {
        Older older(parameters, sources);
        return maker->second(older);
    }
    std::vector<std::string> known;
    for (const auto& [name, make] : older_makers())
        if (!name.empty()) known.push_back(name);
    parameters.error(fmt::format("unknown material '{}'{}", type, did_you_mean(type, known)));
    parameters.ignore_all();
    Material unknown;
    unknown.model = DiffuseMaterial{sources.known.textures.constant(older_half), 0, std::nullopt};
    return unknown;
}

}  // namespace lightnet::pbrt
