// What `lightnet render` makes of a scene file: a graph, which then runs like any other.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "tools/options.hpp"

namespace lightnet {

/// A graph that has not been checked, and what was wrong on the way to it.
struct RenderGraph {
    Graph graph;
    std::vector<Problem> problems;
};

/// The graph that lights the scene file of the options in the way of `--lighting`: "path", "direct", "ao", or a graph
/// file whose scenes are replaced by this one. `--env` becomes an override of the scene.
RenderGraph render_graph(const Options& options);

/// What a film's crop, in parts of its sides, is in pixels of a picture of that size: those whose left and upper edges
/// lie in it, as pbrt has it. None: all of them, or none.
std::optional<PictureCrop> crop_in_pixels(const std::array<float, 4>& crop, const PictureSize& size);

/// "x.exr" for a scene "…/x.pbrt": the picture lies here, as no folder of scenes should be written to.
std::string picture_of(const std::string& scene);

}  // namespace lightnet
