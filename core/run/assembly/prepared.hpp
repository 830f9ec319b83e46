// The order of preparing, and the names of its results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "core/base/lamp_groups.hpp"
#include "core/base/query.hpp"
#include "core/film/tile.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/scene/data/identity.hpp"

namespace lightnet {

/// Nodes that the picture needs and that prepare, inputs before those who ask them.
std::vector<std::size_t> preparing_nodes(const Graph& graph, const Registry& registry);

/// For each of these nodes, the position of the first that prepares together with it. Those of one rank can't ask each
/// other, so what one computes fills the pauses of another. A node that rehearses prepares alone: what it notes must
/// not depend on how far others are.
std::vector<std::size_t> stages_of(const std::vector<std::size_t>& nodes, const Graph& graph, const Registry& registry);

/// Per node, whether it is made and prepared anew for each pass: its kind says so, or it prepares and depends on such a
/// node.
std::vector<bool> renewed_nodes(const Graph& graph, const Registry& registry);

/// The pixels of a rehearsal: every `stride`-th of every `stride`-th row of the graph's film. Throws Error when stride
/// is 0. They belong to that pass.
std::vector<Tile> rehearsal_tiles(const Graph& graph, const Registry& registry, std::uint32_t stride,
                                  std::uint32_t pass = 0);

/// What a rehearsal gives: the questions that were noted, sorted.
Bytes rehearsal_result(const std::vector<Query>& noted);

/// Takes out of a node that makes the image what changes no answer: film, samples and noise threshold.
void leave_film_out(Node& image, const Kind& kind);

/// The nodes that the picture needs as text, without what changes no answer: where their lines stand, the film but for
/// its size, samples and noise threshold, and what the graph says of its scene.
std::string text_of_light(const Graph& graph, const Registry& registry);

/// Everything that results may depend on beside the nodes that are asked for them. A value.
struct MadeFrom {
    MadeFrom() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a text that stands for all of it
    MadeFrom(std::string all) : run(std::move(all)) {}
    // NOLINTNEXTLINE(google-explicit-constructor): likewise
    MadeFrom(const char* all) : run(all) {}

    std::string run;                   // build, instruction set, seed, plugins, and what nodes go on from
    std::string files{};               // of the scene; they count where nobody has looked into it
    std::optional<SceneTree> scene{};  // with camera and film
    std::vector<SceneParts> reads{};   // by node of the graph
    std::vector<GroupSet> lamps{};     // likewise: those that it looks for, if it reads lamps
    std::string light{};               // text_of_light() of it
};
/// Names what these nodes of a graph read of a scene that somebody has looked into, and `more` of it.
Hash hash_of_read(const MadeFrom& made_from, const std::vector<bool>& used, SceneParts more = {});

/// Names for results of preparing: equal recipes give equal results.
class Recipes {
public:
    Recipes(const Graph& graph, MadeFrom made_from);

    /// The `call`-th call of the node's prepare(). What a node learns in rehearsals depends on the whole graph; before
    /// the first of them, on the node and on what it asks: on the parts of the scene that these read, or where nobody
    /// has looked into it, on its files and on what the graph says of it. `part` says which part of the result is
    /// meant; "": all.
    // DECISIONS: recipes-by-part
    Hash of(std::size_t node, std::uint32_t call, bool rehearsed, const std::string& part = {}) const;

private:
    std::string text_of_scene(const std::vector<bool>& used) const;

    const Graph& graph_;
    MadeFrom made_from_;
    std::string whole_;                  // graph and scene, as text
    std::vector<std::string> subgraph_;  // by node, likewise
};

/// What a call of preparing has given, and its content hash. Without bytes: there is none.
struct Result {
    Hash name;
    Bytes bytes;
};

/// Keeps results from run to run, by recipe. Any thread.
class ResultCache {
public:
    virtual ~ResultCache() = default;
    /// Its bytes are what its name says.
    virtual Result find(const Hash& recipe) const = 0;
    /// Failing to keep is no error: the next run computes it again.
    virtual void keep(const Hash& recipe, const Result& result) = 0;
};

}  // namespace lightnet
