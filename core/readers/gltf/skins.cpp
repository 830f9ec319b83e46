#include "core/readers/gltf/skins.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/readers/common/mesh_tools.hpp"

namespace lightnet::gltf {
namespace {

using Attribute = std::function<std::optional<Values>(const std::string&)>;

constexpr std::size_t no_parent = ~std::size_t{0};

Matrix nothing() {
    Matrix t;
    for (auto& row : t.m) row = {};
    return t;
}

void add(Matrix& to, const Matrix& t, double share) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) to.m[i][j] += share * t.m[i][j];
}

/// One of the sets of four joints that each vertex hangs on.
struct FourJoints {
    Values joints, weights;
};

/// JOINTS_0 with WEIGHTS_0, JOINTS_1 with WEIGHTS_1 … None: reported.
std::optional<std::vector<FourJoints>> joints_of(const At& attributes, const Attribute& attribute,
                                                 std::size_t vertices) {
    std::vector<FourJoints> sets;
    for (;;) {
        const std::string of_joints = fmt::format("JOINTS_{}", sets.size());
        const std::string of_weights = fmt::format("WEIGHTS_{}", sets.size());
        const At joints = attributes[of_joints], weights = attributes[of_weights];
        if (!joints && !sets.empty()) return sets;
        auto which = joints ? attribute(of_joints) : std::nullopt;
        auto share = weights ? attribute(of_weights) : std::nullopt;
        if (!joints || !weights) (joints ? weights : joints).error("is not there: the mesh's node has a skin");
        if (!which || !share) return std::nullopt;
        if (which->width != 4 || share->width != 4 || which->count() != vertices || share->count() != vertices) {
            joints.error("and its weights must name four joints for each vertex");
            return std::nullopt;
        }
        sets.push_back({*std::move(which), *std::move(share)});
    }
}

/// The transform of each vertex.
class Blend {
public:
    Blend(const Skin& skin, const std::vector<FourJoints>& sets) : skin_(skin), sets_(sets) {}

    /// None: a joint that there isn't.
    std::optional<Matrix> of(std::size_t vertex) const {
        Matrix sum = nothing();
        double shares = 0;
        for (const FourJoints& set : sets_)
            for (std::size_t i = vertex * 4; i < vertex * 4 + 4; ++i) {
                const double share = set.weights.numbers[i];
                if (!(share > 0)) continue;  // the joint of such a one is anything
                const double joint = set.joints.numbers[i];
                if (!(joint >= 0 && joint < double(skin_.size()))) return std::nullopt;
                add(sum, skin_[static_cast<std::size_t>(joint)], share);
                shares += share;
            }
        if (!(shares > 0)) return skin_[0];
        Matrix mean = nothing();
        add(mean, sum, 1 / shares);
        return mean;
    }

private:
    const Skin& skin_;
    const std::vector<FourJoints>& sets_;
};

}  // namespace

Matrix from_parts(const std::array<double, 3>& move, std::array<double, 4> q, const std::array<double, 3>& scale) {
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(size > 0)) q = {0, 0, 0, 1};
    const double n = size > 0 ? 1 / size : 1, x = q[0] * n, y = q[1] * n, z = q[2] * n, w = q[3] * n;
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    Matrix t;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) t.m[i][j] = r[i][j] * scale[j];
        t.m[i][3] = move[i];
    }
    return t;
}

Matrix matrix_of(const At& node) {
    if (!node["matrix"])
        return from_parts(node["translation"].numbers<3>({0, 0, 0}), node["rotation"].numbers<4>({0, 0, 0, 1}),
                          node["scale"].numbers<3>({1, 1, 1}));
    const auto columns = node["matrix"].numbers<16>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    Matrix t;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) t.m[i][j] = columns[j * 4 + i];
    return t;
}

WorldOfNodes::WorldOfNodes(const At& nodes) : nodes_(nodes), parents_(nodes.size(), no_parent) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const At children = nodes[i]["children"];
        for (std::size_t j = 0; j < children.size(); ++j)
            if (const auto child = children[j].index(nodes.size())) parents_[*child] = i;
    }
}

std::optional<Matrix> WorldOfNodes::to_world(std::size_t node) const {
    Matrix whole;
    std::size_t steps = 0;
    for (std::size_t at = node; at != no_parent; at = parents_[at]) {
        if (steps++ > nodes_.size()) return std::nullopt;
        whole = matrix_of(nodes_[at]) * whole;
    }
    return whole;
}

std::optional<Skin> read_skin(const At& at, const WorldOfNodes& nodes, Document& document) {
    const At joints = at["joints"], made = at["inverseBindMatrices"];
    const std::size_t count = document.root()["nodes"].size();
    const auto unbind = made ? document.values(made) : std::nullopt;
    if (made && !unbind) return std::nullopt;
    if (joints.size() == 0 || (unbind && (unbind->width != 16 || unbind->count() < joints.size()))) {
        at.error(joints.size() == 0 ? "has no joints" : "must have an inverse bind matrix for each joint");
        return std::nullopt;
    }
    Skin skin;
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const auto node = joints[k].index(count);
        if (!node) return std::nullopt;
        const auto to_world = nodes.to_world(*node);
        if (!to_world) {
            joints[k].error("names a node that stands below itself");
            return std::nullopt;
        }
        Matrix from_mesh;
        for (std::size_t i = 0; unbind && i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j) from_mesh.m[i][j] = unbind->numbers[k * 16 + j * 4 + i];
        skin.push_back(*to_world * from_mesh);
    }
    return skin;
}

bool hang_on(const Skin& skin, const At& attributes, const Attribute& attribute, Mesh& mesh) {
    const auto sets = joints_of(attributes, attribute, mesh.positions.size());
    if (!sets) return false;
    const Blend blend(skin, *sets);
    std::vector<bool> mirrored(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto to_world = blend.of(i);
        if (!to_world) {
            attributes.error(fmt::format("hang a vertex on a joint of a skin that has {}", skin.size()));
            return false;
        }
        mesh.positions[i] = transform_point(*to_world, mesh.positions[i]);
        if (!finite(mesh.positions[i])) {
            attributes.error("hang a vertex where it is not finite in the scene");
            return false;
        }
        if (!mesh.normals.empty()) mesh.normals[i] = moved_normal(mesh.normals[i], *to_world);
        mirrored[i] = swaps_handedness(*to_world);
        if (!mesh.tangents.empty()) {
            auto& [along, hand] = mesh.tangents[i];
            along = transform_direction(*to_world, along);
            if (mirrored[i]) hand = -hand;
        }
    }
    // so that what a mirroring joint holds keeps its outside; where there are normals they say so later
    for (auto& t : mesh.triangles)
        if (t[0] < mirrored.size() && mirrored[t[0]]) std::swap(t[1], t[2]);
    return true;
}

}  // namespace lightnet::gltf
