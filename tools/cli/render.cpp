#include "tools/cli/render.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "core/base/frame_name.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/frames_beside.hpp"
#include "core/network/graph/value.hpp"
#include "lua/load_graph.hpp"
#include "tools/cli/lightings.hpp"

namespace lightnet {
namespace {

constexpr double usual_fps = 24;

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
    if (!wanted.animation.empty()) scene.params["animation"] = {wanted.animation};
    if (!(wanted.shutter > 0)) return;
    scene.params["shutter"] = {Table{{{0.0}, {wanted.shutter / 360}}, {}}};
    scene.params.try_emplace("fps", Value{wanted.fps > 0 ? wanted.fps : usual_fps});
    scene.params.try_emplace("time", Value{0.0});
}

/// What stands in the place of a graph's own scene.
std::vector<Value> scene_entry(const RenderedScene& wanted, int by) {
    return {{from_anywhere(with_frame(wanted.file, wanted.frame.number + by))}};
}

/// The graph with the scene as it is so many frames later.
Graph in_frame(int by, Graph graph, const RenderedScene& wanted) {
    const auto number = [](Node& node, const char* name) {
        const auto found = node.params.find(name);
        return found == node.params.end() ? nullptr : std::get_if<double>(&found->second.data);
    };
    for (auto& node : graph.nodes) {
        if (node.kind != "Scene") continue;
        if (has_frame_place(wanted.file)) node.entries = scene_entry(wanted, by);
        const double* rate = number(node, "fps");
        if (double* time = number(node, "time")) *time += by / (rate ? *rate : usual_fps);
    }
    return graph;
}

Graph own_graph(const RenderedScene& wanted, const Lighting& lighting) {
    const SourceLine where{wanted.file, 0};
    Graph graph;
    graph.file = wanted.file;
    const std::string file = std::filesystem::path(with_frame(wanted.file, wanted.frame.number)).filename().string();
    graph.nodes.push_back({"scene", "Scene", {{file}}, {}, where});
    Node& scene = graph.nodes.back();
    if (wanted.frame.asked)
        scene.params["time"] = {(wanted.frame.number - 1) / (wanted.fps > 0 ? wanted.fps : usual_fps)};
    if (!wanted.constants.empty()) {
        Table constants;
        for (const auto& [name, value] : wanted.constants) constants.named[name] = {value};
        scene.params["constants"] = {std::move(constants)};
    }
    for (auto& node : nodes_of(lighting, where)) graph.nodes.push_back(std::move(node));
    Node image{"image", "RayTracer", {{NodeRef{graph.nodes.back().name}}}, {}, where};
    image.params["scene"] = {NodeRef{"scene"}};
    image.params["samples"] = {double(usual_samples)};
    image.params["film"] = {Table{{{512.0}, {512.0}}, {}}};  // overridden by the scene's
    graph.nodes.push_back(std::move(image));
    return graph;
}

UserError unknown_lighting(const std::string& name) {
    const auto names = lighting_names();
    return UserError({"--lighting", 0}, "must be " + joined(names) + " or a graph file (.lua), not '" + name + "'" +
                                            did_you_mean(name, names));
}

}  // namespace

// DECISIONS: render-is-a-graph
RenderGraph render_graph(const RenderedScene& wanted) {
    RenderGraph result;
    if (const Lighting* lighting = find_lighting(wanted.lighting)) {
        result.graph = own_graph(wanted, *lighting);
    } else if (!wanted.lighting.ends_with(".lua")) {
        throw unknown_lighting(wanted.lighting);
    } else {
        auto constants = wanted.constants;
        if (wanted.fps > 0) constants["fps"] = number_text(wanted.fps);
        GraphFile file = read_graph(wanted.lighting, {.constants = std::move(constants), .frame = wanted.frame});
        result = {std::move(file.graph), std::move(file.problems)};
        for (auto& node : result.graph.nodes)
            if (node.kind == "Scene") {
                node.entries = scene_entry(wanted, 0);
                for (const char* own : {"previous", "next"}) node.params.erase(own);
            }
    }
    for (auto& node : result.graph.nodes)
        if (node.kind == "Scene") override_scene(node, wanted);
    note_frames_beside(result.graph, [&](int by) { return in_frame(by, result.graph, wanted); });
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
