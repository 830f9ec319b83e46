#include "core/readers/daylight/daylight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "core/readers/common/spectra.hpp"
#include "core/readers/daylight/clear_sky.hpp"

namespace lightnet {
namespace {

constexpr double half_turn = std::numbers::pi;

double from_zenith(const Daylight& day) { return std::acos(std::clamp(double{dot(day.up, day.to_sun)}, -1.0, 1.0)); }

/// Level, towards the sun; any way where that stands in the zenith.
Vec3 ahead(const Daylight& day) {
    Vec3 level = day.to_sun - day.up * dot(day.up, day.to_sun);
    if (length(level) < 1e-6f) {
        level = std::fabs(day.up.x) < 0.5f ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
        level = level - day.up * dot(day.up, level);
    }
    return normalize(level);
}

/// What is left of light of each of some wavelengths.
using Spectrum = std::vector<SpectrumPoint>;

double value_at(const Spectrum& spectrum, double wavelength) {
    if (wavelength < double{spectrum.front().wavelength} || wavelength > double{spectrum.back().wavelength}) return 0;
    const auto above = std::find_if(spectrum.begin(), spectrum.end(),
                                    [&](const auto& p) { return double{p.wavelength} >= wavelength; });
    if (above == spectrum.begin()) return double{above->value};
    const auto& [first, before] = *(above - 1);
    const double t = (wavelength - double{first}) / (double{above->wavelength} - double{first});
    return double{before} + t * (double{above->value} - double{before});
}

// Preetham et al., table 2. The sun beyond the air, W·sr⁻¹·m⁻²·nm⁻¹, every 10 nm from 380 on
constexpr std::array<float, 38> solar{16559.0f, 16233.7f, 21127.5f, 25888.2f, 25829.1f, 24232.3f, 26760.5f, 29658.3f,
                                      30545.4f, 30057.5f, 30663.7f, 28830.4f, 28712.1f, 27825.0f, 27100.6f, 27233.6f,
                                      26361.3f, 25503.8f, 25060.2f, 25311.6f, 25355.9f, 25134.2f, 24631.5f, 24173.2f,
                                      23685.3f, 23212.1f, 22827.7f, 22339.8f, 21970.2f, 21526.7f, 21097.9f, 20728.3f,
                                      20240.4f, 19870.8f, 19427.2f, 19072.4f, 18628.9f, 18259.2f};

// How ozone, water vapour and mixed gases absorb, cm⁻¹
const Spectrum& ozone() {
    static const Spectrum table{
        {355, 0},     {445, .003f}, {450, .003f}, {455, .004f}, {460, .006f}, {465, .008f}, {470, .009f}, {475, .012f},
        {480, .014f}, {485, .017f}, {490, .021f}, {495, .025f}, {500, .03f},  {505, .035f}, {510, .04f},  {515, .045f},
        {520, .048f}, {525, .057f}, {530, .063f}, {535, .07f},  {540, .075f}, {545, .08f},  {550, .085f}, {555, .095f},
        {560, .103f}, {565, .11f},  {570, .12f},  {575, .122f}, {580, .12f},  {585, .118f}, {590, .115f}, {595, .12f},
        {600, .125f}, {605, .13f},  {610, .12f},  {620, .105f}, {630, .09f},  {640, .079f}, {650, .067f}, {660, .057f},
        {670, .048f}, {680, .036f}, {690, .028f}, {700, .023f}, {710, .018f}, {720, .014f}, {730, .011f}, {740, .01f},
        {750, .009f}, {760, .007f}, {770, .004f}, {780, 0},     {790, 0}};
    return table;
}
const Spectrum& vapour() {
    static const Spectrum table{{689, 0},     {690, 1.6e-2f},  {700, 2.4e-2f}, {710, 1.25e-2f}, {720, 1},
                                {730, .87f},  {740, 6.1e-2f},  {750, 1e-3f},   {760, 1e-5f},    {770, 1e-5f},
                                {780, 6e-4f}, {790, 1.75e-2f}, {800, 3.6e-2f}};
    return table;
}
const Spectrum& gases() {
    static const Spectrum table{{759, 0}, {760, 3}, {770, .21f}, {771, 0}};
    return table;
}

/// The share of that wavelength (nm) that comes through `mass` times the air over one's head.
double passes(double wavelength, double mass, double turbidity) {
    const double micrometres = wavelength / 1000;
    const double rayleigh = 0.008735 * std::pow(micrometres, -4.08);
    const double haze = (0.04608365822050 * turbidity - 0.04586025928522) * std::pow(micrometres, -1.3);
    const double by_ozone = value_at(ozone(), wavelength) * 0.35;  // cm of it
    const double gas = 1.41 * value_at(gases(), wavelength) * mass;
    const double water = value_at(vapour(), wavelength) * 2 * mass;  // cm of it
    return std::exp(-mass * (rayleigh + haze + by_ozone)) * std::exp(-gas / std::pow(1 + gas * (118.93 / 1.41), 0.45)) *
           std::exp(-0.2385 * water / std::pow(1 + 20.07 * water, 0.45));
}

}  // namespace

EnvironmentData sky_of(const Daylight& day, std::uint32_t columns) {
    const std::uint32_t width = std::max(columns, 4u), height = width / 2;
    const double sun = from_zenith(day);
    const ClearSky sky(double{day.turbidity}, day.albedo, half_turn / 2 - sun);
    std::vector<Rgb> pixels(std::size_t{width} * height);
    for (std::uint32_t row = 0; row < height; ++row) {
        const double seen = (row + 0.5) / height * half_turn;
        double theta = seen / double{day.stretch};
        if (theta >= half_turn / 2 && !day.extended) break;
        theta = std::min(theta, half_turn / 2 - 1e-4);
        const double t = std::clamp(2 - 2 * seen / half_turn, 0.0, 1.0);
        const float left = day.extended ? float(t * t * (3 - 2 * t)) : 1.0f;
        for (std::uint32_t column = 0; column < width; ++column) {
            const double phi = ((column + 0.5) / width - 0.5) * 2 * half_turn;  // the sun is in the middle
            const double near = std::cos(theta) * std::cos(sun) + std::sin(theta) * std::sin(sun) * std::cos(phi);
            pixels[std::size_t{row} * width + column] =
                sky.radiance(std::cos(theta), std::acos(std::clamp(near, -1.0, 1.0))) * left;
        }
    }
    EnvironmentData environment;
    environment.radiance = Rgb{1, 1, 1} * day.scale;
    environment.image = std::make_shared<const Image>(width, height, pixels);
    const Vec3 level = ahead(day), right = cross(level, day.up);
    for (std::size_t i = 0; i < 3; ++i) {
        environment.to_world.m[i][0] = double{right[i]};
        environment.to_world.m[i][1] = double{day.up[i]};
        environment.to_world.m[i][2] = double{-level[i]};
    }
    return environment;
}

// Kasten 1966: through how much air the light goes.
Rgb radiance_of_sun(double from_zenith, double turbidity) {
    const double degrees = std::min(from_zenith * 180 / half_turn, 93.0);
    const double mass = 1 / (std::cos(degrees * half_turn / 180) + 0.15 * std::pow(93.885 - degrees, -1.253));
    Spectrum left;
    for (std::size_t i = 0; i < solar.size(); ++i) {
        const float wavelength = 380 + 10 * float(i);
        left.push_back({wavelength, float(double{solar[i]} * passes(double{wavelength}, mass, turbidity))});
    }
    return mean_light(left).rgb;
}

// All its light in one direction, or as much of it on a plane across as the disk's angle leaves.
DirectionalLight sun_of(const Daylight& day, float half_angle) {
    const auto drop = [](float angle) { return 2 * std::pow(std::sin(double{angle} / 2), 2); };  // 1 - cosine
    const double total = 2 * half_turn * drop(angle_of_sun), across = 1 - drop(half_angle) / 2;
    const double sun = from_zenith(day), seen = sun * double{day.stretch};
    const Vec3 towards =
        day.stretch == 1 ? day.to_sun : day.up * float(std::cos(seen)) + ahead(day) * float(std::sin(seen));
    const Rgb radiance = radiance_of_sun(sun, double{day.turbidity});
    return {normalize(-towards), radiance * (day.scale * float(total * across)), {}, half_angle};
}

}  // namespace lightnet
