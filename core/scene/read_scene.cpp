#include "core/scene/read_scene.hpp"

#include "core/scene/pbrt/pbrt.hpp"

namespace lightnet {

SceneData read_scene(Files& files, const std::string& path) {
    if (path.ends_with(".pbrt")) return pbrt::read(files, path);
    throw UserError({path, 0}, "a scene must be a '.pbrt' file");
}

}  // namespace lightnet
