// The scene of a run, read or found where the run before has left it.
#pragma once

#include <memory>
#include <optional>

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/run_recorder.hpp"

namespace lightnet {

/// A scene as those see it who write of it.
inline const SceneData& data_of(const LoadedScene& scene) { return scene.built ? scene.built->data() : scene.data; }

/// One thread's; all that it is given outlives it.
class RunScene {
public:
    RunScene(const RunRequest& request, const Registry& registry, const FilmFormat& format, Handover* handover)
        : request_(request), registry_(registry), format_(format), handover_(handover) {}

    /// What is to be said of it goes into the book. Throws UserError or Error.
    LoadedScene load(RunRecorder& book);
    /// Of a frame that is to be gone on with: another run, or an earlier one, has done all of it.
    bool was_there(LoadedScene& scene, RunRecorder& book) const;

    /// What it is made of, for all that follows from it. Whoever comes next finds what was looked into.
    MadeFrom made_from(LoadedScene& scene) const;

    /// Once it is loaded.
    const Job& job() const { return job_; }
    const DiskFiles& files() const { return read_->files; }

private:
    LoadedScene read(RunRecorder& book);
    std::optional<LoadedScene> load_again();
    void warn_of(const SceneData& scene, RunRecorder& book) const;

    const RunRequest& request_;
    const Registry& registry_;
    const FilmFormat& format_;
    Handover* handover_;
    Job job_;
    std::shared_ptr<ReadScene> read_;  // whose data is taken away
};

}  // namespace lightnet
