#include "core/readers/mitsuba/colours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/dispersion.hpp"
#include "core/readers/common/spectra.hpp"

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
    const bool negative = node.tag != "float" && node.tag != "integer" &&
                          std::ranges::any_of(*values, [](double value) { return value < 0; });
    if (negative) context.warn(node, fmt::format("<{}> has a negative component: 0 is taken", node.tag));
    const auto at = [&](std::size_t i) {
        const float value = float((*values)[values->size() == 1 ? 0 : i]);
        return negative && value < 0 ? 0 : encoded ? from_srgb(value) : value;
    };
    return Rgb{at(0), at(1), at(2)};
}

/// W·m⁻²·sr⁻¹·nm⁻¹, Planck's law.
double planck(double kelvin, double nanometres) {
    constexpr double first = 1.191042972e20, second = 1.438776877e7;  // 2hc² with lengths in nm and areas in m²; hc/k
    return first / std::pow(nanometres, 5) / std::expm1(second / (nanometres * kelvin));
}

/// What of a spectrum depends on whether it is one of light.
template <class Colour>
constexpr bool shines = std::is_same_v<Colour, LightColour>;

void warn_of_cut(const Node& node, const Context& context) {
    context.warn(node, fmt::format("<{}> is of a colour that sRGB can't show, and is cut", node.tag));
}

/// Spectra of Mitsuba are 0 beyond their tables. Those of surfaces often end at 400 and 700 nm, where they were
/// measured no further, and go on so.
template <class Colour>
Colour of_table(std::vector<SpectrumPoint> points, const Node& node, const Context& context) {
    points =
        shines<Colour> ? dark_beyond_ends(std::move(points), 360, 830) : dark_beyond_ends(std::move(points), 400, 700);
    if constexpr (shines<Colour>) {
        if (beyond_srgb(points)) warn_of_cut(node, context);
        return mean_light_of_lines(points);
    } else {
        return surface_colour(points);
    }
}

/// With the absolute brightness of Mitsuba, which is the mean over the eye's sensitivity.
template <class Colour>
std::optional<Colour> blackbody(double kelvin, double scale, const Node& node, const Context& context) {
    if (!shines<Colour>) {
        context.error(node, "a black body is light, and no colour of a surface");
        return std::nullopt;
    }
    if (!(kelvin > 0) || kelvin > 1e6) {
        context.error(node, "a black body needs a temperature in kelvin");
        return std::nullopt;
    }
    if (blackbody_beyond_srgb(float(kelvin))) warn_of_cut(node, context);
    double sum = 0, weights = 0;
    for (double w = 400; w <= 700; w += 10) {
        const double t = (w - 556) / 45, weight = std::exp(-0.5 * t * t);  // about the CIE's ȳ
        sum += weight * planck(kelvin, w), weights += weight;
    }
    return Colour{blackbody_colour(static_cast<float>(kelvin)).rgb * static_cast<float>(scale * sum / weights)};
}

/// "400:0.1, 700:0.3"
std::optional<std::vector<SpectrumPoint>> table(std::string_view text, const Node& node, const Context& context) {
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
    return points;
}

std::optional<std::vector<SpectrumPoint>> spectrum_file(const Node& node, const Context& context) {
    const auto bytes = context.assets.read(context.path(std::string(node.attribute("filename")), node), node.where);
    if (!bytes) return std::nullopt;
    try {
        return read_spd({reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size()});
    } catch (const Error& problem) {
        context.error(node, problem.what());
        return std::nullopt;
    }
}

/// <spectrum type="regular"> and "irregular".
std::optional<std::vector<SpectrumPoint>> samples(Properties& properties) {
    const Node& node = properties.node();
    const auto& context = properties.context();
    const auto values = numbers(properties.text("values", ""), node, context);
    auto wavelengths = numbers(properties.text("wavelengths", ""), node, context);
    if (!values || !wavelengths) return std::nullopt;
    if (node.type == "regular") {
        const auto bound = [&](const char* name, const char* older, float fallback) {
            return double(properties.number(name, properties.number(older, fallback)));
        };
        const double low = bound("wavelength_min", "lambda_min", 360),
                     high = bound("wavelength_max", "lambda_max", 830);
        for (std::size_t i = 0; i < values->size(); ++i)
            wavelengths->push_back(low + (high - low) * double(i) / std::max(1.0, double(values->size()) - 1));
    }
    std::string pairs;
    for (std::size_t i = 0; i < std::min(values->size(), wavelengths->size()); ++i)
        pairs += fmt::format("{}:{} ", (*wavelengths)[i], (*values)[i]);
    return table(pairs, node, context);
}

template <class Colour>
std::optional<Colour> colour_of(const Node& node, const Context& context);

template <class Colour>
std::optional<Colour> colour_in(Properties& properties, std::string_view name) {
    const Node* given = properties.find(name);
    if (!given) return std::nullopt;
    if (is_colour(*given)) return colour_of<Colour>(*given, properties.context());
    if (given->tag == "texture" || given->tag == "ref" || given->tag == "volume")
        properties.context().warn(*given, fmt::format("<{}> for '{}' of {} is left out: its usual colour is taken",
                                                      given->tag, name, properties.owner()));
    else
        properties.context().error(
            *given, fmt::format("'{}' of {} must be a colour, not <{}>", name, properties.owner(), given->tag));
    return std::nullopt;
}

