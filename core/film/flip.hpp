// FLIP: how different two pictures look to someone who flips between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// How pictures are looked at.
struct FlipView {
    double pixels_per_degree = 67;  // a screen 0.7 m wide, with 3840 pixels, 0.7 m away
    double exposure = 0;            // stops
};

/// 0: they look alike, 1: as different as can be.
struct Flip {
    double mean = 0;
    std::vector<float> map;  // per pixel
};

/// LDR-FLIP of two pictures of linear colours, `width` pixels wide (Andersson, Nilsson, Akenine-Möller, Oskarsson,
/// Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating Images", 2020). Both are first shown as our PNG
/// shows them, but not rounded to 8 bits: exposed, clipped to 0..1, black where they are no numbers.
Flip flip(std::uint32_t width, std::span<const Rgb> reference, std::span<const Rgb> picture, const FlipView& view = {});

}  // namespace lightnet
