#include "core/estimate/guide_trial.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

constexpr double work_of_guide = 1.3;  // beside paths without one: measured on rooms
constexpr double dark = 0.5;           // of the mean over all points

// What all rounds have said of the gain.
GuideTrial::Gain gain_of_all(std::span<const GuideTrial::Gain> gains) {
    // The guide that was judged earlier knew less. In rooms the last one's gain is so many times as large.
    constexpr std::array<double, guide_rounds - 1> to_come{1.3, 1.15, 1};
    double weights = 0, sum = 0;
    for (std::size_t i = 0; i < gains.size(); ++i) {
        const double times = to_come[i] * gains[i].times, error = to_come[i] * gains[i].error;
        if (!(error > 0)) continue;
        weights += 1 / (error * error), sum += times / (error * error);
    }
    return weights > 0 ? GuideTrial::Gain{sum / weights, 1 / std::sqrt(weights)} : GuideTrial::Gain{};
}

double times_of(double alone, double guided) { return guided > 0 ? alone / guided / work_of_guide : 0; }

}  // namespace

void GuideTrial::Sums::add(const Sums& more, double times) {
    light += times * more.light, moment += times * more.moment;
    surfaces += times * more.surfaces, paths += times * more.paths;
}

// With a mean of one, a moment of order 3/2 is one where there is no noise.
double GuideTrial::Sums::noise() const {
    if (!(light > 0)) return 0;
    const double mean = light / paths;
    return std::fmax(0.0, moment / paths / (mean * std::sqrt(mean)) - 1);
}

double GuideTrial::Sums::cost() const { return light > 0 ? noise() * surfaces / paths : 0; }

GuideRecord GuideTrial::record_of(const Tried& tried) {
    return GuideRecord(Vec3{tried.path.radiance, tried.path.surfaces, float(2 * tried.point + tried.guided)});
}

void GuideTrial::add(const GuideRecord& path, bool judged) {
    const auto [radiance, surfaces, origin] = path.position();
    if (LightGuide::learns_from(path) || !path.sound()) return;
    if (!(radiance >= 0 && surfaces >= 0 && origin >= 0 && origin < float(2 * points_))) return;
    const auto number = std::size_t(origin), kind = number % 2;
    if (kind == 0 || judged) kinds_[kind].push_back({number / 2, radiance, surfaces});
}

// A path is compared with the others of its point: a bright one must not hide itself.
std::array<GuideTrial::Kinds, GuideTrial::groups> GuideTrial::sums() const {
    struct Point {
        double radiance = 0, paths = 0;
    };
    std::vector<Point> points(points_);
    Point all;
    for (const auto& kind : kinds_)
        for (const Path& path : kind)
            for (Point* to : {&points[path.point], &all}) to->radiance += path.radiance, to->paths += 1;
    std::array<Kinds, groups> sums;
    if (!(all.radiance > 0)) return sums;
    const double least = dark * all.radiance / all.paths;
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind)
        for (const Path& path : kinds_[kind]) {
            const auto [radiance, paths] = points[path.point];
            const double others = paths > 1 ? (radiance - path.radiance) / (paths - 1) : 0;
            const double light = (path.radiance + least) / (others + least);
            sums[path.point % groups][kind].add({light, light * std::sqrt(light), path.surfaces, 1}, 1);
        }
    return sums;
}

// Jackknife: what `of` says without each of the groups.
template <class Of>
GuideTrial::Gain GuideTrial::with_error(const Of& of) const {
    const auto parts = sums();
    Kinds all;
    for (const Kinds& part : parts)
        for (std::size_t kind = 0; kind < all.size(); ++kind) all[kind].add(part[kind], 1);
    std::array<double, groups> without;
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < groups; ++i) {
        Kinds rest = all;
        for (std::size_t kind = 0; kind < rest.size(); ++kind) rest[kind].add(parts[i][kind], -1);
        without[i] = of(rest);
        mean += without[i] / groups;
    }
    for (const double times : without) squares += (times - mean) * (times - mean);
    return {of(all), std::sqrt(squares * (groups - 1) / groups)};
}

GuideTrial::Gain GuideTrial::gain() const {
    return with_error([](const Kinds& kinds) { return times_of(kinds[0].cost(), kinds[1].cost()); });
}

GuideTrial::Gain GuideTrial::noise_alone() const {
    return with_error([](const Kinds& kinds) { return kinds[0].noise(); });
}

// How many times less noise × work there must be. The guide that is judged has not learnt from its round yet, which
// doubles what it knows: then it helps more. Before the last round nobody is turned down who may still pay, which is in
// doubt for longer where there is much noise to take away; in the end who can't be told to pay is, neither by that
// round nor by all.
// DECISIONS: rounds-judge-together
bool guide_pays(std::span<const GuideTrial::Gain> gains, double noise) {
    constexpr std::array<double, guide_rounds> least_gain{0, 0.72, 0.8, 0.85};
    constexpr double much = 0.5, doubt = 2.5;  // standard errors
    const auto& last = gains.back();
    const double gain = gains.size() + 1 < guide_rounds ? last.times + (noise > much ? doubt : 1) * last.error
                                                        : std::max(last.low(), gain_of_all(gains).low());
    return gain >= least_gain[gains.size()];
}

}  // namespace lightnet
