#include "core/estimate/photon_time.hpp"

#include "core/base/query.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

PhotonWindow window_of(const Scene& scene, const Query& question, float width) {
    if (!scene.moves() || question.is_in_space() || !scene.moves(scene.hit(question))) return {};
    return PhotonWindow::around(PhotonTime::instant_of(question.time), width);
}

}  // namespace lightnet
