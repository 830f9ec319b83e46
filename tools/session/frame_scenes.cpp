#include "tools/session/frame_scenes.hpp"

#include <memory>
#include <variant>

#include "core/base/allowance.hpp"
#include "core/base/own_process.hpp"
#include "core/base/spare_threads.hpp"
#include "core/base/unwanted.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "tools/request/run_settings.hpp"

namespace lightnet {
namespace {

void read(RunRequest& request, const SceneConstants& constants) {
    auto read = std::make_shared<ReadScene>();
    read->scene = read_scene(read->files, request.scene, constants);
    request.read = std::move(read);
}

// Two scenes are held while one is read ahead.
bool memory_is_short() {
    const auto usable = usable_memory();
    return usable && process_figures().resident > usable / 3;
}

bool may_move(const RunRequest& request, const Node& scene) {
    const auto* format = scene_format_of(request.scene);
    return scene.params.contains("time") && format && format->moves;
}

}  // namespace

Motion::Key Motion::key_of(const RunRequest& request, const Node& scene) const {
    auto constants = scene_constants(request.graph, scene);
    for (const auto name : {time_constant, previous_constant, next_constant}) constants.erase(std::string(name));
    return {request.scene, std::move(constants)};
}

bool Motion::is_known(const RunRequest& request) const {
    const Node& scene = scene_of(request.graph, registry_);
    return !may_move(request, scene) || known_.contains(key_of(request, scene));
}

void Motion::settle(RunRequest& request) {
    Node& scene = request.graph.nodes[request.graph.find(scene_of(request.graph, registry_).name).value()];
    if (!scene.params.contains("time") || moves(request, scene)) return;
    scene.params.erase("time");
    for (const char* frame : {"previous", "next"})
        if (const auto beside = scene.params.find(frame); beside != scene.params.end())
            if (!std::get<Table>(beside->second.data).named.contains("file")) scene.params.erase(beside);
}

bool Motion::moves(RunRequest& request, const Node& scene) {
    if (!may_move(request, scene)) return false;
    const auto [known, fresh] = known_.try_emplace(key_of(request, scene), false);
    if (!fresh) return known->second;
    if (!request.read) read(request, scene_constants(request.graph, scene));  // it is at this time already
    return known->second = !request.read->scene.animations.empty();
}

void FrameScenes::settle(RunRequest& request) {
    try {
        if (reading_.valid()) reading_.get();
    } catch (const Cancelled&) {  // the run ends anyhow
    }
    motion_.settle(request);
}

void FrameScenes::read_ahead(RunRequest& next, const Handover& handover) {
    const bool known = motion_.is_known(next);
    if (known) motion_.settle(next);
    if (next.read || (known && is_held(next, handover)) || memory_is_short()) return;
    reading_ = in_background([this, &next] {
        const LookingAt looking(&signals_.any);
        motion_.settle(next);
        if (!next.read) read(next, scene_constants(next.graph, registry_));
    });
}

bool FrameScenes::is_held(const RunRequest& next, const Handover& handover) const {
    if (!handover.read()) return false;
    return handover.holds_scene_of(make_job(next, registry_, film_format(next, registry_), handover.read()->files),
                                   registry_);
}

}  // namespace lightnet
