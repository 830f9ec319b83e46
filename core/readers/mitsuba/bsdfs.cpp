#include "core/readers/mitsuba/bsdfs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/suggestion.hpp"
#include "core/readers/common/dispersion.hpp"
#include "core/readers/mitsuba/colours.hpp"
#include "core/readers/mitsuba/metals.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr int deepest = 64;  // bsdfs inside of bsdfs

template <class Model>
Material one_sided(Model model) {
    Material material{"", std::move(model)};
    material.one_sided = true;
    return material;
}

/// The texture of a number. None: it has none.
std::optional<TextureId> varying(Textures& textures, Properties& properties, std::string_view name) {
    const Node* given = properties.find(name);
    return given && !is_colour(*given) ? std::optional(textures.number_of(*given)) : std::nullopt;
}

bool may_be_above_zero(const Context& context, TextureId texture) {
    const Texture& number = context.assets.scene().textures[texture];
    return !std::holds_alternative<std::monostate>(number.pattern) || number.scale.r > 0;
}

}  // namespace

const std::map<std::string, Bsdfs::Maker, std::less<>>& Bsdfs::makers() {
    static const std::map<std::string, Maker, std::less<>> table{{"diffuse", &Bsdfs::diffuse},
                                                                 {"lambertian", &Bsdfs::diffuse},
                                                                 {"roughdiffuse", &Bsdfs::rough_diffuse},
                                                                 {"difftrans", &Bsdfs::translucent},
                                                                 {"dielectric", &Bsdfs::dielectric},
                                                                 {"thindielectric", &Bsdfs::thin_dielectric},
                                                                 {"roughdielectric", &Bsdfs::rough_dielectric},
                                                                 {"conductor", &Bsdfs::conductor},
                                                                 {"roughconductor", &Bsdfs::rough_conductor},
                                                                 {"plastic", &Bsdfs::plastic},
                                                                 {"roughplastic", &Bsdfs::plastic},
                                                                 {"pplastic", &Bsdfs::plastic},
                                                                 {"polarizer", &Bsdfs::polarising_filter},
                                                                 {"circular", &Bsdfs::polarising_filter},
                                                                 {"retarder", &Bsdfs::polarising_filter},
                                                                 {"phong", &Bsdfs::phong},
                                                                 {"ward", &Bsdfs::ward},
                                                                 {"principled", &Bsdfs::principled},
                                                                 {"principledthin", &Bsdfs::thin_principled},
                                                                 {"twosided", &Bsdfs::two_sided},
                                                                 {"mask", &Bsdfs::mask},
                                                                 {"blendbsdf", &Bsdfs::blend},
                                                                 {"mixturebsdf", &Bsdfs::mixture},
                                                                 {"bumpmap", &Bsdfs::bump_map},
                                                                 {"bump", &Bsdfs::bump_map},
                                                                 {"normalmap", &Bsdfs::normal_map},
                                                                 {"coating", &Bsdfs::coating},
                                                                 {"roughcoating", &Bsdfs::coating},
                                                                 {"measured", &Bsdfs::measured},
                                                                 {"hair", &Bsdfs::hair},
                                                                 {"null", &Bsdfs::nothing}};
    return table;
}

MaterialId Bsdfs::of(const Node& node) {
    const auto [entry, fresh] = made_.try_emplace(&node);
    if (!fresh && !entry->second) context_.error(node, fmt::format("bsdf '{}' refers to itself", node.id));
    if (!fresh) return entry->second.value_or(unnamed(false));
    Material material = make(node);
    material.name = node.id;
    const MaterialId made = context_.assets.add(std::move(material));
    made_[&node] = made;
    return made;
}

MaterialId Bsdfs::unnamed(bool lamp) {
    auto& known = unnamed_[lamp ? 1 : 0];
    if (!known) {
        known = context_.assets.add(one_sided(DiffuseMaterial{context_.assets.grey(lamp ? 0.0f : 0.5f)}));
    }
    return *known;
}

Material Bsdfs::grey() { return {"", DiffuseMaterial{context_.assets.grey(0.5f)}}; }

Material Bsdfs::copy_of(MaterialId id) const { return context_.assets.scene().materials[id]; }

Material Bsdfs::make(const Node& node) {
    Properties properties(node, context_);
    const auto maker = makers().find(node.type);
    if (maker == makers().end() || depth_ >= deepest) {
        properties.ignore_all();
        if (depth_ >= deepest) {
            context_.error(node, "bsdfs are nested too deeply");
            return grey();
        }
        std::vector<std::string> names;
        for (const auto& [name, make] : makers()) names.push_back(name);
        context_.warn(node, fmt::format("bsdf '{}' is not supported{}: grey is taken", node.type,
                                        did_you_mean(node.type, names)));
        return grey();
    }
    ++depth_;
    Material material = (this->*maker->second)(properties);
    --depth_;
    return material;
}

