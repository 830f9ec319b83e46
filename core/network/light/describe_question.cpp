#include "core/network/light/describe_question.hpp"

#include <fmt/format.h>

namespace lightnet {

std::string describe(const Query& query) {
    if (query.is_in_space()) {
        const Vec3 at = query.place_in_space();
        return fmt::format("question at ({:g}, {:g}, {:g}) in medium {}, sample {} of stream {:#x}, depth {}", at.x,
                           at.y, at.z, query.medium, query.sample, query.stream, query.depth);
    }
    const auto instance =
        query.instance == Query::no_instance ? std::string() : fmt::format("instance {}, ", query.instance);
    return fmt::format("question at {}shape {}, primitive {}, uv ({:g}, {:g}), sample {} of stream {:#x}, depth {}",
                       instance, query.geometry, query.primitive, query.u, query.v, query.sample, query.stream,
                       query.depth);
}

std::string describe(const Tile& tile) {
    return fmt::format("tile {}x{} at pixel ({}, {}), samples {} to {}", tile.width, tile.height, tile.x, tile.y,
                       tile.first_sample, tile.first_sample + tile.samples - 1);
}

}  // namespace lightnet
