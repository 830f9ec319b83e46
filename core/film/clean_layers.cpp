#include "core/film/clean_layers.hpp"

#include <algorithm>

namespace lightnet::cleaning {

std::string half_of(const std::string& layer) { return "half." + layer; }

bool is_half(const std::string& layer) { return layer.starts_with("half."); }

const std::vector<std::string>& feature_layers() {
    static const std::vector<std::string> names{"clean_albedo", "clean_normal", "clean_depth"};
    return names;
}

bool is_for_cleaning(const std::string& layer) {
    const auto& features = feature_layers();
    return is_half(layer) || std::find(features.begin(), features.end(), layer) != features.end();
}

}  // namespace lightnet::cleaning
