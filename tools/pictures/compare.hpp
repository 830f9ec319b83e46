// The work of `lightnet compare`.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "core/film/flip.hpp"
#include "core/film/picture.hpp"

namespace lightnet {

/// Pictures to hold against a reference, and how far the beauty may be off.
struct CompareRequest {
    std::string reference;
    std::vector<std::string> pictures;
    std::optional<double> max_relmse, max_trimmed, max_blocks, max_bias, max_flip;
    bool equal_bytes = false;  // of every pixel of every layer
    bool json = false;
    FlipView view;
    std::string difference, flip_map;  // files to write; "": none
};

/// Writes what there is to say to `out`, and mistakes and what is too far off to `err`. An exit code: 0, 1 when a
/// tolerance is passed, 2 when a picture can't be read or has another size.
int compare_pictures(const CompareRequest& request, std::ostream& out, std::ostream& err);

}  // namespace lightnet
