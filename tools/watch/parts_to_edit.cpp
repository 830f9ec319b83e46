#include "tools/watch/parts_to_edit.hpp"

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "core/network/graph/graph_film.hpp"
#include "core/scene/data/lamp_names.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_parts = 60;  // of each, which go with every state

JsonTree colour_json(Rgb colour) { return {colour.r, colour.g, colour.b}; }

/// The texture that edit_parts() would put another into.
struct ColourOf {
    std::optional<TextureId> operator()(const DiffuseMaterial& one) const { return one.reflectance; }
    std::optional<TextureId> operator()(const CoatedDiffuseMaterial& one) const { return one.reflectance; }
    std::optional<TextureId> operator()(const PrincipledMaterial& one) const { return one.base_colour; }
    std::optional<TextureId> operator()(const BurleyMaterial& one) const { return one.base_colour; }
    std::optional<TextureId> operator()(const auto&) const { return std::nullopt; }
};

// None: it is told by more than a colour.
std::optional<Rgb> single_colour(const SceneData& scene, const Material& material) {
    const auto texture = std::visit(ColourOf{}, material.model);
    if (!texture) return std::nullopt;
    const Texture& paint = scene.textures[*texture];
    if (!std::holds_alternative<std::monostate>(paint.pattern)) return std::nullopt;
    return paint.invert ? Rgb{1, 1, 1} - paint.scale : paint.scale;
}

bool has_colour(const AnyMaterial& model) {
    return !std::holds_alternative<MixtureMaterial>(model) && !std::holds_alternative<TwoFacedMaterial>(model) &&
           !std::holds_alternative<NoMaterial>(model) && !std::holds_alternative<MeasuredMaterial>(model) &&
           !std::holds_alternative<HairMaterial>(model);
}

std::optional<float> roughness_of(const AnyMaterial& model) {
    return std::visit(
        [](const auto& one) -> std::optional<float> {
            if constexpr (requires { one.roughness.u; })
                return one.roughness.u;
            else
                return std::nullopt;
        },
        model);
}

JsonTree materials_json(const SceneData& scene) {
    auto all = JsonTree::list();
    std::set<std::string> names;
    for (const Material& material : scene.materials) {
        if (names.size() >= most_parts) break;
        if (!has_colour(material.model) || material.name.empty() || !names.insert(material.name).second) continue;
        const auto colour = single_colour(scene, material);
        JsonTree one{{"name", material.name}, {"colour", colour ? colour_json(*colour) : JsonTree(nullptr)}};
        if (const auto roughness = roughness_of(material.model)) one["roughness"] = *roughness;
        all.push_back(std::move(one));
    }
    return all;
}

JsonTree lamps_json(const SceneData& scene) {
    auto all = JsonTree::list();
    std::set<std::string> names;
    for (const auto& lamp : lamps_of(scene)) {
        if (names.size() >= most_parts) break;
        if (names.insert(lamp.names.front()).second) all.push_back(lamp.names.front());
    }
    return all;
}

JsonTree numbers_json(const Value& value) {
    const auto* number = std::get_if<double>(&value.data);
    if (number) return *number;
    auto list = JsonTree::list();
    for (const auto& part : std::get<Table>(value.data).list) list.push_back(std::get<double>(part.data));
    return list;
}

}  // namespace

JsonTree parts_to_edit(const Graph& graph, const Registry& registry, const SceneData& scene) {
    const Node& node = scene_of(graph, registry);
    JsonTree edits = JsonTree::object();
    for (const char* what : {"lamps", "colours", "roughness"}) {
        auto& by_name = edits[what] = JsonTree::object();
        if (const auto given = node.params.find(what); given != node.params.end())
            for (const auto& [name, value] : std::get<Table>(given->second.data).named)
                by_name[name] = numbers_json(value);
    }
    return {{"scene", node.name},
            {"lamps", lamps_json(scene)},
            {"materials", materials_json(scene)},
            {"edits", std::move(edits)}};
}

}  // namespace lightnet
