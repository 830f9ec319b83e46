#include "core/readers/read_scene.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/readers/gltf/gltf.hpp"
#include "core/readers/mitsuba/mitsuba.hpp"
#include "core/readers/obj/obj.hpp"
#include "core/readers/pbrt/pbrt.hpp"
#include "core/readers/ply.hpp"

namespace lightnet {
namespace {

/// Files of one scene, and the first that lies elsewhere.
class Watched final : public Files {
public:
    Watched(Files& files, const std::string& scene) : files_(files), scene_(scene) {}
    Bytes read(const std::string& path) override {
        auto bytes = files_.read(path);
        if (outside_.empty() && path != scene_ && !stays_beside(files_, scene_, path)) outside_ = path;
        return bytes;
    }
    std::string real_path(const std::string& path) const override { return files_.real_path(path); }
    /// "": all of them are where the scene is, or below.
    const std::string& outside() const { return outside_; }

private:
    Files& files_;
    const std::string& scene_;
    std::string outside_;
};

std::string ending_of(const std::string& path) {
    std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return ending;
}

SceneData read(Files& files, const std::string& path, const std::map<std::string, std::string>& constants) {
    const std::string ending = ending_of(path);
    if (ending == ".xml") return mitsuba::read(files, path, constants);
    if (!constants.empty())
        throw UserError({path, 0}, "only Mitsuba's scenes ('.xml') have variables: there is no '" +
                                       constants.begin()->first + "' to define");
    if (ending == ".pbrt") return pbrt::read(files, path);
    if (ending == ".gltf" || ending == ".glb") return gltf::read(files, path);
    if (ending == ".obj") return obj::read(files, path);
    if (ending == ".ply") return read_ply_scene(files, path);
    throw UserError({path, 0}, "a scene must be a '.pbrt', '.xml' (Mitsuba), '.gltf', '.glb', '.obj' or '.ply' file");
}

}  // namespace

bool is_named_like_a_scene(const std::string& path) {
    constexpr std::array endings{".pbrt", ".xml", ".gltf", ".glb", ".obj", ".ply"};
    return std::find(endings.begin(), endings.end(), ending_of(path)) != endings.end();
}

SceneData read_scene(Files& files, const std::string& path, const std::map<std::string, std::string>& constants) {
    Watched watched(files, path);
    SceneData scene = read(watched, path, constants);
    if (!watched.outside().empty())
        scene.warnings.push_back(
            {{path, 0},
             "reads files outside of its folder, such as '" + watched.outside() + "': hosts are sent them as well"});
    return scene;
}

}  // namespace lightnet
