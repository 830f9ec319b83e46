// A plugin with emulated nodes, for the programs as they are shipped. LIGHTNET_WAITING_SPEED says how quick this host
// is; 1: as usual.
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "core/network/light/plugin.hpp"
#include "tests/bench/emulated_kinds.hpp"

namespace {

void add_kinds(std::vector<lightnet::Kind>& kinds) {
    const char* const speed = std::getenv("LIGHTNET_WAITING_SPEED");
    const auto slowness = std::make_shared<lightnet::bench::Slowness>();
    if (speed) slowness->of_others = 1 / std::strtod(speed, nullptr);
    for (auto& kind : lightnet::bench::emulated_kinds_with(slowness, slowness)) kinds.push_back(std::move(kind));
}

}  // namespace

extern "C" const lightnet::PluginCard* lightnet_plugin() {
    static const lightnet::PluginCard card{.name = "waiting", .version = "1", .add_kinds = add_kinds};
    return &card;
}
