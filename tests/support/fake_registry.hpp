// Kinds without algorithms, for tests of graphs that nobody renders.
#pragma once

#include <limits>

#include "core/network/graph/kind.hpp"

namespace lightnet::test {

inline Param count_param(const char* name, double initial) {
    return {.name = name,
            .type = ParamType::integer,
            .help = "how many",
            .unit = "samples",
            .initial = Value{initial},
            .least = 1,
            .most = 64};
}

/// Gives light, by itself: `rays`, an optional `reach`, and `paths` of two kinds.
inline Kind ambient() {
    Kind kind{.name = "Ambient", .help = "light from everywhere"};
    kind.params = {count_param("rays", 4),
                   {.name = "reach", .help = "how far", .unit = "m", .least = 0, .optional = true},
                   {.name = "paths",
                    .type = ParamType::text,
                    .help = "which light",
                    .initial = Value{std::string("all")},
                    .choices = {"all", "caustic"}},
                   {.name = "soft", .type = ParamType::flag, .help = "without edges", .initial = Value{false}}};
    kind.run.landmarks = [](const NodeContext&) { return std::vector<Vec3>{}; };
    return kind;
}

/// Sums light.
inline Kind combine() {
    Kind kind{.name = "Combine", .help = "sums its inputs"};
    kind.inputs = {1, std::numeric_limits<std::size_t>::max()};
    kind.light.linear = true;
    kind.params = {{.name = "weights",
                    .type = ParamType::numbers,
                    .help = "one per input",
                    .initial = Value{Table{}},
                    .per_input = true}};
    return kind;
}

/// Does something to its input that isn't linear, and keeps what it learns.
inline Kind cache() {
    Kind kind{.name = "Cache", .help = "remembers light"};
    kind.inputs = {1, 1};
    kind.run.prepares = true;
    kind.run.freezes = "records";
    kind.run.landmarks = [](const NodeContext&) { return std::vector<Vec3>{}; };
    return kind;
}

/// Takes what a Cache keeps.
inline Kind reuse() {
    Kind kind{.name = "Reuse", .help = "takes what was remembered"};
    kind.run.prepares = true;
    kind.params = {{.name = "of", .type = ParamType::node, .help = "whose", .choices = {"records"}}};
    return kind;
}

inline Kind ray_tracer() {
    Kind kind{.name = "RayTracer", .role = Role::image, .help = "makes the image"};
    kind.inputs = {1, 1};
    kind.params = {{.name = "scene", .type = ParamType::scene, .help = "what is seen"},
                   {.name = "film", .type = ParamType::film, .help = "size and file of the picture"},
                   {.name = "show", .type = ParamType::nodes, .help = "pictures beside it", .initial = Value{Table{}}},
                   count_param("samples", 16)};
    return kind;
}

inline Registry fake_registry() { return Registry({ray_tracer(), ambient(), combine(), cache(), reuse()}); }

}  // namespace lightnet::test
