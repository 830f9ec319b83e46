// The bsdfs that are made of others.
#include <fmt/format.h>

#include <algorithm>

#include "core/readers/mitsuba/bsdfs.hpp"
#include "core/readers/mitsuba/colours.hpp"

namespace lightnet::mitsuba {
namespace {

/// What Mitsuba lets become of light below a coat: it is absorbed on both ways, and meets the base once.
CoatLayer coat_layer(Properties& properties) {
    const Rgb absorbed = surface_of(properties, "sigma_a", {}).rgb * properties.number("thickness", 1);
    const float mean = std::max(0.0f, luminance(absorbed));
    if (max_component(absorbed) > 1.001f * mean)
        properties.context().warn(properties.node(),
                                  "the colour of a coat ('sigma_a') is left out: it absorbs as grey");
    return {mean, 1};
}

}  // namespace

Material Bsdfs::two_sided(Properties& properties) {
    const auto inner = nested(properties, 1);
    if (inner.empty()) return grey();
    if (inner.size() > 1) {
        const auto front = of(*inner[0]), back = of(*inner[1]);
        const auto facing = [&](MaterialId id) {  // on its own side it is seen from either direction
            Material part = copy_of(id);
            part.one_sided = false;
            return context_.assets.add(std::move(part));
        };
        return {"", TwoFacedMaterial{facing(front), facing(back)}};
    }
    Material material = copy_of(of(*inner[0]));
    material.one_sided = false;
    if (auto* mixture = std::get_if<MixtureMaterial>(&material.model)) {
        const auto both = [&](MaterialId id) {
            Material part = copy_of(id);
            part.one_sided = false;
            return context_.assets.add(std::move(part));
        };
        *mixture = {both(mixture->first), both(mixture->second), mixture->amount};
    }
    return material;
}

Material Bsdfs::mask(Properties& properties) {
    const auto inner = nested(properties, 1);
    const TextureId opacity = textures_.number(properties, "opacity", 0.5f);
    if (inner.empty()) return grey();
    Material material = copy_of(of(*inner[0]));
    material.opacity = opacity;
    return material;
}

Material Bsdfs::blend(Properties& properties) {
    const auto inner = nested(properties, 2);
    MixtureMaterial model;
    model.amount = textures_.number(properties, "weight", 0.5f);
    if (inner.empty()) return grey();
    model.first = of(*inner[0]);
    model.second = of(*inner[1]);
    return {"", model};
}

/// Of any number of bsdfs: one mixture inside of another. What the weights leave of 1 is black.
Material Bsdfs::mixture(Properties& properties) {
    const auto inner = nested(properties, 1);
    const auto weights = numbers(properties.text("weights", ""), properties.node(), context_);
    if (inner.empty() || !weights) return grey();
    if (weights->size() != inner.size()) {
        context_.error(properties.node(),
                       fmt::format("there are {} weights for {} bsdfs", weights->size(), inner.size()));
        return grey();
    }
    double sum = 0;
    for (const double weight : *weights) sum += std::max(weight, 0.0);
    std::vector<std::pair<MaterialId, double>> parts;
    for (std::size_t i = 0; i < inner.size(); ++i)
        parts.emplace_back(of(*inner[i]), std::max((*weights)[i], 0.0) / std::max(sum, 1.0));
    if (sum < 1 - 1e-6)
        parts.emplace_back(context_.assets.add(Material{"", DiffuseMaterial{context_.assets.grey(0)}}), 1 - sum);
    MaterialId whole = parts[0].first;
    double before = parts[0].second;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        before += parts[i].second;
        const float share = before > 0 ? static_cast<float>(parts[i].second / before) : 0;
        whole = context_.assets.add(Material{"", MixtureMaterial{whole, parts[i].first, context_.assets.grey(share)}});
    }
    return copy_of(whole);
}

Material Bsdfs::bump_map(Properties& properties) {
    const auto inner = nested(properties, 1);
    auto maps = properties.objects("texture");
    const float scale = properties.number("scale", 1);
    if (inner.empty()) return grey();
    Material material = copy_of(of(*inner[0]));
    if (maps.empty()) {
        context_.error(properties.node(), "a bumpmap needs a texture");
        return material;
    }
    Texture height = context_.assets.scene().textures[textures_.number_of(*maps[0])];
    height.scale *= scale;
    material.bump_map = context_.assets.add(height);
    return material;
}

Material Bsdfs::normal_map(Properties& properties) {
    const auto inner = nested(properties, 1);
    auto maps = properties.objects("texture");
    if (inner.empty()) return grey();
    Material material = copy_of(of(*inner[0]));
    if (maps.empty())
        context_.error(properties.node(), "a normalmap needs a texture");
    else
        material.normal_map = NormalMap{textures_.of(*maps[0]), 1, NormalMap::Green::across};
    return material;
}

/// A coat over a metal or over something diffuse; over others it is left out.
Material Bsdfs::coating(Properties& properties) {
    const auto inner = nested(properties, 1);
    const float eta = index_of(properties, "int_ior", "bk7") / index_of(properties, "ext_ior", "air");
    const Roughness rough = properties.node().type == "roughcoating" ? roughness(properties, 0.1f) : Roughness{};
    const CoatLayer layer = coat_layer(properties);
    if (inner.empty()) return grey();
    Material material = copy_of(of(*inner[0]));
    if (const auto* base = std::get_if<DiffuseMaterial>(&material.model)) {
        material.model = CoatedDiffuseMaterial{base->reflectance, eta, rough, {}, true, layer};
    } else if (const auto* metal = std::get_if<ConductorMaterial>(&material.model)) {
        material.model = CoatedConductorMaterial{metal->metal, metal->roughness, eta, rough, layer};
    } else {
        context_.warn(
            properties.node(),
            "a coat over anything but a metal or a diffuse surface is left out: what is below it is seen bare");
    }
    return material;
}

}  // namespace lightnet::mitsuba
