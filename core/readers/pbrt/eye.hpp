// The camera and the film of a pbrt file.
#pragma once

#include <string>

#include "core/base/math/rgb.hpp"
#include "core/readers/pbrt/camera.hpp"
#include "core/readers/pbrt/syntax.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// What they say beside the camera and the film of a scene, and that holds for all of it.
class Eye {
public:
    explicit Eye(Version version) : version_(version) {}

    /// A camera that stands somewhere, inside of a medium.
    Shot camera(Statement& statement, const std::string& medium);
    void film(Statement& statement, SceneData& scene);
    /// Takes exposure and white balance into the scene. Once, at the end.
    void finish(SceneData& scene) const;

    /// Name of the camera's medium, and the place in the file where it is said.
    const std::string& medium() const { return medium_; }
    const SourceLine& where() const { return where_; }

private:
    Version version_;
    float exposure_ = 1;
    Rgb white_{1, 1, 1};
    std::string medium_;
    SourceLine where_;
};

}  // namespace lightnet::pbrt
