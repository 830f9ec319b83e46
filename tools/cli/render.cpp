#include "tools/cli/render.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "core/base/frame_name.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/value.hpp"
#include "lua/load_graph.hpp"

namespace lightnet {
namespace {

constexpr double usual_samples = 64, usual_fps = 24;

/// "0.5" or "1,0.9,0.8" as a table of three numbers; none: something else.
std::optional<Table> colour_of(std::string_view text) {
    Table colour;
    while (true) {
        double part = 0;
        const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), part);
        if (fault != std::errc{}) return std::nullopt;
        colour.list.push_back({part});
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.empty()) break;
        if (text[0] != ',') return std::nullopt;
        text.remove_prefix(1);
    }
    if (colour.list.size() == 1) colour.list.resize(3, colour.list[0]);
    return colour;
}

/// Files in a graph are named from the graph's folder, wherever the user stands.
std::string from_anywhere(const std::string& file) { return std::filesystem::absolute(file).lexically_normal(); }

void override_scene(Node& scene, const RenderedScene& wanted) {
    if (!wanted.environment.empty()) {
        if (auto colour = colour_of(wanted.environment))
            scene.params["environment"] = {std::move(*colour)};
        else
            scene.params["environment"] = {from_anywhere(wanted.environment)};
    }
    if (wanted.two_sided) scene.params["two_sided"] = {true};
    if (!(wanted.shutter > 0)) return;
    scene.params["shutter"] = {Table{{{0.0}, {wanted.shutter / 360}}, {}}};
    scene.params.try_emplace("fps", Value{wanted.fps > 0 ? wanted.fps : usual_fps});
    scene.params.try_emplace("time", Value{0.0});
}

/// `kinds`: what is added up.
Graph own_graph(const RenderedScene& wanted, const std::vector<std::string>& kinds) {
    const SourceLine where{wanted.file, 0};
    Graph graph;
    graph.file = wanted.file;
    const std::string file = std::filesystem::path(with_frame(wanted.file, wanted.frame.number)).filename().string();
    graph.nodes.push_back({"scene", "Scene", {{file}}, {}, where});
    if (wanted.frame.asked)
        graph.nodes.back().params["time"] = {(wanted.frame.number - 1) / (wanted.fps > 0 ? wanted.fps : usual_fps)};
    Node sum{"light", "Combine", {}, {}, where};
    for (const auto& kind : kinds) {
        const std::string name = kind == "DirectLighting" ? "direct" : kind == "PathTracing" ? "bounce" : "openness";
        graph.nodes.push_back({name, kind, {}, {}, where});
        sum.entries.push_back({NodeRef{name}});
    }
    graph.nodes.push_back(std::move(sum));
    Node image{"image", "RayTracer", {{NodeRef{"light"}}}, {}, where};
    image.params["scene"] = {NodeRef{"scene"}};
    image.params["samples"] = {usual_samples};
    image.params["film"] = {Table{{{512.0}, {512.0}}, {}}};  // overridden by the scene's
    graph.nodes.push_back(std::move(image));
    return graph;
}

}  // namespace

// DECISIONS: render-is-a-graph
RenderGraph render_graph(const RenderedScene& wanted) {
    static const std::map<std::string, std::vector<std::string>> kinds{
        {"ao", {"AmbientOcclusion"}}, {"direct", {"DirectLighting"}}, {"path", {"DirectLighting", "PathTracing"}}};
    RenderGraph result;
    if (const auto kind = kinds.find(wanted.lighting); kind != kinds.end()) {
        result.graph = own_graph(wanted, kind->second);
        if (!wanted.constants.empty()) {
            Table constants;
            for (const auto& [name, value] : wanted.constants) constants.named[name] = {value};
            result.graph.nodes.front().params["constants"] = {std::move(constants)};
        }
    } else if (!wanted.lighting.ends_with(".lua")) {
        throw UserError({"--lighting", 0}, "must be path, direct, ao or a graph file (.lua), not '" + wanted.lighting +
                                               "'" + did_you_mean(wanted.lighting, {"path", "direct", "ao"}));
    } else {
        auto constants = wanted.constants;
        if (wanted.fps > 0) constants["fps"] = number_text(wanted.fps);
        GraphFile file = read_graph(wanted.lighting, {.constants = std::move(constants), .frame = wanted.frame});
        result = {std::move(file.graph), std::move(file.problems)};
        for (auto& node : result.graph.nodes)
            if (node.kind == "Scene") node.entries = {{from_anywhere(with_frame(wanted.file, wanted.frame.number))}};
    }
    for (auto& node : result.graph.nodes)
        if (node.kind == "Scene") override_scene(node, wanted);
    return result;
}

std::optional<PictureCrop> crop_in_pixels(const std::array<float, 4>& crop, const PictureSize& size) {
    const auto edge = [](float part, std::uint32_t side) {
        return static_cast<std::uint32_t>(std::ceil(std::clamp(part, 0.0f, 1.0f) * static_cast<float>(side)));
    };
    const PictureCrop made{edge(crop[0], size.width), edge(crop[2], size.height), edge(crop[1], size.width),
                           edge(crop[3], size.height)};
    if (made.x0 >= made.x1 || made.y0 >= made.y1 || made == PictureCrop{0, 0, size.width, size.height})
        return std::nullopt;
    return made;
}

std::string picture_of(const std::string& scene) { return std::filesystem::path(scene).stem().string() + ".exr"; }

}  // namespace lightnet
