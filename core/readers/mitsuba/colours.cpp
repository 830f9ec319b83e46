#include "core/readers/mitsuba/colours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/base/suggestion.hpp"
#include "core/readers/spectra.hpp"

namespace lightnet::mitsuba {
namespace {

float from_srgb(float value) { return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f); }

/// "#ff8000", encoded as sRGB.
std::optional<Rgb> hexadecimal(std::string_view text) {
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
    if (problem != std::errc{} || end != text.data() + text.size() || text.size() != 7) return std::nullopt;
    const auto part = [&](int shift) { return from_srgb(float((value >> shift) & 255) / 255); };
    return Rgb{part(16), part(8), part(0)};
}

std::optional<Rgb> rgb(const Node& node, const Context& context) {
    const auto text = node.attribute("value");
    const bool encoded = node.tag == "srgb";
    if (text.starts_with('#')) {
        if (const auto colour = hexadecimal(text)) return colour;
        context.error(node, fmt::format("a colour is written '#rrggbb', not '{}'", text.substr(0, 32)));
        return std::nullopt;
    }
    const auto values = numbers(text, node, context);
    if (!values) return std::nullopt;
    if (values->size() != 1 && values->size() != 3) {
        context.error(node, fmt::format("a colour has one or three numbers, not {}", values->size()));
        return std::nullopt;
    }
    const auto at = [&](std::size_t i) {
        const float value = float((*values)[values->size() == 1 ? 0 : i]);
        return encoded ? from_srgb(value) : value;
    };
    return Rgb{at(0), at(1), at(2)};
}

/// W·m⁻²·sr⁻¹·nm⁻¹, Planck's law.
double planck(double kelvin, double nanometres) {
    constexpr double first = 1.191042972e20, second = 1.438776877e7;  // 2hc² with lengths in nm and areas in m²; hc/k
    return first / std::pow(nanometres, 5) / std::expm1(second / (nanometres * kelvin));
}

/// With the absolute brightness of Mitsuba, which is the mean over the eye's sensitivity.
std::optional<Rgb> blackbody(double kelvin, double scale, const Node& node, const Context& context) {
    if (!(kelvin > 0) || kelvin > 1e6) {
        context.error(node, "a black body needs a temperature in kelvin");
        return std::nullopt;
    }
    double sum = 0, weights = 0;
    for (double w = 400; w <= 700; w += 10) {
        const double t = (w - 556) / 45, weight = std::exp(-0.5 * t * t);  // about the CIE's ȳ
        sum += weight * planck(kelvin, w), weights += weight;
    }
    return blackbody_colour(static_cast<float>(kelvin)) * static_cast<float>(scale * sum / weights);
}

/// "400:0.1, 700:0.3"
std::optional<Rgb> table(std::string_view text, const Node& node, const Context& context) {
    std::string spaced(text);
    std::replace(spaced.begin(), spaced.end(), ':', ' ');
    const auto values = numbers(spaced, node, context);
    if (!values) return std::nullopt;
    std::vector<SpectrumPoint> points;
    for (std::size_t i = 0; i + 1 < values->size(); i += 2)
        points.push_back({float((*values)[i]), float((*values)[i + 1])});
    const auto behind = [](const SpectrumPoint& a, const SpectrumPoint& b) { return a.wavelength >= b.wavelength; };
    if (points.empty() || values->size() % 2 ||
        std::adjacent_find(points.begin(), points.end(), behind) != points.end()) {
        context.error(node, "a spectrum is written 'wavelength:value, …', with ascending wavelengths");
        return std::nullopt;
    }
    return surface_colour(points);
}

std::optional<Rgb> spectrum_file(const Node& node, const Context& context) {
    const auto bytes = context.assets.read(context.path(std::string(node.attribute("filename")), node), node.where);
    if (!bytes) return std::nullopt;
    try {
        const auto points = read_spd({reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size()});
        return surface_colour(points);
    } catch (const Error& problem) {
        context.error(node, problem.what());
        return std::nullopt;
    }
}

/// <spectrum type="…">, as version 3 has it.
std::optional<Rgb> plugin(const Node& node, const Context& context) {
    Properties properties(node, context);
    if (node.type == "blackbody")
        return blackbody(double(properties.number("temperature", 5000)), double(properties.number("scale", 1)), node,
                         context);
    if (node.type == "uniform" || node.type == "d65") {
        const float value = properties.number(node.type == "d65" ? "scale" : "value", 1);
        return Rgb{value, value, value};
    }
    if (node.type == "rgb" || node.type == "srgb")
        return colour_of(properties, node.type == "rgb" ? "value" : "color", {1, 1, 1});
    if (node.type == "irregular" || node.type == "regular") {
        const auto values = numbers(properties.text("values", ""), node, context);
        auto wavelengths = numbers(properties.text("wavelengths", ""), node, context);
        if (!values || !wavelengths) return std::nullopt;
        if (node.type == "regular") {
            const double low = double(properties.number("wavelength_min", 360)),
                         high = double(properties.number("wavelength_max", 830));
            for (std::size_t i = 0; i < values->size(); ++i)
                wavelengths->push_back(low + (high - low) * double(i) / std::max(1.0, double(values->size()) - 1));
        }
        std::string pairs;
        for (std::size_t i = 0; i < std::min(values->size(), wavelengths->size()); ++i)
            pairs += fmt::format("{}:{} ", (*wavelengths)[i], (*values)[i]);
        return table(pairs, node, context);
    }
    properties.ignore_all();
    context.error(node, fmt::format("unknown spectrum '{}'", node.type));
    return std::nullopt;
}

std::optional<Rgb> spectrum(const Node& node, const Context& context) {
    if (!node.type.empty()) return plugin(node, context);
    if (node.has("filename")) return spectrum_file(node, context);
    const auto text = node.attribute("value");
    if (text.find(':') != text.npos) return table(text, node, context);
    return rgb(node, context);
}

struct NamedIor {
    std::string_view name;
    float value;
};

/// As in the documentation of Mitsuba's dielectric.
constexpr std::array<NamedIor, 24> dielectrics{
    {{"vacuum", 1},         {"helium", 1.000036f},        {"hydrogen", 1.000132f},
     {"air", 1.000277f},    {"carbon dioxide", 1.00045f}, {"water", 1.333f},
     {"acetone", 1.36f},    {"ethanol", 1.361f},          {"carbon tetrachloride", 1.461f},
     {"glycerol", 1.4729f}, {"benzene", 1.501f},          {"silicone oil", 1.52045f},
     {"bromine", 1.661f},   {"water ice", 1.31f},         {"fused quartz", 1.458f},
     {"pyrex", 1.47f},      {"acrylic glass", 1.49f},     {"polypropylene", 1.49f},
     {"bk7", 1.5046f},      {"sodium chloride", 1.544f},  {"amber", 1.55f},
     {"pet", 1.575f},       {"diamond", 2.419f},          {"none", 1}}};

struct NamedMetal {
    std::string_view name;
    ComplexIndex index;
};

/// Those that pbrt doesn't name: the usual RGB values of the same measurements.
constexpr std::array<NamedMetal, 13> metals{
    {{"Be", {{4.185059f, 3.185060f, 2.784091f}, {3.835440f, 3.010126f, 2.869009f}}},
     {"Cr", {{4.369683f, 2.916702f, 1.654700f}, {5.206434f, 4.231365f, 3.754947f}}},
     {"Hg", {{2.398931f, 1.440025f, 0.909551f}, {6.327627f, 4.371941f, 3.421790f}}},
     {"Ir", {{3.086410f, 2.082194f, 1.617887f}, {5.592151f, 4.067176f, 3.267261f}}},
     {"K", {{0.064049f, 0.046410f, 0.038184f}, {2.104216f, 1.348936f, 0.913211f}}},
     {"Li", {{0.265787f, 0.195610f, 0.220920f}, {3.540174f, 2.311131f, 1.668593f}}},
     {"Mo", {{4.483701f, 3.525458f, 2.776077f}, {4.111131f, 3.420872f, 3.150603f}}},
     {"Na_palik", {{0.060267f, 0.056141f, 0.061991f}, {3.179291f, 2.112480f, 1.579094f}}},
     {"Nb", {{3.420135f, 2.790192f, 2.395586f}, {3.441382f, 2.737644f, 2.579913f}}},
     {"Rh", {{2.585795f, 1.860187f, 1.554428f}, {6.782293f, 4.702950f, 3.976089f}}},
     {"TiN", {{1.648469f, 1.150448f, 1.379780f}, {3.368460f, 1.943489f, 1.102012f}}},
     {"V_palik", {{4.277513f, 3.513154f, 2.761126f}, {3.491184f, 2.889358f, 3.111697f}}},
     {"W", {{4.370703f, 3.300297f, 2.998267f}, {3.500678f, 2.604865f, 2.273193f}}}}};

}  // namespace

