// Mitsuba's spectra as linear RGB, and the materials that it knows by name.
#pragma once

#include <optional>
#include <string>

#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// True for <rgb>, <srgb>, <spectrum>, <blackbody>, <float> and the like.
bool is_colour(const Node& node);
/// What such a node says. None: reported.
std::optional<Rgb> colour_of(const Node& node, const Context& context);
Rgb colour_of(Properties& properties, std::string_view name, Rgb fallback);

/// The index of refraction that `name` says: a number, or a material ("bk7", "water").
float index_of(Properties& properties, std::string_view name, const std::string& fallback);

struct ComplexIndex {
    Rgb eta, k;
};
/// Of a metal ("Au"). None: there is none of that name.
std::optional<ComplexIndex> metal_named(const std::string& name);

}  // namespace lightnet::mitsuba
