// Puts what the command line says in place of what the graph says.
#pragma once

#include <string>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "tools/cli/options.hpp"

namespace lightnet {

/// Writes --samples, --noise, --size, --crop, --gain, --clean, --alpha and --compression into the renderers of an
/// unchecked graph, and --camera into its scenes.
void override_picture(Graph& graph, const Registry& registry, const PictureOptions& wanted);

/// "shot" of a graph "…/shot.lua", "stdin" of one that comes from standard input: what its pictures are called.
std::string stem_of_pictures(const std::string& graph);

/// Where the picture of a checked graph goes: -o, else the film's file, else the graph's name with .exr, here.
std::string output_file(const Graph& graph, const Registry& registry, const PictureOptions& wanted);

}  // namespace lightnet
