// Mitsuba's emitters that are no shapes.
#pragma once

#include "core/readers/mitsuba/textures.hpp"

namespace lightnet::mitsuba {

/// Adds the lights of an <emitter> to the scene.
void add_emitter(const Node& node, Textures& textures);

}  // namespace lightnet::mitsuba
