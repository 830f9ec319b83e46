#include "tools/cli/overrides.hpp"

#include <filesystem>

#include "core/network/graph/graph_film.hpp"

namespace lightnet {
namespace {

// A film that is wrong stays as it is, so that check() can say so.
void set_size(Value& film, const PictureSize& size) {
    if (auto* table = std::get_if<Table>(&film.data))
        table->list = {{static_cast<double>(size.width)}, {static_cast<double>(size.height)}};
}

void set_crop(Value& film, const PictureCrop& crop) {
    if (auto* table = std::get_if<Table>(&film.data))
        table->named["crop"] = {
            Table{{{double(crop.x0)}, {double(crop.y0)}, {double(crop.x1)}, {double(crop.y1)}}, {}}};
}

void set_gains(Value& film, const std::vector<Gain>& gains) {
    auto* table = std::get_if<Table>(&film.data);
    if (!table || gains.empty()) return;
    auto* entry = std::get_if<Table>(&table->named.try_emplace("gains", Value{Table{}}).first->second.data);
    if (!entry) return;
    for (const auto& [layer, value] : gains)
        entry->named[layer] = {Table{{{double(value.r)}, {double(value.g)}, {double(value.b)}}, {}}};
}

void set_clean(Value& film, bool clean) {
    if (auto* table = std::get_if<Table>(&film.data); table && clean) table->named["clean"] = {true};
}

void set_compression(Value& film, const std::string& name) {
    if (auto* table = std::get_if<Table>(&film.data); table && !name.empty()) table->named["compression"] = {name};
}

void change_scene(Node& scene, const Kind& kind, const PictureOptions& wanted) {
    for (const auto& param : kind.params) {
        if (!wanted.camera.empty() && param.name == "seen_by") scene.params[param.name] = {wanted.camera};
    }
}

}  // namespace

void override_picture(Graph& graph, const Registry& registry, const PictureOptions& wanted) {
    for (auto& node : graph.nodes) {
        const Kind* kind = registry.find(node.kind);
        if (kind && kind->role == Role::scene) change_scene(node, *kind, wanted);
        if (!kind || kind->role != Role::image) continue;
        for (const auto& param : kind->params) {
            if (wanted.samples && param.name == "samples")
                node.params[param.name] = {static_cast<double>(*wanted.samples)};
            if (wanted.noise && param.name == "error") node.params[param.name] = {*wanted.noise};
            if (wanted.alpha && param.name == "alpha") node.params[param.name] = {true};
            if (wanted.alpha && param.name == "background") node.params[param.name] = {false};
            const bool changes =
                wanted.size || wanted.crop || !wanted.gains.empty() || wanted.clean || !wanted.compression.empty();
            if (param.type != ParamType::film || !changes) continue;
            Value& film = node.params.try_emplace(param.name, Value{Table{}}).first->second;
            if (wanted.size) set_size(film, *wanted.size);
            if (wanted.crop) set_crop(film, *wanted.crop);
            set_gains(film, wanted.gains);
            set_clean(film, wanted.clean);
            set_compression(film, wanted.compression);
        }
    }
}

std::string stem_of_pictures(const std::string& graph) {
    return graph == standard_input_name ? "stdin" : std::filesystem::path(graph).stem().string();
}

std::string output_file(const Graph& graph, const Registry& registry, const PictureOptions& wanted) {
    if (!wanted.output.empty()) return wanted.output;
    if (const auto file = film_of(graph, registry).file; !file.empty()) return file;
    return stem_of_pictures(graph.file) + ".exr";
}

}  // namespace lightnet
