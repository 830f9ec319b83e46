#include "core/run/assembly/last_scene.hpp"

#include <utility>

namespace lightnet {

std::shared_ptr<const Scene> LastScene::take(const SceneSource& source, const Look& look) {
    since_.reset();
    if (!scene_ || source == source_) return scene_;
    auto other = look && source.is_but_for_sight(source_) ? look(*scene_) : nullptr;
    if (!other) scene_.reset();
    return other;
}

void LastScene::hold(SceneSource source, std::shared_ptr<const Scene> scene) {
    source_ = std::move(source);
    scene_ = std::move(scene);
    since_.reset();
}

void LastScene::wait(Time now) {
    if (!since_) since_ = now;
    if (now - *since_ >= stays) scene_.reset();
}

}  // namespace lightnet
