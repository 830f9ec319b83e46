#include "core/readers/pbrt/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/pbrt/pictured_lights.hpp"
#include "core/readers/pbrt/transforms.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float float_pi = std::numbers::pi_v<float>;

/// pbrt gives a light of rgb the luminance that the numbers say, and any other spectrum luminance 1; then `scale`.
std::optional<Rgb> strength(Parameters& parameters, const Sources& sources, const char* name) {
    Rgb colour{1, 1, 1};
    if (const Parameter* given = parameters.find(name)) {
        const auto found = light_of(*given, sources);
        if (!found) return std::nullopt;
        colour = found->rgb;
    }
    const float scale = parameters.number("scale", 1);
    if (scale < 0) parameters.error("'scale' must not be negative");
    const Rgb strength = colour * std::max(scale, 0.0f);
    if (finite(strength)) return strength;
    parameters.error("the light is infinitely bright");
    return std::nullopt;
}

/// Not of pbrt, whose files name no light; pbrt lets it pass in an Attribute statement.
LampLabel label_of(Parameters& parameters) { return {parameters.text("name", "")}; }

/// An image and a colour exclude each other.
std::string picture_file(Parameters& parameters, const char* colour) {
    const std::string file = parameters.text("filename", "");
    if (!file.empty() && *colour && parameters.find(colour))
        parameters.error(fmt::format("'{}' and 'filename' exclude each other", colour));
    return file;
}

Vec3 point(Parameters& parameters, const char* name, Vec3 fallback) {
    const auto given = parameters.triples(name, Type::point3);
    if (given.size() == 1) return given[0];
    if (!given.empty()) parameters.error(fmt::format("'{}' must be one point", name));
    return fallback;
}

/// Power in watts, if it is given and makes sense.
std::optional<float> power_of(Parameters& parameters) {
    const float power = parameters.number("power", -1);
    return power > 0 ? std::optional(power) : std::nullopt;
}

/// What the makers of lights have in common.
struct Making {
    Parameters& parameters;
    Textures& textures;
    const Sources& sources;
    const Matrix& to_world;
    SceneData& scene;
    LampLabel label;
};

/// Where the axis of a light goes in the world. None: reported.
std::optional<Vec3> axis_of(const Making& making, Vec3 from, Vec3 to) {
    const Vec3 axis = transform_direction(making.to_world, to - from);
    const float size = length(axis);
    if (size > 0 && std::isfinite(size)) return axis / size;
    making.parameters.error("'from' and 'to' are the same");
    return std::nullopt;
}

void point_light(const Making& making) {
    auto colour = strength(making.parameters, making.sources, "I");
    const Vec3 from = transform_point(making.to_world, point(making.parameters, "from", {}));
    if (const auto power = power_of(making.parameters); power && colour) *colour *= *power / (4 * float_pi);
    if (colour) making.scene.lights.push_back(PointLight{from, *colour, making.label});
}

void spot_light(const Making& making) {
    auto& parameters = making.parameters;
    auto colour = strength(parameters, making.sources, "I");
    const Vec3 from = point(parameters, "from", {}), to = point(parameters, "to", {0, 0, 1});
    const auto axis = axis_of(making, from, to);
    const float outer = parameters.number("coneangle", 30), inner = outer - parameters.number("conedeltaangle", 5);
    if (!(outer > 0 && outer <= 180 && inner <= outer)) {
        parameters.error("'coneangle' must be above 0 and at most 180 degrees, and 'conedeltaangle' not negative");
        return;
    }
    SpotLight light;
    light.position = transform_point(making.to_world, from);
    light.inner = std::max(inner, 0.0f) * float_pi / 180, light.outer = outer * float_pi / 180;
    if (const auto power = power_of(parameters); power && colour) {
        const float start = std::cos(light.inner), end = std::cos(light.outer);
        *colour *= *power / (2 * float_pi * ((1 - start) + (start - end) / 2));
    }
    if (!colour || !axis) return;
    light.axis = *axis, light.intensity = *colour, light.label = making.label;
    making.scene.lights.push_back(light);
}

void distant_light(const Making& making) {
    auto colour = strength(making.parameters, making.sources, "L");
    const Vec3 from = point(making.parameters, "from", {}), to = point(making.parameters, "to", {0, 0, 1});
    const auto axis = axis_of(making, from, to);
    if (const float lux = making.parameters.number("illuminance", -1); lux > 0 && colour) *colour *= lux;
    if (colour && axis) making.scene.lights.push_back(DirectionalLight{*axis, *colour, making.label});
}

/// Of the matrix of an environment, what turns (and perhaps mirrors) it.
Matrix turn_of(const Making& making) {
    if (!uniform_scale(making.to_world)) making.parameters.warn("an environment is turned, but not stretched");
    Matrix turn;
    for (int j = 0; j < 3; ++j) {
        double square = 0;
        for (int i = 0; i < 3; ++i) square += making.to_world.m[i][j] * making.to_world.m[i][j];
        for (int i = 0; i < 3; ++i) turn.m[i][j] = square > 0 ? making.to_world.m[i][j] / std::sqrt(square) : i == j;
    }
    return turn;
}

// pbrt's rectangle, whose corners are in world space whatever the transform; light comes in against the cross product
// of the sides from its first corner to the last and to the second.
std::optional<Portal> portal_of(Parameters& parameters) {
    if (!parameters.find("portal")) return {};
    const auto corners = parameters.triples("portal", Type::point3);
    constexpr float square = 1e-3f;  // cosine to a right angle
    const auto nearly_0 = [](Vec3 a, Vec3 b) { return std::fabs(dot(a, b)) <= square * length(a) * length(b); };
    if (corners.size() == 4) {
        const Portal portal{corners[0], corners[3] - corners[0], corners[1] - corners[0]};
        const Vec3 across = corners[2] - corners[1] - portal.side;
        const bool flat = length(across) <= square * length(portal.side);
        if (flat && nearly_0(portal.side, portal.other) && length(cross(portal.side, portal.other)) > 0) return portal;
    }
    parameters.error("'portal' is not four corners of a rectangle, one after the other");
    return {};
}

