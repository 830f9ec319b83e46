// The explanation of a pixel, for people.
#pragma once

#include <cstddef>
#include <string>

#include "tools/explain/pixel_account.hpp"

namespace lightnet {

/// The pixel and the share of each layer, then its `most` brightest samples, each with every question, answer and ray
/// in their order.
std::string explanation_text(const PixelAccount& account, const std::string& picture, std::size_t most);

}  // namespace lightnet
