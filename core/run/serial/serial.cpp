#include "core/run/serial/serial.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/network/light/services.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// One node's services, in a run of one thread: loops.
class SerialRun::Preparing final : public Services {
public:
    Preparing(SerialRun& run, std::size_t node, const Recipes& recipes)
        : run_(run), node_(node), recipes_(recipes), cache_(run.network_.renewed[node] ? nullptr : run.cache_) {}

    std::vector<Query> rehearse(std::uint32_t stride) override {
        rehearsed_ = true;
        const auto result = recall([&] {
            const auto& network = run_.network_;
            run_.assembly_.rehearsal(node_).begin();
            const auto tiles = rehearsal_tiles(network.graph, network.registry, stride, run_.pass_of(node_));
            for (std::size_t i = 0; i < tiles.size(); ++i) {
                step(i, tiles.size());
                run_.render_as_prepared(tiles[i]);
            }
            return rehearsal_result(run_.assembly_.rehearsal(node_).end());
        });
        const Mapped<Query> noted(result);
        return {noted.begin(), noted.end()};
    }
    void say(const std::string& text) override {
        if (run_.say_) run_.say_(run_.network_.graph.nodes[node_].name + ": " + text);
    }

    void doing(const std::string& what, std::uint64_t done, std::uint64_t total) override {
        look();
        counts_ = total > 0;
        run_.progress_.what = what;
        run_.step(done, total);
    }
    void look() const override {
        if (run_.pause_) run_.pause_();
    }

protected:
    Bytes map_bytes(std::size_t count, const Shard& work) override {
        return recall([&] {
            std::vector<std::vector<std::byte>> shards(count);
            for (std::size_t i = 0; i < count; ++i) {
                step(i, count);
                work(i, shards[i]);
            }
            return join_shards(shards);
        });
    }
    std::shared_ptr<const void> once_any(const Make& make) override {
        OneBuilder alone([this](std::size_t done, std::size_t count) { step(done, count); });
        return make(alone);
    }

private:
    void step(std::uint64_t done, std::uint64_t total) const {
        look();
        if (!counts_) run_.step(done, total);
    }

    template <class Compute>
    Bytes recall(const Compute& compute) {
        return run_.last_results_[node_] = found_or(compute);
    }

    template <class Compute>
    Bytes found_or(const Compute& compute) {
        const Hash recipe = recipes_.of(node_, call_++, rehearsed_);
        if (cache_)
            if (auto known = cache_->find(recipe).bytes) return known;
        auto made = compute();
        if (cache_) cache_->keep(recipe, {content_hash(*made), made});
        return made;
    }

    SerialRun& run_;
    std::size_t node_;
    const Recipes& recipes_;
    ResultCache* cache_;
    std::uint32_t call_ = 0;
    bool rehearsed_ = false;
    bool counts_ = false;  // the node says itself how much is done
};

SerialRun::SerialRun(const Network& network, std::function<void()> pause, AccountKeeper* keeper)
    : network_(network),
      pause_(std::move(pause)),
      image_(renderer_of(network.graph, network.registry)),
      rays_before_(Scene::rays_of_this_thread()),
      gauge_(network.graph.nodes.size(), asking_edges(network.graph, network.layers, network.registry).size()),
      meter_(gauge_, asking_edges(network.graph, network.layers, network.registry),
             [] { return std::chrono::steady_clock::now().time_since_epoch(); }),
      assembly_(network,
                [this](std::size_t node, std::size_t width) {
                    const auto called = assembly_.callee(node);
                    return ports_
                        .emplace_back(std::make_unique<DirectPort>(called, width, counters_.local_questions, pause_))
                        .get();
                },
                {.locks = &locks_}, {.meter = &meter_, .keeper = keeper}) {
    assembly_.show(gauge_);
    assembly_.renderer(image_);
}

