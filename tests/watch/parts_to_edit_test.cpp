// Lamps and materials that a page can edit.
#include "tools/watch/parts_to_edit.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/network/graph/check.hpp"
#include "core/readers/part_edits.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::parts_to_edit_test {
namespace {

Value named(const std::string& name, double value) {
    Table table;
    table.named[name] = Value{value};
    return {table};
}

SceneData room() {
    SceneData scene;
    scene.textures = {{{0.5f, 0.25f, 0.125f}, {}, false}, {{1, 1, 1}, CheckerTexture{0, 0, {}}, false}};
    scene.materials = {{"wall", DiffuseMaterial{0}},
                       {"tiles", CoatedDiffuseMaterial{TextureId(1), 1.5f, Roughness{0.25f, 0.25f, {}}}},
                       {"", DiffuseMaterial{0}},
                       {"wall", DiffuseMaterial{1}},
                       {"both", MixtureMaterial{0, 1, 0}}};
    PointLight bulb;
    bulb.strength() = {1, 1, 1};
    bulb.label.name = "bulb";
    scene.lights = {bulb};
    return scene;
}

TEST(PartsToEdit, AreToldByTheirNames) {
    const Registry registry{standard_nodes()};
    Graph graph;
    graph.nodes = {{"hall", "Scene", {Value{std::string("hall.pbrt")}}, {{"lamps", named("bulb", 2)}}, {}},
                   {"light", "DirectLighting", {}, {}, {}},
                   {"image", "RayTracer", {Value{NodeRef{"light"}}}, {{"scene", Value{NodeRef{"hall"}}}}, {}}};
    Table film;
    film.list = {Value{16.0}, Value{16.0}};
    film.named = {{"file", Value{std::string("x.exr")}}};
    graph.nodes.back().params.emplace("film", Value{film});
    graph = check(graph, registry);
    SceneData scene = room();
    edit_parts({{{"bulb", {2, 2, 2}}}}, scene, {});
    EXPECT_EQ(sorted_text(parts_to_edit(graph, registry, scene)),
              R"({"edits":{"colours":{},"lamps":{"bulb":2.0},"roughness":{}},"lamps":["bulb"],"materials":[)"
              R"({"colour":[0.5,0.25,0.125],"name":"wall"},{"colour":null,"name":"tiles","roughness":0.25}],)"
              R"("scene":"hall"})");
}

}  // namespace
}  // namespace lightnet::parts_to_edit_test
