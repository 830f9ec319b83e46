// Hands out the tiles of a picture.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/runtime/carrier.hpp"
#include "core/runtime/multiplexer.hpp"
#include "core/runtime/remote_channel.hpp"

namespace lightnet {

/// Has every tile rendered once, by whichever place will finish it first, and hands the pixels on. Renders nothing
/// itself. Lives on the launcher's thread.
class MasterRenderer final : public BundleOwner<Tile> {
public:
    using Done = std::function<void(const Tile&, std::span<const Rgb>)>;

    struct Job {
        std::uint64_t run = 0;
        std::uint32_t image = 0;  // the renderer's node
        std::uint32_t width = 1;  // colours per pixel
        std::vector<Tile> tiles;  // in the order of handing out
        Credit credit{3, 3};      // tiles in flight per place
    };
    MasterRenderer(Job job, Carrier& carrier, Done done);

    /// From now on, these places render.
    void use(const Plan& plan);
    /// Hands out tiles and takes in pixels until all are there, or for about `most`. True when all are there. Throws
    /// Error when a node failed.
    bool work(std::chrono::nanoseconds most);
    /// More tiles, after all others. May be called while pixels are handed on.
    void append(const std::vector<Tile>& tiles);
    /// Hands out no more tiles.
    void drain() { next_ = job_.tiles.size(), again_.clear(), draining_ = true; }
    /// Tiles that are handed out and not answered.
    std::size_t outstanding() const { return replicas_.outstanding(); }
    /// Places that render now.
    std::size_t renderers() const { return replicas_.size(); }
    const Counters& counters() const { return counters_; }

    void answered(const Bundle<Tile>& bundle, std::vector<Rgb> pixels) override;
    void failed(const Bundle<Tile>& bundle, const std::string& why) override;
    void returned(Bundle<Tile> bundle) override {
        if (!draining_) again_.push_back(std::move(bundle));
    }

private:
    void hand_out();

    Job job_;
    Carrier& carrier_;
    Done done_;
    Counters counters_;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> places_;  // → index in channels_
    std::vector<std::unique_ptr<RemoteChannel<Tile>>> channels_;
    Multiplexer<Tile> replicas_;
    std::deque<Bundle<Tile>> again_;  // came back unanswered
    std::size_t next_ = 0;            // tile to hand out
    std::size_t unanswered_;
    bool draining_ = false;
    std::string error_;
};

}  // namespace lightnet
