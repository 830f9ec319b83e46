// Spreads of the blocks of samples of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// Of a pixel's blocks, per channel (Welford 1962).
struct PixelSpread {
    double mean[3] = {}, squares[3] = {};
    friend bool operator==(const PixelSpread&, const PixelSpread&) = default;
};

/// What a pixel whose channels add up to `sum`, as the picture shows them, has its noise compared with. Black ones are
/// compared with a little.
double scale_of_noise(double sum);

/// Of all pixels.
class Spreads {
public:
    void resize(std::size_t pixels) { all_.resize(pixels); }
    bool empty() const { return all_.empty(); }
    const std::vector<PixelSpread>& all() const { return all_; }
    void take(std::vector<PixelSpread> all) { all_ = std::move(all); }

    /// Takes the mean of another block of a pixel, as the picture shows it, when it had so many.
    void note(std::size_t pixel, const Rgb& sum, double scale, std::uint32_t blocks);
    /// Of the mean of so many blocks, in parts of scale_of_noise(): the sum of its channels' deviations.
    double noise_of(std::size_t pixel, std::uint32_t blocks) const;

private:
    std::vector<PixelSpread> all_;
};

}  // namespace lightnet
