// The whole network in one thread: function calls and nothing else, so that a debugger shows the whole way of a
// question.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/run/message/counters.hpp"
#include "core/run/prepare/assembly.hpp"
#include "core/run/prepare/direct_port.hpp"
#include "core/run/prepare/prepare_progress.hpp"

namespace lightnet {

/// Renders tiles one after the other on the caller's thread. Opens no socket and makes no fiber.
class SerialRun {
public:
    /// `pause` is called often; it may throw to end the work.
    explicit SerialRun(const Network& network, std::function<void()> pause = {});

    /// Has all nodes that prepare do so. Before the first tile. Results are looked for in `cache`, and kept there;
    /// lines for the user go to `say`.
    void prepare(const std::string& made_from, ResultCache* cache = nullptr,
                 const std::function<void(const std::string&)>& say = {});
    /// Is told how far preparing is, from now on.
    void watch(std::function<void(const PrepareProgress&)> watcher) { watcher_ = std::move(watcher); }
    /// The result of a node's last call while it prepared; null: it made none.
    Bytes last_result(std::size_t node) const;
    /// All samples of the tile's block: see Renderer::render.
    std::vector<Rgb> render(const Tile& tile);
    Counters counters() const;

private:
    class Preparing;

    void step(std::uint64_t done, std::uint64_t total);

    const Network& network_;
    std::function<void()> pause_;
    std::function<void(const PrepareProgress&)> watcher_;
    PrepareProgress progress_;
    std::size_t image_;
    Counters counters_;
    std::uint64_t rays_before_;
    std::vector<std::unique_ptr<DirectPort>> ports_;
    std::map<std::size_t, Bytes> last_results_;
    NoLocks locks_;
    Assembly assembly_;
};

}  // namespace lightnet
