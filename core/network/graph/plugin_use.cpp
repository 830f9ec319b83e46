#include "core/network/graph/plugin_use.hpp"

#include <algorithm>
#include <set>

namespace lightnet {
namespace {

std::string name_in(const std::string& plugin) { return plugin.substr(0, plugin.find(' ')); }

std::vector<std::string> without_repeats(std::set<std::string> plugins) {
    plugins.erase("");  // the program itself
    return {plugins.begin(), plugins.end()};
}

}  // namespace

std::vector<std::string> plugins_of(const Registry& registry) {
    std::set<std::string> plugins;
    for (const auto& kind : registry.kinds()) plugins.insert(kind.plugin);
    return without_repeats(std::move(plugins));
}

std::vector<std::string> plugins_of(const Graph& graph, const Registry& registry) {
    std::set<std::string> plugins;
    for (const auto& node : graph.nodes)
        if (const Kind* kind = registry.find(node.kind)) plugins.insert(kind->plugin);
    return without_repeats(std::move(plugins));
}

std::string why_plugins_differ(const std::vector<std::string>& wanted, const Registry& registry) {
    const auto own = plugins_of(registry);
    std::string why;
    for (const auto& plugin : wanted) {
        if (std::find(own.begin(), own.end(), plugin) != own.end()) continue;
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
