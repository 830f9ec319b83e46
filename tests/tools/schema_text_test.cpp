// What programs are told of kinds.
#include "tools/cli/schema_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::schema_text_test {
namespace {

using testing::HasSubstr;

const Registry& every_kind() {
    static const Registry registry(standard_nodes());
    return registry;
}

TEST(SchemaText, SaysAllOfEveryKindAsJson) {
    const auto json = nlohmann::json::parse(schema_json(every_kind().kinds()));
    EXPECT_EQ(json.size(), every_kind().kinds().size());
    for (const auto& kind : every_kind().kinds()) EXPECT_EQ(json.at(kind.name).at("params").size(), kind.params.size());
    const auto& samples = json.at("AmbientOcclusion").at("params").at("samples");
    EXPECT_EQ(samples.at("type"), "integer");
    EXPECT_EQ(samples.at("default"), 16);
    EXPECT_EQ(samples.at("most"), 65536);
    EXPECT_EQ(json.at("Combine").at("inputs").at("least"), every_kind().find("Combine")->inputs.least);
}

TEST(SchemaText, DefinesEveryKindForEditors) {
    const auto text = lua_definitions(every_kind().kinds());
    EXPECT_THAT(text, HasSubstr("---@field samples? integer directions per question, in samples; default 16\n"));
    EXPECT_THAT(text, HasSubstr("function PhotonMap(entries) end\n"));
    EXPECT_TRUE(parse_graph(text, "lightnet.lua").nodes.empty()) << "it is Lua";
}

TEST(SchemaText, TellsLuacheckEveryName) {
    const auto text = luacheck_settings(every_kind().kinds());
    for (const auto& kind : every_kind().kinds()) EXPECT_THAT(text, HasSubstr("\"" + kind.name + "\",\n"));
}

}  // namespace
}  // namespace lightnet::schema_text_test
