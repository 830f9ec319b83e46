// The graph that `lightnet render` makes of a scene file, which then runs like any other.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "lua/load_graph.hpp"
#include "tools/cli/options.hpp"

namespace lightnet {

/// Per pixel, where nobody says how many.
inline constexpr std::uint32_t usual_samples = 64;

/// A graph that has not been checked, and what was wrong on the way to it.
struct RenderGraph {
    Graph graph;
    std::vector<Problem> problems;
};

/// A scene file, and what is asked of it.
struct RenderedScene {
    std::string file;
    std::string lighting = "path";                 // a name (lightings.hpp) or a graph file
    std::string environment;                       // a picture's file or a colour; "": as the scene says
    bool two_sided = false;                        // no surface is black from behind
    std::map<std::string, std::string> constants;  // -D: of the scene file, or of the graph file
    GraphFrame frame{};                            // which is rendered
    double fps = 0;                                // 0: as a graph file says, or 24
    double shutter = 0;                            // degrees; 0: each frame is an instant
    std::string animation{};                       // which of the file's; "": the first
};

/// The graph that lights the scene in the way of its `lighting`; the scenes of a graph file are replaced by this one.
/// The environment becomes an override of the scene. Throws UserError.
RenderGraph render_graph(const RenderedScene& wanted);

/// What a film's crop, in parts of its sides, is in pixels of a picture of that size: those whose left and upper edges
/// lie in it, as pbrt has it. None: all of them, or none.
std::optional<PictureCrop> crop_in_pixels(const std::array<float, 4>& crop, const PictureSize& size);

/// "x.exr" for a scene "…/x.pbrt": the picture lies here, as no folder of scenes should be written to.
std::string picture_of(const std::string& scene);

}  // namespace lightnet