void SerialRun::prepare(const MadeFrom& made_from, ResultCache* cache, std::function<void(const std::string&)> say,
                        std::uint32_t pass) {
    made_from_ = made_from;
    cache_ = cache;
    say_ = std::move(say);
    pass_ = pass;
    prepare_nodes(false);
}

// All of them, or those that are prepared again for this pass.
void SerialRun::prepare_nodes(bool again) {
    const TellingOfLostRays telling(assembly_.keeper_of_lost_rays());
    const Recipes recipes(network_.graph, made_from_);
    auto nodes = preparing_nodes(network_.graph, network_.registry);
    if (again) std::erase_if(nodes, [&](auto node) { return !network_.renewed[node]; });
    const auto tiles = counters_.tiles;
    progress_ = {};
    progress_.nodes = nodes.size();
    for (const auto node : nodes) {
        progress_.node = network_.graph.nodes[node].name;
        progress_.what.clear();
        ++progress_.position;
        step(0, 0);
        Preparing services(*this, node, recipes);
        const auto begun = std::chrono::steady_clock::now();
        assembly_.prepare(node, services, pass_of(node));
        if (tracer_) tracer_->worked(TraceKind::prepare, node, begun);
    }
    counters_.tiles = tiles;  // those of rehearsals make no picture
}

std::uint32_t SerialRun::pass_of(std::size_t node) const { return network_.renewed[node] ? pass_ : 0; }

void SerialRun::step(std::uint64_t done, std::uint64_t total) {
    progress_.done = done, progress_.total = total;
    if (watcher_) watcher_(progress_);
}

Bytes SerialRun::last_result(std::size_t node) const {
    const auto found = last_results_.find(node);
    return found == last_results_.end() ? nullptr : found->second;
}

std::vector<Rgb> SerialRun::render(const Tile& tile) {
    if (!network_.has_passes()) return render_as_prepared(tile);
    std::vector<Rgb> pixels;
    for (const Tile& block : one_by_one(tile)) {
        if (pass_ != lightnet::pass_of(block)) {
            pass_ = lightnet::pass_of(block);
            prepare_nodes(true);
        }
        auto sum = render_as_prepared(block);
        if (pixels.empty())
            pixels.swap(sum);
        else  // as Renderer adds them up
            addition_of(network_.layers)(pixels, sum);
    }
    return pixels;
}

std::vector<Rgb> SerialRun::render_as_prepared(const Tile& tile) {
    std::vector<Rgb> pixels((tile.rehearses() ? tile.pixels() : tile.told()) * network_.width_of(image_));
    const auto begun = std::chrono::steady_clock::now();
    const ScopedActivity turned(gauge_, Gauge::at(image_));
    const TellingOfLostRays telling(assembly_.keeper_of_lost_rays());
    assembly_.renderer(image_).render(tile, pixels);
    rendered_ns_ += static_cast<std::uint64_t>((std::chrono::steady_clock::now() - begun).count());
    rendered_ += tile.blocks();
    if (tracer_) tracer_->worked(tile.rehearses() ? TraceKind::prepare : TraceKind::tiles, image_, begun);
    ++counters_.tiles;
    return pixels;
}

Counters SerialRun::counters() const {
    Counters counters = counters_;
    counters.not_finite = assembly_.not_finite();
    counters.off_surface = assembly_.off_surface();
    counters.unsound_questions = assembly_.unsound_questions();
    counters.lost_rays = assembly_.lost_rays();
    counters.rays = Scene::rays_of_this_thread() - rays_before_;
    PlaceRecord record;
    record.lived_ns = static_cast<std::uint64_t>((std::chrono::steady_clock::now() - begun_).count());
    meter_.write(network_.graph, record);
    auto& image = record.nodes[network_.graph.nodes[image_].name];
    image.answered = rendered_, image.busy_ns = rendered_ns_;
    counters.places.push_back(std::move(record));
    return counters;
}

}  // namespace lightnet
