// A finished picture: what goes into files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// One contribution to the picture.
struct PictureLayer {
    std::string name;
    std::vector<Rgb> pixels;  // row by row, row 0 on top
    Rgb gain{1, 1, 1};        // so many times it is in the beauty
    friend bool operator==(const PictureLayer&, const PictureLayer&) = default;
};

/// A picture and what it is the sum of. Linear RGB with the primaries of BT.709. May be cut out of a larger one.
struct Picture {
    std::uint32_t width = 0, height = 0;              // of what is there
    std::vector<Rgb> beauty;                          // row by row, row 0 on top
    std::vector<PictureLayer> layers;                 // in the order in which they add up to the beauty; may be empty
    std::uint32_t x = 0, y = 0;                       // of its upper left pixel, in the whole picture
    std::uint32_t whole_width = 0, whole_height = 0;  // 0: this is the whole picture
    std::vector<float> samples{};                     // per pixel; empty: the same number everywhere
    std::vector<PictureLayer> shown{};                // beside the sum: what operators answer that others ask
    float done = 1;                                   // how much of the work is in it; below 1: a preview
    std::uint64_t overflowed = 0;                     // pixels that are black as their sum is more than a float32 holds
    friend bool operator==(const Picture&, const Picture&) = default;
};

/// Makes pixels black, in all layers, whose layers or the plain sum of them are not finite: many bright samples may add
/// up to more than a float32 holds. Of what is shown beside the sum each layer stands for itself. Counts them, and
/// makes the beauty.
void blacken_overflow(Picture& picture);

/// The float32 sum of the layers, each times its gain, from the left to the right.
std::vector<Rgb> sum_of(const std::vector<PictureLayer>& layers);

/// The beauty: sum_of() the layers; a pixel whose gains take it beyond a float32 is black in it, and counted.
void make_beauty(Picture& picture);

}  // namespace lightnet
