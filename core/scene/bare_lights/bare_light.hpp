// All lights without a surface there are, and what every one of them must be able to say.
#pragma once

#include <concepts>
#include <variant>

#include "core/base/math/rgb.hpp"
#include "core/base/math/shutter.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/directional_light.hpp"
#include "core/scene/bare_lights/lamp_label.hpp"
#include "core/scene/bare_lights/point_light.hpp"
#include "core/scene/bare_lights/spot_light.hpp"

namespace lightnet {

/// The list, in world space. A new one goes to its end: the number of a light in it is part of a scene's identity.
using BareLight = std::variant<PointLight, SpotLight, DirectionalLight>;

/// Shines from a place of the scene, and may move while the shutter is open.
///   aim(): in which it is turned; {}: it shines alike in all directions
///   stands_as(): is nothing of it that may move other than in another one of its kind?
///   between(): it at a time between two steps, without what takes long to make ready
///   ready(): what its light is found by, or one of several (see IsNearLight)
template <class L>
concept IsNear = requires(const L& light, const StepPlace& place) {
    { light.position } -> std::same_as<const Vec3&>;
    { light.aim() } -> std::same_as<Vec3>;
    { light.stands_as(light) } -> std::same_as<bool>;
    { light.between(place, light) } -> std::same_as<L>;
    typename std::void_t<decltype(light.ready())>;
};
/// Comes from infinity, out of a disk of directions.
template <class L>
concept IsFar = requires(const L& light) {
    { light.disk() } -> std::same_as<SunDisk>;
};
/// Can shine as a luminaire's maker measured it, which hangs straight down unless it is turned.
template <class L>
concept IsLuminaire = IsNear<L> && requires(const L& light) {
    { light.luminaire } -> std::same_as<const Matrix&>;
};
/// What every light of the list is, beside a list of its own members.
///   name: how one is called that has no name
///   names(): what several like it are called in words
///   strength(): in units of its own, to which all of its light is in proportion
template <class L>
concept IsLight = (IsNear<L> != IsFar<L>)&&requires(L& light, const L& constant) {
    { L::name } -> std::convertible_to<const char*>;
    { constant.names() } -> std::same_as<const char*>;
    { light.label } -> std::same_as<LampLabel&>;
    { light.strength() } -> std::same_as<Rgb&>;
    visit_members(light, [](auto&...) {});
};

inline bool can_move(const BareLight& light) {
    return std::visit([]<IsLight L>(const L&) { return IsNear<L>; }, light);
}

}  // namespace lightnet
