#include "core/network/graph/plugin_use.hpp"

#include <algorithm>

namespace lightnet {
namespace {

std::string name_in(const std::string& plugin) { return plugin.substr(0, plugin.find(' ')); }

}  // namespace

std::set<std::string> plugins_of(const Graph& graph, const Registry& registry) {
    std::set<std::string> plugins;
    for (const auto& node : graph.nodes)
        if (const Kind* kind = registry.find(node.kind)) plugins.insert(kind->plugin);
    plugins.erase("");  // the program itself
    return plugins;
}

std::string why_plugins_differ(const std::vector<std::string>& wanted, const Registry& registry) {
    const auto& own = registry.plugins();
    std::string why;
    for (const auto& plugin : wanted) {
        if (own.contains(plugin)) continue;
        const auto namesake = std::find_if(own.begin(), own.end(),
                                           [&](const std::string& mine) { return name_in(mine) == name_in(plugin); });
        why += why.empty() ? "" : "; ";
        if (namesake != own.end())
            why += "plugins differ: it has " + *namesake + ", the launcher " + plugin;
        else
            why += "it lacks the plugin " + plugin +
                   ": start it with --plugin, or put the library into its folder of "
                   "plugins";
    }
    return why;
}

}  // namespace lightnet
