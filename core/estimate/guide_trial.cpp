#include "core/estimate/guide_trial.hpp"

#include <cmath>

namespace lightnet {
namespace {

constexpr double work_of_guide = 1.35;  // per surface, beside paths without one: measured on rooms
constexpr double dark = 0.1;            // of the mean over all points

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
    std::vector<double> means(points_), counts(points_);
    double mean = 0;
    for (const auto& round : rounds_)
        for (const Path& path : round) means[path.point] += path.radiance, counts[path.point] += 1;
    for (std::size_t i = 0; i < points_; ++i) {
        if (counts[i] > 0) means[i] /= counts[i];
        mean += means[i] / double(points_);
    }
    if (!(mean > 0) || rounds_.size() < 2) return 0;
    const double alone = cost_of(rounds_.front(), means, dark * mean);
    const double guided = work_of_guide * cost_of(rounds_.back(), means, dark * mean);
    return guided > 0 ? alone / guided : 0;
}

// Mean square error × surfaces.
double GuideTrial::cost_of(const std::vector<Path>& round, std::span<const double> means, double least) const {
    double squares = 0, surfaces = 0;
    for (const Path& path : round) {
        const double off = path.radiance - means[path.point];
        squares += off * off / (means[path.point] * means[path.point] + least * least);
        surfaces += path.surfaces;
    }
    const auto count = double(round.size());
    return count > 0 ? squares / count * (surfaces / count) : 0;
}

}  // namespace lightnet
