#include "core/readers/pbrt/eye.hpp"

#include <algorithm>
#include <variant>

namespace lightnet::pbrt {

Shot Eye::camera(Statement& s, const std::string& medium) {
    Shot shot = make_camera(s.names[0], s.parameters, version_);
    s.parameters.warn_unused();
    exposure_ = shot.exposure;
    medium_ = medium;
    where_ = s.where;
    return shot;
}

void Eye::film(Statement& s, SceneData& scene) {
    const FilmShot shot = make_film(s.names[0], s.parameters, version_);
    scene.film = shot.film;
    white_ = shot.white;
    s.parameters.warn_unused();
}

void Eye::finish(SceneData& scene) const {
    scene.film.scale *= exposure_;
    take_scale_out(scene.camera);
    if (white_ == Rgb{1, 1, 1}) return;
    // light is linear, so a white balance per channel may as well be done where the light comes from
    const Rgb gain{1 / std::max(white_.r, 1e-3f), 1 / std::max(white_.g, 1e-3f), 1 / std::max(white_.b, 1e-3f)};
    for (auto& shape : scene.shapes)
        if (shape.emission) shape.emission->radiance *= gain;
    for (auto& environment : scene.environments) environment.radiance *= gain;
    for (auto& light : scene.lights) std::visit([&](auto& one) { one.strength() *= gain; }, light);
}

}  // namespace lightnet::pbrt
