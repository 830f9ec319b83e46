#include "tools/explain/live_explainer.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/words_of.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/explain/explanation_text.hpp"
#include "tools/explain/path_picture.hpp"
#include "tools/request/run_settings.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet {
namespace {

constexpr int way_given = 10;            // nice: about a tenth of what each thread that renders gets
constexpr std::size_t most_waiting = 8;  // wishes
constexpr std::size_t most_told = 3;     // samples, the brightest first

struct ExplainerEnds {};

std::string explained(const PixelWish& wish, JsonTree more) {
    more["x"] = wish.x, more["y"] = wish.y;
    return sorted_text({{"explained", std::move(more)}});
}

// As the page draws them: two places each, whose ray it is ("": the renderer's), and whether it was stopped on its way
// to light.
JsonTree rays_of(const PixelAccount& account) {
    constexpr std::size_t most_rays = 2000;
    auto rays = JsonTree::list();
    const auto lines = path_lines(account, most_told);
    const auto tenth = [](float at) { return std::round(double{at} * 10) / 10; };
    for (std::size_t i = lines.size() - std::min(most_rays, lines.size()); i < lines.size(); ++i) {
        const auto& [from, to, node, hidden] = lines[i];
        if (!std::isfinite(from.x + from.y + to.x + to.y)) continue;
        rays.push_back({tenth(from.x), tenth(from.y), tenth(to.x), tenth(to.y),
                        node == AskedQuestion::nobody ? "" : account.network->graph.nodes[node].name, hidden});
    }
    return rays;
}

}  // namespace

LiveExplainer::LiveExplainer(const RunRequest& request, const Registry& registry, FilmFormat format)
    : request_(request), registry_(registry), format_(std::move(format)) {}

LiveExplainer::~LiveExplainer() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    asked_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void LiveExplainer::begin() {
    const std::lock_guard lock(mutex_);
    begun_ = true;
}

// Sectors are for many hosts; one thread has no use for them.
void LiveExplainer::share(std::shared_ptr<const Network> network, MadeFrom made_from, float scale) {
    if (!shards_in(network->graph).empty()) return;
    const std::lock_guard lock(mutex_);
    shared_ = PixelRecount::Source{std::move(network), format_, std::move(made_from), scale};
}

std::string LiveExplainer::why_not(const PixelWish& wish) const {
    const auto work = format_.crop.value_or(Window{0, 0, format_.width, format_.height});
    const bool inside =
        wish.x >= work.x && wish.y >= work.y && wish.x - work.x < work.width && wish.y - work.y < work.height;
    if (!inside) return "the picture has no such pixel";
    if (!begun_) return "the run does not render yet; ask again when it does";
    if (waiting_.size() >= most_waiting) return "too many pixels are asked for at once";
    if (request_.tuning.cache == "none" && !preparing_nodes(request_.graph, registry_).empty())
        return "what nodes have prepared is not kept (--cache none), and preparing it again would take as long as it "
               "did";
    return {};
}

void LiveExplainer::explain(const PixelWish& wish, Reply reply) {
    std::unique_lock lock(mutex_);
    if (const auto why = why_not(wish); !why.empty()) {
        lock.unlock();
        return reply(explained(wish, {{"error", why}}));
    }
    try {
        if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    } catch (const std::system_error&) {
        lock.unlock();
        return reply(explained(wish, {{"error", "the system gives no thread to explain with"}}));
    }
    waiting_.emplace_back(wish, std::move(reply));
    asked_.notify_all();
}

void LiveExplainer::work() {
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), way_given);
    std::unique_lock lock(mutex_);
    while (true) {
        asked_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
        if (ends_) return;
        const auto [wish, reply] = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        try {
            reply(answer(wish));
        } catch (const ExplainerEnds&) {
            return;
        } catch (const std::exception& error) {
            reply(explained(wish, {{"error", words_of(error)}}));
        }
        lock.lock();
    }
}

std::string LiveExplainer::answer(const PixelWish& wish) {
    const auto begun = std::chrono::steady_clock::now();
    const auto samples = std::clamp(wish.samples, 1u, std::min(most_samples, format_.samples));
    const auto account = recount().account(wish.x, wish.y, samples);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    return explained(wish, {{"samples", samples},
                            {"of", format_.samples},
                            {"seconds", std::round(took.count() * 1000) / 1000},
                            {"text", explanation_text(account, request_.output, most_told)},
                            {"rays", rays_of(account)}});
}

PixelRecount& LiveExplainer::recount() {
    if (recount_) return *recount_;
    auto from = source();
    std::unique_ptr<ResultCache> cache;
    if (!preparing_nodes(from.network->graph, registry_).empty())
        cache = std::make_unique<DiskResultCache>(
            request_.tuning.cache.empty() ? default_cache_folder() : request_.tuning.cache, request_.tuning.cache_size);
    recount_ = std::make_unique<PixelRecount>(std::move(from), std::move(cache), [this] {
        if (ends_) throw ExplainerEnds{};
    });
    return *recount_;
}

PixelRecount::Source LiveExplainer::source() const {
    {
        const std::lock_guard lock(mutex_);
        if (shared_) return *shared_;
    }
    RunRequest request;
    request.graph = written(request_.graph);
    request.scene = request_.scene;
    request.seed = request_.seed;
    DiskFiles files;
    LoadedScene scene = load_scene(request.graph, registry_, files, request.scene);
    const float scale = scene.data.film.scale;
    const Job job = make_job(request, registry_, format_, files);
    auto made = made_from_if_prepared(job, registry_, scene);
    return {build_network(job, registry_, std::move(scene)), format_, std::move(made), scale};
}

}  // namespace lightnet