/// The bsdfs inside of one; too few are reported, and the list is empty.
std::vector<const Node*> Bsdfs::nested(Properties& properties, std::size_t count) {
    auto found = properties.objects("bsdf");
    if (found.size() >= count) return found;
    context_.error(properties.node(), fmt::format("{} needs {} inside of it", properties.owner(),
                                                  count == 1 ? "a bsdf" : fmt::format("{} bsdfs", count)));
    return {};
}

/// α from alpha, or from alpha_u and alpha_v.
Roughness Bsdfs::roughness(Properties& properties, float fallback) {
    const std::string distribution = properties.text("distribution", "beckmann");
    const bool beckmann = distribution == "beckmann";
    if (!beckmann && distribution != "ggx")
        context_.warn(properties.node(),
                      fmt::format("distribution '{}' is taken as 'ggx'", distribution.substr(0, 32)));
    const FacetLaw law{beckmann ? FacetLaw::Normals::beckmann : FacetLaw::Normals::ggx, FacetLaw::Masking::independent};
    properties.ignore({"sample_visible"});
    Roughness rough{fallback, fallback, {}, Roughness::Means::alpha, law};
    const Node* alpha = properties.find("alpha");
    if (alpha && !is_colour(*alpha)) {
        rough = {1, 1, textures_.number_of(*alpha), Roughness::Means::alpha, law};
    } else {
        rough.u = rough.v = properties.number("alpha", fallback);
        const auto one = [&](const char* name, float other) {
            const Node* given = properties.find(name);
            if (!given || is_colour(*given)) return given ? properties.number(name, other) : other;
            context_.warn(*given, "a texture for one direction of roughness is taken as its mean");
            return luminance(mean_colour(context_.assets.scene(), textures_.of(*given)));
        };
        rough.u = one("alpha_u", rough.u), rough.v = one("alpha_v", rough.v);
    }
    rough.u = std::clamp(rough.u, 0.0f, 1.0f), rough.v = std::clamp(rough.v, 0.0f, 1.0f);
    return rough;
}

Material Bsdfs::diffuse(Properties& properties) {
    return one_sided(DiffuseMaterial{textures_.get(properties, "reflectance", 0.5f)});
}

Material Bsdfs::rough_diffuse(Properties& properties) {
    properties.ignore({"use_fast_approx"});
    Material material = diffuse(properties);
    auto& model = std::get<DiffuseMaterial>(material.model);
    // in Mitsuba 0.6 alpha is the root mean square slope of Beckmann's facets; Oren and Nayar's σ = α/√2
    model.sigma = std::clamp(mean_of(properties, "alpha", 0.2f), 0.0f, 1.0f) / std::sqrt(2.0f);
    return material;
}

Material Bsdfs::translucent(Properties& properties) {
    DiffuseMaterial model{context_.assets.grey(0)};
    model.transmittance = textures_.get(properties, "transmittance", 0.5f);
    return {"", model};
}

// Tints, and what is thin, take one index.
Material Bsdfs::glass(Properties& properties, const Roughness& roughness, bool thin) {
    const Rgb eta = indices_of(properties, "int_ior", "bk7") / indices_of(properties, "ext_ior", "air").g;
    const auto reflected = textures_.maybe(properties, "specular_reflectance");
    const auto transmitted = textures_.maybe(properties, "specular_transmittance");
    if (const auto solid = dispersing_glass(eta, roughness, context_.assets.grey(1))) {
        const bool dispersing = !thin && !reflected && !transmitted;
        context_.warn(*properties.find("int_ior"), std::string(dispersing ? three_indices : one_index));
        if (dispersing) return {"", *solid};
    }
    DielectricMaterial model{eta.g, roughness, reflected, transmitted, thin};
    return {"", model};
}

Material Bsdfs::dielectric(Properties& properties) { return glass(properties, {}, false); }

Material Bsdfs::thin_dielectric(Properties& properties) { return glass(properties, {}, true); }

Material Bsdfs::rough_dielectric(Properties& properties) {
    return glass(properties, roughness(properties, 0.1f), false);
}

