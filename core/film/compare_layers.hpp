// Measures of how far one file is from another, layer by layer.
#pragma once

#include <string>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/flip.hpp"
#include "core/film/picture.hpp"

namespace lightnet {

struct LayerDifference {
    std::string layer;
    Difference difference;
    double flip = 0;  // mean over the pixels
};

struct Comparison {
    bool identical = true;                // the same layers in the same order, the same bits in all of them
    std::vector<LayerDifference> layers;  // the beauty first, then those that both have
    std::vector<std::string> only_in_reference, only_in_picture;
    std::vector<float> flip_map;  // of the beauty, per pixel
};

/// Compares the beauty and every layer. Throws Error when the sizes differ.
Comparison compare_layers(const Picture& reference, const Picture& picture, const FlipView& view = {});

/// Picture minus reference: beauty and the layers that both have. Throws Error when the sizes differ.
Picture difference_of(const Picture& reference, const Picture& picture);

/// How large each pixel's difference is, whether above or below: for the eye.
Picture without_signs(Picture difference);

/// Values from 0 to 1 as colours, black over purple and orange to pale yellow (the map "magma", as FLIP is usually
/// shown). A PNG of it has just these colours.
Picture magma_of(std::uint32_t width, const std::vector<float>& values);

}  // namespace lightnet
