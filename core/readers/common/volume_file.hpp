// Mitsuba's grids of numbers in space: files that end with .vol.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "core/base/math/box.hpp"
#include "core/scene/media/medium.hpp"

namespace lightnet {

struct VolumeFile {
    std::shared_ptr<const VolumeGrid> grid;
    Box box;  // that the file says it fills
};

/// What numbers a file may have.
enum class VolumeNumbers { not_negative, any };

/// `grid` says how it is to be looked up. Throws Error, without a file name, where the file is not sound.
VolumeFile read_volume_file(std::span<const std::byte> bytes, VolumeGrid grid,
                            VolumeNumbers allowed = VolumeNumbers::not_negative);

}  // namespace lightnet
