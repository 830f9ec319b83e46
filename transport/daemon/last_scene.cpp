#include "transport/daemon/last_scene.hpp"

#include <utility>

namespace lightnet {

std::shared_ptr<const Scene> LastScene::take(const SceneSource& source) {
    since_.reset();
    if (!(source == source_)) scene_.reset();
    return scene_;
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
