#include "core/readers/pbrt/older_sums.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lightnet::pbrt {
namespace {

/// By what each is likely to send back. Those that are bounded get as much as they may send, if there is room.
std::vector<double> shares_of(const std::vector<Reflection>& parts, Parameters& parameters) {
    constexpr double least = 0.02, facets = 0.15, some = 0.05;
    std::vector<double> shares;
    double bounded = 0, free = 0;
    for (const Reflection& part : parts) {
        const double most = std::clamp(double(part.most), least, 1.0);
        shares.push_back(part.bounded ? most : facets * most + least);
        (part.bounded ? bounded : free) += shares.back();
    }
    if (bounded + free > 1) {
        if (bounded > 1 + least) parameters.warn("its colours reflect more than arrives, and are cut");
        free = 0;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (!parts[i].bounded) free += shares[i] = std::min(shares[i], some);
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (parts[i].bounded) shares[i] *= (1 - free) / bounded;
    }
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) share /= all;
    return shares;
}

}  // namespace

// DECISIONS: older-pbrt
Material sum_of(const std::vector<Reflection>& parts, Parameters& parameters, const OlderSources& sources) {
    auto& textures = sources.known.textures;
    if (parts.empty()) {
        Material black;
        black.model = DiffuseMaterial{textures.constant({}), 0, std::nullopt};
        return black;
    }
    const auto shares = shares_of(parts, parameters);
    Material sum = parts[0].make(float(1 / shares[0]));
    double so_far = shares[0];
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const MaterialId first = sources.add(std::move(sum)), next = sources.add(parts[i].make(float(1 / shares[i])));
        so_far += shares[i];
        const float amount = float(shares[i] / so_far);
        sum = Material();
        sum.model = MixtureMaterial{first, next, textures.constant({amount, amount, amount})};
    }
    return sum;
}

}  // namespace lightnet::pbrt
