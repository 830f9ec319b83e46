// Hands out the tiles of a picture.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/run/master/cut_tiles.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/schedule/multiplexer.hpp"
#include "core/run/schedule/remote_channels.hpp"

namespace lightnet {

/// Has every tile rendered, by whichever place will finish it first, and hands the pixels on, once for each tile. What
/// would take long goes in pieces: then little is lost with a host, and nobody waits long for the last.
/// Renders nothing itself. Lives on the launcher's thread.
class MasterRenderer final : private BundleOwner<Tile> {
public:
    using Done = std::function<void(const Tile&, std::span<const Rgb>)>;

    struct Job {
        std::uint64_t run = 0;
        std::uint32_t image = 0;     // the renderer's node
        std::uint32_t width = 1;     // colours per pixel
        std::vector<Tile> tiles;     // in the order of handing out
        Credit credit{3, 3};         // of a place: more blocks of samples than bundles: quick ones go together
        bool double_tail = true;     // idle places do the last tiles once more
        bool check_answers = false;  // tiles that are done twice must have the same bits
        std::uint32_t verify = 0;    // millionths of the tiles that two hosts are asked
        /// Whether hosts answer tiles without others; else a tile that differs does not tell who is at fault.
        std::function<bool(const Plan&)> alone = [](const Plan&) { return false; };
        std::function<double()> clock = steady_seconds;
        std::function<void(const std::vector<Tile>&)> handed_out = {};  // is told, for display
    };
    MasterRenderer(Job job, Carrier& carrier, Done done);
    /// As many blocks of samples as should go together at most, for the credit of jobs.
    static constexpr std::size_t most_together = 32;

    /// From now on, these places render.
    void use(const Plan& plan);
    /// Hands out tiles and takes in pixels until all are there, or for about `most`. True when none is missing but
    /// those set aside. Throws Error when a node failed, or when a tile was done twice with different bits.
    bool work(std::chrono::nanoseconds most);
    /// More tiles, after all others. May be called while pixels are handed on.
    void append(const std::vector<Tile>& tiles);
    /// Takes in what is still under way of tiles that are done, for about `most`: copies, that are compared when
    /// checking.
    void settle(std::chrono::nanoseconds most);
    /// Hands out no more tiles.
    void drain();
    /// Tiles that are handed out and not answered.
    std::size_t outstanding() const { return replicas_.outstanding(); }
    /// Blocks of samples that are not there yet.
    std::size_t unanswered() const { return unanswered_; }
    /// Places that render now.
    std::size_t renderers() const { return replicas_.places(); }
    /// Tiles that seem to kill hosts, and on which hosts they did: one sentence each.
    const std::vector<std::string>& set_aside_tiles() const { return set_aside_; }
    const Counters& counters() const { return counters_; }

private:
    void answered(const Bundle<Tile>& bundle, std::vector<Rgb> pixels) override;
    void failed(const Bundle<Tile>& bundle, const Failure& failure) override;
    void returned(Bundle<Tile>) override {}  // a multiplexer keeps what it has taken
    void set_aside(const Bundle<Tile>& bundle, const std::string& why) override;
    struct Together {              // blocks
        std::size_t quick = 1;     // of several tiles
        std::size_t of_group = 1;  // of one
    };
    Together together() const;
    const Tile& next_tile() const;
    void pass_next_tile();
    std::vector<Tile> cut(const Tile& tile);
    std::vector<Tile> take_next();
    void note_size(const std::vector<Tile>& tiles);
    void hand_on(const Tile& tile, std::span<const Rgb> pixels);
    void show(std::vector<Tile> tiles) const;
    void hand_out();
    void take_in();

    Job job_;
    Carrier& carrier_;
    Done done_;
    Counters counters_;
    RemoteChannels<Tile> channels_;
    RemoteChannels<Tile>::Edge edge_;
    Multiplexer<Tile> replicas_;
    bool planned_ = false, draining_ = false, alone_each_ = false;
    std::size_t next_ = 0;      // tile to hand out
    std::vector<Tile> pieces_;  // to be handed out before it, the last one first
    CutTiles cut_tiles_;
    double pixels_ = 0;              // of a tile or piece that was answered lately
    std::vector<Tile> alone_;        // and before those, one by one
    std::size_t left_, unanswered_;  // blocks of samples: not handed out, not there
    std::vector<std::string> set_aside_;
    std::string error_;
};

}  // namespace lightnet
