// The pixel filter, as a density of samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Where the samples of a pixel lie: distributed like its filter (Ernst et al. 2006, "Filter importance sampling").
/// Filters with negative lobes (Mitchell's) have no such density, and would need weights of both signs.
class PixelFilter {
public:
    PixelFilter(const std::string& shape, float radius) {
        if (shape == "box") {
            box_ = true;
            radius_ = radius > 0 ? radius : 0.5f;
            return;
        }
        const bool tent = shape == "tent";
        radius_ = radius > 0 ? radius : tent ? 1 : 1.5f;
        // Gaussian of deviation radius / 3, lowered so that it ends in 0.
        const auto height = [&](double t) { return tent ? 1 - std::fabs(t) : std::exp(-4.5 * t * t) - std::exp(-4.5); };
        ends_[0] = 0;
        for (std::size_t i = 0; i < steps; ++i) {
            const double left = 2.0 * double(i) / steps - 1, right = 2.0 * double(i + 1) / steps - 1;
            ends_[i + 1] = ends_[i] + (height(left) + height(right)) / steps;
        }
        for (double& end : ends_) end /= ends_[steps];
    }

    /// From the pixel's upper left corner.
    Vec2 place(Vec2 u) const {
        if (box_ && radius_ == 0.5f) return u;
        return {0.5f + radius_ * offset(u.x), 0.5f + radius_ * offset(u.y)};
    }

private:
    // In -1 … 1. Within a step the density is taken for constant.
    float offset(float u) const {
        if (box_) return 2 * u - 1;
        const auto end = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, double{u});
        const auto step = end - ends_.begin() - 1;
        const double part = (u - ends_[std::size_t(step)]) / (*end - ends_[std::size_t(step)]);
        return float(2 * (double(step) + part) / steps - 1);
    }

    static constexpr std::size_t steps = 256;
    bool box_ = false;
    float radius_ = 0.5f;
    std::array<double, steps + 1> ends_{};  // share of the filter up to each step
};

}  // namespace lightnet
