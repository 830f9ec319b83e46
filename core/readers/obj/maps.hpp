// Pictures as MTL statements name them.
#pragma once

#include <optional>
#include <string>

#include "core/readers/common/report.hpp"
#include "core/readers/obj/lines.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::obj {

/// An image as an MTL statement names it, with its options.
struct Map {
    std::string file;
    SourceLine where;
    Vec2 scale{1, 1}, offset{0, 0};
    bool clamp = false;
    float bump = 1, gain = 1;
    ImageTexture::Channel channel = ImageTexture::Channel::colour;  // of maps of numbers; colour: none is named
};

/// What stands behind the word of such a statement: options, and a name. None: there is no name, which is warned of.
std::optional<Map> read_map(const std::string& statement, Lines& lines, Report& report);

}  // namespace lightnet::obj
