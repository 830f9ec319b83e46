#include "core/estimate/hemisphere.hpp"

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightnet {
namespace {

void add_scaled(std::array<Vec3, 3>& sum, Vec3 direction, Rgb by) {
    sum[0] += direction * by.r;
    sum[1] += direction * by.g;
    sum[2] += direction * by.b;
}

}  // namespace

Rgb IrradianceRecord::at(Vec3 point, Vec3 towards) const {
    const Vec3 offset = point - position, turn = cross(normal, towards);
    const auto changed = [&](float value, std::size_t colour) {
        return std::max(0.0f, value + dot(moved[colour], offset) + dot(turned[colour], turn));
    };
    return {changed(irradiance.r, 0), changed(irradiance.g, 1), changed(irradiance.b, 2)};
}

Hemisphere::Hemisphere(std::size_t rays)
    : rings_(std::max<std::size_t>(2, std::size_t(std::lround(std::sqrt(double(rays) / 3.14159265358979))))),
      sectors_(std::max<std::size_t>(4, (rays + rings_ / 2) / rings_)) {
    for (std::size_t j = 0; j < rings_; ++j) {
        const double low = double(j) / double(rings_), high = double(j + 1) / double(rings_);  // sin²
        const auto tangents = [](double x) { return std::asin(std::sqrt(x)) - std::sqrt(x * (1 - x)); };
        ring_.push_back({float(std::sqrt(low)), float(std::sqrt(high)), float(std::sqrt(1 - low)),
                         float((tangents(high) - tangents(low)) / (high - low))});
    }
    for (std::size_t k = 0; k < sectors_; ++k) {
        const auto direction = [&](double turns) {
            const double angle = 2 * 3.14159265358979323846 * turns;
            return Vec2{float(std::cos(angle)), float(std::sin(angle))};
        };
        const double n = double(sectors_), middle = (double(k) + 0.5) / n;
        sector_.push_back({direction(middle), direction(middle + 0.25), direction(double(k) / n + 0.25)});
    }
}

void Hemisphere::add_rays(Vec3 origin, Vec3 normal, Key stream, std::uint8_t depth,
                          std::vector<GatherRay>& rays) const {
    const Frame frame = Frame::around(normal);
    for (std::size_t j = 0; j < rings_; ++j)
        for (std::size_t k = 0; k < sectors_; ++k) {
            // one stream, so that what the rays draw further on is spread over all of them as well
            const auto index = static_cast<std::uint32_t>(j * sectors_ + k);
            const Vec2 u = Samples(child(stream, j, k), 0).next_2d();
            const float squared = std::min((float(j) + u.x) / float(rings_), 0x1.fffffep-1f);  // sin²
            const float angle = 2 * pi * (float(k) + u.y) / float(sectors_);
            const float sine = std::sqrt(squared);
            const Vec3 local{sine * std::cos(angle), sine * std::sin(angle), std::sqrt(1 - squared)};
            rays.push_back({{origin, normalize(frame.to_world(local))}, stream, index, depth});
        }
}

IrradianceRecord Hemisphere::record(Vec3 position, Vec3 normal, std::span<const GatherResult> found) const {
    IrradianceRecord record{position, normal, {}, 0, std::numeric_limits<float>::infinity(), {}, {}};
    const Frame frame = Frame::around(normal);
    const auto world = [&](Vec2 d) { return frame.x * d.x + frame.y * d.y; };
    const float even = pi / float(size()), sector = 2 * pi / float(sectors_);
    double nearness = 0;
    for (std::size_t j = 0; j < rings_; ++j)
        for (std::size_t k = 0; k < sectors_; ++k) {
            const GatherResult& here = found[j * sectors_ + k];
            const GatherResult& beside = found[j * sectors_ + (k + sectors_ - 1) % sectors_];
            const Ring& ring = ring_[j];
            record.irradiance += here.light * even;
            nearness += here.distance > 0 ? 1.0 / here.distance : 0;
            record.nearest = std::min(record.nearest, here.distance);
            add_scaled(record.turned, world(sector_[k].across), here.light * (ring.tangent * even));
            const float to_side = std::min(here.distance, beside.distance);
            if (to_side > 0)
                add_scaled(record.moved, world(sector_[k].start),
                           (here.light - beside.light) * ((ring.high - ring.low) / to_side));
            if (j == 0) continue;
            const GatherResult& above = found[(j - 1) * sectors_ + k];
            const float to_ring = std::min(here.distance, above.distance);
            if (to_ring > 0)
                add_scaled(record.moved, world(sector_[k].middle),
                           (here.light - above.light) * (sector * ring.low * ring.cosine * ring.cosine / to_ring));
        }
    record.distance = nearness > 0 ? float(double(size()) / nearness) : std::numeric_limits<float>::infinity();
    return record;
}

float Hemisphere::noise(std::span<const GatherResult> once, std::span<const GatherResult> again, std::size_t groups) {
    // Both rays of a cell differ by its noise alone.
    double differences = 0, sum = 0;
    for (std::size_t first = 0; first < once.size(); first += groups) {
        double here = 0, there = 0;
        for (std::size_t g = first; g < first + groups; ++g) {
            here += double{luminance(once[g].light)};
            there += double{luminance(again[g].light)};
        }
        differences += (here - there) * (here - there);
        sum += here + there;
    }
    return sum > 0 ? float(std::sqrt(2 * differences) / sum) : 0;
}

}  // namespace lightnet
