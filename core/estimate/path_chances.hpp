// The chances of light paths to go on.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// Without a branch, as what is in the way can't be foretold.
inline Rgb nothing_if(bool occluded, Rgb light) {
    const std::uint32_t mask = std::uint32_t{occluded} - 1;
    const auto masked = [&](float x) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) & mask); };
    return {masked(light.r), masked(light.g), masked(light.b)};
}

/// Russian roulette: paths end by chance, and the others carry more. `kept` is the share of light that the last
/// surface leaves: by it alone, not by all that was lost before, paths end gradually from `roulette_depth` on.
/// Measured on rooms, variance × rays is a quarter to a half less than with a chance by the whole weight.
// DECISIONS: roulette-from-the-third
inline float chance_to_survive(float kept) { return std::min(kept, 0.95f); }
// With a guide, by what the path may still bring, beside what all of it is thought to bring: Vorba & Křivánek 2016,
// "Adjoint-Driven Russian Roulette and Splitting in Light Transport Simulation", without splitting.
// Without a branch, as what is left can't be foretold: a compiler would make one for the chance of 1.
inline float chance_by_hope(float left) {
    constexpr float hope_counts = 4, least_chance = 0.1f;
    const auto select = [](bool first, float a, float b) {
        const std::uint32_t mask = std::uint32_t{first} - 1;
        return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & ~mask) |
                                    (std::bit_cast<std::uint32_t>(b) & mask));
    };
    const float wish = hope_counts * left, least = select(wish > least_chance, wish, least_chance);
    return select(least < 1, least, 1);
}

/// Some guided paths go by surfaces alone, and each weighs what it does by both ways together: the balance heuristic
/// over whole paths (Veach & Guibas 1995). So none weighs more than 1 / (their share) of what it would without a guide,
/// however little that knows of the light. Of one path: how likely it is one of them, by the way that it has gone.
// DECISIONS: guided-paths-in-part
class AloneOdds {
public:
    static constexpr float share = 0.1f;
    /// It goes on in a direction that lies `favour` times denser by the guide: how many times by both together.
    float take(float favour) {
        const float both = odds_ + (1 - odds_) * favour;
        odds_ /= both;
        return both;
    }

private:
    float odds_ = share;
};

/// Chances by hope alone would make paths of a thousand times their weight where a guide knows nothing of a light that
/// they may still meet. `weight`: of the light that the path brings, before; ends by chance never raise it above one.
// DECISIONS: no-weight-by-chance
inline float chance_by_weight(float chance, float weight) { return std::max(chance, std::min(weight, 1.0f)); }

}  // namespace lightnet
