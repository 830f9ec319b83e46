// Substances that pbrt knows by name.
#pragma once

#include <optional>
#include <string>

#include "core/readers/pbrt/parameters.hpp"

namespace lightnet::pbrt {

/// What a medium does with light, per millimetre.
struct Substance {
    Rgb scattered, absorbed;
};
/// Of a substance that pbrt knows by name. None: it isn't known here, and a warning says so.
std::optional<Substance> substance_named(const std::string& name, const Parameters& parameters);
/// What is taken where nothing is said: whole milk.
Substance usual_substance();

}  // namespace lightnet::pbrt
