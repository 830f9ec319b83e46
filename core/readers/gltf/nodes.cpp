#include "core/readers/gltf/nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "core/readers/common/clipping.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/gltf/lights.hpp"
#include "core/readers/gltf/meshes.hpp"
#include "core/readers/gltf/skins.hpp"
#include "core/scene/reach.hpp"
#include "core/scene/surfaces/placement.hpp"

namespace lightnet::gltf {
namespace {

/// Has an inverse, and no numbers beyond sense.
bool invertible(const Matrix& t) {
    const auto& m = t.m;
    for (const auto& row : m)
        for (const double value : row)
            if (!(std::fabs(value) < 1e30)) return false;
    return std::fabs(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])) > 1e-30;
}

/// What has no size now, but may have one at another time, when it must be the same thing: a millionth of it is left.
Matrix hardly_there(Matrix t) {
    for (std::size_t i = 0; i < 3; ++i) t.m[i][i] += 1e-6;
    return t;
}

struct Standing {
    std::size_t number = 0;
    At node;
    Matrix to_world;
    bool visible = true;  // it and all above it
};

/// How a mesh looks where it stands.
struct Pose {
    std::size_t mesh = 0;
    std::optional<std::size_t> node{};  // whose alone it is, as its weights move: all moments have the same order
    std::vector<double> weights{};      // of its morph targets; none: as it was made
    std::optional<std::size_t> skin{};  // that it hangs on
    friend auto operator<=>(const Pose&, const Pose&) = default;
};

/// Between which planes a camera sees, along its axis.
struct Depth {
    float nearest = 0, farthest = 0;
};

std::vector<double> weights_of(const At& list) {
    std::vector<double> weights(list.size());
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = list[i].number(0);
    if (std::ranges::all_of(weights, [](double weight) { return weight == 0; })) weights.clear();
    return weights;
}

class Builder {
public:
    Builder(Document& document, Assets& assets, const Shown& shown)
        : document_(document),
          assets_(assets),
          shown_(shown),
          materials_(document, assets, shown.variant),
          lights_(document, assets),
          nodes_(document.root()["nodes"]) {}

    void build() {
        const auto standing = all_nodes();
        const std::size_t meshes = document_.root()["meshes"].size();
        std::map<Pose, std::vector<Place>> places;
        for (const auto& [number, node, to_world, visible] : standing) {
            if (assets_.report().full()) return;
            if (node["mesh"])
                if (const auto mesh = node["mesh"].index(meshes); mesh && visible) {
                    Pose pose = pose_of(node, *mesh);
                    if (shown_.morphing.contains(number)) pose.node = number;
                    put(node, to_world, pose, places[pose]);
                }
            if (node["camera"]) camera(node["camera"], to_world, node["name"].text(""));
            if (visible) lights_.add(node, to_world);
        }
        for (const auto& [pose, where] : places)
            if (!assets_.report().full()) add(pose, where);
        cut();
    }

private:
    /// Where a mesh stands, and what its node is called.
    struct Place {
        Matrix to_world;
        std::string name;
    };

    /// Every node of the scene, parents before children.
    std::vector<Standing> all_nodes() {
        std::vector<Standing> result;
        std::vector<Standing> waiting;
        std::vector<bool> seen(nodes_.size());
        const auto add = [&](const At& index, const Matrix& parent, bool visible) {
            const auto which = index.index(nodes_.size());
            if (!which) return;
            if (seen[*which]) return index.error(fmt::format("names node {}, which stands elsewhere already", *which));
            seen[*which] = true;
            waiting.push_back({*which, nodes_[*which], parent, visible});
        };
        roots(add);
        while (!waiting.empty() && !assets_.report().full()) {
            const auto [number, node, parent, shown] = waiting.back();
            waiting.pop_back();
            const Matrix to_world = parent * matrix_of(node);
            const bool visible = shown && node["extensions"]["KHR_node_visibility"]["visible"].boolean(true);
            result.push_back({number, node, to_world, visible});
            const At children = node["children"];
            for (std::size_t i = children.size(); i-- > 0;) add(children[i], to_world, visible);
        }
        return result;
    }

