#include "tools/session/run_scene.hpp"

#include <string>
#include <utility>

#include "core/readers/read_scene.hpp"
#include "tools/request/run_settings.hpp"
#include "tools/session/sequence_report.hpp"

namespace lightnet {

LoadedScene RunScene::load(RunRecorder& book) {
    auto again = load_again();
    LoadedScene scene = again ? *std::move(again) : read(book);
    if (handover_ && handover_->loaded) handover_->loaded();
    return scene;
}

LoadedScene RunScene::read(RunRecorder& book) {
    read_ = request_.read;
    if (!read_) {
        read_ = std::make_shared<ReadScene>();
        read_->scene = read_scene(read_->files, request_.scene, scene_constants(request_.graph, registry_));
    }
    LoadedScene scene = override_scene(request_.graph, registry_, read_->files, std::move(read_->scene));
    warn_of(scene.data, book);
    job_ = make_job(request_, registry_, format_, read_->files);
    if (handover_) handover_->hold(job_, registry_, read_);
    return scene;
}

// That of the frame before, where this one has the same.
std::optional<LoadedScene> RunScene::load_again() {
    if (!handover_ || !handover_->read()) return std::nullopt;
    read_ = handover_->read();
    job_ = make_job(request_, registry_, format_, read_->files);
    return handover_->take(job_, registry_);
}

void RunScene::warn_of(const SceneData& scene, RunRecorder& book) const {
    for (const auto& warning : scene.warnings) {
        const auto text = to_string(warning);
        if (handover_ && !handover_->is_new(text)) continue;
        if (is_of_files_outside(warning) && request_.mode == Mode::network)
            book.account().alert(text);
        else
            book.account().warn(text);
    }
}

bool RunScene::was_there(LoadedScene& scene, RunRecorder& book) const {
    if (!request_.frame) return false;
    const auto recipe = recipe_of_frame(job_);
    book.account().set("recipe", recipe);
    book.account().set("frame", std::to_string(request_.frame->number));
    if (!request_.resume || !is_there(request_.output, recipe)) return false;
    if (handover_) handover_->was_there = true;
    if (handover_) handover_->leave(scene);
    return true;
}

MadeFrom RunScene::made_from(LoadedScene& scene) const {
    auto made =
        request_.memo ? lightnet::made_from(job_, registry_, scene) : made_from_if_prepared(job_, registry_, scene);
    if (handover_ && scene.tree) handover_->hold(*scene.tree);
    return made;
}

}  // namespace lightnet
