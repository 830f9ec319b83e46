// A first-order regression around each pixel: a plane over features, fitted to what is alike.
#pragma once

#include <cstddef>
#include <vector>

#include "core/film/clean/guide.hpp"
#include "core/film/clean/pair_weights.hpp"
#include "core/film/clean/sheet.hpp"

namespace lightnet::cleaning {

/// Numbers of the pixels of an area, and of those around it that it looks at, by channel. Scratch of one thread.
class AreaValues {
public:
    static constexpr std::size_t stride = area_side + 2 * reach;

    explicit AreaValues(std::size_t channels) : channels_(channels), values_(channels * stride * stride) {}
    std::size_t channels() const { return channels_; }
    /// Coordinates from the area's upper left pixel; may lie up to `reach` outside.
    float* at(std::size_t channel, std::int64_t x, std::int64_t y) {
        return values_.data() + channel * stride * stride + index(x, y);
    }
    const float* at(std::size_t channel, std::int64_t x, std::int64_t y) const {
        return values_.data() + channel * stride * stride + index(x, y);
    }

private:
    static std::size_t index(std::int64_t x, std::int64_t y) {
        return static_cast<std::size_t>(y + reach) * stride + static_cast<std::size_t>(x + reach);
    }
    std::size_t channels_;
    std::vector<float> values_;
};

/// Numbers of an area alone, by channel.
class AreaResult {
public:
    explicit AreaResult(std::size_t channels) : values_(channels * area_side * area_side) {}
    float* row(std::size_t channel, std::size_t y) { return values_.data() + (channel * area_side + y) * area_side; }
    const float* row(std::size_t channel, std::size_t y) const {
        return values_.data() + (channel * area_side + y) * area_side;
    }

private:
    std::vector<float> values_;
};

/// Fits colour = c + Σ g (feature - the pixel's feature) by weighted least squares around each pixel of a strip, and
/// adds what c differs from the pixel by to `change`, all channels with the same weights (Bitterli et al. 2016,
/// "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings"). c is linear in the colours: a
/// sum of weights that add up to 1, and where all colours are alike it differs from them by exactly 0. Slopes along
/// features that hardly vary, or by no more than their noise, are held small. `row`: of the area, where the strip
/// begins; `area`: where that begins in the picture.
void fit_strip(const Guide& guide, const PairWeights& weights, std::size_t filter, const AreaValues& values, Place area,
               std::size_t row, AreaResult& change);

}  // namespace lightnet::cleaning
