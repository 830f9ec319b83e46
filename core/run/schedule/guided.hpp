// Guided self-scheduling (Polychronopoulos & Kuck 1987): how much of what is left is handed out at once.
#pragma once

#include <cstddef>

namespace lightnet {

/// A fixed part of what is left for each worker: much at first, so that there are few messages, and little at the end,
/// so that who ends last keeps nobody waiting long. 0: less than one.
inline std::size_t guided_share(std::size_t left, std::size_t workers, std::size_t parts_for_each) {
    return left / (parts_for_each * workers);
}

}  // namespace lightnet
