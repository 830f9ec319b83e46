#include "core/estimate/guide_trial.hpp"

#include <cmath>

namespace lightnet {
namespace {

constexpr double work_of_guide = 1.35;  // per surface, beside paths without one: measured on rooms
constexpr double dark = 0.5;            // of the mean over all points

}  // namespace

GuideRecord GuideTrial::record_of(const PathRecord& path) {
    GuideRecord record;
    record.radiance = path.radiance;
    record.density = path.surfaces + 1;
    record.turn = LightGuide::turns;
    return record;
}

void GuideTrial::add(std::size_t round, std::size_t point, const GuideRecord& path) {
    if (rounds_.size() <= round) rounds_.resize(round + 1);
    if (point < points_ && path.sound()) rounds_[round].push_back({point, path.radiance, path.density});
}

double GuideTrial::gain() const {
    if (rounds_.size() < 2) return 0;
    std::vector<Point> points(points_);
    double sum = 0, count = 0;
    for (const auto& round : rounds_)
        for (const Path& path : round) {
            points[path.point].radiance += path.radiance, points[path.point].paths += 1;
            sum += path.radiance, count += 1;
        }
    if (!(sum > 0)) return 0;
    const double least = dark * sum / count;
    const double guided = work_of_guide * cost_of(rounds_.back(), points, least);
    return guided > 0 ? cost_of(rounds_.front(), points, least) / guided : 0;
}

// Mean square error × surfaces. A path is compared with the others of its point: a bright one must not hide itself.
double GuideTrial::cost_of(const std::vector<Path>& round, std::span<const Point> points, double least) const {
    double squares = 0, surfaces = 0;
    for (const Path& path : round) {
        const Point& point = points[path.point];
        const double others = point.paths > 1 ? (point.radiance - path.radiance) / (point.paths - 1) : 0;
        const double off = path.radiance - others;
        squares += off * off / (others * others + least * least);
        surfaces += path.surfaces;
    }
    const auto count = double(round.size());
    return count > 0 ? squares / count * (surfaces / count) : 0;
}

}  // namespace lightnet
