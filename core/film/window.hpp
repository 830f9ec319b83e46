// A part of a picture.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lightnet {

/// Pixels x … x + width - 1 of rows y … y + height - 1 of a picture; row 0 is on top.
struct Window {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;

    std::size_t pixels() const { return std::size_t{width} * height; }
    friend bool operator==(const Window&, const Window&) = default;
};

}  // namespace lightnet
