// Things that the runs of a sequence leave for each other: whatever the next frame does not change.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/scene/scene.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/crew.hpp"
#include "tools/session/results_at_hand.hpp"
#include "tools/watch/watch_server.hpp"

namespace lightnet {

/// Hosts stay in the crew, local workers alive with what they hold, and the scene as it was read and built. One
/// thread's.
class Handover {
public:
    /// Of the last run; empty before it.
    std::optional<Crew>& crew() { return crew_; }
    /// Hosts that have answered falsely.
    std::set<std::string>& liars() { return liars_; }

    /// The scene was read for that job, and is kept as long as the next ones want the same.
    void hold(const Job& job, const Registry& registry, std::shared_ptr<ReadScene> read);
    /// It was built; or, where nothing was built of it, this is what there is.
    void hold(std::shared_ptr<const Scene> built) { built_ = std::move(built), before_.reset(); }
    void hold(SceneData data) { data_ = std::move(data), before_data_.reset(); }
    /// One or the other, of a scene that its run needs no more.
    void leave(LoadedScene& scene);
    /// Somebody has looked into it.
    void hold(SceneTree tree) { tree_ = std::move(tree); }

    /// The files of the scene so far; null: none.
    const std::shared_ptr<ReadScene>& read() const { return read_; }
    /// The scene as another job looks at it; none: it has to be read anew, and nothing of it is held any more. Throws
    /// UserError with what is wrong with it.
    std::optional<LoadedScene> take(const Job& job, const Registry& registry);

    /// Will take() find the scene of that job, as far as can be told without looking at it?
    bool holds_scene_of(const Job& job, const Registry& registry) const;

    /// The next job reads them anew: they have changed on the disk, or it wants others.
    void forget_files();

    /// True for what nobody has said yet.
    bool is_new(const std::string& warning) { return said_.insert(warning).second; }
    /// So far nobody has heard anything.
    void say_again() { said_.clear(); }
    /// Where its runs are watched, one after the other; null: each has a page of its own, if any.
    WatchServer* server = nullptr;
    /// What nodes of its runs have prepared, for those that prepare the same; null: each looks on the disk alone.
    std::shared_ptr<ResultsAtHand> results{};
    /// What became of the last run: its picture was there already.
    bool was_there = false;
    /// Has the files of a run written, by another thread, while the next run goes on; what it is given returns an exit
    /// code or throws. None: files are written before the run returns.
    std::function<void(std::function<int()> write)> write_beside = {};
    /// Is told when the scene of a run is read, and all that is held of it; none: nobody wants to know.
    std::function<void()> loaded = {};

private:
    std::optional<Crew> crew_;
    std::set<std::string> liars_, said_;
    std::optional<SceneSource> source_;
    std::shared_ptr<ReadScene> read_;
    std::shared_ptr<const Scene> built_, before_;  // the next will be like the latter
    std::optional<SceneData> data_, before_data_;  // without its shapes
    std::optional<SceneTree> tree_;
};

}  // namespace lightnet
