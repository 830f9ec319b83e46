#include "core/readers/mitsuba/emitters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/turns.hpp"
#include "core/readers/daylight/daylight.hpp"
#include "core/readers/daylight/sun_position.hpp"
#include "core/readers/mitsuba/colours.hpp"
#include "core/readers/mitsuba/sensors.hpp"
#include "core/readers/mitsuba/transforms.hpp"
#include "core/scene/reach.hpp"
#include "core/scene/textures/look_up.hpp"

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

/// A spot of Mitsuba's shines along +z, straight down of a luminaire is -z.
Matrix luminaire_of_spot(const Matrix& to_world) {
    Matrix half_turn;
    half_turn.m[1][1] = half_turn.m[2][2] = -1;
    return turn_of(to_world * half_turn);
}

LampLabel label(const Properties& properties) { return {properties.node().id}; }

void point(Properties& properties, Textures&, SceneData& scene) {
    const Matrix to_world = transform_of(properties);
    const Vec3 origin = transform_point(to_world, {0, 0, 0});
    const Vec3 position = properties.point("position", origin);
    scene.lights.push_back(
        PointLight{position, light_of(properties, "intensity", 1).rgb, label(properties), {}, turn_of(to_world)});
}

/// A texture as a picture, upright as Mitsuba has it: pixel by pixel where it is one, else of 512 by 512; at most of
/// 4096 by 4096.
std::shared_ptr<const Image> picture_of(const SceneData& scene, TextureId texture) {
    constexpr std::uint32_t most = 4096;
    std::uint32_t wide = 512, high = 512;
    if (is_constant(scene.textures[texture])) wide = high = 1;
    if (const auto* picture = std::get_if<ImageTexture>(&scene.textures[texture].pattern);
        picture && picture->image && !picture->image->empty())
        wide = std::min(most, picture->image->width), high = std::min(most, picture->image->height);
    std::vector<Rgb> pixels;
    pixels.reserve(std::size_t{wide} * high);
    for (std::uint32_t y = 0; y < high; ++y)
        for (std::uint32_t x = 0; x < wide; ++x)
            pixels.push_back(look_up(scene.textures, texture,
                                     {{(float(x) + 0.5f) / float(wide), 1 - (float(y) + 0.5f) / float(high)}}));
    return std::make_shared<const Image>(wide, high, pixels);
}

/// As wide as the cone, in front of the light.
void add_slide(SpotLight& light, const Node& given, Textures& textures, const Matrix& to_world) {
    const auto& context = textures.context();
    const TextureId texture = textures.of_light(given);
    if (light.outer >= 89.5f * to_radians) {
        context.warn(given, "a spot of 90 degrees or more throws no picture: the mean of its texture is taken");
        light.intensity *= mean_colour(context.assets.scene(), texture);
        return;
    }
    const float tangent = std::tan(light.outer);
    light.slide = Slide{picture_of(context.assets.scene(), texture), turn_of(to_world), tangent, tangent, false};
}

void spot(Properties& properties, Textures& textures, SceneData& scene) {
    const Matrix to_world = transform_of(properties);
    SpotLight light;
    light.position = transform_point(to_world, {0, 0, 0});
    light.axis = unit(transform_direction(to_world, {0, 0, 1}), {0, 0, 1});
    light.luminaire = luminaire_of_spot(to_world);
    light.intensity = light_of(properties, "intensity", 1).rgb;
    const float cutoff = std::clamp(properties.number("cutoff_angle", 20), 0.01f, 180.0f);
    const float beam = std::clamp(properties.number("beam_width", cutoff * 0.75f), 0.0f, cutoff);
    light.outer = cutoff * to_radians, light.inner = beam * to_radians;
    light.falloff = SpotLight::Falloff::linear;
    light.label = label(properties);
    if (const Node* given = properties.find("texture")) add_slide(light, *given, textures, to_world);
    scene.lights.push_back(light);
}