    template <class Add>
    void roots(const Add& add) {
        const At scenes = document_.root()["scenes"];
        const At chosen = document_.root()["scene"];
        if (scenes.size()) {
            const At list = scenes[chosen ? chosen.index(scenes.size()).value_or(0) : 0]["nodes"];
            if (const auto others = scenes.size() - 1; others > 0)
                scenes.warn(fmt::format("{} other scene{} of the file {} left out", others, others == 1 ? "" : "s",
                                        others == 1 ? "is" : "are"));
            for (std::size_t i = list.size(); i-- > 0;) add(list[i], Matrix{}, true);
            return;
        }
        std::vector<bool> child(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const At children = nodes_[i]["children"];
            for (std::size_t j = 0; j < children.size(); ++j)
                if (const auto which = children[j].index(nodes_.size())) child[*which] = true;
        }
        // an index that the file does not hold itself
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            if (child[i]) continue;
            const Json index{std::uint64_t{i}};
            add(At(index, document_.path(), assets_.report()), Matrix{}, true);
        }
    }

    Pose pose_of(const At& node, std::size_t mesh) {
        const At own = node["weights"], usual = document_.root()["meshes"][mesh]["weights"];
        const At weights = own ? own : usual, made = document_.root()["meshes"][mesh];
        const std::size_t targets = made["primitives"][0]["targets"].size();
        if (weights.size() > 0 && weights.size() != targets)
            node.warn(fmt::format("{} weight{} for a mesh with {} morph target{}", weights.size(),
                                  weights.size() == 1 ? "" : "s", targets, targets == 1 ? "" : "s"));
        Pose pose{mesh, {}, weights_of(weights)};
        if (node["skin"]) pose.skin = node["skin"].index(document_.root()["skins"].size());
        return pose;
    }

    /// Where a node's mesh stands: once, or as often as EXT_mesh_gpu_instancing says. What hangs on a skin stands where
    /// its joints do.
    void put(const At& node, const Matrix& to_world, const Pose& pose, std::vector<Place>& places) {
        if (pose.skin) {
            if (places.empty()) places.push_back({{}, node["name"].text("")});
            return;
        }
        const At many = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        const auto place = [&](Matrix t) {
            if (shown_.moves && !invertible(t)) t = hardly_there(t);
            if (!invertible(t)) return node.warn("meshes without a size are left out");
            places.push_back({t, node["name"].text("")});
        };
        if (!many) return place(to_world);
        const auto list = [&](const char* name) { return many[name] ? document_.values(many[name]) : std::nullopt; };
        const auto moves = list("TRANSLATION"), turns = list("ROTATION"), scales = list("SCALE");
        const std::size_t count = moves ? moves->count() : turns ? turns->count() : scales ? scales->count() : 0;
        const auto fits = [&](const auto& values, std::size_t width) {
            return !values || (values->width == width && values->count() == count);
        };
        if (!fits(moves, 3) || !fits(turns, 4) || !fits(scales, 3)) return many.error("have not all the same count");
        for (std::size_t i = 0; i < count; ++i) {
            const auto at = [&](const auto& values, std::size_t j, double fallback) {
                return values ? double(values->numbers[i * values->width + j]) : fallback;
            };
            place(to_world * from_parts({at(moves, 0, 0), at(moves, 1, 0), at(moves, 2, 0)},
                                        {at(turns, 0, 0), at(turns, 1, 0), at(turns, 2, 0), at(turns, 3, 1)},
                                        {at(scales, 0, 1), at(scales, 1, 1), at(scales, 2, 1)}));
        }
    }

    /// A mesh at all its places: one object with instances, but lamps and what stands once in the world itself. It
    /// goes by its own name, or by that of its first node.
    void add(const Pose& pose, const std::vector<Place>& places) {
        const At mesh = document_.root()["meshes"][pose.mesh];
        std::optional<Skin> skin;
        if (pose.skin) {
            if (!world_of_nodes_) world_of_nodes_.emplace(nodes_);
            skin = read_skin(document_.root()["skins"][*pose.skin], *world_of_nodes_, document_);
            if (!skin) return;
        }
        Object object;
        object.name = mesh["name"].text(places.empty() ? "" : places.front().name);
        for (auto& primitive : read_mesh(mesh, {pose.weights, skin ? &*skin : nullptr}, document_, materials_)) {
            if (places.size() > 1 && !primitive.emission) {
                object.shapes.push_back(shape(std::move(primitive), object.name, ""));
                continue;
            }
            for (const Place& place : places) bake(primitive, place, mesh, object.name);
        }
        if (object.shapes.empty()) return;
        auto& scene = assets_.scene();
        scene.objects.push_back(std::move(object));
        for (const auto& [place, name] : places) {
            if (const std::string fault = lightnet::Placement::fault(place); !fault.empty()) return mesh.error(fault);
            scene.instances.push_back({static_cast<std::uint32_t>(scene.objects.size() - 1), place, name});
        }
    }

    std::uint32_t shape(Primitive primitive, const std::string& name, const std::string& node) {
        auto& shapes = assets_.scene().shapes;
        shapes.push_back(
            {std::move(primitive.mesh), primitive.material, primitive.emission, {document_.path(), 0}, name, {}, node});
        return static_cast<std::uint32_t>(shapes.size() - 1);
    }

    void bake(const Primitive& primitive, const Place& where, const At& mesh, const std::string& name) {
        const Matrix& place = where.to_world;
        constexpr std::uint64_t most_triangles = std::uint64_t{1} << 26;
        baked_ += primitive.mesh.triangles.size();
        if (baked_ > most_triangles) return mesh.error("is a lamp too often: too many triangles");
        Primitive copy = primitive;
        if (swaps_handedness(place)) flip_order(copy.mesh);
        if (!transform(copy.mesh, place)) return mesh.error("has a vertex that is not finite in the scene");
        shape(std::move(copy), name, where.name);
    }

    /// So that a mirrored mesh keeps its outside, as glTF asks.
    static void flip_order(Mesh& mesh) {
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    }

    /// It goes by the name of its node, or else by its own.
    void camera(const At& index, const Matrix& to_world, const std::string& node) {
        const At list = document_.root()["cameras"];
        const auto which = index.index(list.size());
        if (!which) return;
        auto& scene = assets_.scene();
        if (!invertible(to_world)) return index.error("stands where there is no space");
        CameraData camera;
        camera.to_world = to_world;
        for (std::size_t j = 0; j < 3; ++j) {
            const double size = std::hypot(to_world.m[0][j], to_world.m[1][j], to_world.m[2][j]);
            for (std::size_t i = 0; i < 3; ++i)
                camera.to_world.m[i][j] /= j == 2 ? -size : size;  // glTF looks along -z
        }
        FilmData film = scene.film;
        if (!lens(list[*which], camera, film)) return;
        scene.cameras.push_back({node.empty() ? list[*which]["name"].text("") : node, camera, film});
        const At planes = list[*which][camera.is_orthographic() ? "orthographic" : "perspective"];
        depths_.push_back({planes["znear"].real(0), planes["zfar"].real(std::numeric_limits<float>::infinity())});
        if (scene.camera_given) return;
        scene.camera = camera;
        scene.film = film;
        scene.camera_given = true;
    }

    /// Away what no camera of the file sees, as viewers do, once all meshes are there.
    void cut() {
        SceneData& scene = assets_.scene();
        for (std::size_t i = 0; i < depths_.size(); ++i)
            clip(scene.cameras[i].camera, depths_[i].nearest, depths_[i].farthest, scene);
        if (!depths_.empty()) scene.camera = scene.cameras[0].camera;
    }

    bool lens(const At& at, CameraData& camera, FilmData& film) {
        if (at["type"].text("perspective") == "orthographic") {
            const float x = at["orthographic"]["xmag"].real(1), y = at["orthographic"]["ymag"].real(1);
            camera.projection = Orthographic{};
            camera.screen_given = true;
            camera.screen = {-x, x, -y, y};
            return resize(at, film, double(x) / double(y));
        }
        const double angle = at["perspective"]["yfov"].number(0.8), aspect = at["perspective"]["aspectRatio"].number(1);
        if (!(angle > 0 && angle < std::numbers::pi)) {
            at["perspective"]["yfov"].error("must lie between 0 and π");
            return false;
        }
        const double shorter = std::tan(angle / 2) * std::min(aspect, 1.0);
        camera.fov = static_cast<float>(2 * std::atan(shorter) * 180 / std::numbers::pi);
        return resize(at, film, aspect);
    }

    /// glTF names no image size: its shape is kept, its height is the usual one.
    bool resize(const At& at, FilmData& film, double aspect) {
        if (!(aspect > 0.01 && aspect < 100)) {
            at.error("has an image of an impossible shape");
            return false;
        }
        film.width = static_cast<std::uint32_t>(std::max(1.0, std::round(film.height * aspect)));
        return true;
    }

    Document& document_;
    Assets& assets_;
    const Shown& shown_;
    Materials materials_;
    Lights lights_;
    std::vector<Depth> depths_;  // of the scene's cameras
    At nodes_;
    std::optional<WorldOfNodes> world_of_nodes_;  // once a skin asks
    std::uint64_t baked_ = 0;                     // triangles
};

}  // namespace

void add_nodes(Document& document, Assets& assets, const Shown& shown) { Builder(document, assets, shown).build(); }

}  // namespace lightnet::gltf