void infinite_light(const Making& making) {
    auto& parameters = making.parameters;
    EnvironmentData environment;
    environment.to_world = turn_of(making);
    const auto colour = strength(parameters, making.sources, "L");
    const std::string file = picture_file(parameters, "L");
    if (!file.empty()) {
        environment.image = making.textures.pictures().get(file, {}, parameters.where());
        if (!environment.image) return;
        making.textures.pictures().finish();  // its shape tells how it is laid out
        environment.layout = layout_of(*environment.image);
    }
    environment.portal = portal_of(parameters);
    if (!colour) return;
    environment.radiance = *colour;
    if (const float lux = parameters.number("illuminance", -1); lux > 0) {
        // of the upper half, as pbrt takes it
        const float now = environment.image ? upper_illuminance(environment) : float_pi;
        if (now > 0) environment.radiance *= lux / now;
    }
    making.scene.environments.push_back(environment);
}

/// Lights with an image of directions are taken as the nearest that a scene has.
void goniometric_light(const Making& making) {
    auto& parameters = making.parameters;
    auto colour = strength(parameters, making.sources, "I");
    const std::string file = picture_file(parameters, "");
    float mean = 1;
    if (!file.empty()) {
        const auto image = making.textures.pictures().get(file, {}, parameters.where());
        making.textures.pictures().finish();
        if (image) mean = mean_luminance(*image);
        parameters.warn("a goniometric light is taken as a point light with the same power in all directions");
    }
    const auto power = power_of(parameters);
    if (colour) *colour *= power ? *power / (4 * float_pi) : mean;
    if (colour) making.scene.lights.push_back(PointLight{transform_point(making.to_world, {}), *colour, making.label});
}

void projection_light(const Making& making) {
    auto& parameters = making.parameters;
    auto colour = strength(parameters, making.sources, "I");
    const std::string file = picture_file(parameters, "");
    if (file.empty()) parameters.error("parameter 'filename' is missing");
    const float fov = parameters.number("fov", 90);
    if (!(fov > 0 && fov < 180)) parameters.error("'fov' must be between 0 and 180 degrees");
    const auto image = file.empty() ? nullptr : making.textures.pictures().get(file, {}, parameters.where());
    making.textures.pictures().finish();
    const auto axis = axis_of(making, {}, {0, 0, 1});
    if (!image || !colour || !axis) return;
    parameters.warn("a projection light is taken as a spot light with the mean colour of its image");
    SpotLight light;
    light.position = transform_point(making.to_world, {});
    light.label = making.label;
    light.axis = *axis;
    light.outer = light.inner = fov / 2 * float_pi / 180;
    light.intensity = *colour * mean_colour(*image);
    if (const auto power = power_of(parameters); power && luminance(light.intensity) > 0)
        light.intensity *= *power / (2 * float_pi * (1 - std::cos(light.outer)) * luminance(light.intensity));
    making.scene.lights.push_back(light);
}

using LightMaker = void (*)(const Making&);

const std::map<std::string, LightMaker>& light_makers() {
    static const std::map<std::string, LightMaker> table{
        {"distant", distant_light}, {"goniometric", goniometric_light}, {"infinite", infinite_light},
        {"point", point_light},     {"projection", projection_light},   {"spot", spot_light}};
    return table;
}

}  // namespace

AreaEmission AreaLight::on(double area) const {
    if (!power || !(area > 0) || !(brightness > 0)) return emission;
    const double sides = emission.two_sided ? 2 : 1;
    AreaEmission scaled = emission;
    scaled.radiance *= float(*power / (sides * area * std::numbers::pi * brightness));
    return scaled;
}

std::optional<AreaLight> make_area_light(const std::string& type, Parameters& parameters, Textures& textures,
                                         const Sources& sources) {
    if (type != "diffuse") {
        parameters.error(fmt::format("unknown area light '{}' (there is 'diffuse')", type));
        parameters.ignore_all();
        return std::nullopt;
    }
    AreaLight light;
    light.emission.two_sided = parameters.boolean("twosided", false);
    light.power = power_of(parameters);
    const auto colour = strength(parameters, sources, "L");
    if (const std::string file = picture_file(parameters, "L"); !file.empty()) {
        ImageTexture picture;
        picture.image = textures.pictures().get(file, {}, parameters.where());
        if (picture.image && light.power) {
            textures.pictures().finish();
            light.brightness = mean_luminance(*picture.image);
        }
        if (picture.image) light.emission.texture = textures.add({{1, 1, 1}, std::move(picture), false});
    }
    light.emission.label = label_of(parameters);
    if (!colour) return std::nullopt;
    light.emission.radiance = *colour;
    return light;
}

void add_light(const std::string& type, Parameters& parameters, Textures& textures, const Sources& sources,
               const Matrix& to_world, SceneData& scene) {
    if (const auto maker = light_makers().find(type); maker != light_makers().end())
        return maker->second({parameters, textures, sources, to_world, scene, label_of(parameters)});
    std::vector<std::string> known;
    for (const auto& [name, maker] : light_makers()) known.push_back(name);
    parameters.error(fmt::format("unknown light '{}'{}", type, did_you_mean(type, known)));
    parameters.ignore_all();
}

}  // namespace lightnet::pbrt
