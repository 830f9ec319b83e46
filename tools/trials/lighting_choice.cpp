#include "tools/trials/lighting_choice.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <limits>

namespace lightnet {
namespace {

constexpr double clearly_better = 0.9;

std::string words_of(const LightingTrial& trial, const AskedPicture& asked) {
    if (!trial.failed.empty()) return fmt::format("{} ({})", trial.name, trial.failed);
    const auto expected = forecast_of(trial, asked);
    return fmt::format("{} ({:.3g} s x {:.3g} = {:.3g})", trial.name, expected.seconds, expected.error,
                       expected.cost());
}

}  // namespace

LightingForecast forecast_of(const LightingTrial& trial, const AskedPicture& asked) {
    const double longer = asked.samples / trial.samples, larger = asked.pixels / trial.pixels;
    const double seconds = trial.preparing * trial.preparing_grows + trial.rendering * larger * longer;
    if (trial.progressive)
        return {seconds, (trial.own_error + trial.shared_error) * trial.falls * std::pow(longer, -2.0 / 3)};
    return {seconds, trial.own_error * trial.falls / longer + trial.shared_error};
}

std::size_t best_lighting(const std::vector<LightingTrial>& trials, const AskedPicture& asked) {
    assert(!trials.empty() && "there is always one");
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
