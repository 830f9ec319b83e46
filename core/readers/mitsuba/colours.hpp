// Mitsuba's spectra as linear RGB, of light or of surfaces, and the dielectrics that it knows by name.
#pragma once

#include <optional>
#include <string>

#include "core/readers/common/spectra.hpp"
#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// True for <rgb>, <srgb>, <spectrum>, <blackbody>, <float> and the like.
bool is_colour(const Node& node);
/// What such a node says of light. None: reported.
std::optional<LightColour> light_of(const Node& node, const Context& context);
LightColour light_of(Properties& properties, std::string_view name, float fallback);
/// What it says of a surface, or of what absorbs light. None: reported.
std::optional<SurfaceColour> surface_of(const Node& node, const Context& context);
SurfaceColour surface_of(Properties& properties, std::string_view name, Rgb fallback);

/// The index of refraction that `name` says, for each colour: a number, a material ("bk7", "water"), or a spectrum.
Rgb indices_of(Properties& properties, std::string_view name, const std::string& fallback);
/// That of green light alone.
float index_of(Properties& properties, std::string_view name, const std::string& fallback);

}  // namespace lightnet::mitsuba