/// Its picture is the irradiance of a plane at distance 1, over π.
void projector(Properties& properties, Textures& textures, SceneData& scene) {
    const auto& context = properties.context();
    const Matrix to_world = transform_of(properties);
    const Node* given = properties.find("irradiance");
    const float strength = std::numbers::pi_v<float> * std::max(0.0f, properties.number("scale", 1));
    if (!given) return context.error(properties.node(), "a projector needs an 'irradiance'");
    SpotLight light;
    light.position = transform_point(to_world, {0, 0, 0});
    light.axis = unit(transform_direction(to_world, {0, 0, 1}), {0, 0, 1});
    light.luminaire = luminaire_of_spot(to_world);
    light.intensity = {strength, strength, strength};
    light.label = label(properties);
    Slide slide{picture_of(scene, textures.of_light(*given)), turn_of(to_world)};
    for (std::size_t i = 0; i < 3; ++i)  // as a camera's picture, whose right is -x and whose top +y
        slide.to_world.m[i][0] *= -1, slide.to_world.m[i][1] *= -1;
    const Extent extent = extent_of(properties, slide.image->width, slide.image->height);
    slide.half_width = float(extent.x), slide.half_height = float(extent.y);
    slide.even_on_planes = true;
    light.outer = light.inner = std::atan(std::hypot(slide.half_width, slide.half_height)) + 1e-3f;
    light.slide = slide;
    scene.lights.push_back(light);
}

/// A number that has bounds.
float bounded(Properties& properties, std::string_view name, float fallback, float least, float most) {
    const float value = properties.number(name, fallback);
    if (value >= least && value <= most) return value;
    properties.context().error(properties.node(),
                               fmt::format("'{}' is {}, but must be {} … {}", name, value, least, most));
    return fallback;
}

void directional(Properties& properties, Textures&, SceneData& scene) {
    const Matrix to_world = transform_of(properties);
    const Vec3 ahead = properties.has("direction") ? properties.point("direction", {0, 0, 1})
                                                   : transform_direction(to_world, {0, 0, 1});
    const float angle = bounded(properties, "angle", 0, 0, 179);
    scene.lights.push_back(DirectionalLight{unit(ahead, {0, 0, 1}), light_of(properties, "irradiance", 1).rgb,
                                            label(properties), angle / 2 * to_radians});
}

void constant(Properties& properties, Textures&, SceneData& scene) {
    EnvironmentData environment;
    environment.radiance = light_of(properties, "radiance", 1).rgb;
    scene.environments.push_back(environment);
}

void environment_map(Properties& properties, Textures&, SceneData& scene) {
    const auto& context = properties.context();
    EnvironmentData environment;
    const float scale = properties.number("scale", 1), gamma = properties.number("gamma", -1);
    environment.radiance = {scale, scale, scale};
    environment.to_world = turn_of(transform_of(properties)) * half_turn();
    const Node* file = properties.find("filename");
    properties.ignore({"cache", "max_anisotropy"});
    if (!file) return context.error(properties.node(), "an envmap needs a 'filename'");
    const Encoding encoding = gamma == 1  ? Encoding{Encoding::Curve::linear, 1}
                              : gamma > 0 ? Encoding{Encoding::Curve::gamma, gamma}
                                          : Encoding{};
    environment.image =
        context.assets.picture(context.path(std::string(file->attribute("value")), *file), encoding, file->where);
    scene.environments.push_back(environment);
}

/// Does any of these stand there?
bool has_any(Properties& properties, std::initializer_list<std::string_view> names) {
    bool any = false;
    for (const auto name : names) any |= properties.has(name);
    return any;
}

TimeAndPlace time_and_place(Properties& properties) {
    TimeAndPlace at;
    at.year = properties.integer("year", at.year);
    at.month = properties.integer("month", at.month);
    at.day = properties.integer("day", at.day);
    const auto number = [&](const char* name, double& value) { value = double{properties.number(name, float(value))}; };
    number("hour", at.hour), number("minute", at.minute), number("second", at.second);
    number("latitude", at.latitude), number("longitude", at.longitude), number("timezone", at.timezone);
    if (at.month < 1 || at.month > 12 || at.day < 1 || at.day > 31)
        properties.context().error(properties.node(), fmt::format("there is no day {} of month {}", at.day, at.month));
    return at;
}

