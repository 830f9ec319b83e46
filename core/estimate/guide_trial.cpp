#include "core/estimate/guide_trial.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

constexpr double work_of_guide = 1.25;      // beside paths without one: measured on rooms
constexpr double work_before = 2;           // of ray and direct light of the point where a path begins, in surfaces
constexpr double dark = 0.5;                // of the mean over all points
constexpr std::array clipped{0.001, 0.01};  // of paths count no more than the least bright of them

}  // namespace

GuideRecord GuideTrial::record_of(const PathRecord& path) { return GuideRecord(Vec3{path.radiance, path.surfaces, 0}); }

void GuideTrial::add(std::size_t round, std::size_t point, const GuideRecord& path) {
    if (rounds_.size() <= round) rounds_.resize(round + 1);
    const auto [radiance, surfaces, nothing] = path.position();
    const bool sound = path.sound() && radiance >= 0 && surfaces >= 0;
    if (point < points_ && sound) rounds_[round].push_back({point, radiance, surfaces});
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
    const Cost alone = cost_of(rounds_.front(), 1, points, least);
    const Cost guided = cost_of(rounds_.back(), work_of_guide, points, least);
    double most = 0;
    for (std::size_t i = 0; i < alone.size(); ++i)
        if (guided[i] > 0) most = std::max(most, alone[i] / guided[i]);
    return most;
}

// Mean square error × work. A path is compared with the others of its point: a bright one must not hide itself. Nor
// must a few rare ones decide, which may be in one round and not in the other.
GuideTrial::Cost GuideTrial::cost_of(const std::vector<Path>& round, double work, std::span<const Point> points,
                                     double least) const {
    Cost cost{};
    if (round.empty()) return cost;
    std::vector<double> squares;
    squares.reserve(round.size());
    double surfaces = 0;
    for (const Path& path : round) {
        const Point& point = points[path.point];
        const double others = point.paths > 1 ? (point.radiance - path.radiance) / (point.paths - 1) : 0;
        const double off = path.radiance - others;
        squares.push_back(off * off / (others * others + least * least));
        surfaces += path.surfaces;
    }
    std::sort(squares.begin(), squares.end());
    const auto count = double(round.size());
    for (std::size_t i = 0; i < cost.size(); ++i) {
        const double most = squares[std::size_t((1 - clipped[i]) * (count - 1))];
        double sum = 0;
        for (const double square : squares) sum += std::min(square, most);
        cost[i] = sum / count * (work * surfaces / count + work_before);
    }
    return cost;
}

}  // namespace lightnet
