// Names and groups of lamps.
#pragma once

#include <cstdint>
#include <string>

namespace lightnet {

/// What a lamp is known by: nothing of what shines.
struct LampLabel {
    std::string name{};       // as in the file; may be empty: see lamps_of()
    std::uint32_t group = 0;  // index into SceneData::groups
};

}  // namespace lightnet
