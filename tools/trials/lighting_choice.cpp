#include "tools/trials/lighting_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lightnet {
namespace {

constexpr double clearly_better = 0.9;

std::string words_of(const LightingTrial& trial, const AskedPicture& asked) {
    if (!trial.foretold.empty()) return fmt::format("{} ({})", trial.name, trial.foretold);
    if (!trial.failed.empty()) return fmt::format("{} ({})", trial.name, trial.failed);
    const auto expected = forecast_of(trial, asked);
    return fmt::format("{} ({:.3g} s x {:.3g} = {:.3g})", trial.name, expected.seconds, expected.error,
                       expected.cost());
}

// What caches and maps of detailed scenes prepare may take longer than all else.
bool is_plain(double triangles) { return triangles <= 20000; }

// As long as a million samples and more, so small pictures of them need a larger promise.
double clear_promise(const AskedPicture& asked, double triangles) {
    constexpr double clear = 10, many_samples = 1e6;
    return is_plain(triangles) ? clear : clear * std::max(1.0, many_samples / (asked.pixels * asked.samples));
}

}  // namespace

// DECISIONS: lighting-by-trials
LightingPromise promise_of(const LightingTrial& first, const AskedPicture& asked, double triangles) {
    constexpr double of_caches = 2e-4;  // relative square that records and photons are off by
    constexpr double quickness = 0.35;  // time of a sample, beside path tracing's
    constexpr double more_direct = 2;   // noise of direct light
    constexpr double of_gloss = 0.5;    // of that of what is seen in gloss: it is looked for anew, in maps or by paths
    constexpr double most_narrow = 4;   // error of a sample: records of paths have too much noise
    constexpr double least_caustic = 0.35, most_caustic = 0.8, most_soft = 0.5;
    constexpr double many_samples = 6e6;  // maps take longer to prepare, and are off by less
    const auto part = [&](PathKind kind) { return std::max(0.0, first.parts[static_cast<std::size_t>(kind)]); };
    const double of_sample = first.own_error * first.samples, alone = of_sample / asked.samples;
    // Also what glossy metal casts, which records of paths meet as seldom.
    const double caustic = part(PathKind::caustic) + part(PathKind::mirrored) + part(PathKind::glossy);
    const double learnt = part(PathKind::soft) + part(PathKind::glossy) + part(PathKind::shining);
    // All that a guide can take away is noise: where there is much, a small part of it is worth learning.
    const double least_learnt = of_sample >= most_narrow ? 0.03 : of_sample >= 0.1 ? 0.2 : 0.5;
    const double stays = more_direct * part(PathKind::direct) + of_gloss * part(PathKind::shining);
    LightingPromise promise;
    if (std::all_of(first.parts.begin(), first.parts.end(), [](double one) { return one == 0; })) {
        promise.why = "nobody knows what makes the error";
        return promise;
    }
    std::size_t most = 0;
    for (std::size_t k = 1; k < path_kinds; ++k)
        if (first.parts[k] > first.parts[most]) most = k;
    promise.times = alone / (stays * alone + of_caches) / quickness;
    promise.is_clear = promise.times >= clear_promise(asked, triangles);
    promise.why = fmt::format("paths {} make {:.0f} % of the error", word_of(static_cast<PathKind>(most)),
                              100 * std::min(1.0, first.parts[most]));
    const bool casts_all = part(PathKind::caustic) + part(PathKind::mirrored) >= most_caustic;
    const bool lasts = asked.pixels * asked.samples >= many_samples;
    const bool by_maps = caustic >= least_caustic || lasts;
    if (casts_all && is_plain(triangles) && !promise.is_clear && of_sample > 0)
        promise.covers = Covers::caustics;
    else if (promise.times >= least_promise)
        promise.covers = (by_maps && promise.is_clear && is_plain(triangles)) || of_sample >= most_narrow
                             ? Covers::all
                             : Covers::soft;
    else if (learnt >= least_learnt)
        promise.covers = Covers::narrow;
    // Records of some scenes are off by far less: where it costs little, that is looked at.
    promise.else_learns = promise.covers == Covers::narrow && part(PathKind::soft) >= most_soft && is_plain(triangles);
    if (promise.else_learns) promise.covers = Covers::soft;
    return promise;
}

LightingForecast forecast_of(const LightingTrial& trial, const AskedPicture& asked) {
    const double longer = asked.samples / trial.samples, larger = asked.pixels / trial.pixels;
    const double seconds = trial.preparing * trial.preparing_grows + trial.rendering * larger * longer;
    return {seconds, trial.own_error / longer + trial.shared_error * std::pow(longer, -trial.shared_falls)};
}

std::size_t best_lighting(const std::vector<LightingTrial>& trials, const AskedPicture& asked) {
    assert(!trials.empty() && "there is always one");
    for (std::size_t i = 0; i < trials.size(); ++i)
        if (!trials[i].foretold.empty()) return i;
    std::size_t best = 0;
    const LightingTrial& first = trials.front();
    double least = first.failed.empty() ? clearly_better * forecast_of(first, asked).cost()
                                        : std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < trials.size(); ++i) {
        if (!trials[i].failed.empty()) continue;
        if (const double cost = forecast_of(trials[i], asked).cost(); cost < least) best = i, least = cost;
    }
    return best;
}

std::string words_of_choice(const std::vector<LightingTrial>& trials, const AskedPicture& asked, std::size_t chosen) {
    std::string words = words_of(trials[chosen], asked);
    for (std::size_t i = 0; i < trials.size(); ++i)
        if (i != chosen) words += ", " + words_of(trials[i], asked);
    return words;
}

}  // namespace lightnet
