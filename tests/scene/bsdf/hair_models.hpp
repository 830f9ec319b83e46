// Fibres of hair, made when they are wanted.
#pragma once

#include <optional>

#include "core/scene/bsdf/hair.hpp"

namespace lightnet::models_test {

inline HairBsdf hair_of(const HairSurface& surface, Rgb absorption = {}, std::optional<float> across = {}) {
    HairBsdf made = hair_fibre(absorption, 1.55f, surface);
    made.across = across;
    return made;
}

}  // namespace lightnet::models_test
