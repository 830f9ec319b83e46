#include "core/run/runtime/serial.hpp"

#include "core/network/light/services.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// One node's services, in a run of one thread: loops.
class SerialRun::Preparing final : public Services {
public:
    using Say = std::function<void(const std::string&)>;

    Preparing(SerialRun& run, std::size_t node, const Recipes& recipes, ResultCache* cache, const Say& say)
        : run_(run), node_(node), recipes_(recipes), cache_(cache), say_(say) {}

    std::vector<Query> rehearse(std::uint32_t stride) override {
        rehearsed_ = true;
        const auto result = recall([&] {
            const auto& network = run_.network_;
            run_.assembly_.rehearsal(node_).begin();
            const auto tiles = rehearsal_tiles(network.graph, network.registry, stride);
            for (std::size_t i = 0; i < tiles.size(); ++i) {
                run_.step(i, tiles.size());
                run_.render(tiles[i]);
            }
            return rehearsal_result(run_.assembly_.rehearsal(node_).end());
        });
        const Mapped<Query> noted(result);
        return {noted.begin(), noted.end()};
    }
    Whereabouts whereabouts() const override { return {"this thread", 1}; }
    void say(const std::string& text) override {
        if (say_) say_(run_.network_.graph.nodes[node_].name + ": " + text);
    }

protected:
    Bytes map_bytes(std::size_t count, const Shard& work) override {
        return recall([&] {
            std::vector<std::vector<std::byte>> shards(count);
            for (std::size_t i = 0; i < count; ++i) {
                if (run_.pause_) run_.pause_();
                run_.step(i, count);
                work(i, shards[i]);
            }
            return join_shards(shards);
        });
    }
    std::shared_ptr<const void> once_any(const std::function<std::shared_ptr<const void>()>& make) override {
        return make();
    }

private:
    template <class Make>
    Bytes recall(const Make& make) {
        return run_.last_results_[node_] = found_or(make);
    }

    template <class Make>
    Bytes found_or(const Make& make) {
        const Hash recipe = recipes_.of(node_, call_++, rehearsed_);
        if (cache_)
            if (auto known = cache_->find(recipe).bytes) return known;
        auto made = make();
        if (cache_) cache_->keep(recipe, {content_hash(*made), made});
        return made;
    }

    SerialRun& run_;
    std::size_t node_;
    const Recipes& recipes_;
    ResultCache* cache_;
    const Say& say_;
    std::uint32_t call_ = 0;
    bool rehearsed_ = false;
};

SerialRun::SerialRun(const Network& network, std::function<void()> pause)
    : network_(network),
      pause_(std::move(pause)),
      image_(renderer_of(network.graph, network.registry)),
      rays_before_(Scene::rays_of_this_thread()),
      assembly_(
          network,
          [this](std::size_t node, std::size_t width) {
              const auto called = assembly_.callee(node);
              return ports_.emplace_back(std::make_unique<DirectPort>(called, width, counters_.local_questions, pause_))
                  .get();
          },
          locks_) {
    assembly_.renderer(image_);
}

void SerialRun::prepare(const std::string& made_from, ResultCache* cache,
                        const std::function<void(const std::string&)>& say) {
    const Recipes recipes(network_.graph, made_from);
    const auto nodes = preparing_nodes(network_.graph, network_.registry);
    progress_.nodes = nodes.size();
    for (const auto node : nodes) {
        progress_.node = network_.graph.nodes[node].name;
        ++progress_.position;
        step(0, 0);
        Preparing services(*this, node, recipes, cache, say);
        assembly_.prepare(node, services);
    }
    counters_.tiles = 0;  // those of rehearsals make no picture
}

void SerialRun::step(std::uint64_t done, std::uint64_t total) {
    progress_.done = done, progress_.total = total;
    if (watcher_) watcher_(progress_);
}

Bytes SerialRun::last_result(std::size_t node) const {
    const auto found = last_results_.find(node);
    return found == last_results_.end() ? nullptr : found->second;
}

std::vector<Rgb> SerialRun::render(const Tile& tile) {
    std::vector<Rgb> pixels(tile.pixels() * network_.width_of(image_));
    assembly_.renderer(image_).render(tile, pixels);
    ++counters_.tiles;
    return pixels;
}

Counters SerialRun::counters() const {
    Counters counters = counters_;
    counters.not_finite = assembly_.not_finite();
    counters.rays = Scene::rays_of_this_thread() - rays_before_;
    return counters;
}

}  // namespace lightnet
