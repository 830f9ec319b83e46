#include "tools/pictures/node_pictures.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/base/own_files.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

constexpr double white_share = 0.99;  // of the pixels of what is no light

// Of "direct", and of "direct.key", which is what it gave of one group of lamps.
std::string maker_of(const std::string& layer) { return layer.substr(0, layer.find('.')); }

// All but what the renderer sees itself.
std::vector<Rgb> all_light(const Picture& picture) {
    auto layers = picture.layers;
    std::erase_if(layers, [](const PictureLayer& layer) { return maker_of(layer.name) == "emission"; });
    return sum_of(layers);
}

bool is_light(const Node& node, const Kind& kind) {
    return !kind.light.paths || !kind.light.paths(node).empty() || kind.light.onward;
}

void scale_to_white(std::vector<Rgb>& pixels) {
    std::vector<float> values;
    for (const Rgb& pixel : pixels)
        if (max_component(pixel) > 0) values.push_back(max_component(pixel));
    if (values.empty()) return;
    const auto white = values.begin() + std::ptrdiff_t(white_share * double(values.size() - 1));
    std::nth_element(values.begin(), white, values.end());
    for (Rgb& pixel : pixels) pixel *= 1 / *white;
}

}  // namespace

std::map<std::string, std::string> write_node_pictures(const Graph& graph, const Registry& registry,
                                                       const std::string& exr) {
    const Picture picture = read_exr(exr);
    const std::size_t renderer = renderer_of(graph, registry);
    std::map<std::string, std::vector<Rgb>> pixels;
    for (const std::size_t input : graph.inputs_of(renderer)) pixels[graph.nodes[input].name] = all_light(picture);
    for (const auto* layers : {&picture.layers, &picture.shown})
        for (const auto& layer : *layers) pixels[layer.name] = layer.pixels;
    std::map<std::string, std::vector<PictureLayer>> groups;
    for (const auto& layer : picture.layers)
        if (layer.name != maker_of(layer.name)) groups[maker_of(layer.name)].push_back(layer);
    for (const auto& [name, layers] : groups) pixels[name] = sum_of(layers);
    pixels[graph.nodes[renderer].name] = picture.beauty;

    std::map<std::string, std::string> files;
    for (const Node& node : graph.nodes) {
        const auto found = pixels.find(node.name);
        if (found == pixels.end() || found->second.empty()) continue;
        if (!is_light(node, *registry.find(node.kind))) scale_to_white(found->second);
        Picture own;
        own.width = picture.width, own.height = picture.height;
        own.beauty = std::move(found->second);
        const auto file = std::filesystem::path(exr).replace_extension("." + node.name + ".png");
        expect_ours(file, png_beginning);
        write_png(file, own);
        files[node.name] = file.string();
    }
    return files;
}

}  // namespace lightnet
