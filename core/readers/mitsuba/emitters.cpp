#include "core/readers/mitsuba/emitters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/suggestion.hpp"
#include "core/readers/mitsuba/colours.hpp"
#include "core/readers/mitsuba/sky.hpp"
#include "core/readers/mitsuba/transforms.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr float to_radians = std::numbers::pi_v<float> / 180;

Vec3 unit(Vec3 v, Vec3 fallback) {
    const float size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : fallback;
}

/// The middle of Mitsuba's latitude-longitude maps is +z, ours is -z.
Matrix half_turn() {
    Matrix t;
    t.m[0][0] = t.m[2][2] = -1;
    return t;
}

/// Without scale, so that only the turning of an environment is left.
Matrix rotation_of(Matrix t) {
    for (std::size_t j = 0; j < 3; ++j) {
        const double size = std::hypot(t.m[0][j], t.m[1][j], t.m[2][j]);
        for (std::size_t i = 0; i < 3; ++i) t.m[i][j] = size > 0 ? t.m[i][j] / size : (i == j ? 1 : 0);
        t.m[j][3] = 0;
    }
    return t;
}

LampLabel label(const Properties& properties) { return {properties.node().id}; }

void point(Properties& properties, SceneData& scene) {
    const Matrix to_world = transform_of(properties);
    const Vec3 origin = transform_point(to_world, {0, 0, 0});
    scene.lights.push_back(PointLight{properties.point("position", origin),
                                      colour_of(properties, "intensity", {1, 1, 1}), label(properties)});
}

void spot(Properties& properties, SceneData& scene) {
    const Matrix to_world = transform_of(properties);
    SpotLight light;
    light.position = transform_point(to_world, {0, 0, 0});
    light.axis = unit(transform_direction(to_world, {0, 0, 1}), {0, 0, 1});
    light.intensity = colour_of(properties, "intensity", {1, 1, 1});
    const float cutoff = std::clamp(properties.number("cutoff_angle", 20), 0.01f, 180.0f);
    const float beam = std::clamp(properties.number("beam_width", cutoff * 0.75f), 0.0f, cutoff);
    light.outer = cutoff * to_radians, light.inner = beam * to_radians;
    light.falloff = SpotLight::Falloff::linear;
    light.label = label(properties);
    if (properties.has("texture"))
        properties.context().warn(properties.node(), "the texture of a spot light is left out");
    scene.lights.push_back(light);
}

void directional(Properties& properties, SceneData& scene) {
    const Matrix to_world = transform_of(properties);
    const Vec3 ahead = properties.has("direction") ? properties.point("direction", {0, 0, 1})
                                                   : transform_direction(to_world, {0, 0, 1});
    scene.lights.push_back(
        DirectionalLight{unit(ahead, {0, 0, 1}), colour_of(properties, "irradiance", {1, 1, 1}), label(properties)});
}

void constant(Properties& properties, SceneData& scene) {
    EnvironmentData environment;
    environment.radiance = colour_of(properties, "radiance", {1, 1, 1});
    scene.environments.push_back(environment);
}

void environment_map(Properties& properties, SceneData& scene) {
    const auto& context = properties.context();
    EnvironmentData environment;
    const float scale = properties.number("scale", 1), gamma = properties.number("gamma", -1);
    environment.radiance = {scale, scale, scale};
    environment.to_world = rotation_of(transform_of(properties)) * half_turn();
    const Node* file = properties.find("filename");
    properties.ignore({"cache", "max_anisotropy"});
    if (!file) return context.error(properties.node(), "an envmap needs a 'filename'");
    const Encoding encoding = gamma == 1 ? Encoding{Encoding::Curve::linear, 1} : Encoding{};
    environment.image =
        context.assets.picture(context.path(std::string(file->attribute("value")), *file), encoding, file->where);
    scene.environments.push_back(environment);
}

/// Both in one, or one of both.
void sun_and_sky(Properties& properties, SceneData& scene) {
    const auto& context = properties.context();
    const auto& type = properties.node().type;
    Sky sky;
    sky.turbidity = std::clamp(properties.number("turbidity", 3), 1.7f, 10.0f);
    sky.to_sun = unit(properties.point("sun_direction", {0, 0.7071f, 0.7071f}), {0, 1, 0});
    sky.to_world = rotation_of(transform_of(properties));
    sky.sun = properties.node().id;
    if (properties.has("year") || properties.has("hour") || properties.has("latitude"))
        context.warn(properties.node(), "the time and place of a sun are left out: give its 'sunDirection'");
    const float scale = properties.number("scale", 1);
    const float sun_scale = properties.number("sun_scale", 1) * scale,
                sky_scale = properties.number("sky_scale", 1) * scale;
    properties.ignore_all();
    context.warn(properties.node(),
                 fmt::format("emitter '{}' is approximated: Preetham's sky, and a sun without extent", type));
    if (type != "sun") add_sky(sky, sky_scale, scene);
    if (type != "sky") add_sun(sky, sun_scale, scene);
}

}  // namespace

void add_emitter(const Node& node, const Context& context) {
    using Adder = void (*)(Properties&, SceneData&);
    static const std::map<std::string, Adder, std::less<>> adders{{"point", point},
                                                                  {"spot", spot},
                                                                  {"directional", directional},
                                                                  {"constant", constant},
                                                                  {"envmap", environment_map},
                                                                  {"sunsky", sun_and_sky},
                                                                  {"sky", sun_and_sky},
                                                                  {"sun", sun_and_sky}};
    Properties properties(node, context);
    properties.ignore({"sampling_weight"});
    if (const auto adder = adders.find(node.type); adder != adders.end())
        return adder->second(properties, context.assets.scene());
    properties.ignore_all();
    std::vector<std::string> names;
    for (const auto& [name, add] : adders) names.push_back(name);
    context.warn(
        node, fmt::format("emitter '{}' is not supported{} and left out", node.type, did_you_mean(node.type, names)));
}

}  // namespace lightnet::mitsuba
