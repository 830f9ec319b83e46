#include "tools/pictures/picture_recipe.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/base/build_info.hpp"
#include "core/base/hash.hpp"
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
    SceneParts read = all_read(made_from, used_nodes(job.graph, renderer_of(job.graph, registry)));
    if (format.adaptive()) read |= ScenePart::film;  // noise counts as it is seen
    recipe["graph"] = to_hex(content_hash(made_from.light));
    recipe["scene"] = to_hex(made_from.scene->of(read));
    return recipe;
}

}  // namespace lightnet