/// Without a material and an index it is copper in Mitsuba 0, and the perfect mirror since then.
ConductorMaterial Bsdfs::metal(Properties& properties) {
    ConductorMaterial model;
    std::string name = properties.text("material", context_.document.version == 0 ? "Cu" : "none");
    if (same_but_for_case(name, "none")) name = "none";
    const float outside = index_of(properties, "ext_eta", "vacuum");
    model.tint = textures_.maybe(properties, "specular_reflectance");
    const bool by_index = properties.has("eta") || properties.has("k");
    constexpr ComplexIndex mirror{{{0, 0, 0}}, {{1, 1, 1}}};
    auto index = name == "none" ? mirror : metal_named(name);
    if (!index && !by_index)
        context_.warn(properties.node(), fmt::format("the metal '{}' is not known{}: grey is taken", name.substr(0, 32),
                                                     did_you_mean(name, metal_names())));
    if (!by_index && (!index || name == "none")) {
        model.metal.reflectance = context_.assets.grey(index ? 1.0f : 0.5f);
        return model;
    }
    if (!index) index = mirror;
    const auto part = [&](const char* key, SurfaceColour fallback) {
        const Node* given = properties.find(key);
        if (given && !is_colour(*given)) {
            Texture inside = context_.assets.scene().textures[textures_.of(*given)];
            inside.scale = inside.scale / outside;
            return outside == 1 ? textures_.of(*given) : context_.assets.add(inside);
        }
        return context_.assets.colour((given ? surface_of(*given, context_).value_or(fallback) : fallback).rgb /
                                      outside);
    };
    model.metal.eta = part("eta", index->eta);
    model.metal.k = part("k", index->k);
    return model;
}

Material Bsdfs::conductor(Properties& properties) { return one_sided(metal(properties)); }

Material Bsdfs::rough_conductor(Properties& properties) {
    auto model = metal(properties);
    model.roughness = roughness(properties, 0.1f);
    return one_sided(model);
}

CoatedDiffuseMaterial Bsdfs::coat(Properties& properties) {
    CoatedDiffuseMaterial model;
    model.base_colours_repeat = properties.boolean("nonlinear", false);
    model.tint = textures_.maybe(properties, "specular_reflectance");
    model.reflectance = textures_.get(properties, "diffuse_reflectance", 0.5f);
    model.eta = index_of(properties, "int_ior", "polypropylene") / index_of(properties, "ext_ior", "air");
    return model;
}

Material Bsdfs::plastic(Properties& properties) {
    auto model = coat(properties);
    const std::string& type = properties.node().type;
    if (type != "plastic") model.roughness = roughness(properties, 0.1f);
    if (type == "pplastic") context_.warn(properties.node(), "its light is not polarised");
    return one_sided(model);
}

/// Lets light straight through that is not polarised: a polariser half of it, a retarder all.
Material Bsdfs::polarising_filter(Properties& properties) {
    properties.ignore({"theta", "delta", "polarizing", "left_handed"});
    context_.warn(properties.node(), "no light is polarised: it lets an even part of all through");
    Texture kept = context_.assets.scene().textures[textures_.number(properties, "transmittance", 1.0f)];
    if (properties.node().type != "retarder") kept.scale *= 0.5f;
    kept.invert = true;
    Material material{"", DiffuseMaterial{context_.assets.grey(0)}};
    material.opacity = context_.assets.add(kept);
    return material;
}

/// A diffuse surface under a highlight of a model that a scene has not.
Material Bsdfs::highlight(Properties& properties, Roughness rough) {
    context_.warn(properties.node(), fmt::format("{} is taken as a principled surface", properties.owner()));
    PrincipledMaterial model;
    model.base_colour = textures_.get(properties, "diffuse_reflectance", 0.5f);
    const TextureId shine = textures_.get(properties, "specular_reflectance", 0.2f);
    model.specular = std::clamp(luminance(mean_colour(context_.assets.scene(), shine)), 0.0f, 1.0f);
    model.roughness = rough;
    return one_sided(model);
}

Material Bsdfs::phong(Properties& properties) {
    const float alpha = std::sqrt(2 / (std::max(mean_of(properties, "exponent", 30), 0.0f) + 2));
    return highlight(properties, {alpha, alpha, {}, Roughness::Means::alpha});
}

Material Bsdfs::ward(Properties& properties) {
    properties.ignore({"variant"});
    const float u = mean_of(properties, "alpha_u", 0.1f), v = mean_of(properties, "alpha_v", 0.1f);
    return highlight(properties, {std::clamp(u, 0.0f, 1.0f), std::clamp(v, 0.0f, 1.0f), {}, Roughness::Means::alpha});
}

