#include "core/scene/pbrt/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

/// pbrt's screen for a picture of that width over height: the shorter side spans ±1.
std::array<float, 4> screen_of(float aspect) {
    if (aspect > 1) return {-aspect, aspect, -1, 1};
    return {-1, 1, -1 / aspect, 1 / aspect};
}

std::array<float, 4> window(const Parameter& given, const Parameters& parameters, std::array<float, 4> fallback) {
    if (given.numbers.size() != 4 || given.numbers[0] >= given.numbers[1] || given.numbers[2] >= given.numbers[3]) {
        parameters.error(fmt::format("'{}' needs four numbers: x min, x max, y min, y max", given.name));
        return fallback;
    }
    return {given.numbers[0], given.numbers[1], given.numbers[2], given.numbers[3]};
}

/// In pixels, made into fractions of the film.
void pixel_bounds(FilmData& film, Parameters& parameters) {
    const Parameter* bounds = parameters.find("pixelbounds", Type::integer);
    if (!bounds) return;
    const auto& b = bounds->integers;
    if (b.size() != 4 || b[0] >= b[1] || b[2] >= b[3]) {
        parameters.error("'pixelbounds' needs four whole numbers: x min, x max, y min, y max");
        return;
    }
    const auto part = [](int pixel, std::uint32_t size) { return std::clamp(float(pixel) / float(size), 0.0f, 1.0f); };
    film.crop = {part(b[0], film.width), part(b[1], film.width), part(b[2], film.height), part(b[3], film.height)};
}

}  // namespace

Shot make_camera(const std::string& type, Parameters& parameters, const Matrix& to_world) {
    Shot shot;
    shot.camera.to_world = to_world;
    if (type != "perspective") {
        const bool known = type == "orthographic" || type == "realistic" || type == "spherical";
        parameters.error(known ? fmt::format("cameras of type '{}' are not supported; there is 'perspective'", type)
                               : fmt::format("unknown camera '{}'{}", type, did_you_mean(type, {"perspective"})));
        parameters.ignore_all();
        return shot;
    }
    shot.camera.fov = parameters.number("fov", 90);
    if (!(shot.camera.fov > 0 && shot.camera.fov < 180)) parameters.error("'fov' must be between 0 and 180 degrees");
    if (const auto aspect = parameters.maybe_number("frameaspectratio")) {
        if (*aspect > 0) {
            shot.camera.screen = screen_of(*aspect);
            shot.camera.screen_given = true;
        } else {
            parameters.error("'frameaspectratio' must be above 0");
        }
    }
    if (const Parameter* given = parameters.find("screenwindow", Type::number)) {
        shot.camera.screen = window(*given, parameters, shot.camera.screen);
        shot.camera.screen_given = true;
    }
    if (parameters.number("lensradius", 0) > 0) parameters.warn("the lens is left out: everything is in focus");
    parameters.ignore({"focaldistance"});
    shot.exposure = parameters.number("shutterclose", 1) - parameters.number("shutteropen", 0);
    if (!(shot.exposure > 0)) {
        parameters.error("the shutter must close after it has opened");
        shot.exposure = 1;
    }
    return shot;
}

FilmData make_film(const std::string& type, Parameters& parameters) {
    static const std::vector<std::string> known{"gbuffer", "rgb", "spectral"};
    if (std::find(known.begin(), known.end(), type) == known.end())
        parameters.error(fmt::format("unknown film '{}'{}", type, did_you_mean(type, known)));
    FilmData film;
    constexpr int longest_side = 1 << 16;
    const int width = parameters.integer("xresolution", 1280), height = parameters.integer("yresolution", 720);
    if (width < 1 || height < 1 || width > longest_side || height > longest_side)
        parameters.error(
            fmt::format("a film of {} x {} pixels is not possible (1 to {} each)", width, height, longest_side));
    else
        film.width = static_cast<std::uint32_t>(width), film.height = static_cast<std::uint32_t>(height);
    film.scale = parameters.number("iso", 100) / 100;
    if (!(film.scale > 0)) parameters.error("'iso' must be above 0");
    if (const std::string sensor = parameters.text("sensor", "cie1931"); sensor != "cie1931")
        parameters.warn(fmt::format("the colours of sensor '{}' are left out: taken as 'cie1931'", sensor));
    if (parameters.number("whitebalance", 0) != 0) parameters.warn("'whitebalance' is left out");
    if (const Parameter* crop = parameters.find("cropwindow", Type::number)) {
        film.crop = window(*crop, parameters, film.crop);
        for (float& side : film.crop) side = std::clamp(side, 0.0f, 1.0f);
    }
    pixel_bounds(film, parameters);
    // the picture's file is the graph's business
    parameters.ignore({"filename", "diagonal", "savefp16", "maxcomponentvalue", "coordinatesystem", "buckets",
                       "nbuckets", "lambdamin", "lambdamax"});
    return film;
}

}  // namespace lightnet::pbrt
