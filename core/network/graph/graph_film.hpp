// The size of the image, and where it goes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/film/window.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// `film = { width, height, crop = { x0, y0, x1, y1 }, file = "x.exr" }`
struct GraphFilm {
    std::uint32_t width = 0, height = 0;  // pixels
    std::string file;                     // "" where the graph names none
    std::optional<Window> crop{};         // none: the whole image
    friend bool operator==(const GraphFilm&, const GraphFilm&) = default;
};

/// Width and height of an image are at most this many pixels.
inline constexpr std::uint32_t longest_side = 16384;

/// The film of a checked graph's renderer.
GraphFilm film_of(const Graph& graph, const Registry& registry);

/// The Scene node of a checked graph's renderer.
const Node& scene_of(const Graph& graph, const Registry& registry);

/// The scene file of a checked graph's renderer: as the graph names it, taken from the graph's folder.
std::string scene_file(const Graph& graph, const Registry& registry);

/// A scene file as `graph` names it, taken from the graph's folder.
std::string beside_graph(const Graph& graph, const std::string& path);

}  // namespace lightnet