/// In world space. Up is +y, north -z and east +x, turned by the emitter's transform; version 3 has +z up, and the sun
/// in the north at -x, in the east at -y.
Daylight daylight_of(Properties& properties) {
    const auto& context = properties.context();
    const bool third = context.document.version >= 3;
    const Matrix turn = turn_of(transform_of(properties));
    Daylight day;
    day.up = transform_direction(turn, third ? Vec3{0, 0, 1} : Vec3{0, 1, 0});
    if (properties.has("sun_direction")) {
        day.to_sun = unit(properties.point("sun_direction", day.up), day.up);
        if (has_any(properties,
                    {"year", "month", "day", "hour", "minute", "second", "latitude", "longitude", "timezone"}))
            context.error(properties.node(), "a sun has a direction or a time and a place, not both");
    } else {
        const auto [from_zenith, azimuth] = sun_position(time_and_place(properties));
        const auto flat = float(std::sin(from_zenith)), high = float(std::cos(from_zenith));
        const float north = flat * float(std::cos(azimuth)), east = flat * float(std::sin(azimuth));
        day.to_sun =
            unit(transform_direction(turn, third ? Vec3{-north, -east, high} : Vec3{east, high, -north}), day.up);
    }
    return day;
}

/// Both in one, or one of both. By default the sun is as bright as the sky, whose scale is that of both.
void sun_and_sky(Properties& properties, Textures&, SceneData& scene) {
    const auto& context = properties.context();
    const auto& node = properties.node();
    const bool third = context.document.version >= 3;
    Daylight day = daylight_of(properties);
    if (dot(day.up, day.to_sun) < 0)
        context.error(node, fmt::format("the sun is {:.1f}° below the horizon, and the sky is known by day only",
                                        std::asin(-dot(day.up, day.to_sun)) / to_radians));
    day.turbidity = bounded(properties, "turbidity", 3, 1, 10);
    day.stretch = bounded(properties, "stretch", 1, 1, 2);
    day.extended = properties.boolean("extend", false);
    const float ground = third ? 0.3f : 0.2f;
    day.albedo = surface_of(properties, "albedo", {ground, ground, ground}).rgb;
    const float scale = properties.number("scale", 1);
    const float sun_scale = properties.number("sun_scale", scale), sky_scale = properties.number("sky_scale", scale);
    const auto columns = std::uint32_t(bounded(properties, "resolution", 512, 4, 16384));
    float angle = angle_of_sun * bounded(properties, "sun_radius_scale", 1, 0, 300);
    if (properties.has("sun_aperture")) angle = bounded(properties, "sun_aperture", 0.5358f, 0, 179) / 2 * to_radians;
    if (node.type != "sun") {
        day.scale = sky_scale;
        scene.environments.push_back(sky_of(day, columns));
    }
    if (node.type == "sky") return;
    day.scale = sun_scale;
    DirectionalLight sun = sun_of(day, angle);
    sun.label.name = node.id;
    scene.lights.push_back(sun);
    if (third) context.warn(node, "the sun is as bright to its rim, and as Mitsuba 0.6 has it");
}

}  // namespace

void add_emitter(const Node& node, Textures& textures) {
    const auto& context = textures.context();
    using Adder = void (*)(Properties&, Textures&, SceneData&);
    static const std::map<std::string, Adder, std::less<>> adders{
        {"point", point},         {"spot", spot},
        {"projector", projector}, {"directional", directional},
        {"constant", constant},   {"envmap", environment_map},
        {"sunsky", sun_and_sky},  {"sky", sun_and_sky},
        {"sun", sun_and_sky}};
    Properties properties(node, context);
    if (context.document.lent.contains(node.id) && !adders.contains(node.type)) {
        properties.ignore_all();  // the shapes that it is lent to say what there is to say
        return;
    }
    if (node.type == "area") {
        properties.ignore_all();
        context.warn(node, "emitter 'area' belongs to no shape and is left out: it is dark");
        return;
    }
    properties.ignore({"sampling_weight"});
    if (const auto adder = adders.find(node.type); adder != adders.end()) {
        auto& scene = context.assets.scene();
        const std::size_t before = scene.lights.size();
        adder->second(properties, textures, scene);
        if (scene.lights.size() > before && !in_reach(scene.lights.back()))
            context.error(node, "it stands out of reach");
        return;
    }
    properties.ignore_all();
    std::vector<std::string> names;
    for (const auto& [name, add] : adders) names.push_back(name);
    context.warn(
        node, fmt::format("emitter '{}' is not supported{} and left out", node.type, did_you_mean(node.type, names)));
}

}  // namespace lightnet::mitsuba
