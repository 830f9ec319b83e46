#include "tools/pictures/picture_recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/build_info.hpp"
#include "core/base/hash.hpp"
#include "core/film/clean_layers.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/fingerprint.hpp"

namespace lightnet {
namespace {

// The graph without what stands apart in a recipe, and without what changes no pixel: where its lines stand, and how
// its files are called.
std::string text_of_graph(Graph graph, const Registry& registry) {
    graph.file.clear();
    for (auto& node : graph.nodes) {
        node.where = {};
        const Kind* kind = registry.find(node.kind);
        if (kind->role == Role::image) leave_film_out(node, *kind);
    }
    return to_json(graph);
}

}  // namespace

std::map<std::string, std::string> picture_recipe(const Job& job, const Registry& registry, const FilmFormat& format,
                                                  std::uint32_t tile) {
    std::string files = job.scene;
    for (const auto& file : job.files) files += "\n" + file.path + " " + to_hex(file.hash);
    std::string build = build_id();
    for (const auto& plugin : job.plugins) build += ", " + plugin;
    const auto crop = format.crop.value_or(Window{0, 0, format.width, format.height});
    return {{"graph", to_hex(content_hash(text_of_graph(written(job.graph), registry)))},
            {"scene", to_hex(content_hash(files))},
            {"seed", std::to_string(job.seed)},
            {"size", fmt::format("{}x{}", format.width, format.height)},
            {"crop", fmt::format("{},{},{},{}", crop.x, crop.y, crop.x + crop.width, crop.y + crop.height)},
            {"noise", fmt::format("{}", format.refinement.noise)},
            {"tile", std::to_string(tile)},
            {"build", build},
            {"arithmetic", std::to_string(fingerprint(job.isa))}};
}

std::map<std::string, std::string> film_recipe(const Job& job, const Registry& registry, const FilmFormat& format,
                                               std::uint32_t tile, const MadeFrom& made_from) {
    auto recipe = picture_recipe(job, registry, format, tile);
    std::string colours;
    for (std::size_t i = 0; i < format.colours(); ++i) colours += format.name_of(i) + '\n';
    recipe["colours"] = to_hex(content_hash(colours));
    recipe["run"] = to_hex(content_hash(made_from.run));
    if (!made_from.scene) return recipe;
    const auto used = used_nodes(job.graph, renderer_of(job.graph, registry));
    const SceneParts seen = format.adaptive() ? ScenePart::film : SceneParts();  // noise counts as it is seen
    recipe["graph"] = to_hex(content_hash(made_from.light));
    recipe["scene"] = to_hex(hash_of_read(made_from, used, seen));
    return recipe;
}

std::vector<LightRecipe> light_recipes(const Job& job, const Registry& registry, const FilmFormat& format,
                                       std::uint32_t tile, const MadeFrom& made_from) {
    std::vector<LightRecipe> recipes;
    if (!made_from.scene || format.adaptive()) return recipes;
    auto lights = single_lights(job.graph, registry);
    if (lights.size() < 2) return recipes;
    const Node& renderer = job.graph.nodes[renderer_of(job.graph, registry)];
    const SceneParts asked = registry.find(renderer.kind)->asks_by(renderer);
    const auto whole = film_recipe(job, registry, format, tile, made_from);
    for (auto& light : lights) {
        LightRecipe one{std::move(light), {}, whole};
        std::string names;
        for (const auto layer : one.light.layers) names += format.layers[layer] + '\n';
        for (std::size_t colour = 0; colour < format.colours(); ++colour)
            for (const auto layer : one.light.layers)
                if (colour == layer || format.name_of(colour) == cleaning::half_of(format.layers[layer])) {
                    one.colours.push_back(colour);
                    names += std::to_string(one.colours.size()) + (colour == layer ? " whole\n" : " half\n");
                }
        one.recipe["colours"] = to_hex(content_hash(names));
        one.recipe["graph"] = to_hex(content_hash(one.light.text));
        one.recipe["scene"] = to_hex(hash_of_read(made_from, one.light.used, asked));
        recipes.push_back(std::move(one));
    }
    return recipes;
}

}  // namespace lightnet
