// glTF's tree of nodes: where meshes, cameras and lights stand.
#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

/// How a scene is wanted.
struct Shown {
    std::string variant{};             // of the file's materials; "": none
    std::set<std::size_t> morphing{};  // nodes that look otherwise at other times
    bool moves = false;                // it is one of several moments
};

/// Adds all that stands in the document's default scene. Meshes that
/// stand there more than once become objects.
void add_nodes(Document& document, Assets& assets, const Shown& shown);

}  // namespace lightnet::gltf
