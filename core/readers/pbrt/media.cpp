#include "core/readers/pbrt/media.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

const std::vector<std::string> known_media{"homogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"};

bool scatters(const Medium& medium) {
    return medium.extinction.grid || medium.albedo.grid || !is_black(medium.albedo.value) || medium.emission.grid ||
           !is_black(medium.emission.value);
}

}  // namespace

std::optional<Rgb> Media::colour(Parameters& parameters, const char* name) {
    const Parameter* given = parameters.find(name);
    if (!given) return std::nullopt;
    const auto found = surface_of(*given, Use::index, sources_);
    return found ? std::optional(found->rgb) : std::nullopt;
}

bool Media::define(const std::string& name, const Matrix& to_world, Parameters& parameters) {
    if (has(name)) return false;
    Made& made = made_[name];
    auto medium = this->medium(parameters.text("type", ""), to_world, parameters);
    if (!medium) return true;  // empty space
    medium->name = name;
    medium->where = parameters.where();
    if (const auto fault = medium->fault(); !fault.empty()) parameters.error(fault);
    made.medium = *std::move(medium);
    if (scatters(made.medium)) be_space(name);
    return true;
}

void Media::be_space(const std::string& name) {
    const auto found = made_.find(name);
    if (found == made_.end() || found->second.in_space) return;
    found->second.in_space = true;
    found->second.index = static_cast<std::uint16_t>(scene_.media.size());
    scene_.media.push_back(found->second.medium);
}

std::uint16_t Media::add(Medium medium) {
    scene_.media.push_back(std::move(medium));
    return static_cast<std::uint16_t>(scene_.media.size() - 1);
}

Rgb Media::absorbed_in(const std::string& name) const {
    const auto found = made_.find(name);
    return found == made_.end() || found->second.in_space ? Rgb{} : found->second.medium.extinction.value;
}

std::uint16_t Media::index(const std::string& name) const {
    const auto found = made_.find(name);
    return found == made_.end() ? Query::no_medium : found->second.index;
}

std::vector<std::string> Media::names() const {
    std::vector<std::string> all;
    for (const auto& [name, made] : made_) all.push_back(name);
    return all;
}

std::optional<Medium> Media::medium(const std::string& type, const Matrix& to_world, Parameters& parameters) {
    Medium medium;
    medium.albedo_scatters = true;
    const bool older_grid = sources_.older() && type == "heterogeneous";
    if (!older_grid && std::find(known_media.begin(), known_media.end(), type) == known_media.end()) {
        parameters.ignore_all();
        sources_.report.warn(parameters.where(),
                             fmt::format("a medium of type '{}' is not supported{}: the space is taken as empty", type,
                                         did_you_mean(type, known_media)));
        return std::nullopt;
    }
    const float g = parameters.number("g", 0);
    if (g != 0) medium.phase = {PhaseFunction::Law::henyey_greenstein, g};
    if (type == "homogeneous")
        even(parameters, medium);
    else if (!gridded(type, to_world, parameters, medium))
        return std::nullopt;
    parameters.warn_unused();
    return medium;
}

/// 'sigma_a', 'sigma_s' and 'Le' of a medium that has the same colours everywhere.
void Media::coloured(Parameters& parameters, Medium& medium, Rgb absorbed, Rgb scattered) {
    const auto preset = parameters.text("preset", "");
    if (const auto known = preset.empty() ? std::nullopt : substance_named(preset, parameters))
        absorbed = known->absorbed, scattered = known->scattered;
    const float scale = parameters.number("scale", 1);
    absorbed = colour(parameters, "sigma_a").value_or(absorbed) * scale;
    scattered = colour(parameters, "sigma_s").value_or(scattered) * scale;
    medium.extinction.value = absorbed + scattered;
    medium.albedo.value = scattered;
    if (const Parameter* light = parameters.find("Le"))
        if (const auto found = light_of(*light, sources_)) medium.emission.value = found->rgb * absorbed;
}

void Media::even(Parameters& parameters, Medium& medium) {
    coloured(parameters, medium, usual_substance().absorbed, usual_substance().scattered);
    medium.emission.value *= parameters.number("Lescale", 1);
}

}  // namespace lightnet::pbrt
