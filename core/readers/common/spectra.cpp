#include "core/readers/common/spectra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {

std::array<double, 3> rgb_of_xyz(double x, double y, double z) {
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

namespace {

/// One lobe of the fits of Wyman, Sloan & Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching
/// Functions", with another width on each side.
double lobe(double wavelength, double peak, double below, double above) {
    const double t = (wavelength - peak) * (wavelength < peak ? below : above);
    return std::exp(-0.5 * t * t);
}

std::array<double, 3> matching_functions(double w) {
    return {1.056 * lobe(w, 599.8, 0.0264, 0.0323) + 0.362 * lobe(w, 442.0, 0.0624, 0.0374) -
                0.065 * lobe(w, 501.1, 0.0490, 0.0382),
            0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
            1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

constexpr double first_wavelength = 380, step = 10;

/// CIE standard illuminant D65, 380 to 780 nm in steps of 10.
constexpr std::array<double, 41> daylight{
    49.98,  54.65,  82.75,  91.49,  93.43,  86.68, 104.86, 117.01, 117.81, 114.86, 115.92, 108.81, 109.35, 107.80,
    104.79, 107.69, 104.41, 104.05, 100.00, 96.33, 95.79,  88.69,  90.01,  89.60,  87.70,  83.29,  83.70,  80.03,
    80.21,  82.28,  78.28,  69.72,  71.61,  74.35, 61.60,  69.89,  75.09,  63.59,  46.42,  66.81,  63.38};

/// Linear sRGB of a spectrum, without any scale.
template <class Spectrum>
std::array<double, 3> project(const Spectrum& spectrum) {
    double x = 0, y = 0, z = 0;
    for (std::size_t i = 0; i < daylight.size(); ++i) {
        const double wavelength = first_wavelength + step * static_cast<double>(i);
        const auto match = matching_functions(wavelength);
        const double value = spectrum(wavelength, daylight[i]);
        x += value * match[0], y += value * match[1], z += value * match[2];
    }
    return rgb_of_xyz(x, y, z);
}

/// Linear sRGB of a spectrum, with D65 as {1, 1, 1}.
template <class Spectrum>
Rgb balanced(const Spectrum& spectrum) {
    static const auto white = project([](double, double d65) { return d65; });
    const auto c = project(spectrum);
    return {float(c[0] / white[0]), float(c[1] / white[1]), float(c[2] / white[2])};
}

double value_at(std::span<const SpectrumPoint> s, double wavelength) {
    if (s.empty()) return 0;
    const auto above = std::upper_bound(s.begin(), s.end(), wavelength,
                                        [](double w, const SpectrumPoint& p) { return w < double(p.wavelength); });
    if (above == s.begin()) return s.front().value;
    if (above == s.end()) return s.back().value;
    const auto& a = *(above - 1);
    const double t = (wavelength - a.wavelength) / (double(above->wavelength) - a.wavelength);
    return (1 - t) * a.value + t * above->value;
}

Rgb with_luminance_one(Rgb c) {
    c = {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
    const float y = luminance(c);
    return y > 0 && std::isfinite(y) ? c / y : Rgb{};
}

struct NamedIndex {
    std::string_view name;
    Rgb value;
};

// Ag, Al, Au, Cu: the usual RGB values of the measurements (Johnson & Christy 1972, Rakić 1995), as in Mitsuba and
// Tungsten. The rest: indices at 610, 550 and 465 nm. Brass: Querry 1985; magnesia: Stephens & Malitson 1952; rutile:
// the extraordinary ray, Devore 1951. Glasses: Schott's Sellmeier coefficients; those that pbrt calls F are the dense
// flints SF5, SF10 and SF11.
constexpr std::array<NamedIndex, 21> indices{
    {{"metal-Ag-eta", {0.155265f, 0.116723f, 0.138342f}}, {"metal-Ag-k", {4.828370f, 3.122485f, 2.146969f}},
     {"metal-Al-eta", {1.657460f, 0.880369f, 0.521229f}}, {"metal-Al-k", {9.223869f, 6.269523f, 4.837001f}},
     {"metal-Au-eta", {0.143119f, 0.374957f, 1.442479f}}, {"metal-Au-k", {3.983160f, 2.385721f, 1.603215f}},
     {"metal-Cu-eta", {0.200438f, 0.924033f, 1.102212f}}, {"metal-Cu-k", {3.912949f, 2.452848f, 2.142188f}},
     {"metal-CuZn-eta", {0.444f, 0.527f, 1.094f}},        {"metal-CuZn-k", {3.695f, 2.765f, 1.829f}},
     {"metal-MgO-eta", {1.7363f, 1.7400f, 1.7519f}},      {"metal-MgO-k", {0, 0, 0}},
     {"metal-TiO2-eta", {2.8898f, 2.9529f, 3.1169f}},     {"metal-TiO2-k", {0, 0, 0}},
     {"glass-BK7", {1.5159f, 1.5185f, 1.5240f}},          {"glass-BAF10", {1.6685f, 1.6731f, 1.6830f}},
     {"glass-FK51A", {1.4859f, 1.4878f, 1.4917f}},        {"glass-LASF9", {1.8474f, 1.8558f, 1.8748f}},
     {"glass-F5", {1.6705f, 1.6771f, 1.6921f}},           {"glass-F10", {1.7255f, 1.7337f, 1.7522f}},
     {"glass-F11", {1.7815f, 1.7911f, 1.8134f}}}};

struct NamedLight {
    std::string_view name;
    double x, y;  // chromaticity, 2° observer
};

// CIE 15:2004, tables T.3 and T.8; D60 of ACES by SMPTE ST 2065-1.
constexpr std::array<NamedLight, 16> lights{{{"stdillum-D65", 0.31272, 0.32903},
                                             {"stdillum-D50", 0.34567, 0.35851},
                                             {"stdillum-A", 0.44758, 0.40745},
                                             {"stdillum-F1", 0.3131, 0.3371},
                                             {"stdillum-F2", 0.3721, 0.3751},
                                             {"stdillum-F3", 0.4091, 0.3941},
                                             {"stdillum-F4", 0.4402, 0.4031},
                                             {"stdillum-F5", 0.3138, 0.3452},
                                             {"stdillum-F6", 0.3779, 0.3882},
                                             {"stdillum-F7", 0.3129, 0.3292},
                                             {"stdillum-F8", 0.3458, 0.3586},
                                             {"stdillum-F9", 0.3741, 0.3727},
                                             {"stdillum-F10", 0.3458, 0.3588},
                                             {"stdillum-F11", 0.3805, 0.3769},
                                             {"stdillum-F12", 0.4370, 0.4042},
                                             {"illum-acesD60", 0.32168, 0.33767}}};

LightColour of_chromaticity(double x, double y) {
    const auto c = rgb_of_xyz(x / y, 1, (1 - x - y) / y);
    return {with_luminance_one({float(c[0]), float(c[1]), float(c[2])})};
}

/// By sums over the wavelengths of its colours, and of the eye's sensitivity.
LightColour light_of_sums(const std::array<double, 3>& sums, double whole) {
    const auto part = [&](double sum) { return float(std::max(0.0, sum / whole)); };
    return {{part(sums[0]), part(sums[1]), part(sums[2])}};
}

}  // namespace

SurfaceColour surface_colour(std::span<const SpectrumPoint> spectrum) {
    return {balanced([&](double w, double d65) { return d65 * value_at(spectrum, w); })};
}

LightColour light_colour(std::span<const SpectrumPoint> spectrum) {
    return {with_luminance_one(balanced([&](double w, double) { return value_at(spectrum, w); }))};
}

LightColour mean_light(std::span<const SpectrumPoint> spectrum) {
    const auto sums = project([&](double w, double) { return value_at(spectrum, w); });
    double whole = 0;
    for (std::size_t i = 0; i < daylight.size(); ++i)
        whole += matching_functions(first_wavelength + step * static_cast<double>(i))[1];
    return light_of_sums(sums, whole);
}

namespace {

/// CIE XYZ, in steps of a nanometre.
template <class Spectrum>
std::array<double, 3> finely(const Spectrum& spectrum) {
    double x = 0, y = 0, z = 0;
    for (double wavelength = 360; wavelength <= 830; wavelength += 1) {
        const auto match = matching_functions(wavelength);
        const double value = spectrum(wavelength);
        x += value * match[0], y += value * match[1], z += value * match[2];
    }
    return {x, y, z};
}

std::array<double, 3> rgb_of(const std::array<double, 3>& xyz) { return rgb_of_xyz(xyz[0], xyz[1], xyz[2]); }

double daylight_at(double wavelength) {
    const double at = std::clamp((wavelength - first_wavelength) / step, 0.0, double(daylight.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(at), daylight.size() - 2);
    return daylight[below] + (daylight[below + 1] - daylight[below]) * (at - double(below));
}

}  // namespace

LightColour mean_light_of_lines(std::span<const SpectrumPoint> spectrum) {
    static const double whole = finely([](double) { return 1.0; })[1];
    return light_of_sums(rgb_of(finely([&](double w) { return value_at(spectrum, w); })), whole);
}

LightColour light_colour_of_lines(std::span<const SpectrumPoint> spectrum) {
    static const auto white = rgb_of(finely(daylight_at));
    const auto c = rgb_of(finely([&](double w) { return value_at(spectrum, w); }));
    return {with_luminance_one({float(c[0] / white[0]), float(c[1] / white[1]), float(c[2] / white[2])})};
}

std::vector<SpectrumPoint> dark_beyond_ends(std::vector<SpectrumPoint> spectrum, float low, float high) {
    constexpr float none = 0, endless = 1e6f;
    const float first = spectrum.front().wavelength, last = spectrum.back().wavelength;
    if (first > low) spectrum.insert(spectrum.begin(), {std::nextafter(first, none), 0});
    if (last < high) spectrum.push_back({std::nextafter(last, endless), 0});
    return spectrum;
}

namespace {

/// Planck's law, without any scale.
double planck(double wavelength, double kelvin) {
    constexpr double second_radiation_constant = 1.438776877e7;  // nm·K
    return std::pow(wavelength / 560, -5) / std::expm1(second_radiation_constant / (wavelength * kelvin));
}

/// By more than the fits of what the eye sees are off.
bool cut_from(const std::array<double, 3>& rgb) {
    const auto [least, most] = std::minmax({rgb[0], rgb[1], rgb[2]});
    return least < -0.005 * most;
}

}  // namespace

bool beyond_srgb(std::span<const SpectrumPoint> spectrum) {
    return cut_from(rgb_of(finely([&](double w) { return value_at(spectrum, w); })));
}

bool blackbody_beyond_srgb(float kelvin) {
    const double scale = 1 / planck(780, double{kelvin});
    return cut_from(rgb_of(finely([&](double w) { return planck(w, double{kelvin}) * scale; })));
}

LightColour blackbody_colour(float kelvin) {
    const double scale = 1 / planck(780, double{kelvin});
    return {with_luminance_one(balanced([&](double w, double) { return planck(w, double{kelvin}) * scale; }))};
}

LightColour daylight_colour(float kelvin) {
    if (!(kelvin >= 4000)) return blackbody_colour(kelvin);
    // CIE 15:2004, eqs. 3.3 and 3.4
    const double t = std::min(double(kelvin), 25000.0);
    const double x = t <= 7000 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                               : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
    const double y = (-3.000 * x + 2.870) * x - 0.275;
    return of_chromaticity(x, y);
}

std::optional<SurfaceColour> named_index(std::string_view name) {
    for (const auto& index : indices)
        if (index.name == name) return SurfaceColour{index.value};
    return std::nullopt;
}

std::optional<LightColour> named_light(std::string_view name) {
    if (name == lights[0].name) return LightColour{{1, 1, 1}};  // white by definition
    for (const auto& light : lights)
        if (light.name == name) return of_chromaticity(light.x, light.y);
    return std::nullopt;
}

const std::vector<std::string>& spectrum_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& index : indices) list.emplace_back(index.name);
        for (const auto& light : lights) list.emplace_back(light.name);
        return list;
    }();
    return names;
}

std::vector<SpectrumPoint> read_spd(std::string_view text) {
    std::vector<float> numbers;
    for (std::size_t i = 0; i < text.size();) {
        const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; };
        if (text[i] == '#') {
            while (i < text.size() && text[i] != '\n') ++i;
        } else if (is_space(text[i])) {
            ++i;
        } else {
            double value = 0;
            const auto [end, problem] = std::from_chars(text.data() + i, text.data() + text.size(), value);
            if (problem != std::errc{} || !std::isfinite(static_cast<float>(value)))
                throw Error(fmt::format("a number expected, not '{}'", text.substr(i, 16)));
            numbers.push_back(static_cast<float>(value));
            i = static_cast<std::size_t>(end - text.data());
        }
    }
    if (numbers.empty() || numbers.size() % 2) throw Error("a table of wavelengths and values needs pairs of numbers");
    std::vector<SpectrumPoint> points;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        if (!points.empty() && numbers[i] <= points.back().wavelength) throw Error("the wavelengths must ascend");
        points.push_back({numbers[i], numbers[i + 1]});
    }
    return points;
}

}  // namespace lightnet
