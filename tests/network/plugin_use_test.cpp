// What hosts must have in common of plugins.
#include "core/network/graph/plugin_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::plugin_use_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Registry registry_with(const std::string& plugin) {
    std::vector<Kind> own(1), others(2);
    own[0].name = "Own", others[0].name = "Fog", others[1].name = "Mist";
    Registry registry(std::move(own));
    registry.add_plugin(plugin, std::move(others));
    return registry;
}

Graph graph_of(const std::vector<std::string>& kinds) {
    Graph graph;
    for (const auto& kind : kinds) graph.nodes.push_back({kind, kind, {}, {}, {}});
    return graph;
}

TEST(PluginUse, NamesThoseThatAGraphNeeds) {
    const auto registry = registry_with("fog 1.0 (aa)");
    EXPECT_THAT(registry.plugins(), ElementsAre("fog 1.0 (aa)"));
    EXPECT_THAT(plugins_of(graph_of({"Fog", "Own", "Mist"}), registry), ElementsAre("fog 1.0 (aa)"));
    EXPECT_THAT(plugins_of(graph_of({"Own"}), registry), IsEmpty());
}

TEST(PluginUse, KnowsThoseThatBringNoKinds) {
    auto registry = registry_with("fog 1.0 (aa)");
    registry.add_plugin("off 1.0 (bb)", {});
    EXPECT_THAT(registry.plugins(), ElementsAre("fog 1.0 (aa)", "off 1.0 (bb)"));
    EXPECT_EQ(why_plugins_differ({"off 1.0 (bb)"}, registry), "");
}

TEST(PluginUse, SaysWhatDiffers) {
    EXPECT_EQ(why_plugins_differ({"fog 1.0 (aa)"}, registry_with("fog 1.0 (aa)")), "");
    EXPECT_EQ(why_plugins_differ({}, registry_with("fog 1.0 (aa)")), "") << "more than is needed";
    EXPECT_EQ(why_plugins_differ({"fog 1.0 (aa)"}, registry_with("fog 1.1 (bb)")),
              "plugins differ: it has fog 1.1 (bb), the launcher fog 1.0 (aa)");
    EXPECT_EQ(why_plugins_differ({"rain 1 (cc)"}, registry_with("fog 1.0 (aa)")),
              "it lacks the plugin rain 1 (cc): start it with --plugin, or put the library into its folder of plugins");
}

}  // namespace
}  // namespace lightnet::plugin_use_test
