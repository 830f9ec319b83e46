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
#include "core/graph/check.hpp"
#include "core/graph/graph_film.hpp"
#include "core/runtime/serial.hpp"
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

    /// Mean radiance per pixel, all layers added.
    std::vector<Rgb> picture(std::uint32_t samples, std::uint64_t seed = 1) const {
        auto nodes = nodes_;
        const Value film{Table{{Value{double(width_)}, Value{double(height_)}}, {}}};
        nodes.push_back({"image",
                         "RayTracer",
                         {Value{NodeRef{nodes_.back().name}}},
                         {{"scene", Value{NodeRef{"scene"}}}, {"film", film}},
                         {"test.lua", 1}});
        const Network network{check({"test.lua", std::move(nodes)}, registry_), registry_, scene_, seed};
        SerialRun run(network);
        run.prepare("");
        const std::size_t layers = network.layers.film.size();
        std::vector<Rgb> sum(std::size_t{width_} * height_);
        for (std::uint32_t first = 0; first < samples; first += samples_per_block) {
            const auto block =
                run.render({0, 0, width_, height_, first, std::min(samples_per_block, samples - first), 1});
            for (std::size_t i = 0; i < block.size(); ++i) sum[i / layers] += block[i] / float(samples);
        }
        return sum;
    }

    const Scene& scene() const { return *scene_; }

private:
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
};

inline double mean_of(const std::vector<Rgb>& pixels) {
    double sum = 0;
    for (const Rgb& pixel : pixels) sum += pixel.g;
    return sum / double(pixels.size());
}

}  // namespace lightnet::test
