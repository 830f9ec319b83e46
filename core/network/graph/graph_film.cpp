#include "core/network/graph/graph_film.hpp"

#include <algorithm>
#include <filesystem>

#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

// The value of the renderer's parameter of that type, whatever the kind calls it.
const Value& param_of(const Graph& graph, const Registry& registry, ParamType type) {
    const Node& renderer = graph.nodes[renderer_of(graph, registry)];
    for (const auto& param : registry.find(renderer.kind)->params)
        if (param.type == type)
            if (const auto at = renderer.params.find(param.name); at != renderer.params.end()) return at->second;
    throw Error(renderer.name, "has no " + std::string(to_string(type)));
}

// A number, or one for each channel.
Rgb gain_in(const Value& value) {
    const auto number = [](const Value& one) { return static_cast<float>(std::get<double>(one.data)); };
    if (const auto* table = std::get_if<Table>(&value.data))
        return {number(table->list.at(0)), number(table->list.at(1)), number(table->list.at(2))};
    return {number(value), number(value), number(value)};
}

}  // namespace

GraphFilm film_of(const Graph& graph, const Registry& registry) {
    const auto& film = std::get<Table>(param_of(graph, registry, ParamType::film).data);
    const auto side = [&](std::size_t i) { return static_cast<std::uint32_t>(std::get<double>(film.list.at(i).data)); };
    const auto file = film.named.find("file");
    GraphFilm made{side(0), side(1), file == film.named.end() ? "" : std::get<std::string>(file->second.data)};
    if (const auto crop = film.named.find("crop"); crop != film.named.end()) {
        const auto& edges = std::get<Table>(crop->second.data).list;
        const auto edge = [&](std::size_t i) { return static_cast<std::uint32_t>(std::get<double>(edges[i].data)); };
        made.crop = Window{edge(0), edge(1), edge(2) - edge(0), edge(3) - edge(1)};
    }
    if (const auto gains = film.named.find("gains"); gains != film.named.end())
        for (const auto& [layer, value] : std::get<Table>(gains->second.data).named)
            made.gains.push_back({layer, gain_in(value)});
    if (const auto half = film.named.find("half"); half != film.named.end())
        made.storage.half = std::get<bool>(half->second.data);
    if (const auto parts = film.named.find("parts"); parts != film.named.end())
        made.storage.parts = std::get<bool>(parts->second.data);
    if (const auto packed = film.named.find("compression"); packed != film.named.end())
        made.storage.compression = std::get<std::string>(packed->second.data);
    return made;
}

GraphSampling sampling_of(const Graph& graph, const Registry& registry) {
    const auto& params = graph.nodes[renderer_of(graph, registry)].params;
    const auto number = [&](const char* name) {
        const auto param = params.find(name);
        return param == params.end() ? 0 : std::get<double>(param->second.data);
    };
    const auto count = [&](const char* name) { return static_cast<std::uint32_t>(number(name)); };
    return {count("samples"), static_cast<float>(number("error")), count("least_samples")};
}

const Node& scene_of(const Graph& graph, const Registry& registry) {
    const auto& ref = std::get<NodeRef>(param_of(graph, registry, ParamType::scene).data);
    const auto scene = graph.find(ref.name);
    if (!scene) throw Error(graph.file, "no scene called '" + ref.name + "'");
    return graph.nodes[*scene];
}

std::string scene_file(const Graph& graph, const Registry& registry) {
    return beside_graph(graph, std::get<std::string>(scene_of(graph, registry).entries.at(0).data));
}

std::string beside_graph(const Graph& graph, const std::string& path) {
    return (std::filesystem::path(graph.file).parent_path() / path).lexically_normal().string();
}

}  // namespace lightnet
