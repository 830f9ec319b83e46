#include "core/readers/gltf/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/readers/mesh_tools.hpp"

namespace lightnet::gltf {
namespace {

enum Mode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };

/// Corners → triangles.
std::vector<std::array<std::uint32_t, 3>> cut(const std::vector<std::uint32_t>& corners, std::uint64_t mode) {
    std::vector<std::array<std::uint32_t, 3>> result;
    const std::size_t n = corners.size();
    for (std::size_t i = 2; i < n; i += mode == triangles ? 3 : 1) {
        const std::size_t j = i - 2;
        if (mode == fan)
            result.push_back({corners[i - 1], corners[i], corners[0]});
        else if (mode == strip && j % 2)
            result.push_back({corners[j], corners[j + 2], corners[j + 1]});
        else
            result.push_back({corners[j], corners[j + 1], corners[j + 2]});
    }
    return result;
}

class Reader {
public:
    Reader(const At& at, Document& document) : at_(at), document_(document) {}

    /// Positions, normals, colours and triangles. None: reported, or without a surface.
    std::optional<Mesh> read() {
        const auto mode = at_["mode"].whole(triangles);
        if (mode < triangles || mode > fan) {
            at_.warn(mode < triangles ? "points and lines have no surface and are left out"
                                      : "primitives of an unknown mode are left out");
            return std::nullopt;
        }
        const At attributes = at_["attributes"];
        if (at_["targets"].size()) at_.warn("morph targets are left out");
        if (attributes["JOINTS_0"]) at_.warn("skins are left out: meshes stand as they were made");
        auto positions = vectors<Vec3>(attributes["POSITION"], 3);
        if (!positions || positions->empty()) {
            if (!attributes["POSITION"]) at_.error("has no POSITION");
            return std::nullopt;
        }
        mesh_.positions = *std::move(positions);
        if (auto normals = vectors<Vec3>(attributes["NORMAL"], 3)) mesh_.normals = *std::move(normals);
        colours(attributes["COLOR_0"]);
        if (!corners(mode) || !sound()) return std::nullopt;
        return std::move(mesh_);
    }

    std::vector<Vec2> uvs(std::size_t set) {
        const At at = at_["attributes"][fmt::format("TEXCOORD_{}", set)];
        auto found = at ? vectors<Vec2>(at, 2) : std::nullopt;
        if (!found) return {};
        for (auto& uv : *found) uv.y = 1 - uv.y;  // glTF counts from the top
        return *std::move(found);
    }

private:
    template <class Vector>
    std::optional<std::vector<Vector>> vectors(const At& at, std::size_t width) {
        if (!at) return std::nullopt;
        const auto values = document_.values(at);
        if (!values) return std::nullopt;
        if (values->width != width || (!mesh_.positions.empty() && values->count() != mesh_.positions.size())) {
            at.error(fmt::format("must name {} vectors of {} numbers", mesh_.positions.size(), width));
            return std::nullopt;
        }
        std::vector<Vector> result(values->count());
        for (std::size_t i = 0; i < result.size(); ++i) {
            const float* v = &values->numbers[i * width];
            if constexpr (std::is_same_v<Vector, Vec3>)
                result[i] = {v[0], v[1], v[2]};
            else
                result[i] = {v[0], v[1]};
        }
        return result;
    }

    void colours(const At& at) {
        const auto values = at ? document_.values(at) : std::nullopt;
        if (!values) return;
        if (values->width < 3 || values->count() != mesh_.positions.size())
            return at.error("must name a colour for each vertex");
        for (std::size_t i = 0; i < values->count(); ++i) {
            const float* v = &values->numbers[i * values->width];
            mesh_.colours.push_back({v[0], v[1], v[2]});
        }
    }

    bool corners(std::uint64_t mode) {
        std::vector<std::uint32_t> list;
        if (at_["indices"]) {
            auto given = document_.indices(at_["indices"]);
            if (!given) return false;
            list = *std::move(given);
        } else {
            for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) list.push_back(i);
        }
        if (mode == triangles && list.size() % 3) at_.warn("the corners behind the last whole triangle are left out");
        mesh_.triangles = cut(list, mode);
        return true;
    }

    bool sound() {
        for (const auto& t : mesh_.triangles)
            for (const auto corner : t)
                if (corner >= mesh_.positions.size()) {
                    at_["indices"].error(fmt::format("has the vertex index {}, but there are {} vertices", corner,
                                                     mesh_.positions.size()));
                    return false;
                }
        for (const Vec3 p : mesh_.positions)
            if (!finite(p)) {
                at_.error("has a position that is not finite");
                return false;
            }
        return !mesh_.triangles.empty();
    }

    const At& at_;
    Document& document_;
    Mesh mesh_;
};

}  // namespace

std::vector<Primitive> read_mesh(const At& at, Document& document, Materials& materials) {
    std::vector<Primitive> found;
    const At primitives = at["primitives"];
    for (std::size_t i = 0; i < primitives.size() && !at.report().full(); ++i) {
        const At primitive = primitives[i];
        Reader reader(primitive, document);
        auto mesh = reader.read();
        if (!mesh) continue;
        const Surface& surface = materials.of(primitive["material"], !mesh->colours.empty());
        mesh->uvs = reader.uvs(surface.uv_set);
        if (mesh->uvs.size() != mesh->positions.size()) mesh->uvs = {};
        if (!mesh->normals.empty()) order_by_normals(*mesh);  // without any, glTF wants flat ones
        found.push_back({*std::move(mesh), surface.material, surface.emission});
    }
    return found;
}

}  // namespace lightnet::gltf
