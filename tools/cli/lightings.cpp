#include "tools/cli/lightings.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {
namespace {

constexpr double paths_per_sample = 4, paths_per_lesson = 24, least_lessons = 60000;
constexpr double wanted_error = 0.04, photons_per_sample = 100000;

/// Writes nodes as a graph file does.
class Nodes {
public:
    explicit Nodes(SourceLine where) : where_(std::move(where)) {}

    Nodes& add(std::string name, std::string kind, std::vector<std::string> inputs = {},
               std::map<std::string, Value> params = {}) {
        nodes_.push_back({std::move(name), std::move(kind), {}, std::move(params), where_});
        for (auto& input : inputs) nodes_.back().entries.push_back({NodeRef{std::move(input)}});
        return *this;
    }
    std::vector<Node> take() { return std::move(nodes_); }

private:
    SourceLine where_;
    std::vector<Node> nodes_;
};

Value number(double value) { return {value}; }
Value text(const char* value) { return {std::string(value)}; }

// graphs/path_all.lua, and with a guide graphs/guided.lua
std::vector<Node> path_nodes(Nodes nodes, bool guided) {
    std::map<std::string, Value> params{{"paths", text("all")}, {"samples", number(paths_per_sample)}};
    if (guided) {
        nodes.add("guide", "Guide", {}, {{"paths", number(least_lessons)}, {"when", text("worthwhile")}});
        params["guide"] = {NodeRef{"guide"}};
    }
    return nodes.add("lighting", "PathTracing", {}, std::move(params)).take();
}

// graphs/irradiance_cache.lua
std::vector<Node> cache_nodes(Nodes nodes) {
    return nodes.add("direct", "DirectLighting", {}, {{"samples", number(1)}})
        .add("paths", "PathTracing", {}, {{"paths", text("all")}, {"samples", number(1)}})
        .add("caustics", "PhotonMap", {}, {{"paths", text("caustic")}, {"error", number(wanted_error)}})
        .add("soft", "IrradianceCache", {"paths"}, {{"rays", number(0)}, {"error", number(wanted_error)}})
        .add("lighting", "Combine", {"direct", "caustics", "soft"})
        .take();
}

// graphs/paper/figure5.lua
std::vector<Node> figure5_nodes(Nodes nodes) {
    const auto map = [&](const char* name, const char* paths) {
        nodes.add(
            name, "PhotonMap", {},
            {{"paths", text(paths)}, {"photons", number(0)}, {"error", number(wanted_error)}, {"gather", number(50)}});
    };
    nodes.add("direct", "DirectLighting", {}, {{"samples", number(1)}});
    map("caustics", "caustic");
    map("global", "diffuse");
    return nodes.add("first", "Combine", {"direct", "caustics", "global"})
        .add("soft", "IrradianceCache", {"first"},
             {{"rays", number(0)}, {"glossy_rays", number(4)}, {"error", number(wanted_error)}})
        .add("lighting", "Combine", {"direct", "caustics", "soft"})
        .take();
}

// graphs/progressive.lua
std::vector<Node> progressive_nodes(Nodes nodes) {
    return nodes.add("direct", "DirectLighting", {}, {{"samples", number(1)}})
        .add("indirect", "ProgressivePhotonMapping", {},
             {{"paths", text("indirect")}, {"photons", number(photons_per_sample)}})
        .add("lighting", "Combine", {"direct", "indirect"})
        .take();
}

}  // namespace

const std::vector<Lighting>& lightings() {
    static const std::vector<Lighting> all{
        {.name = "path", .graph = "path.lua", .shows = "all light paths, direct light apart"},
        {.name = "path_all",
         .graph = "path_all.lua",
         .on_trial = true,
         .shows = "all light paths in one layer, quicker"},
        {.name = "irradiance_cache",
         .graph = "irradiance_cache.lua",
         .is_biased = true,
         .on_trial = true,
         .covers = Covers::soft,
         .shows = "soft light interpolated, caustics by photons"},
        {.name = "progressive",
         .graph = "progressive.lua",
         .is_biased = true,
         .on_trial = true,
         .covers = Covers::caustics,
         .shows = "photons, for caustics"},
        {.name = "guided",
         .graph = "guided.lua",
         .learns = true,
         .on_trial = true,
         .covers = Covers::narrow,
         .shows = "paths that learn where light is"},
        {.name = "figure5",
         .graph = "paper/figure5.lua",
         .is_biased = true,
         .on_trial = true,
         .covers = Covers::all,
         .shows = "soft light interpolated over photon maps"},
        {.name = "direct", .graph = "", .shows = "direct light only"},
        {.name = "ao", .graph = "", .shows = "ambient occlusion"},
    };
    return all;
}

const Lighting* find_lighting(std::string_view name) {
    const auto found = std::find_if(lightings().begin(), lightings().end(),
                                    [&](const Lighting& lighting) { return lighting.name == name; });
    return found == lightings().end() ? nullptr : &*found;
}

std::vector<std::string> lighting_names() {
    std::vector<std::string> names{std::string(lighting_by_trials)};
    for (const auto& lighting : lightings()) names.push_back(lighting.name);
    return names;
}

std::vector<Node> nodes_of(const Lighting& lighting, const SourceLine& where) {
    Nodes nodes(where);
    const auto& name = lighting.name;
    if (name == "path_all" || name == "guided") return path_nodes(std::move(nodes), name == "guided");
    if (name == "irradiance_cache") return cache_nodes(std::move(nodes));
    if (name == "figure5") return figure5_nodes(std::move(nodes));
    if (name == "progressive") return progressive_nodes(std::move(nodes));
    if (name == "ao") return nodes.add("openness", "AmbientOcclusion").add("light", "Combine", {"openness"}).take();
    nodes.add("direct", "DirectLighting");
    if (name == "direct") return nodes.add("light", "Combine", {"direct"}).take();
    return nodes.add("bounce", "PathTracing").add("light", "Combine", {"direct", "bounce"}).take();
}

double lessons_of(std::uint64_t pixels, std::uint64_t samples) {
    return std::max(least_lessons,
                    double(pixels * samples * std::uint64_t(paths_per_sample) / std::uint64_t(paths_per_lesson)));
}

void settle_lighting(Graph& graph, std::uint64_t pixels, std::uint64_t samples) {
    constexpr double most_lessons = 1 << 24;  // of the kind
    for (auto& node : graph.nodes)
        if (node.kind == "Guide") {
            node.params["paths"] = number(std::min(most_lessons, lessons_of(pixels, samples)));
            node.params["picture"] = number(double(pixels * samples) * paths_per_sample);
        }
}

}  // namespace lightnet
