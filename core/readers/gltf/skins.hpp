// glTF's skins: meshes that hang on joints, as these stand in the file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/math/transform.hpp"
#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

/// Of each joint: from the space in which the mesh was made into the world.
using Skin = std::vector<Matrix>;

/// Where nodes stand, in the scene or not: joints need not be in it.
class WorldOfNodes {
public:
    explicit WorldOfNodes(const At& nodes);
    /// Of a node's own space. None: it stands below itself.
    std::optional<Matrix> to_world(std::size_t node) const;

private:
    At nodes_;
    std::vector<std::size_t> parents_;
};

/// A node's own transform.
Matrix matrix_of(const At& node);
/// By their parts; `q` of any length.
Matrix from_parts(const std::array<double, 3>& move, std::array<double, 4> q, const std::array<double, 3>& scale);

/// None: reported.
std::optional<Skin> read_skin(const At& skin, const WorldOfNodes& nodes, Document& document);

/// Moves the mesh of a primitive into the world, each vertex by its joints; `attribute` gives their
/// numbers by name. False: reported.
bool hang_on(const Skin& skin, const At& attributes,
             const std::function<std::optional<Values>(const std::string&)>& attribute, Mesh& mesh);

}  // namespace lightnet::gltf
