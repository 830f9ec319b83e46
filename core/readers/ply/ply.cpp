#include "core/readers/ply/ply.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/readers/common/assets.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/ply/mesh.hpp"

namespace lightnet::ply {
namespace {

/// A mesh, and the picture that it wears.
struct Worn {
    Mesh mesh;
    std::string picture{};  // "": none
};

Worn read_worn(Assets& assets, const std::string& path) {
    const auto bytes = assets.read(path, {path, 0});
    assets.report().check();
    try {
        Mesh mesh = read_ply(**bytes);
        if (mesh.colours.empty())
            if (const auto faces = read_ply(**bytes, "face_color"); faces.found) paint(mesh, faces.of_triangles);
        std::string picture = texture_of_ply(**bytes);
        if (!picture.empty() && mesh.uvs.empty()) {
            assets.report().warn({path, 0}, fmt::format("the texture '{}' is left out: no vertex says where it lies",
                                                        std::exchange(picture, "").substr(0, 64)));
        }
        for (const auto& what : skipped_in_ply(**bytes))
            assets.report().warn({path, 0}, what + " is left out: the picture shows nothing of it");
        return {std::move(mesh), std::move(picture)};
    } catch (const Error& problem) {
        throw UserError({path, 0}, problem.what());
    }
}

/// The picture counts before colours of vertices, which then often are a poorer copy of it.
TextureId colour_of(const Mesh& mesh, const std::string& picture, Assets& assets, const std::string& path) {
    if (!picture.empty()) {
        ImageTexture worn;
        worn.image = assets.picture(beside(path, picture), {}, {path, 0});
        return assets.add({{1, 1, 1}, worn, false});
    }
    return mesh.colours.empty() ? assets.grey(0.5f) : assets.add({{1, 1, 1}, VertexColour{}, false});
}

SceneData read(Files& files, const std::string& path, const SceneConstants&) {
    return read_by_assets(files, path, [&](Assets& assets) {
        auto [mesh, picture] = read_worn(assets, path);
        if (mesh.triangles.empty()) throw UserError({path, 0}, "there are no faces");
        if (!mesh.normals.empty()) order_by_normals(mesh);
        const TextureId colour = colour_of(mesh, picture, assets, path);
        const MaterialId matt = assets.add(Material{"", DiffuseMaterial{colour}});
        assets.scene().shapes.push_back({std::move(mesh), matt, {}, {path, 0}, stem_of(path)});
    });
}

}  // namespace

SceneFormat format() { return {.endings = {".ply"}, .read = read}; }

}  // namespace lightnet::ply
