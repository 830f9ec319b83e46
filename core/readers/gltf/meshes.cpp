#include "core/readers/gltf/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/gltf/draco.hpp"

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
    Reader(const At& at, const Moved& moved, Document& document) : at_(at), moved_(moved), document_(document) {}

    /// Positions, normals, colours and triangles. None: reported, or without a surface.
    std::optional<Mesh> read() {
        const auto mode = at_["mode"].whole(triangles);
        if (mode < triangles || mode > fan) {
            at_.warn(mode < triangles ? "points and lines have no surface and are left out"
                                      : "primitives of an unknown mode are left out");
            return std::nullopt;
        }
        const At attributes = at_["attributes"];
        if (packed() && !unpack()) return std::nullopt;
        auto positions = vectors<Vec3>("POSITION", 3);
        if (!positions || positions->empty()) {
            if (!attributes["POSITION"]) at_.error("has no POSITION");
            return std::nullopt;
        }
        mesh_.positions = *std::move(positions);
        if (auto normals = vectors<Vec3>("NORMAL", 3)) mesh_.normals = *std::move(normals);
        if (!moved_.weights.empty())
            for (Vec3& n : mesh_.normals) n = length_squared(n) > 0 ? normalize(n) : n;
        colours();
        tangents();
        if (!corners(mode) || !sound()) return std::nullopt;
        if (moved_.skin && !hang()) return std::nullopt;
        return std::move(mesh_);
    }

    std::vector<Vec2> uvs(std::size_t set) {
        auto found = vectors<Vec2>(fmt::format("TEXCOORD_{}", set), 2);
        if (!found) return {};
        for (auto& uv : *found) uv.y = 1 - uv.y;  // glTF counts from the top
        return *std::move(found);
    }

private:
    At packed() const { return at_["extensions"]["KHR_draco_mesh_compression"]; }

    bool unpack() {
        const auto bytes = document_.view(packed()["bufferView"]);
        if (!bytes) return false;
        auto mesh = unpack_mesh(packed(), *bytes, (std::uint64_t{1} << 20) + bytes->size() * 256);
        if (mesh) unpacked_ = *std::move(mesh);
        return mesh.has_value();
    }

    bool hang() {
        const auto values = [&](const std::string& name) { return attribute(name); };
        return hang_on(*moved_.skin, at_["attributes"], values, mesh_);
    }

    /// An attribute as it was made.
    std::optional<Values> plain_attribute(const std::string& name) {
        const At at = at_["attributes"][name], id = packed()["attributes"][name];
        if (!id) return at ? document_.values(at) : std::nullopt;
        const auto found = unpacked_.attributes.find(id.whole(~std::uint64_t{0}));
        if (found == unpacked_.attributes.end()) {
            id.error("names an attribute that the packed mesh does not have");
            return std::nullopt;
        }
        Values values = found->second;
        document_.normalise(at, values);
        return values;
    }

    /// An attribute, moved by the morph targets. None: not there, or reported.
    std::optional<Values> attribute(const std::string& name) {
        const At targets = at_["targets"];
        auto values = plain_attribute(name);
        for (std::size_t i = 0; values && i < std::min(moved_.weights.size(), targets.size()); ++i) {
            const At target = targets[i][name];
            if (!target || moved_.weights[i] == 0) continue;
            if (!add(target, float(moved_.weights[i]), *values)) return std::nullopt;
        }
        return values;
    }

    bool add(const At& target, float weight, Values& to) {
        const auto by = document_.values(target);
        if (!by) return false;
        if (by->width > to.width || by->count() != to.count()) {
            target.error(fmt::format("must name {} vectors of {} numbers", to.count(), to.width));
            return false;
        }
        for (std::size_t i = 0; i < by->count(); ++i)
            for (std::size_t j = 0; j < by->width; ++j)
                to.numbers[i * to.width + j] += weight * by->numbers[i * by->width + j];
        return true;
    }

    template <class Vector>
    std::optional<std::vector<Vector>> vectors(const std::string& name, std::size_t width) {
        const auto values = attribute(name);
        if (!values) return std::nullopt;
        if (values->width != width || (!mesh_.positions.empty() && values->count() != mesh_.positions.size())) {
            at_["attributes"][name].error(
                fmt::format("must name {} vectors of {} numbers", mesh_.positions.size(), width));
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

    void colours() {
        auto values = attribute("COLOR_0");
        if (!values) return;
        if (values->width < 3 || values->count() != mesh_.positions.size())
            return at_["attributes"]["COLOR_0"].error("must name a colour for each vertex");
        if (!moved_.weights.empty())
            for (float& number : values->numbers) number = std::clamp(number, 0.0f, 1.0f);
        for (std::size_t i = 0; i < values->count(); ++i) {
            const float* v = &values->numbers[i * values->width];
            mesh_.colours.push_back({v[0], v[1], v[2]});
            if (values->width > 3) mesh_.values.alphas.push_back(v[3]);
        }
        const auto whole = [](float alpha) { return alpha == 1; };
        if (std::ranges::all_of(mesh_.values.alphas, whole)) mesh_.values.alphas.clear();
    }

    /// glTF's y axis is against v, as ours is along what v goes up by.
    void tangents() {
        if (mesh_.normals.empty()) return;  // then they have no effect
        const auto values = attribute("TANGENT");
        if (!values) return;
        if (values->width != 4 || values->count() != mesh_.positions.size())
            return at_.warn(
                "tangents that are not four numbers for each vertex are left out: normal maps and grooves "
                "lie along the texture coordinates");
        for (std::size_t i = 0; i < values->count(); ++i) {
            const float* v = &values->numbers[i * 4];
            mesh_.tangents.push_back({{v[0], v[1], v[2]}, v[3] < 0 ? -1.0f : 1.0f});
        }
    }

    bool corners(std::uint64_t mode) {
        std::vector<std::uint32_t> list;
        if (packed()) {
            list = std::move(unpacked_.corners);
            mode = triangles;
        } else if (at_["indices"]) {
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
    const Moved& moved_;
    Document& document_;
    Unpacked unpacked_;
    Mesh mesh_;
};

}  // namespace

std::vector<Primitive> read_mesh(const At& at, const Moved& moved, Document& document, Materials& materials) {
    std::vector<Primitive> found;
    const At primitives = at["primitives"];
    for (std::size_t i = 0; i < primitives.size() && !at.report().full(); ++i) {
        const At primitive = primitives[i];
        Reader reader(primitive, moved, document);
        auto mesh = reader.read();
        if (!mesh) continue;
        const Surface& surface = materials.of(primitive, {!mesh->colours.empty(), !mesh->values.alphas.empty()});
        const auto& sets = surface.uv_sets;
        mesh->uvs = reader.uvs(sets.empty() ? 0 : sets[0]);
        bool lacks = !sets.empty() && mesh->uvs.empty();
        for (std::size_t other = 1; other < sets.size(); ++other) {
            auto& uvs = mesh->values.uvs.emplace_back(reader.uvs(sets[other]));
            lacks |= uvs.empty();
            uvs.resize(mesh->positions.size());
        }
        if (!surface.turned) mesh->tangents.clear();
        if (!surface.fades) mesh->values.alphas.clear();
        if (lacks)
            primitive.warn("a mesh lacks the texture coordinates that its material asks for: its images lie anyhow");
        if (!mesh->normals.empty()) order_by_normals(*mesh);  // without any, glTF wants flat ones
        found.push_back({*std::move(mesh), surface.material, surface.emission});
    }
    return found;
}

}  // namespace lightnet::gltf
