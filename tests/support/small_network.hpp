// A whole network of one thread over a scene made in code, prepared and rendered as runs are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/film/tile.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/serial/serial.hpp"
#include "core/scene/scene.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::test {

/// Nodes are added inputs first, then picture() makes the picture of the last.
class SmallNetwork {
public:
    using Params = std::map<std::string, Value>;

    SmallNetwork(SceneData data, std::uint32_t width, std::uint32_t height)
        : width_(width), height_(height), scene_(std::make_shared<const Scene>(std::move(data), options())) {
        nodes_.push_back({"scene", "Scene", {Value{std::string("none.pbrt")}}, {}, {"test.lua", 1}});
    }

    SmallNetwork& add(const std::string& name, const std::string& kind, const std::vector<std::string>& inputs = {},
                      Params params = {}) {
        Node node{name, kind, {}, std::move(params), {"test.lua", 1}};
        for (const auto& input : inputs) node.entries.push_back(Value{NodeRef{input}});
        nodes_.push_back(std::move(node));
        return *this;
    }

    /// The picture is that of this node instead of the last.
    SmallNetwork& lit_by(const std::string& name) {
        lit_by_ = name;
        return *this;
    }

    /// Nodes whose own light is kept beside the picture.
    SmallNetwork& show(const std::vector<std::string>& names) {
        for (const auto& name : names) shown_.list.push_back(Value{NodeRef{name}});
        return *this;
    }

    /// The scene has these groups of lamps, whose names it was sorted by (sort_lamps); the renderer keeps them apart.
    SmallNetwork& groups(const std::vector<std::string>& names) {
        Table groups;
        for (const auto& name : names) groups.named[name] = Value{std::string("*")};
        nodes_.front().params["groups"] = Value{groups};
        grouped_ = true;
        return *this;
    }

    /// Mean radiance per pixel, all layers added.
    std::vector<Rgb> picture(std::uint32_t samples, std::uint64_t seed = 1) const {
        std::vector<Rgb> sum(std::size_t{width_} * height_);
        const Network network = assembled(seed);
        const std::size_t colours = colours_of(network.layers);
        render(network, samples, [&](std::size_t i, Rgb part) {
            if (i % colours < network.layers.film.size()) sum[i / colours] += part;
        });
        return sum;
    }

    /// Renders with this flag, which the renderer has.
    SmallNetwork& with(const std::string& flag, bool value) {
        flags_[flag] = Value{value};
        return *this;
    }

    /// Renders what pictures are cleaned by, too.
    SmallNetwork& for_cleaning() {
        for_cleaning_ = true;
        return *this;
    }

    /// The same of each layer, and of what is shown beside them, by name; of ids each rank, as "name 0".
    std::map<std::string, std::vector<Rgb>> pictures(std::uint32_t samples, std::uint64_t seed = 1) const {
        const Network network = assembled(seed);
        auto names = network.layers.film;
        const auto shown = shown_names(network.layers, network.graph);
        for (std::size_t i = 0; i < shown.size(); ++i) {
            const std::uint32_t ids = i < network.layers.ids.size() ? network.layers.ids[i] : 0;  // halves have none
            if (!ids) names.push_back(shown[i]);
            for (std::uint32_t rank = 0; rank < ids; ++rank) names.push_back(shown[i] + " " + std::to_string(rank));
        }
        if (network.layers.alpha) names.emplace_back("A");
        std::map<std::string, std::vector<Rgb>> all;
        for (const auto& name : names) all[name].resize(std::size_t{width_} * height_);
        render(network, samples,
               [&](std::size_t i, Rgb part) { all[names[i % names.size()]][i / names.size()] += part; });
        return all;
    }

    const Scene& scene() const { return *scene_; }

private:
    Network assembled(std::uint64_t seed) const {
        auto nodes = nodes_;
        const Value film{Table{{Value{double(width_)}, Value{double(height_)}}, {{"clean", Value{for_cleaning_}}}}};
        Params params{
            {"scene", Value{NodeRef{"scene"}}}, {"film", film}, {"show", Value{shown_}}, {"groups", Value{grouped_}}};
        params.insert(flags_.begin(), flags_.end());
        nodes.push_back({"image",
                         "RayTracer",
                         {Value{NodeRef{lit_by_.empty() ? nodes_.back().name : lit_by_}}},
                         std::move(params),
                         {"test.lua", 1}});
        return {check({"test.lua", std::move(nodes)}, registry_), registry_, scene_, seed};
    }

    // Calls add(index of the colour, part of its mean) for all blocks.
    template <class Add>
    void render(const Network& network, std::uint32_t samples, const Add& add) const {
        SerialRun run(network);
        run.prepare("");
        for (std::uint32_t first = 0; first < samples; first += samples_per_block) {
            const auto block =
                run.render({0, 0, width_, height_, first, std::min(samples_per_block, samples - first), 1});
            for (std::size_t i = 0; i < block.size(); ++i) add(i, block[i] / float(samples));
        }
    }

    SceneOptions options() const {
        SceneOptions options;
        options.width = width_;
        options.height = height_;
        return options;
    }

    std::uint32_t width_, height_;
    Registry registry_{standard_nodes()};
    std::shared_ptr<const Scene> scene_;
    std::vector<Node> nodes_;
    std::string lit_by_;
    Table shown_;
    Params flags_;
    bool for_cleaning_ = false;
    bool grouped_ = false;
};

inline double mean_of(const std::vector<Rgb>& pixels) {
    double sum = 0;
    for (const Rgb& pixel : pixels) sum += pixel.g;
    return sum / double(pixels.size());
}

}  // namespace lightnet::test
