// Has a job rendered: in one thread, in places of this process, or on hosts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "core/run/master/coordinator.hpp"
#include "core/run/master/tiles_by_pass.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/serial/serial.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/crew.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/kept_files.hpp"
#include "tools/session/moves.hpp"
#include "tools/session/noise_of_run.hpp"
#include "tools/session/run_recorder.hpp"
#include "tools/support/signals.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet {

/// What is to be rendered. All of it outlives the rendering.
struct Assignment {
    const RunRequest& request;
    const Registry& registry;
    const Job& job;
    const FilmFormat& format;
    const KeptFiles& kept;
    const MadeFrom& made_from;
    Handover* handover = nullptr;              // between the runs of a sequence; null: this one is alone
    bool look_alone = false;                   // no more than the coarse look
    std::shared_ptr<const Network> network{};  // with which places of this process render; null: none do, or not yet
    std::shared_ptr<NetworkBeside> beside{};   // where others render: to look again; null: nobody does

    bool wants(const std::vector<Tile>& tiles) const { return !tiles.empty() && (tiles.front().coarse || !look_alone); }
};

/// This process as a host, for display.
HostState this_process(std::uint32_t places, HostFigures figures);

/// One thread's. Tiles go into the book; a signal ends it early, and so does the book's limit of time.
class Rendering {
public:
    Rendering(Assignment what, RunRecorder& book, const Signals& signals);

    /// `files`: what was read for the scene. Throws NoWorker or Error.
    void perform(LoadedScene scene, const DiskFiles& files);

private:
    std::shared_ptr<const Network> network_of(LoadedScene scene);
    void serially(LoadedScene scene);
    void in_threads(LoadedScene scene);
    void on_hosts(LoadedScene scene, const DiskFiles& files);
    void on(Crew& crew);
    void warn_of_unverified(const Plan& plan);
    void begin_anew(Crew& crew, const Failure& lie);
    std::shared_ptr<const Network> network_of_files() const;
    Cluster::Options cluster_options(const DiskFiles& files);
    /// Those who do the work.
    struct Crowd {
        std::function<void(std::size_t renderers)> look_around;  // called several times a second
        std::function<Doings()> doing;                           // while they prepare
        std::function<std::vector<HostState>()> hosts;
        std::function<bool(const std::string& host)> drain;  // none: nobody can be taken out
        std::function<void()> trust = [] {};                 // throws when somebody has lied
        std::function<void()> move = [] {};                  // nodes, where that pays; called as often as look_around
    };
    void show(const Crowd& crowd);
    void obey(const WatchCommand& wish, const Crowd& crowd);
    class Attention;
    void move_nodes(const Cluster& cluster);
    void render(SerialRun& run);
    void hand_out(Carrier& carrier, const Plan& plan, const Crowd& crowd);
    void hand_out_pass(Coordinator& coordinator, TilesByPass& passes, const Crowd& crowd, const Attention& attention);
    bool prepare(Coordinator& coordinator, const Crowd& crowd);
    ResultCache* cache();
    std::uint32_t tiles_per_place(const Plan& plan) const;
    bool ended() const { return signals_.any || book_.steps().limit().over(std::chrono::steady_clock::now()); }

    Assignment what_;
    RunRecorder& book_;
    const Signals& signals_;
    std::size_t image_;
    std::unique_ptr<ResultCache> cache_;
    std::uint64_t id_;
    std::set<std::string> liars_;  // hosts that take no part any more
    bool whole_ = false;           // each host is to hold the whole network, whatever the hosts file says
    std::optional<Moves> moves_;   // none: nodes stay where they are
};

}  // namespace lightnet
