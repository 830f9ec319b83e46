// The scenes of a sequence's frames: which of them differ, and the next one read while a frame is rendered.
#pragma once

#include <future>
#include <map>
#include <string>
#include <utility>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/handover.hpp"
#include "tools/support/signals.hpp"

namespace lightnet {

/// Does a scene move? It does where its file holds animations.
class Motion {
public:
    explicit Motion(const Registry& registry) : registry_(registry) {}

    /// Takes times out of what is asked for where nothing hangs on them, so that all frames ask for the same. May read
    /// the scene, which then stays in the request.
    void settle(RunRequest& request);
    /// That takes no reading.
    bool is_known(const RunRequest& request) const;

private:
    using Key = std::pair<std::string, SceneConstants>;
    Key key_of(const RunRequest& request, const Node& scene) const;
    bool moves(RunRequest& request, const Node& scene);

    const Registry& registry_;
    std::map<Key, bool> known_;
};

/// Belongs to one thread, and reads in another, one scene at a time.
class FrameScenes {
public:
    /// `signals` end what is being read.
    FrameScenes(const Registry& registry, const Signals& signals)
        : registry_(registry), signals_(signals), motion_(registry) {}

    /// Before the run of that frame: its scene is there then if it was to be read ahead, and times are settled. Throws
    /// what reading has thrown.
    void settle(RunRequest& request);
    /// Reads that of the frame which comes next, unless `handover` holds it, or memory is short. The request stays
    /// where it is until it is settled.
    void read_ahead(RunRequest& next, const Handover& handover);

private:
    bool is_held(const RunRequest& next, const Handover& handover) const;

    const Registry& registry_;
    const Signals& signals_;
    Motion motion_;
    std::future<void> reading_;  // the first to go: waits for its end
};

}  // namespace lightnet
