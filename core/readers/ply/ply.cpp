#include "core/readers/ply/ply.hpp"

#include "core/readers/common/assets.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/ply/mesh.hpp"

namespace lightnet::ply {
namespace {

Mesh mesh_of(Assets& assets, const std::string& path) {
    const auto bytes = assets.read(path, {path, 0});
    assets.report().check();
    try {
        Mesh mesh = read_ply(**bytes);
        if (mesh.colours.empty())
            if (const auto faces = read_ply(**bytes, "face_color"); faces.found) paint(mesh, faces.of_triangles);
        for (const auto& what : skipped_in_ply(**bytes))
            assets.report().warn({path, 0}, what + " is left out: the picture shows nothing of it");
        return mesh;
    } catch (const Error& problem) {
        throw UserError({path, 0}, problem.what());
    }
}

SceneData read(Files& files, const std::string& path, const SceneConstants&) {
    return read_by_assets(files, path, [&](Assets& assets) {
        Mesh mesh = mesh_of(assets, path);
        if (mesh.triangles.empty()) throw UserError({path, 0}, "there are no faces");
        if (!mesh.normals.empty()) order_by_normals(mesh);
        const TextureId colour =
            mesh.colours.empty() ? assets.grey(0.5f) : assets.add({{1, 1, 1}, VertexColour{}, false});
        const MaterialId matt = assets.add(Material{"", DiffuseMaterial{colour}});
        assets.scene().shapes.push_back({std::move(mesh), matt, {}, {path, 0}, stem_of(path)});
    });
}

}  // namespace

SceneFormat format() { return {.endings = {".ply"}, .read = read}; }

}  // namespace lightnet::ply
