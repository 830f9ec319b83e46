#include "core/scene/pbrt/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// pbrt gives a light of `L` rgb the luminance that the numbers say, and any other spectrum luminance 1; then `scale`.
std::optional<Rgb> radiance(Parameters& parameters, const Sources& sources) {
    Rgb colour{1, 1, 1};
    if (const Parameter* given = parameters.find("L")) {
        const auto found = colour_of(*given, Use::light, sources);
        if (!found) return std::nullopt;
        colour = *found;
    }
    const float scale = parameters.number("scale", 1);
    if (scale < 0) parameters.error("'scale' must not be negative");
    const Rgb radiance = colour * std::max(scale, 0.0f);
    if (finite(radiance)) return radiance;
    parameters.error("the light is infinitely bright");
    return std::nullopt;
}

/// Mean over all directions of a picture around the scene: square ones have equal areas, others rows of latitude.
Rgb mean_environment(const Image& image) {
    double r = 0, g = 0, b = 0, weights = 0;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        const bool square = image.width == image.height;
        const double weight = square ? 1 : std::sin(std::numbers::pi * (y + 0.5) / image.height);
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const Rgb p = image.colour(x, y);
            r += weight * p.r, g += weight * p.g, b += weight * p.b;
        }
        weights += weight * image.width;
    }
    return {float(r / weights), float(g / weights), float(b / weights)};
}

}  // namespace

AreaEmission AreaLight::on(double area) const {
    if (!power || !(area > 0)) return emission;
    const double sides = emission.two_sided ? 2 : 1;
    return {emission.radiance * float(*power / (sides * area * std::numbers::pi)), emission.two_sided};
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
    const float power = parameters.number("power", -1);
    if (power > 0) light.power = power;
    auto colour = radiance(parameters, sources);
    if (const std::string file = parameters.text("filename", ""); !file.empty()) {
        if (parameters.find("L")) parameters.error("'L' and 'filename' exclude each other");
        parameters.warn("a picture on a lamp is not supported: its mean is taken");
        ImageTexture picture;
        picture.image = textures.image(file, {}, parameters.where());
        Texture texture;
        texture.pattern = picture;
        if (picture.image && colour) colour = *colour * mean_of(texture);
    }
    if (!colour) return std::nullopt;
    light.emission.radiance = *colour;
    return light;
}

std::optional<EnvironmentData> make_light(const std::string& type, Parameters& parameters, Textures& textures,
                                          const Sources& sources) {
    if (type != "infinite") {
        static const std::vector<std::string> unsupported{"distant", "goniometric", "point", "projection", "spot"};
        const bool known = std::find(unsupported.begin(), unsupported.end(), type) != unsupported.end();
        parameters.error(
            known ? fmt::format("lights of type '{}' are not supported; there are 'infinite' and area lights", type)
                  : fmt::format("unknown light '{}'{}", type, did_you_mean(type, {"infinite"})));
        parameters.ignore_all();
        return std::nullopt;
    }
    auto colour = radiance(parameters, sources);
    if (const std::string file = parameters.text("filename", ""); !file.empty()) {
        if (parameters.find("L")) parameters.error("'L' and 'filename' exclude each other");
        const auto image = textures.image(file, {}, parameters.where());
        parameters.warn("a picture as environment is not supported: its mean is taken from all directions");
        if (image && colour) colour = *colour * mean_environment(*image);
    }
    if (parameters.find("portal")) parameters.warn("'portal' is left out");
    const float illuminance = parameters.number("illuminance", -1);
    if (illuminance > 0 && colour) *colour = *colour * (illuminance / pi);
    if (!colour) return std::nullopt;
    EnvironmentData environment;
    environment.radiance = *colour;
    return environment;
}

}  // namespace lightnet::pbrt
