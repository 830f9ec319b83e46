#include "tools/session/handover.hpp"

#include <utility>
#include <vector>

#include "core/run/assembly/kept.hpp"
#include "core/run/assembly/last_scene.hpp"

namespace lightnet {
namespace {

// Those that ask for the scene as it was read.
bool asks_for_all(const Graph& graph, const Registry& registry) {
    return goes_on_from_kept(graph, registry) || !files_to_keep(graph, registry).empty();
}

void expect_sound(const Job& job, const Registry& registry, const SceneData& scene) {
    std::vector<Problem> problems;
    find_mistakes(job.graph, registry, scene, problems);
    if (!problems.empty()) throw UserError(std::move(problems));
}

}  // namespace

void Handover::hold(const Job& job, const Registry& registry, std::shared_ptr<ReadScene> read) {
    drop();
    source_ = scene_source(job, registry);
    read_ = std::move(read);
}

void Handover::leave(LoadedScene& scene) {
    if (scene.built)
        hold(scene.built);
    else
        hold(std::move(scene.data));
}

std::optional<LoadedScene> Handover::take(const Job& job, const Registry& registry) {
    if (!source_ || (!built_ && !data_)) return std::nullopt;
    auto source = scene_source(job, registry);
    const bool same = source == *source_;
    LoadedScene scene;
    if (!holds_scene_of(job, registry)) return drop(), std::nullopt;
    expect_sound(job, registry, built_ ? built_->data() : *data_);
    if (built_) {
        scene.built = same ? built_ : seen_by(job, registry, *built_);
        if (!scene.built) return drop(), std::nullopt;
    } else {
        if (const auto onlooker = same ? std::nullopt : another_look(job.graph, registry, *data_))
            data_->camera = onlooker->camera, data_->camera_given = true, data_->film = onlooker->film;
        else if (!same)
            return drop(), std::nullopt;
        scene.data = *std::exchange(data_, std::nullopt);
    }
    source_ = std::move(source);
    scene.tree = tree_;
    return scene;
}

bool Handover::holds_scene_of(const Job& job, const Registry& registry) const {
    return source_ && scene_source(job, registry).is_but_for_sight(*source_) && !asks_for_all(job.graph, registry);
}

void Handover::drop() {
    source_.reset();
    read_.reset();
    if (built_ && may_stay_beside_another(*built_)) before_ = built_;
    built_.reset();
    if (data_) data_->shapes.clear(), before_data_ = std::move(data_);  // its images need not be decoded again
    data_.reset();
    tree_.reset();
}

}  // namespace lightnet
