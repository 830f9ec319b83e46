#include "core/readers/assets.hpp"
#include "core/readers/files.hpp"
#include "core/readers/mesh_tools.hpp"
#include "core/readers/ply.hpp"

namespace lightnet {

SceneData read_ply_scene(Files& files, const std::string& path) {
    Report report;
    SceneData scene;
    Assets assets(files, report, scene);
    const auto bytes = assets.read(path, {path, 0});
    report.check();
    Mesh mesh;
    try {
        mesh = read_ply(**bytes);
    } catch (const Error& problem) {
        throw UserError({path, 0}, problem.what());
    }
    if (mesh.triangles.empty()) throw UserError({path, 0}, "there are no faces");
    if (!mesh.normals.empty()) order_by_normals(mesh);
    const TextureId colour = mesh.colours.empty() ? assets.grey(0.5f) : assets.add({{1, 1, 1}, VertexColour{}, false});
    const MaterialId matt = assets.add(Material{"", DiffuseMaterial{colour}});
    scene.shapes.push_back({std::move(mesh), matt, {}, {path, 0}, stem_of(path)});
    light_the_dark(scene, report, path);
    scene.warnings = report.warnings();
    return scene;
}

}  // namespace lightnet
