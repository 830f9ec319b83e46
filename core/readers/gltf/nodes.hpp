// glTF's tree of nodes: where meshes, cameras and lights stand.
#pragma once

#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

/// `variant`: of the file's materials; "": none. Adds all that stands in the document's default scene. Meshes that
/// stand there more than once become objects.
void add_nodes(Document& document, Assets& assets, const std::string& variant);

}  // namespace lightnet::gltf
