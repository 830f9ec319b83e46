// Ways to light a scene that have names: networks of graph files that ship, for any scene.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "tools/trials/lighting_choice.hpp"

namespace lightnet {

/// The word by which trials choose one.
inline constexpr std::string_view lighting_by_trials = "auto";

/// A name, and what its picture's error is made of.
struct Lighting {
    std::string name;
    std::string graph;                // file that ships with the same network, in graphs/; "": none does
    bool is_biased = false;           // noise tells only a part of its error
    bool learns = false;              // what it prepares grows with the picture's samples (see settle_lighting())
    bool on_trial = false;            // may be chosen
    Covers covers = Covers::nothing;  // for which light paths
    std::string shows = "";           // in words, for help
};

/// All of them. The first that may be chosen has no bias.
const std::vector<Lighting>& lightings();
/// Null: none is called so.
const Lighting* find_lighting(std::string_view name);
/// For messages: all names, and `auto`.
std::vector<std::string> lighting_names();

/// The operators of one, of which the last is what the renderer asks.
std::vector<Node> nodes_of(const Lighting& lighting, const SourceLine& where);

/// Gives operators that learn from paths as many as suit a picture of so many pixels and samples, as their graph's file
/// does.
void settle_lighting(Graph& graph, std::uint64_t pixels, std::uint64_t samples);

/// As settle_lighting() has it: of a picture of so many.
double lessons_of(std::uint64_t pixels, std::uint64_t samples);

}  // namespace lightnet