/// <spectrum type="…">, as version 3 has it.
template <class Colour>
std::optional<Colour> plugin(const Node& node, const Context& context) {
    Properties properties(node, context);
    const auto grey = [](float value) { return Rgb{value, value, value}; };
    if (node.type == "blackbody")
        return blackbody<Colour>(double(properties.number("temperature", 5000)), double(properties.number("scale", 1)),
                                 node, context);
    if (node.type == "uniform") {
        const float value = properties.number("value", 1);
        return shines<Colour> ? of_table<Colour>({{360, value}, {830, value}}, node, context) : Colour{grey(value)};
    }
    if (node.type == "d65") {
        const auto colour = colour_in<Colour>(properties, "color");
        return Colour{(colour ? colour->rgb : grey(1)) * properties.number("scale", 1)};
    }
    if (node.type == "rgb" || node.type == "srgb")
        return colour_in<Colour>(properties, node.type == "rgb" ? "value" : "color").value_or(Colour{grey(1)});
    if (node.type == "irregular" || node.type == "regular") {
        auto points = samples(properties);
        return points ? std::optional(of_table<Colour>(*std::move(points), node, context)) : std::nullopt;
    }
    properties.ignore_all();
    context.warn(node, fmt::format("spectrum '{}' is not supported: {} is taken", node.type,
                                   shines<Colour> ? "white light" : "grey"));
    return Colour{grey(shines<Colour> ? 1.0f : 0.5f)};
}

template <class Colour>
std::optional<Colour> spectrum(const Node& node, const Context& context) {
    if (!node.type.empty()) return plugin<Colour>(node, context);
    const auto text = node.attribute("value");
    const bool filed = node.has("filename");
    if (filed || text.find(':') != text.npos) {
        auto points = filed ? spectrum_file(node, context) : table(text, node, context);
        return points ? std::optional(of_table<Colour>(*std::move(points), node, context)) : std::nullopt;
    }
    const auto colour = rgb(node, context);
    return colour ? std::optional(Colour{*colour}) : std::nullopt;
}

template <class Colour>
std::optional<Colour> colour_of(const Node& node, const Context& context) {
    if (node.tag == "blackbody") {
        auto kelvin = node.attribute("temperature");
        if (kelvin.ends_with('K') || kelvin.ends_with('k')) kelvin.remove_suffix(1);
        const auto temperature = number(kelvin, node, context);
        const auto scale = node.has("scale") ? number(node.attribute("scale"), node, context) : 1.0;
        return temperature && scale ? blackbody<Colour>(*temperature, *scale, node, context) : std::nullopt;
    }
    if (node.tag == "spectrum") return spectrum<Colour>(node, context);
    const auto colour = rgb(node, context);
    return colour ? std::optional(Colour{*colour}) : std::nullopt;
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

}  // namespace

bool is_colour(const Node& node) {
    return node.tag == "rgb" || node.tag == "srgb" || node.tag == "spectrum" || node.tag == "blackbody" ||
           node.tag == "float" || node.tag == "integer" || node.tag == "color";
}

std::optional<LightColour> light_of(const Node& node, const Context& context) {
    return colour_of<LightColour>(node, context);
}

LightColour light_of(Properties& properties, std::string_view name, float fallback) {
    return colour_in<LightColour>(properties, name).value_or(LightColour{{fallback, fallback, fallback}});
}

std::optional<SurfaceColour> surface_of(const Node& node, const Context& context) {
    return colour_of<SurfaceColour>(node, context);
}

SurfaceColour surface_of(Properties& properties, std::string_view name, Rgb fallback) {
    return colour_in<SurfaceColour>(properties, name).value_or(SurfaceColour{fallback});
}

Rgb indices_of(Properties& properties, std::string_view name, const std::string& fallback) {
    const auto alike = [](float eta) { return Rgb{eta, eta, eta}; };
    const Node* given = properties.find(name);
    const auto& context = properties.context();
    const auto named = [](std::string_view word) {
        return std::find_if(dielectrics.begin(), dielectrics.end(),
                            [&](const auto& known) { return known.name == word; });
    };
    if (!given) return alike(named(fallback)->value);
    const std::string word = lower_case(given->attribute("value"));
    if (const auto known = named(word); known != dielectrics.end()) return alike(known->value);
    if (given->tag == "string") {
        std::vector<std::string> names;
        for (const auto& known : dielectrics) names.emplace_back(known.name);
        context.error(*given, fmt::format("there is no dielectric '{}'{}", given->attribute("value").substr(0, 32),
                                          did_you_mean(word, names)));
        return alike(named(fallback)->value);
    }
    if (!is_colour(*given)) {
        context.warn(*given, fmt::format("the texture of '{}' of {} is left out: {} is taken", name, properties.owner(),
                                         named(fallback)->value));
        return alike(named(fallback)->value);
    }
    if (const auto index = surface_of(*given, context); index && index->rgb.g > 0) return index->rgb;
    return alike(named(fallback)->value);
}

float index_of(Properties& properties, std::string_view name, const std::string& fallback) {
    const Rgb index = indices_of(properties, name, fallback);
    if (index.r != index.g || index.g != index.b)
        properties.context().warn(*properties.find(name), std::string(one_index));
    return index.g;
}

}  // namespace lightnet::mitsuba
