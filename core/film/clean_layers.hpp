// Names of what a picture has beside its layers so that it can be cleaned.
#pragma once

#include <string>
#include <vector>

namespace lightnet::cleaning {

/// Layers that a picture has beside its sum: "half.direct" is what the second half of all samples has added to
/// "direct", which is about a half of it.
std::string half_of(const std::string& layer);
bool is_half(const std::string& layer);
/// Features of what is seen, at the first surface that is no mirror or glass: their layers beside the sum.
const std::vector<std::string>& feature_layers();
/// One of either.
bool is_for_cleaning(const std::string& layer);

}  // namespace lightnet::cleaning
