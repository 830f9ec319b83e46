// The size of the image, and where it goes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/film/gains.hpp"
#include "core/film/picture.hpp"
#include "core/film/window.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// `film = { width, height, crop = { x0, y0, x1, y1 }, gains = { direct = 0.5, bounce = { 1.2, 1.1, 1 } }, half =
/// true, parts = true, compression = "piz", clean = true, file = "x.exr" }`
struct GraphFilm {
    std::uint32_t width = 0, height = 0;  // pixels
    std::string file;                     // "" where the graph names none
    std::optional<Window> crop{};         // none: the whole image
    std::vector<Gain> gains{};            // of layers; those that are not named have 1
    PictureStorage storage{};             // of the file
    friend bool operator==(const GraphFilm&, const GraphFilm&) = default;
};

/// Width and height of an image are at most this many pixels.
inline constexpr std::uint32_t longest_side = 16384;

/// How many samples a renderer wants. Those of a kind without such parameters have zeros.
struct GraphSampling {
    std::uint32_t samples = 0;        // per pixel, at most
    float noise = 0;                  // threshold; 0: every pixel gets all samples
    std::uint32_t least_samples = 0;  // of each pixel, where there is a threshold
};

/// The film of a checked graph's renderer.
GraphFilm film_of(const Graph& graph, const Registry& registry);

/// The samples of a checked graph's renderer.
GraphSampling sampling_of(const Graph& graph, const Registry& registry);

/// The Scene node of a checked graph's renderer.
const Node& scene_of(const Graph& graph, const Registry& registry);

/// The scene file of a checked graph's renderer: as the graph names it, taken from the graph's folder.
std::string scene_file(const Graph& graph, const Registry& registry);

/// A scene file as `graph` names it, taken from the graph's folder.
std::string beside_graph(const Graph& graph, const std::string& path);

}  // namespace lightnet
