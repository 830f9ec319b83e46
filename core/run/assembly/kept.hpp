// State that a node has learnt in one run, kept in a file for later ones.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/readers/files/files.hpp"
#include "core/scene/data/identity.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// All files that keep something begin with this.
inline constexpr std::string_view kept_beginning = "lightnet kept ";

/// The content of a file that keeps what a node of that kind has learnt: some lines of text, then the results.
std::string kept_text(const Kind& kind, const Hash& scene, std::span<const std::byte> results);

/// The results in such a file. Throws Error when it is none, or of another kind or scene.
Bytes kept_results(const Kind& kind, const Hash& scene, std::span<const std::byte> file);

/// What earlier runs have kept and nodes of this one go on from, by node.
using KeptResults = std::map<std::string, Bytes>;

/// Reads the files that nodes of a checked graph go on from (`extend`). Appends to `problems` what is wrong with them.
KeptResults read_kept(const Graph& graph, const Registry& registry, Files& files, const SceneData& scene,
                      std::vector<Problem>& problems);

/// Does any node go on from such a file?
bool goes_on_from_kept(const Graph& graph, const Registry& registry);

/// The nodes of a checked graph whose results are to be kept, and in which files (`keep`), taken from the graph's
/// folder.
std::vector<std::pair<std::size_t, std::string>> files_to_keep(const Graph& graph, const Registry& registry);

}  // namespace lightnet
