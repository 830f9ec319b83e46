// Weights of multiple importance sampling: two ways to find light share it.
#pragma once

namespace lightnet {

/// How two sampling techniques share the light that both find: multiple importance sampling. Veach 1997, section 9.2.
/// `automatic`: by power for lamps, by balance for what comes from infinity. Or not at all: all of it is found by
/// points on lamps, or by directions from the BSDF, but for what the other alone can find. That is for comparison, as
/// either is noisy where the other is good.
// DECISIONS: balance-for-the-sky
enum class Heuristic { automatic, balance, power, lamps, directions };

/// Do both techniques find the same light?
constexpr bool shares(Heuristic heuristic) {
    return heuristic != Heuristic::lamps && heuristic != Heuristic::directions;
}
/// Where they share: by the squares of their densities, the power heuristic, or by the densities?
constexpr bool squares(Heuristic heuristic, bool from_infinity) {
    return (heuristic == Heuristic::power) | ((heuristic == Heuristic::automatic) & !from_infinity);
}

/// Weight of the technique with density `mine`, when `other` is the density of the other one, and both share.
inline float share(bool squared, float mine, float other) {
    const float ratio = other / mine;
    const float part = 1 / (1 + (squared ? ratio * ratio : ratio));
    return other == 0 ? 1 : part;
}

}  // namespace lightnet
