#include "core/readers/pbrt/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/spectra.hpp"
#include "core/readers/pbrt/transforms.hpp"

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

/// Of a system of lenses: how far it sees to the sides is unknown without tracing it; the eye of a 50 mm lens is near.
void approximate_lens_system(CameraData& camera, Parameters& parameters) {
    parameters.warn(
        "cameras of type 'realistic' are not supported: a perspective one like that of a 50 mm lens is taken");
    camera.fov = 27;                                                         // across the shorter side of 24 x 36 mm
    const float aperture = parameters.number("aperturediameter", 1) / 1000;  // mm
    camera.lens_radius = std::max(aperture, 0.0f) / 2;
    camera.focus_distance = std::max(parameters.number("focusdistance", 10), 1e-3f);
    parameters.ignore({"lensfile", "aperture"});
}

/// All directions, by pbrt's maps; pbrt-v3 has one only.
void look_around(CameraData& camera, Parameters& parameters, Version version) {
    const std::string mapping = version == Version::v3 ? "equirectangular" : parameters.text("mapping", "equalarea");
    if (mapping != "equirectangular" && mapping != "equalarea")
        parameters.error(fmt::format("unknown mapping '{}' (there are 'equalarea' and 'equirectangular')", mapping));
    camera.projection = LatitudeLongitude{};
    if (mapping == "equalarea") camera.projection = EqualArea{};
}

/// The angle of view in degrees; half of it has a name of its own.
float angle_of_view(Parameters& parameters, Version version) {
    const float fov = parameters.number("fov", 90);
    if (version == Version::v4) return fov;
    const auto half = parameters.maybe_number("halffov");
    return half && *half > 0 ? 2 * *half : fov;
}

std::vector<std::string> camera_types(Version version) {
    return {"orthographic", "perspective", "realistic", version == Version::v3 ? "environment" : "spherical"};
}
std::vector<std::string> film_types(Version version) {
    if (version == Version::v3) return {"image"};
    return {"gbuffer", "rgb", "spectral"};
}

}  // namespace

void take_scale_out(CameraData& camera) {
    const auto scale = uniform_scale(camera.to_world);
    if (!scale || !(*scale > 0) || std::fabs(*scale - 1) < 1e-6) return;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) camera.to_world.m[i][j] /= *scale;
    camera.lens_radius *= float(*scale);
    camera.focus_distance *= float(*scale);
    if (camera.is_orthographic())
        for (float& side : camera.screen) side *= float(*scale);
}

Shot make_camera(const std::string& type, Parameters& parameters, Version version) {
    Shot shot;
    const std::vector<std::string> known = camera_types(version);
    if (std::find(known.begin(), known.end(), type) == known.end()) {
        parameters.error(fmt::format("unknown camera '{}'{}", type, did_you_mean(type, known)));
        parameters.ignore_all();
        return shot;
    }
    if (type == "orthographic") shot.camera.projection = Orthographic{};
    if (type == "realistic") approximate_lens_system(shot.camera, parameters);
    if (type == "spherical" || type == "environment") look_around(shot.camera, parameters, version);
    if (type == "perspective") shot.camera.fov = angle_of_view(parameters, version);
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
    shot.camera.lens_radius = parameters.number("lensradius", 0);
    shot.camera.focus_distance = parameters.number("focaldistance", shot.camera.focus_distance);
    if (shot.camera.lens_radius < 0) parameters.error("'lensradius' must not be negative");
    if (!(shot.camera.focus_distance > 0)) parameters.error("'focaldistance' must be above 0");
    const float closes = parameters.number("shutterclose", 1), opens = parameters.number("shutteropen", 0);
    shot.shutter = {opens, closes};
    shot.exposure = closes - opens;
    if (!(shot.exposure > 0)) {
        if (version == Version::v4) parameters.error("the shutter must close after it has opened");
        shot.exposure = 1;
    }
    if (version == Version::v3) shot.exposure = 1;  // there, a shutter is for motion alone
    return shot;
}

namespace {

/// Those that pbrt-v4 has measured.
const std::vector<std::string>& sensors() {
    static const std::vector<std::string> known{
        "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
        "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
        "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
        "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};
    return known;
}

/// Of the light that a sensor shows as white; 0: D65, as it comes. pbrt fits what a camera's sensor sees to what the
/// eye does, by 24 patches under that light, white ones exactly: what is left between both is saturated colours.
float kelvin_of_white(Parameters& parameters) {
    const std::string sensor = parameters.text("sensor", "cie1931");
    const float kelvin = parameters.number("whitebalance", 0);
    if (sensor == "cie1931") return kelvin;
    if (std::ranges::find(sensors(), sensor) == sensors().end())
        parameters.error(fmt::format("unknown sensor '{}'{}", sensor, did_you_mean(sensor, sensors())));
    else
        parameters.warn(
            fmt::format("the colours of sensor '{}' are taken as those of the eye: whites and brightness "
                        "agree, saturated colours may be others",
                        sensor));
    return kelvin > 0 ? kelvin : 6500;
}

}  // namespace

FilmShot make_film(const std::string& type, Parameters& parameters, Version version) {
    const bool older = version == Version::v3;
    const std::vector<std::string> known = film_types(version);
    if (std::find(known.begin(), known.end(), type) == known.end())
        parameters.error(fmt::format("unknown film '{}'{}", type, did_you_mean(type, known)));
    FilmShot shot;
    FilmData& film = shot.film;
    constexpr int longest_side = 1 << 16;
    const int width = parameters.integer("xresolution", older ? 640 : 1280),
              height = parameters.integer("yresolution", older ? 480 : 720);
    if (width < 1 || height < 1 || width > longest_side || height > longest_side)
        parameters.error(
            fmt::format("a film of {} x {} pixels is not possible (1 to {} each)", width, height, longest_side));
    else
        film.width = static_cast<std::uint32_t>(width), film.height = static_cast<std::uint32_t>(height);
    film.scale = older ? parameters.number("scale", 1) : parameters.number("iso", 100) / 100;
    if (!(film.scale > 0)) parameters.error(older ? "'scale' must be above 0" : "'iso' must be above 0");
    if (const float kelvin = older ? 0 : kelvin_of_white(parameters); kelvin > 0)
        shot.white = daylight_colour(kelvin).rgb;
    if (const Parameter* crop = parameters.find("cropwindow", Type::number)) {
        film.crop = window(*crop, parameters, film.crop);
        for (float& side : film.crop) side = std::clamp(side, 0.0f, 1.0f);
    }
    pixel_bounds(film, parameters);
    if (!(shot.white == Rgb{1, 1, 1}) && parameters.find("whitebalance"))
        parameters.warn("the white balance is done for each channel, not for the cones of the eye, as pbrt does it");
    for (const char* most : {"maxcomponentvalue", "maxsampleluminance"})
        if (parameters.find(most))
            parameters.warn(fmt::format("'{}' is left out: samples keep all of their light, however bright", most));
    // the picture's file is the graph's business
    parameters.ignore(
        {"filename", "diagonal", "savefp16", "coordinatesystem", "buckets", "nbuckets", "lambdamin", "lambdamax"});
    return shot;
}

}  // namespace lightnet::pbrt
