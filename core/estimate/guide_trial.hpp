// A trial of whether guided paths find more for the same work.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/estimate/light_guide.hpp"
#include "core/estimate/path_walk.hpp"

namespace lightnet {

/// Compares rounds of paths that begin at the same points: the first, which nobody guides, and the last.
/// DECISIONS: guided-where-it-pays
class GuideTrial {
public:
    explicit GuideTrial(std::size_t points) : points_(points) {}

    /// A whole path, among records of directions. A guide does not learn from it.
    static GuideRecord record_of(const PathRecord& path);
    /// Path of a round that began at that point.
    void add(std::size_t round, std::size_t point, const GuideRecord& path);
    /// How many times more variance × work there is in the first round than in the last. A guided surface counts as a
    /// quarter more work, and every path has its point, whatever guides it. Variance is relative to what all paths have
    /// found at the same point, on average; the darkest points count less. Where nothing was found: 0.
    double gain() const;

private:
    struct Path {
        std::size_t point;
        double radiance, surfaces;
    };
    struct Point {
        double radiance = 0, paths = 0;
    };
    using Cost = std::array<double, 2>;
    Cost cost_of(const std::vector<Path>& round, double work, std::span<const Point> points, double least) const;

    std::size_t points_;
    std::vector<std::vector<Path>> rounds_;
};

}  // namespace lightnet
