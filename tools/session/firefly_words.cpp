#include "tools/session/firefly_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/film/fireflies.hpp"

namespace lightnet {
namespace {

// What is seen of lamps is as bright as they are, and no noise.
std::vector<const PictureLayer*> layers_of_surfaces(const Picture& picture) {
    std::vector<const PictureLayer*> layers;
    for (const auto& layer : picture.layers)
        if (!layer.name.starts_with("emission")) layers.push_back(&layer);
    return layers;
}

}  // namespace

std::string firefly_words(const Picture& picture, const std::vector<NodeReport>& nodes, const std::string& exr) {
    const auto found = fireflies_in(picture, layers_of_surfaces(picture));
    if (!found || found->brightest.empty()) return {};
    const auto any = [&](auto&& is) { return std::any_of(nodes.begin(), nodes.end(), is); };
    const bool photons = any([](const NodeReport& node) { return node.kind.find("Photon") != std::string::npos; });
    const bool paths = any([](const NodeReport& node) { return node.kind == "PathTracing"; });
    const auto [x, y] = found->brightest.front();
    std::string words =
        fmt::format("fireflies: {} {} 99 % of the noise; lightnet explain {} {},{} tells by which light paths",
                    found->pixels, found->pixels == 1 ? "pixel holds" : "pixels hold", exr, x, y);
    if (paths && !photons)
        words += "; where they come by way of glass or mirrors (LS+D), a photon map finds them: graphs/progressive.lua";
    return words;
}

}  // namespace lightnet
