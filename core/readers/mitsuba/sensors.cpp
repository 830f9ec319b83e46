#include "core/readers/mitsuba/sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/readers/mitsuba/transforms.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr double one_degree = std::numbers::pi / 180;

FilmData film_of(Properties& sensor) {
    FilmData film;
    film.width = 768, film.height = 576;
    const auto given = sensor.objects("film");
    if (given.empty()) return film;
    Properties properties(*given[0], sensor.context());
    const auto size = [&](const char* name, std::uint32_t fallback) {
        const int value = properties.integer(name, static_cast<int>(fallback));
        if (value >= 1 && value <= 65536) return static_cast<std::uint32_t>(value);
        sensor.context().error(*given[0], fmt::format("'{}' must be from 1 to 65536, not {}", name, value));
        return fallback;
    };
    film.width = size("width", film.width), film.height = size("height", film.height);
    const float w = float(film.width), h = float(film.height);
    const float x = properties.number("crop_offset_x", 0) / w, y = properties.number("crop_offset_y", 0) / h;
    const float wide = properties.number("crop_width", w) / w, high = properties.number("crop_height", h) / h;
    if (x >= 0 && y >= 0 && wide > 0 && high > 0 && x + wide <= 1.0001f && y + high <= 1.0001f)
        film.crop = {x, std::min(x + wide, 1.0f), y, std::min(y + high, 1.0f)};
    else
        sensor.context().error(*given[0], "the crop window is not inside of the film");
    if (given[0]->type == "specfilm")
        sensor.context().warn(
            *given[0], "the response functions of 'specfilm' are left out: the picture is in red, green and blue");
    properties.ignore_all();  // how pictures are written is the graph's business
    return film;
}

/// tan(fov / 2) along the diagonal of a film of 35 mm, which lengths of lenses mean in Mitsuba; 50 mm if none is given.
double tangent_of_lens(Properties& properties) {
    std::string length = lower_case(properties.text("focal_length", "50mm"));
    if (length.ends_with("mm")) length.resize(length.size() - 2);
    const double focal = number(length, properties.node(), properties.context()).value_or(50);
    if (!(focal > 0)) properties.context().error(properties.node(), "'focal_length' must be above 0");
    if (properties.has("fov"))
        properties.context().warn(properties.node(), "a sensor has a 'fov' or a 'focal_length': the latter is taken");
    properties.ignore({"fov_axis"});  // is of 'fov' alone
    return std::hypot(36.0, 24.0) / (2 * std::max(focal, 1e-3));
}

double tangent_of_fov(Properties& properties) {
    const double fov = double(properties.number("fov", 90));
    if (!(fov > 0 && fov < 180))
        properties.context().error(properties.node(), "'fov' must lie between 0 and 180 degrees");
    return std::tan(std::clamp(fov, 0.01, 179.9) * one_degree / 2);
}

}  // namespace

Extent extent_of(Properties& properties, double w, double h) {
    const bool by_angle = properties.has("fov") && !properties.has("focal_length");
    const double tangent = by_angle ? tangent_of_fov(properties) : tangent_of_lens(properties);
    const std::string axis = by_angle ? lower_case(properties.text("fov_axis", "x")) : "diagonal";
    const double diagonal = std::hypot(w, h);
    if (axis == "diagonal") return {tangent * w / diagonal, tangent * h / diagonal};
    if (axis == "x" || (axis == "smaller" && w <= h) || (axis == "larger" && w >= h)) return {tangent, tangent * h / w};
    if (axis != "y" && axis != "smaller" && axis != "larger")
        properties.context().error(properties.node(), fmt::format("unknown fov_axis '{}'", axis.substr(0, 32)));
    return {tangent * w / h, tangent};
}

namespace {

/// Takes the scale out of a transform and hands it back, per axis.
Vec3 take_scale(Matrix& t) {
    Vec3 scale;
    for (std::size_t j = 0; j < 3; ++j) {
        const double size = std::hypot(t.m[0][j], t.m[1][j], t.m[2][j]);
        scale[j] = static_cast<float>(size);
        for (std::size_t i = 0; i < 3; ++i)
            if (size > 0) t.m[i][j] /= size;
    }
    return scale;
}

/// Of version 0.6: the picture's middle looks along +z, its left quarter to the left, where pbrt's, whose projection
/// this is, look along -x and +z.
void look_around(CameraData& camera) {
    camera.projection = LatitudeLongitude{};
    Matrix axes;
    axes.m[0] = {0, 0, -1, 0}, axes.m[2] = {-1, 0, 0, 0};
    camera.to_world = camera.to_world * axes;
}

}  // namespace

SensorDepth set_sensor(const Node& node, const Context& context) {
    Properties properties(node, context);
    properties.objects("sampler"), properties.objects("rfilter"), properties.objects("medium");
    const SensorDepth depth{properties.number("near_clip", 1e-2f), properties.number("far_clip", 1e4f)};
    SceneData& scene = context.assets.scene();
    scene.film = film_of(properties);
    const ShutterSpan shutter{properties.number("shutter_open", 0), properties.number("shutter_close", 0)};
    if (shutter.close < shutter.open) context.error(node, "the shutter must not close before it opens");
    scene.shutter = shutter;
    CameraData camera;
    camera.to_world = transform_of(properties);
    const Vec3 scale = take_scale(camera.to_world);
    for (std::size_t i = 0; i < 3; ++i) camera.to_world.m[i][0] *= -1;  // Mitsuba's x is on the left
    const double w = scene.film.width, h = scene.film.height;
    const float shift_x = properties.number("principal_point_offset_x", 0),
                shift_y = properties.number("principal_point_offset_y", 0);
    if (node.type == "orthographic") {
        camera.projection = Orthographic{};
        camera.screen_given = true;
        camera.screen = {-scale.x, scale.x, -scale.y * float(h / w), scale.y * float(h / w)};
    } else if (node.type == "spherical") {
        look_around(camera);
    } else {
        if (node.type != "perspective" && node.type != "thinlens")
            context.warn(node,
                         fmt::format("sensor '{}' is not known: a perspective one is taken, which sees other things",
                                     node.type));
        const Extent extent = extent_of(properties, w, h);
        camera.fov = static_cast<float>(2 * std::atan(std::min(extent.x, extent.y)) / one_degree);
    }
    if (shift_x != 0 || shift_y != 0) {
        const float wide = camera.is_orthographic() ? camera.screen[1] : float(std::max(1.0, w / h));
        const float high = camera.is_orthographic() ? camera.screen[3] : float(std::max(1.0, h / w));
        const float x = 2 * shift_x * wide, y = 2 * shift_y * high;
        camera.screen = {x - wide, x + wide, -y - high, -y + high};  // what Mitsuba sees is moved right and down
        camera.screen_given = true;
    }
    if (node.type == "thinlens") {
        camera.lens_radius = std::max(properties.number("aperture_radius", 0), 0.0f);
        camera.focus_distance = std::max(properties.number("focus_distance", depth.farthest), 1e-6f);
    } else {
        properties.ignore({"focus_distance", "aperture_radius"});
    }
    for (const auto& row : camera.to_world.m)
        for (const double value : row)
            if (!std::isfinite(value)) {
                context.error(node, "the transform of the sensor is not finite");
                return depth;
            }
    camera.where = node.where;
    scene.camera = camera;
    scene.camera_given = true;
    if (node.type == "spherical") return {0, std::numeric_limits<float>::infinity()};
    return depth;
}

}  // namespace lightnet::mitsuba
