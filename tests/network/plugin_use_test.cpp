// What hosts must have in common of plugins.
#include "core/network/graph/plugin_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::plugin_use_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Registry registry_with(const std::string& plugin) {
    std::vector<Kind> kinds(3);
    kinds[0].name = "Own", kinds[1].name = "Fog", kinds[2].name = "Mist";
    kinds[1].plugin = kinds[2].plugin = plugin;
    return Registry(std::move(kinds));
}

Graph graph_of(const std::vector<std::string>& kinds) {
    Graph graph;
    for (const auto& kind : kinds) graph.nodes.push_back({kind, kind, {}, {}, {}});
    return graph;
}

TEST(PluginUse, NamesThoseThatAGraphNeeds) {
    const auto registry = registry_with("fog 1.0 (aa)");
    EXPECT_THAT(plugins_of(registry), ElementsAre("fog 1.0 (aa)"));
    EXPECT_THAT(plugins_of(graph_of({"Fog", "Own", "Mist"}), registry), ElementsAre("fog 1.0 (aa)"));
    EXPECT_THAT(plugins_of(graph_of({"Own"}), registry), IsEmpty());
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
