#include "core/readers/pbrt/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/files/other_places.hpp"
#include "core/readers/pbrt/older_light.hpp"

namespace lightnet::pbrt {
namespace {

enum class Seen { surface, index, light };

void warn_of_cut(const Parameter& parameter, const Sources& sources) {
    sources.report.warn(parameter.where, fmt::format("{} '{}' is of a colour that sRGB can't show, and is cut",
                                                     name_of(parameter.type), parameter.name));
}

/// The lights of pbrt-v3 are as bright as their tables say, and go on beyond them. Those of pbrt-v4 end there, and so
/// do surfaces, but where they were measured as far as light is seen well; indices of refraction have no end.
Rgb project(std::vector<SpectrumPoint> points, Seen as, const Parameter& parameter, const Sources& sources) {
    const bool shines = as == Seen::light;
    const bool ends = as != Seen::index && !sources.older() && points.size() > 1;
    if (ends) points = dark_beyond_ends(std::move(points), shines ? 360 : 400, shines ? 830 : 700);
    if (!shines) return surface_colour(points).rgb;
    if (beyond_srgb(points)) warn_of_cut(parameter, sources);
    return sources.older() ? mean_light_of_lines(points).rgb : light_colour_of_lines(points).rgb;
}

std::optional<Rgb> named(const std::string& name, Seen as) {
    const auto rgb = [](const auto& known) { return known ? std::optional(known->rgb) : std::nullopt; };
    return as == Seen::light ? rgb(named_light(name)) : rgb(named_index(name));
}

std::optional<Rgb> from_file(const std::string& name, const Parameter& parameter, Seen as, const Sources& sources) {
    const auto bytes = sources.read(name, parameter.where);
    if (!bytes) return std::nullopt;
    try {
        return project(read_spd({reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size()}), as, parameter,
                       sources);
    } catch (const Error& problem) {
        sources.report.error(parameter.where, fmt::format("'{}': {}", name, problem.what()));
        return std::nullopt;
    }
}

std::optional<Rgb> from_name(const Parameter& parameter, Seen as, const Sources& sources) {
    const std::string& name = parameter.texts[0];
    if (sources.older()) return from_file(parameter.paths[0], parameter, as, sources);
    if (const auto known = named(name, as)) return known;
    // a name of ours with an end is a file: "spds/Au.eta.spd"
    if (name.find('.') != std::string::npos) return from_file(parameter.paths[0], parameter, as, sources);
    sources.report.error(parameter.where, fmt::format("unknown spectrum '{}' for parameter '{}'{}", name,
                                                      parameter.name, did_you_mean(name, spectrum_names())));
    return std::nullopt;
}

std::optional<Rgb> from_values(const Parameter& parameter, Seen as, const Sources& sources) {
    std::vector<SpectrumPoint> points;
    const auto& n = parameter.numbers;
    if (n.size() == 1 && as != Seen::light) return Rgb{n[0], n[0], n[0]};
    bool sound = n.size() % 2 == 0;
    for (std::size_t i = 0; sound && i < n.size(); i += 2) {
        sound = points.empty() || n[i] > points.back().wavelength;
        points.push_back({n[i], n[i + 1]});
    }
    sound = sound && !points.empty();
    if (sound && points.size() == 1 && as != Seen::index && !sources.older())
        sources.report.warn(
            parameter.where,
            fmt::format("spectrum '{}' has one wavelength: all are taken alike, where pbrt is black", parameter.name));
    if (sound) return project(std::move(points), as, parameter, sources);
    sources.report.error(parameter.where, fmt::format("spectrum '{}' needs wavelengths, ascending, each with its value",
                                                      parameter.name));
    return std::nullopt;
}

std::optional<Rgb> checked(Rgb colour, const Parameter& parameter, Seen as, const Sources& sources) {
    if (std::min({colour.r, colour.g, colour.b}) < 0 && parameter.type == Type::rgb) {
        sources.report.error(parameter.where, fmt::format("rgb '{}' has a negative component", parameter.name));
        return std::nullopt;
    }
    const auto clamped = [&](float value) { return std::clamp(value, 0.0f, as == Seen::surface ? 1.0f : value); };
    if (as == Seen::surface && parameter.type == Type::rgb && max_component(colour) > 1)
        sources.report.warn(parameter.where,
                            fmt::format("rgb '{}' reflects more than arrives and is cut at 1", parameter.name));
    return Rgb{clamped(std::max(colour.r, 0.0f)), clamped(std::max(colour.g, 0.0f)), clamped(std::max(colour.b, 0.0f))};
}

std::optional<Rgb> unchecked(const Parameter& parameter, Seen as, const Sources& sources) {
    const auto wrong = [&](const std::string& what) -> std::optional<Rgb> {
        sources.report.error(parameter.where, fmt::format("parameter '{}' {}", parameter.name, what));
        return std::nullopt;
    };
    const auto& n = parameter.numbers;
    switch (parameter.type) {
        case Type::rgb:
            if (n.size() != 3) return wrong("needs three numbers");
            return Rgb{n[0], n[1], n[2]};
        case Type::blackbody:
            if (sources.older()) {
                if (n.size() != 2 || n[0] <= 0) return wrong("needs a temperature above 0, in kelvin, and a scale");
                if (blackbody_beyond_srgb(n[0])) warn_of_cut(parameter, sources);
                return peaked_blackbody(n[0]).rgb * n[1];
            }
            if (as != Seen::light) return wrong("of type blackbody fits a light only");
            if (n.size() != 1 || n[0] <= 0) return wrong("needs one temperature above 0, in kelvin");
            if (blackbody_beyond_srgb(n[0])) warn_of_cut(parameter, sources);
            return blackbody_colour(n[0]).rgb;
        case Type::spectrum:
            if (parameter.texts.size() == 1 && n.empty()) return from_name(parameter, as, sources);
            if (parameter.texts.empty()) return from_values(parameter, as, sources);
            return wrong("needs one name, or wavelengths and values");
        default:
            return wrong(fmt::format("is of type {}, but must be {}", name_of(parameter.type),
                                     as == Seen::light ? "rgb, spectrum or blackbody" : "rgb, spectrum or texture"));
    }
}

/// In linear sRGB, before the white of another colour space counts.
std::optional<Rgb> colour_of(const Parameter& parameter, Seen as, const Sources& sources) {
    const auto colour = unchecked(parameter, as, sources);
    if (!colour) return std::nullopt;
    const auto sound = checked(*colour, parameter, as, sources);
    if (!sound || parameter.type != Type::rgb || parameter.space == ColourSpace::srgb) return sound;
    const Rgb here = to_srgb(*sound, parameter.space);
    constexpr float rounding = 1e-5f;
    if (std::min({here.r, here.g, here.b}) < -rounding * max_component(*sound)) warn_of_cut(parameter, sources);
    return Rgb{std::max(here.r, 0.0f), std::max(here.g, 0.0f), std::max(here.b, 0.0f)};
}

}  // namespace

std::optional<Sources::Found> Sources::find(const std::string& name, const SourceLine& where) const {
    try {
        return Found{path(name), files.read(path(name))};
    } catch (const MissingHere&) {
        throw;
    } catch (const Error& problem) {
        for (const std::string& place : other_places(files, where.file, path(name))) {
            report.warn(where, fmt::format("'{}': {}: '{}' is taken", name, problem.what(), place));
            return Found{place, files.read(place)};
        }
        report.error(where, fmt::format("can't read '{}': {}", name, problem.what()));
        return std::nullopt;
    }
}

std::optional<Bytes> Sources::read(const std::string& name, const SourceLine& where) const {
    auto found = find(name, where);
    return found ? std::optional(std::move(found->bytes)) : std::nullopt;
}

std::optional<LightColour> light_of(const Parameter& parameter, const Sources& sources) {
    auto light = colour_of(parameter, Seen::light, sources);
    if (!light) return std::nullopt;
    if (parameter.type == Type::rgb && parameter.space != ColourSpace::srgb) *light *= white_light(parameter.space);
    return LightColour{*light};
}

std::optional<SurfaceColour> surface_of(const Parameter& parameter, Use use, const Sources& sources) {
    const auto colour = colour_of(parameter, use == Use::surface ? Seen::surface : Seen::index, sources);
    return colour ? std::optional(SurfaceColour{*colour}) : std::nullopt;
}

}  // namespace lightnet::pbrt
