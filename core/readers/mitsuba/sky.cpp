#include "core/readers/mitsuba/sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/readers/spectra.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double efficacy = 136.6;  // lm/W, of daylight

using Five = std::array<double, 5>;

/// Preetham et al. 1999, eq. 3.
double perez(const Five& c, double cos_theta, double gamma) {
    const double cos_gamma = std::cos(gamma);
    return (1 + c[0] * std::exp(c[1] / std::max(cos_theta, 0.01))) *
           (1 + c[2] * std::exp(c[3] * gamma) + c[4] * cos_gamma * cos_gamma);
}

/// One of Y, x and y over the sky; appendix A.2.
struct Channel {
    Five shape;
    double zenith = 0;
};

double polynomial(const std::array<std::array<double, 4>, 3>& m, double turbidity, double sun) {
    const double t[3] = {turbidity * turbidity, turbidity, 1};
    const double s[4] = {sun * sun * sun, sun * sun, sun, 1};
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) sum += t[i] * m[i][j] * s[j];
    return sum;
}

std::array<Channel, 3> channels(double t, double sun) {
    const double chi = (4.0 / 9 - t / 120) * (pi - 2 * sun);
    const double bright = ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192) * 1000;  // cd/m²
    const double x = polynomial({{{0.00166, -0.00375, 0.00209, 0},
                                  {-0.02903, 0.06377, -0.03202, 0.00394},
                                  {0.11693, -0.21196, 0.06052, 0.25886}}},
                                t, sun);
    const double y = polynomial({{{0.00275, -0.00610, 0.00317, 0},
                                  {-0.04214, 0.08970, -0.04153, 0.00516},
                                  {0.15346, -0.26756, 0.06670, 0.26688}}},
                                t, sun);
    return {
        {{{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
          bright},
         {{-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
           -0.0033 * t + 0.0452},
          x},
         {{-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
           -0.0109 * t + 0.0529},
          y}}};
}

Rgb from_xyy(double big_y, double x, double y) {
    const double big_x = x / y * big_y, big_z = (1 - x - y) / y * big_y;
    const auto positive = [](double v) { return float(std::max(v, 0.0)); };
    return {positive(3.2404542 * big_x - 1.5371385 * big_y - 0.4985314 * big_z),
            positive(-0.9692660 * big_x + 1.8760108 * big_y + 0.0415560 * big_z),
            positive(0.0556434 * big_x - 0.2040259 * big_y + 1.0572252 * big_z)};
}

double angle_from_zenith(const Sky& sky) { return std::acos(std::clamp(double(sky.to_sun.y), 0.0, 1.0)); }

}  // namespace

void add_sky(const Sky& sky, float scale, SceneData& scene) {
    constexpr std::uint32_t width = 512, height = 256;
    const double sun = angle_from_zenith(sky);
    const auto model = channels(double(sky.turbidity), sun);
    const auto value = [&](const Channel& c, double cos_theta, double gamma) {
        return c.zenith * perez(c.shape, cos_theta, gamma) / perez(c.shape, 1, sun);
    };
    std::vector<Rgb> pixels(std::size_t{width} * height);
    for (std::uint32_t row = 0; row < height / 2; ++row)  // the lower half stays black
        for (std::uint32_t column = 0; column < width; ++column) {
            const double theta = (row + 0.5) / height * pi, phi = ((column + 0.5) / width - 0.5) * 2 * pi;
            const Vec3 d{float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)),
                         float(-std::sin(theta) * std::cos(phi))};
            const double gamma = std::acos(std::clamp(double(dot(d, sky.to_sun)), -1.0, 1.0));
            const double y = std::max(value(model[0], d.y, gamma), 0.0) / efficacy;
            pixels[std::size_t{row} * width + column] =
                from_xyy(y, value(model[1], d.y, gamma), value(model[2], d.y, gamma));
        }
    EnvironmentData environment;
    environment.radiance = {scale, scale, scale};
    environment.to_world = sky.to_world;
    environment.image = std::make_shared<const Image>(width, height, pixels);
    scene.environments.push_back(std::move(environment));
}

void add_sun(const Sky& sky, float scale, SceneData& scene) {
    if (sky.to_sun.y <= 0) return;
    // Kasten 1966: how much air the light goes through; Ångström's turbidity formula thins it
    const double sun = angle_from_zenith(sky), t = double(sky.turbidity);
    const double air = 1 / (std::cos(sun) + 0.15 * std::pow(93.885 - sun * 180 / pi, -1.253));
    const double beta = 0.04608 * t - 0.04586;
    const auto through = [&](double micrometres) {
        const double rayleigh = std::exp(-air * 0.008735 * std::pow(micrometres, -4.08));
        return rayleigh * std::exp(-air * beta * std::pow(micrometres, -1.3));
    };
    constexpr double above = 500;  // W·m⁻² of visible light beyond the air
    const Rgb white = blackbody_colour(5778);
    const float strength = scale * float(above);
    const Rgb irradiance{white.r * float(through(0.61)), white.g * float(through(0.55)),
                         white.b * float(through(0.465))};
    const Vec3 towards = transform_direction(sky.to_world, sky.to_sun);
    scene.lights.push_back(DirectionalLight{normalize(-towards), irradiance * strength, {sky.sun}});
}

}  // namespace lightnet::mitsuba
