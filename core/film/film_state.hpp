// The state of a film, as it is kept between runs.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/spreads.hpp"

namespace lightnet {

/// What a film holds, to be kept and taken up again, by a film of as many samples or more. A value.
struct FilmState {
    /// What came before its turn, or before all of its group.
    struct Sum {
        std::uint32_t blocks = 0;
        std::vector<Rgb> pixels;
        friend bool operator==(const Sum&, const Sum&) = default;
    };
    using Waiting = std::map<std::uint32_t, Sum>;  // by first block
    /// One rectangle of the tiling.
    struct Part {
        std::uint32_t x = 0, y = 0, width = 0, height = 0;
        std::uint32_t next_block = 0;  // the first one that is not in the sums
        Waiting waiting;
        bool ended = false;  // by a round
        friend bool operator==(const Part&, const Part&) = default;
    };
    std::uint32_t samples = 0;         // of its film
    std::vector<Rgb> sums;             // pixel × layer
    std::vector<PixelSpread> spreads;  // per pixel, where cells decide by themselves
    std::vector<std::uint64_t> lost;
    std::vector<Part> parts;
    friend bool operator==(const FilmState&, const FilmState&) = default;
};

}  // namespace lightnet
