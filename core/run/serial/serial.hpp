// The whole network in one thread: function calls and nothing else, so that a debugger shows the whole way of a
// question.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/direct_port.hpp"
#include "core/run/assembly/edge_meter.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/assembly/prepare_progress.hpp"
#include "core/run/message/counters.hpp"

namespace lightnet {

/// Renders tiles one after the other on the caller's thread. Opens no socket and makes no fiber.
class SerialRun {
public:
    /// `pause` is called often; it may throw to end the work. `keeper`: of what is
    /// asked; null: nobody is.
    explicit SerialRun(const Network& network, std::function<void()> pause = {}, AccountKeeper* keeper = nullptr);

    /// Has all nodes that prepare do so. Before the first tile, which belongs to pass `pass`. Results are looked for in
    /// `cache`, and kept there; lines for the user go to `say`.
    void prepare(const MadeFrom& made_from, ResultCache* cache = nullptr,
                 std::function<void(const std::string&)> say = {}, std::uint32_t pass = 0);
    /// Tells `tracer` from now on what it is busy with.
    void trace(PlaceTracer& tracer) {
        tracer_ = &tracer;
        meter_.trace(&tracer);
    }
    /// Is told how far preparing is, from now on.
    void watch(std::function<void(const PrepareProgress&)> watcher) { watcher_ = std::move(watcher); }
    /// The result of a node's last call while it prepared; null: it made none.
    Bytes last_result(std::size_t node) const;
    /// All samples of the tile: see Renderer::render. Where nodes learn anew for each pass, they are prepared for that
    /// of the tile; passes should come one after the other.
    std::vector<Rgb> render(const Tile& tile);
    Counters counters() const;
    /// What it is at, for other threads to look at.
    const Gauge& gauge() const { return gauge_; }

private:
    class Preparing;

    void step(std::uint64_t done, std::uint64_t total);
    std::uint32_t pass_of(std::size_t node) const;
    void prepare_nodes(bool again);
    std::vector<Rgb> render_as_prepared(const Tile& tile);

    const Network& network_;
    std::function<void()> pause_;
    std::function<void(const PrepareProgress&)> watcher_;
    PrepareProgress progress_;
    std::size_t image_;
    Counters counters_;
    std::uint64_t rays_before_;
    std::vector<std::unique_ptr<DirectPort>> ports_;
    std::map<std::size_t, Bytes> last_results_;
    MadeFrom made_from_;
    ResultCache* cache_ = nullptr;
    std::function<void(const std::string&)> say_;
    std::uint32_t pass_ = 0;
    NoLocks locks_;
    std::uint64_t rendered_ = 0, rendered_ns_ = 0;  // blocks, and how long that took
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    Gauge gauge_;
    EdgeMeter meter_;
    PlaceTracer* tracer_ = nullptr;
    Assembly assembly_;
};

}  // namespace lightnet
