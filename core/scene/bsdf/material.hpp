// All materials there are, and what every one of them must be able to say.
#pragma once

#include <concepts>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/base/each_once.hpp"
#include "core/base/math/rgb.hpp"
#include "core/scene/bsdf/blends.hpp"
#include "core/scene/bsdf/burley.hpp"
#include "core/scene/bsdf/coated_conductor.hpp"
#include "core/scene/bsdf/coated_diffuse.hpp"
#include "core/scene/bsdf/conductor.hpp"
#include "core/scene/bsdf/dielectric.hpp"
#include "core/scene/bsdf/diffuse_material.hpp"
#include "core/scene/bsdf/hair.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/measured.hpp"
#include "core/scene/bsdf/normal_map.hpp"
#include "core/scene/bsdf/principled.hpp"

namespace lightnet {

/// The list. A new one goes to its end: the number of a material in it is part of a scene's identity.
using AnyMaterial = std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, CoatedDiffuseMaterial,
                                 CoatedConductorMaterial, PrincipledMaterial, MixtureMaterial, TwoFacedMaterial,
                                 NoMaterial, BurleyMaterial, MeasuredMaterial, HairMaterial>;

/// Is a model of scattering at each place: at() gives it, or one of several.
template <class M>
concept Scatters = requires(const M& material, const MaterialInputs& inputs) {
    material.at(inputs);
};
/// Is made of others: parts_at() says of which.
template <class M>
concept Blends = requires(const M& material, const MaterialInputs& inputs) {
    { *std::begin(material.parts_at(inputs)) } -> std::convertible_to<BlendPart>;
};
/// Has much to work out once per scene.
template <class M>
concept Coated = requires(const M& material, Coats& coats) {
    { material.coating(coats) } -> std::same_as<Coating>;
};
/// What every material of the list is, beside a list of its own members.
template <class M>
concept IsMaterial = (Scatters<M> != Blends<M>)&&requires(M& material, const M& constant) {
    { M::name } -> std::convertible_to<const char*>;
    { constant.transparency() } -> std::same_as<Transparency>;
    visit_members(material, [](auto&...) {});
};

/// What at() of a material gives: a model, a variant of some; blends have none.
template <class M>
struct ScatteringOf {
    using type = std::variant<>;
};
template <Scatters M>
struct ScatteringOf<M> {
    using type = decltype(std::declval<const M&>().at(std::declval<const MaterialInputs&>()));
};

template <class Materials>
struct ModelsOf;
template <class... Materials>
struct ModelsOf<std::variant<Materials...>> {
    static_assert((IsMaterial<Materials> && ...), "a material must say what IsMaterial asks");
    /// Each model of scattering that materials can be, once.
    using type = EachOnce<typename ScatteringOf<Materials>::type...>;
};

struct Material {
    std::string name;  // as in the file; may be empty
    AnyMaterial model;
    bool one_sided = false;              // black from behind (opaque models only)
    std::optional<TextureId> opacity{};  // share of the light that meets the surface at all; its red counts
    float opacity_cutoff = 0;            // > 0: there where opacity ≥ this, else not
    std::optional<NormalMap> normal_map{};
    std::optional<TextureId> bump_map{};  // height, metres, in the normal's direction; its red counts
    Rgb absorption{};                     // per metre inside a solid (glTF's attenuation, Beer and Lambert's law)
    Rgb absorption_in_front{};            // the same of what lies around it, where its normal points
};
void visit_members(Is<Material> auto& material, const auto& visit) {
    auto& [name, model, one_sided, opacity, opacity_cutoff, normal_map, bump_map, absorption, absorption_in_front] =
        material;
    visit(model, one_sided, opacity, opacity_cutoff, normal_map, bump_map, absorption, absorption_in_front);
}

inline Transparency transparency_of(const Material& material) {
    return std::visit([](const auto& m) { return m.transparency(); }, material.model);
}

/// Does light go straight on through it, all over: is it a pane of glass?
inline bool is_pane(const Material& material) {
    const auto* glass = std::get_if<DielectricMaterial>(&material.model);
    return glass && glass->thin;
}

}  // namespace lightnet