/// A number, or the mean of its texture.
float Bsdfs::mean_of(Properties& properties, std::string_view name, float fallback) {
    const Node* given = properties.find(name);
    if (!given || is_colour(*given)) return properties.number(name, fallback);
    context_.warn(*given, fmt::format("a texture for '{}' is taken as its mean", name));
    return luminance(mean_colour(context_.assets.scene(), textures_.of(*given)));
}

/// Burley 2012: α = roughness², stretched by √(1 - 0.9 anisotropic).
Roughness Bsdfs::burley_roughness(Properties& properties, bool varies) {
    const float anisotropic = varies ? 0 : std::clamp(properties.number("anisotropic", 0), 0.0f, 1.0f);
    const float aspect = std::sqrt(std::sqrt(1 - 0.9f * anisotropic));
    Roughness rough{1, 1, {}, Roughness::Means::square, {FacetLaw::Normals::ggx, FacetLaw::Masking::independent}};
    const Node* given = properties.find("roughness");
    if (given && !is_colour(*given))
        rough.texture = textures_.number_of(*given);
    else
        rough.u = rough.v = std::clamp(properties.number("roughness", 0.5f), 0.0f, 1.0f);
    rough.u /= aspect, rough.v *= aspect;
    return rough;
}

BurleyMaterial Bsdfs::burley(Properties& properties) {
    BurleyMaterial model;
    const auto get = [&](const char* name) { return textures_.number(properties, name, 0.0f); };
    model.base_colour = textures_.get(properties, "base_color", 0.5f);
    model.transmission = get("spec_trans"), model.tint = get("spec_tint");
    model.anisotropic = varying(textures_, properties, "anisotropic");
    model.roughness = burley_roughness(properties, model.anisotropic.has_value());
    model.flatness = get("flatness"), model.sheen = get("sheen"), model.sheen_tint = get("sheen_tint");
    model.metallic = model.coat = model.gloss = model.through = context_.assets.grey(0);
    properties.ignore({"diffuse_reflectance_sampling_rate", "specular_reflectance_sampling_rate",
                       "diffuse_transmittance_sampling_rate", "specular_transmittance_sampling_rate",
                       "clearcoat_reflectance_sampling_rate", "main_specular_sampling_rate", "diff_refl_sampling_rate",
                       "spec_refl_sampling_rate", "spec_trans_sampling_rate", "clearcoat_sampling_rate"});
    return model;
}

Material Bsdfs::principled(Properties& properties) {
    BurleyMaterial model = burley(properties);
    const auto get = [&](const char* name) { return textures_.number(properties, name, 0.0f); };
    model.metallic = get("metallic"), model.coat = get("clearcoat"), model.gloss = get("clearcoat_gloss");
    model.lets_through = may_be_above_zero(context_, model.transmission);
    float eta = 1.5f;
    if (properties.has("eta")) {
        eta = index_of(properties, "eta", "bk7");
        if (eta < 1) context_.warn(properties.node(), "an 'eta' below 1 is taken as 1");
    } else if (model.specular = varying(textures_, properties, "specular"); !model.specular) {
        float specular = std::clamp(properties.number("specular", 0.5f), 0.0f, 1.0f);
        if (model.lets_through && specular == 0) specular = 1e-3f;  // as in Mitsuba
        eta = eta_of_specular(specular);
    }
    model.eta = context_.assets.grey(std::max(eta, model.lets_through ? 1.001f : 1.0f));
    Material material{"", model};
    material.one_sided = !model.lets_through;
    return material;
}

Material Bsdfs::thin_principled(Properties& properties) {
    BurleyMaterial model = burley(properties);
    model.thin = true;
    model.eta = textures_.number(properties, "eta", 1.5f);
    // 2 means that all goes to the other side
    Texture half = context_.assets.scene().textures[textures_.number(properties, "diff_trans", 0.0f)];
    half.scale *= 0.5f;
    model.through = context_.assets.add(half);
    model.lets_through = may_be_above_zero(context_, model.transmission) || may_be_above_zero(context_, model.through);
    return {"", model};
}

Material Bsdfs::measured(Properties& properties) {
    const Node* name = properties.find("filename");
    if (!name) {
        context_.error(properties.node(), fmt::format("{} needs a 'filename'", properties.owner()));
        return grey();
    }
    const std::string path = context_.path(properties.text("filename", ""), *name);
    const auto read = [&] {
        auto [bytes, problem] = context_.assets.try_read(path);
        return bytes ? bytes : throw Error(problem);
    };
    const auto found = measurements_.get(path, name->where, read);
    return found ? one_sided(MeasuredMaterial{found}) : grey();
}

Material Bsdfs::nothing(Properties&) { return {"", NoMaterial{}}; }

}  // namespace lightnet::mitsuba
