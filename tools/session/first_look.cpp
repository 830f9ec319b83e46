#include "tools/session/first_look.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/network/graph/plan.hpp"
#include "core/network/graph/single_lights.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet {
namespace {

// The first thing that each of them prepares is there, and so, most likely, is the rest.
bool are_prepared(const std::vector<std::size_t>& nodes, const RunRequest& request, const Job& job,
                  const MadeFrom& made_from) try {
    const Tuning& tuning = request.tuning;
    if (tuning.cache == "none" || tuning.verify > 0) return false;
    const DiskResultCache cache(tuning.cache.empty() ? default_cache_folder() : tuning.cache, tuning.cache_size);
    const Recipes recipes(job.graph, made_from);
    return std::all_of(nodes.begin(), nodes.end(), [&](std::size_t node) {
        return cache.find(recipes.of(node, 0, false)).bytes || cache.find(recipes.of(node, 0, true)).bytes;
    });
} catch (const Error&) {
    return false;
}

}  // namespace

std::optional<FirstLook> first_look(const RunRequest& request, const Registry& registry, const Job& job,
                                    const MadeFrom& made_from) {
    const auto preparing = preparing_nodes(job.graph, registry);
    if (preparing.empty() || !job.graph.sectors.empty() || are_prepared(preparing, request, job, made_from))
        return std::nullopt;
    FirstLook look{job, {}};
    look.job.graph = without_preparing(job.graph, registry);
    const auto layers = layers_of(job.graph, registry);
    for (std::size_t node = 0; node < job.graph.nodes.size(); ++node)
        if (look.job.graph.nodes[node].kind != job.graph.nodes[node].kind)
            for (const auto layer : layers_made_of(node, layers, job.graph, registry))
                look.without.push_back(layers.film[layer]);
    if (look.without.size() + layers.emission >= layers.film.size()) return std::nullopt;
    return look;
}

}  // namespace lightnet
