#include "core/film/plane.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightnet {
namespace {

using Row = std::span<const float>;

Row row_of(const Plane& plane, std::uint32_t y) {
    return Row(plane.values).subspan(std::size_t{y} * plane.width, plane.width);
}

void add(std::span<float> sum, Row values, double weight) {
    const auto factor = static_cast<float>(weight);
    for (std::size_t x = 0; x < sum.size(); ++x) sum[x] += factor * values[x];
}

Plane along_rows(const Plane& plane, std::span<const double> weights) {
    const std::size_t radius = weights.size() / 2;
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
    std::vector<float> longer(plane.width + 2 * radius);
    for (std::uint32_t y = 0; y < plane.height; ++y) {
        const Row row = row_of(plane, y);
        std::fill_n(longer.begin(), radius, row.front());
        std::copy(row.begin(), row.end(), longer.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(longer.rbegin(), radius, row.back());
        const auto sum = std::span(result.values).subspan(std::size_t{y} * plane.width, plane.width);
        for (std::size_t k = 0; k < weights.size(); ++k) add(sum, Row(longer).subspan(k, plane.width), weights[k]);
    }
    return result;
}

Plane along_columns(const Plane& plane, std::span<const double> weights) {
    const auto radius = static_cast<std::int64_t>(weights.size() / 2);
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
    for (std::int64_t y = 0; y < plane.height; ++y) {
        const auto sum = std::span(result.values).subspan(static_cast<std::size_t>(y) * plane.width, plane.width);
        for (std::int64_t k = -radius; k <= radius; ++k) {
            const auto from = std::clamp<std::int64_t>(y + k, 0, std::int64_t{plane.height} - 1);
            add(sum, row_of(plane, static_cast<std::uint32_t>(from)), weights[static_cast<std::size_t>(k + radius)]);
        }
    }
    return result;
}

}  // namespace

Plane filtered(const Plane& plane, std::span<const double> across, std::span<const double> down) {
    if (plane.values.empty()) return plane;
    return along_columns(along_rows(plane, across), down);
}

Weights gaussian(double sharpness, int radius) {
    Weights weights;
    for (int x = -radius; x <= radius; ++x) weights.push_back(std::exp(-sharpness * x * x));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

}  // namespace lightnet