bool is_colour(const Node& node) {
    return node.tag == "rgb" || node.tag == "srgb" || node.tag == "spectrum" || node.tag == "blackbody" ||
           node.tag == "float" || node.tag == "color";
}

std::optional<Rgb> colour_of(const Node& node, const Context& context) {
    if (node.tag == "blackbody") {
        auto kelvin = node.attribute("temperature");
        if (kelvin.ends_with('K') || kelvin.ends_with('k')) kelvin.remove_suffix(1);
        const auto temperature = number(kelvin, node, context);
        const auto scale = node.has("scale") ? number(node.attribute("scale"), node, context) : 1.0;
        return temperature && scale ? blackbody(*temperature, *scale, node, context) : std::nullopt;
    }
    return node.tag == "spectrum" ? spectrum(node, context) : rgb(node, context);
}

Rgb colour_of(Properties& properties, std::string_view name, Rgb fallback) {
    const Node* given = properties.find(name);
    if (!given) return fallback;
    if (is_colour(*given)) return colour_of(*given, properties.context()).value_or(fallback);
    properties.context().error(
        *given, fmt::format("'{}' of {} must be a colour, not <{}>", name, properties.owner(), given->tag));
    return fallback;
}

float index_of(Properties& properties, std::string_view name, const std::string& fallback) {
    const Node* given = properties.find(name);
    const auto& context = properties.context();
    const auto named = [](std::string_view word) {
        return std::find_if(dielectrics.begin(), dielectrics.end(),
                            [&](const auto& known) { return known.name == word; });
    };
    if (!given) return named(fallback)->value;
    const auto word = given->attribute("value");
    if (const auto known = named(word); known != dielectrics.end()) return known->value;
    if (given->tag == "string") {
        std::vector<std::string> names;
        for (const auto& known : dielectrics) names.emplace_back(known.name);
        context.error(*given,
                      fmt::format("there is no dielectric '{}'{}", word.substr(0, 32), did_you_mean(word, names)));
        return named(fallback)->value;
    }
    if (const auto colour = colour_of(*given, context); colour && colour->g > 0) {
        if (colour->r != colour->g || colour->g != colour->b)
            context.warn(*given, "dispersion is left out: the index of green light is taken");
        return colour->g;
    }
    return named(fallback)->value;
}

std::optional<ComplexIndex> metal_named(const std::string& name) {
    const auto eta = named_index("metal-" + name + "-eta"), k = named_index("metal-" + name + "-k");
    if (eta && k) return ComplexIndex{*eta, *k};
    for (const auto& [known, index] : metals)
        if (known == name) return index;
    return std::nullopt;
}

}  // namespace lightnet::mitsuba
