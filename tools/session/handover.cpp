#include "tools/session/handover.hpp"

#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/part_edits.hpp"
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

// Changes what is not built. False: it can't be. Throws UserError, and then it is no longer what it was.
bool change(SceneData& data, const Job& job, const Registry& registry, bool other_parts) {
    const auto onlooker = another_look(job.graph, registry, data);
    if (!onlooker || (other_parts && !may_be_edited(data))) return false;
    if (other_parts) edit_again(job.graph, registry, data);
    data.camera = onlooker->camera, data.camera_given = true, data.film = onlooker->film;
    return true;
}

}  // namespace

void Handover::hold(const Job& job, const Registry& registry, std::shared_ptr<ReadScene> read) {
    forget_files();
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
    const bool same = source == *source_, other_parts = source.edits != source_->edits;
    LoadedScene scene;
    if (!holds_scene_of(job, registry)) return forget_files(), std::nullopt;
    if (built_) {
        scene.built = same ? built_ : other_parts ? edited(job, registry, *built_) : seen_by(job, registry, *built_);
        if (!scene.built) return forget_files(), std::nullopt;
        expect_sound(job, registry, scene.built->data());
        built_ = scene.built;  // also where this run ends before it renders
    } else {
        expect_sound(job, registry, *data_);
        scene.data = *std::exchange(data_, std::nullopt);
        if (!same && !change(scene.data, job, registry, other_parts)) return forget_files(), std::nullopt;
    }
    if (other_parts) tree_.reset();
    source_ = std::move(source);
    scene.tree = tree_;
    return scene;
}

bool Handover::holds_scene_of(const Job& job, const Registry& registry) const {
    if (!source_ || asks_for_all(job.graph, registry)) return false;
    const auto source = scene_source(job, registry);
    if (built_ && source.edits != source_->edits && !may_stay_beside_another(*built_)) return false;
    return source.is_but_for_edits(*source_);
}

void Handover::forget_files() {
    source_.reset();
    read_.reset();
    if (built_ && may_stay_beside_another(*built_)) before_ = built_;
    built_.reset();
    if (data_) data_->shapes.clear(), before_data_ = std::move(data_);  // its images need not be decoded again
    data_.reset();
    tree_.reset();
}

}  // namespace lightnet
