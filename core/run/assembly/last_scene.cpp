#include "core/run/assembly/last_scene.hpp"

#include <utility>

#include "core/base/this_machine.hpp"

namespace lightnet {

bool may_stay_beside_another(const Scene& scene) {
    constexpr std::uint64_t share = 8;
    const SceneSize size = scene.size();
    return size.shape_bytes + size.tree_bytes + size.texture_bytes + size.light_bytes < machine_memory() / share;
}

std::shared_ptr<const Scene> LastScene::take(const SceneSource& source, const Look& look) {
    since_.reset();
    if (!scene_ || source == source_) return scene_;
    const bool edited = source.edits != source_.edits;
    const bool like = look && source.is_but_for_edits(source_) && (!edited || may_stay_beside_another(*scene_));
    auto other = like ? look(*scene_, edited) : nullptr;
    if (!other && source.scene == source_.scene && may_stay_beside_another(*scene_)) before_ = scene_;
    if (!other) scene_.reset();
    return other;
}

void LastScene::hold(SceneSource source, std::shared_ptr<const Scene> scene) {
    source_ = std::move(source);
    scene_ = std::move(scene);
    before_.reset();
    since_.reset();
}

void LastScene::wait(Time now) {
    if (!since_) since_ = now;
    if (now - *since_ >= stays) scene_.reset(), before_.reset();
}

}  // namespace lightnet
