#include "tools/session/film_memo.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/film/checkpoint.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/kept.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet {

namespace {

Hash name_of(const FilmMemo::Recipe& recipe) {
    std::string text = "film\n";
    for (const auto& [what, value] : recipe) text += what + ' ' + value + '\n';
    return content_hash(text);
}

Hash name_of(const FilmMemo::Recipe& recipe, std::uint32_t samples) {
    return content_hash(to_hex(name_of(recipe)) + " samples " + std::to_string(samples));
}

}  // namespace

FilmMemo::FilmMemo(Recipe recipe, std::vector<LightRecipe> lights, std::unique_ptr<ResultCache> cache)
    : recipe_(std::move(recipe)), lights_(std::move(lights)), cache_(std::move(cache)) {}

std::optional<FilmState> FilmMemo::find(std::uint32_t samples) const {
    if (auto same = find(name_of(recipe_, samples), recipe_, samples)) return same;
    return find(name_of(recipe_), recipe_, samples);
}

// What is damaged, or not what its name says, is none: the picture is rendered.
std::optional<FilmState> FilmMemo::find(const Hash& name, const Recipe& recipe, std::uint32_t most) const try {
    const Bytes bytes = cache_->find(name).bytes;
    if (!bytes) return std::nullopt;
    Checkpoint found = checkpoint_in(*bytes);
    if (found.of != recipe || found.film.samples > most) return std::nullopt;
    return std::move(found.film);
} catch (const Error&) {
    return std::nullopt;
}

KnownLights FilmMemo::find_lights(const FilmFormat& format, const Graph& graph, const Registry& registry) const {
    KnownLights known(format, graph);
    for (const auto& light : lights_)
        if (auto state = find(name_of(light.recipe, format.samples), light.recipe, format.samples))
            known.add(light, *std::move(state));
    if (!known.empty()) known.settle(registry);
    return known;
}

void FilmMemo::keep(const Film& film) {
    const FilmState state = film.state();
    const auto keep = [&](const Hash& name, const Result& result) { cache_->keep(name, result); };
    const auto result_of = [](const Recipe& recipe, FilmState held) {
        const Bytes bytes = checkpoint_bytes({recipe, std::move(held)});
        return Result{content_hash(*bytes), bytes};
    };
    const auto samples = film.format().samples;
    for (const auto& light : lights_)
        if (const Hash name = name_of(light.recipe, samples); !cache_->find(name).bytes)
            keep(name, result_of(light.recipe, colours_of(state, light.colours, film.format().colours())));
    const Result whole = result_of(recipe_, state);
    keep(name_of(recipe_, samples), whole);
    keep(name_of(recipe_), whole);
}

std::unique_ptr<FilmMemo> memo_for(const RunRequest& request, const Registry& registry, const FilmMemo::Recipe& recipe,
                                   std::vector<LightRecipe> lights,
                                   const std::function<void(const std::string&)>& warn) {
    if (!request.memo) return nullptr;
    const Tuning& tuning = request.tuning;
    try {
        if (const auto why = why_no_memo(request, registry); !why.empty()) throw Error(why);
        const auto folder = tuning.cache.empty() ? default_cache_folder() : tuning.cache;
        // Where pictures of fewer samples count, they have the bytes of so many in each layer.
        if (request.time_limit > 0 || !request.reference.empty()) lights.clear();
        return std::make_unique<FilmMemo>(recipe, std::move(lights),
                                          std::make_unique<DiskResultCache>(folder, tuning.cache_size));
    } catch (const Error& error) {
        warn(std::string("no memo: ") + error.what());
        return nullptr;
    }
}

std::string why_no_memo(const RunRequest& request, const Registry& registry) {
    if (request.tuning.verify > 0) return "with --verify, nothing counts that nobody has verified";
    if (request.tuning.check_answers) return "with --check-answers, all is asked anew";
    if (!files_to_keep(request.graph, registry).empty()) return "nodes are to keep in files what they learn now";
    const auto used = used_nodes(request.graph, renderer_of(request.graph, registry));
    for (std::size_t i = 0; i < request.graph.nodes.size(); ++i) {
        const Node& node = request.graph.nodes[i];
        const Kind& kind = *registry.find(node.kind);
        if (!used[i] || kind.role == Role::scene) continue;
        if (!kind.run.reproducible) return "'" + node.name + "' draws random numbers that nobody seeds";
        if (!kind.reads) return "nobody has declared what nodes like '" + node.name + "' read";
    }
    return {};
}

}  // namespace lightnet
