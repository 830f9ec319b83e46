#include "core/readers/gltf/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/readers/common/light_profile.hpp"
#include "core/readers/common/turns.hpp"
#include "core/scene/reach.hpp"

namespace lightnet::gltf {
namespace {

Vec3 axis_of(const Matrix& t, Vec3 direction) {
    const Vec3 d = transform_direction(t, direction);
    return length(d) > 0 && finite(d) ? normalize(d) : direction;
}

Rgb colour_of(const At& at) {
    const auto colour = at["color"].numbers<3>({1, 1, 1});
    return {float(colour[0]), float(colour[1]), float(colour[2])};
}

/// Angles from the axis of a spot, radians. glTF has none wider than half of all directions.
struct Cone {
    float inner = 0, outer = 0;
};
Cone cone_of(const At& spot) {
    constexpr float widest = std::numbers::pi_v<float> / 2;
    const float outer = spot["outerConeAngle"].real(std::numbers::pi_v<float> / 4),
                inner = spot["innerConeAngle"].real(0);
    const Cone cone{std::clamp(inner, 0.0f, std::clamp(outer, 1e-4f, widest)), std::clamp(outer, 1e-4f, widest)};
    if (outer > widest * 1.000001f)
        spot["outerConeAngle"].warn("a spot of glTF reaches 90 degrees at most, π/2: its light ends there");
    if (inner > outer) spot["innerConeAngle"].warn("it is larger than 'outerConeAngle': the light ends sharply there");
    return cone;
}

}  // namespace

void Lights::add(const At& node, const Matrix& to_world) {
    const std::string name = node["name"].text("");
    if (const At light = node["extensions"]["KHR_lights_punctual"]["light"]) punctual(light, to_world, name);
    if (const At named = node["extensions"]["EXT_lights_ies"]; named["light"]) luminaire(named, to_world, name);
}

void Lights::punctual(const At& index, const Matrix& to_world, const std::string& node) {
    const At list = document_.root()["extensions"]["KHR_lights_punctual"]["lights"];
    const auto which = index.index(list.size());
    if (!which) return;
    const At at = list[*which];
    const Rgb strength = colour_of(at) * at["intensity"].real(1);
    if (at["range"]) at.warn("ranges of lights are left out: their light goes on beyond");
    const Vec3 position = transform_point(to_world, {0, 0, 0}), ahead = axis_of(to_world, {0, 0, -1});
    if (!in_reach(position)) return index.error("stands out of reach");
    const std::string type = at["type"].text("");
    auto& lights = assets_.scene().lights;
    const LampLabel label{node.empty() ? at["name"].text("") : node};
    if (type == "point") {
        lights.push_back(PointLight{position, strength, label, {}, turn_of(to_world)});
    } else if (type == "directional") {
        lights.push_back(DirectionalLight{ahead, strength, label});
    } else if (type == "spot") {
        const auto [inner, outer] = cone_of(at["spot"]);
        lights.push_back(SpotLight{
            position, ahead, strength, inner, outer, SpotLight::Falloff::squared_linear, label, {}, turn_of(to_world)});
    } else {
        at["type"].error("must be point, spot or directional");
    }
}

/// A point light, straight down its profile being the node's -z.
void Lights::luminaire(const At& named, const Matrix& to_world, const std::string& node) {
    const At list = document_.root()["extensions"]["EXT_lights_ies"]["lights"];
    const auto which = named["light"].index(list.size());
    if (!which) return;
    const At at = list[*which];
    const float strength = named["multiplier"].real(1);
    if (!(strength >= 0)) return named["multiplier"].error("must not be negative");
    const Luminaire* made = pattern(*which, at);
    const Vec3 position = transform_point(to_world, {0, 0, 0});
    if (!in_reach(position)) return named["light"].error("stands out of reach");
    if (!made) return;
    const LampLabel label{node.empty() ? at["name"].text("") : node};
    PointLight light{position, colour_of(named) * strength, label, made->pattern, turn_of(to_world)};
    light.pattern->to_world = light.luminaire * made->pattern.to_world;
    light.intensity *= made->tilt.factor(light.luminaire, {0, 1, 0});
    assets_.scene().lights.push_back(std::move(light));
}

const Lights::Luminaire* Lights::pattern(std::size_t index, const At& at) {
    const auto [entry, fresh] = patterns_.try_emplace(index);
    auto& made = entry->second;
    if (!fresh) return made ? &*made : nullptr;
    if (const auto kind = at["mimeType"].text(""); !kind.empty() && kind != "application/x-ies-lm-63")
        at["mimeType"].error("must be application/x-ies-lm-63");
    std::optional<Bytes> file;
    std::optional<std::span<const std::byte>> bytes;
    if (at["bufferView"])
        bytes = document_.view(at["bufferView"]);
    else if (at["uri"] && (file = document_.resource(at["uri"])))
        bytes = **file;
    else if (!at["uri"])
        at.error("has neither 'uri' nor 'bufferView'");
    if (!bytes) return nullptr;
    try {
        const auto profile = read_light_profile({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
        if (const std::string lacks = lacks_of_tilt(profile, true); !lacks.empty()) at.warn(lacks);
        made = Luminaire{pattern_of(profile, Matrix{}), profile.tilt};
    } catch (const Error& problem) {
        at.error(problem.what());
    }
    return made ? &*made : nullptr;
}

}  // namespace lightnet::gltf
