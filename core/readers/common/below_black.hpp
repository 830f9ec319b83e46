// Pixels below black, which count as black wherever a picture is light or a share of it.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/readers/common/report.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// An image and where it is from.
struct NamedImage {
    const Image* image = nullptr;
    std::string name;
    SourceLine where;
};

/// "12 of its pixels are negative: 0 is taken", or "" where none is.
std::string below_black(const Image& image);

/// Warns of each that has such pixels and is more in the scene than relief: the numbers of normal, bump and
/// displacement maps may be negative.
void warn_below_black(const SceneData& scene, std::span<const NamedImage> images, Report& report);

}  // namespace lightnet
