// Gains of layers in the beauty, chosen after rendering: light is linear.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/picture.hpp"

namespace lightnet {

/// A layer counts times `value`, per channel, 0 or more. Where groups of lamps are apart, `direct` names all layers of
/// that node, `key` all of that group, and `direct.key` one; a layer that several name counts times each, in this
/// order.
struct Gain {
    std::string layer;
    Rgb value{1, 1, 1};
    friend bool operator==(const Gain&, const Gain&) = default;
};

/// "bounce=0.5", or per channel "bounce=1.2,1.1,1". Throws Error.
Gain gain_of(std::string_view text);
/// The reverse: as few digits as give the same float32.
std::string to_string(const Gain& gain);

/// What is wrong with gains for layers of these names, one sentence each.
std::vector<std::string> mistakes_in(const std::vector<Gain>& gains, const std::vector<std::string>& layers);

/// What each of these layers has: 1 where no gain names it. Empty: all have 1.
std::vector<Rgb> one_for_each(const std::vector<Gain>& gains, const std::vector<std::string>& layers);

/// Gives the layers these gains, and all others 1, and makes the beauty of them. The layers themselves stay as they
/// are: mixing again, with other gains, is as good as rendering with them. Throws Error on gains that are mistaken.
void mix(Picture& picture, const std::vector<Gain>& gains);

}  // namespace lightnet
