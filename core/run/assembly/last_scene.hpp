// The scene of the run before, for the next one.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "core/run/assembly/job.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Is there memory for it and for another like it? What both have in common, the other then takes from it.
bool may_stay_beside_another(const Scene& scene);

/// Holds the scene that a host has built last: through its run, and for a while afterwards. Used by one thread.
/// DECISIONS: last-scene-stays
class LastScene {
public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr auto stays = std::chrono::minutes(5);

    /// The scene looked at otherwise, or with other lamps and materials as well (`edited`); null: it has to be built
    /// anew.
    using Look = std::function<std::shared_ptr<const Scene>(const Scene&, bool edited)>;
    /// The scene, if it was built from that, or, by `look`, from that but for the camera and such edits; else it is
    /// dropped, as two may not fit into memory. A small one stays until the next is there, where that comes from the
    /// same file, edited.
    std::shared_ptr<const Scene> take(const SceneSource& source, const Look& look = {});
    void hold(SceneSource source, std::shared_ptr<const Scene> scene);
    /// No run needs it now. To be called again and again: what is held too long is dropped.
    void wait(Time now);

private:
    SceneSource source_;
    std::shared_ptr<const Scene> scene_;
    std::shared_ptr<const Scene> before_{};  // the next will be like it
    std::optional<Time> since_;              // when it began to wait
};

}  // namespace lightnet
