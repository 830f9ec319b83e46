#include "tools/session/film_memo.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/film/checkpoint.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/kept.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet {

FilmMemo::FilmMemo(std::map<std::string, std::string> recipe, std::unique_ptr<ResultCache> cache)
    : recipe_(std::move(recipe)), cache_(std::move(cache)) {}

Hash FilmMemo::name() const {
    std::string text = "film\n";
    for (const auto& [what, value] : recipe_) text += what + ' ' + value + '\n';
    return content_hash(text);
}

Hash FilmMemo::name(std::uint32_t samples) const {
    return content_hash(to_hex(name()) + " samples " + std::to_string(samples));
}

std::optional<FilmState> FilmMemo::find(std::uint32_t samples) const {
    if (auto same = find(name(samples), samples)) return same;
    return find(name(), samples);
}

// What is damaged, or not what its name says, is none: the picture is rendered.
std::optional<FilmState> FilmMemo::find(const Hash& name, std::uint32_t most) const try {
    const Bytes bytes = cache_->find(name).bytes;
    if (!bytes) return std::nullopt;
    Checkpoint found = checkpoint_in(*bytes);
    if (found.of != recipe_ || found.film.samples > most) return std::nullopt;
    return std::move(found.film);
} catch (const Error&) {
    return std::nullopt;
}

void FilmMemo::keep(const Film& film) {
    const Bytes bytes = checkpoint_bytes({recipe_, film.state()});
    const Result result{content_hash(*bytes), bytes};
    cache_->keep(name(film.format().samples), result);
    cache_->keep(name(), result);
}

std::unique_ptr<FilmMemo> memo_for(const RunRequest& request, const Registry& registry,
                                   const std::map<std::string, std::string>& recipe,
                                   const std::function<void(const std::string&)>& warn) {
    if (!request.memo) return nullptr;
    const Tuning& tuning = request.tuning;
    try {
        if (const auto why = why_no_memo(request, registry); !why.empty()) throw Error(why);
        const auto folder = tuning.cache.empty() ? default_cache_folder() : tuning.cache;
        return std::make_unique<FilmMemo>(recipe, std::make_unique<DiskResultCache>(folder, tuning.cache_size));
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
