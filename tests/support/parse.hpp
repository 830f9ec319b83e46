// Graphs as text, for tests that read as stories.
#pragma once

#include <functional>
#include <string>

#include "core/base/error.hpp"
#include "core/network/graph/check.hpp"
#include "lua/load_graph.hpp"
#include "tests/support/fake_registry.hpp"

namespace lightnet::test {

inline Graph parse(const std::string& text) { return parse_graph(text, "graph.lua"); }

/// A sound graph: `text`, below it a renderer that asks the node called `lighting`.
inline Graph sound_graph(const std::string& text) {
    return check(parse(text + "\nscene = Scene { 'box.pbrt' }\n"
                              "image = RayTracer { lighting, scene = scene, film = { 8, 4 } }\n"),
                 fake_registry());
}

/// What `act` says when it throws; "" when it doesn't.
inline std::string error_of(const std::function<void()>& act) {
    try {
        act();
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

/// Everything that check() finds wrong with a graph.
inline std::string problems_of(const std::string& text, const Hosts& hosts = {}) {
    return error_of([&] { check(parse(text), fake_registry(), hosts); });
}

}  // namespace lightnet::test
