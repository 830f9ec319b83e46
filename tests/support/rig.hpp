// A lighting network of one thread, put together by hand: nodes of a scene that ask each other by calls.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/film/tile.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/scene/scene.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::test {

/// Answers by a function call.
class CallPort final : public Port {
public:
    explicit CallPort(const LightOp& op) : op_(op) {}
    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        std::fill(answers.begin(), answers.end(), Rgb{});
        op_.light(questions, answers);
        return 0;
    }
    void finish(Ticket) override {}
    void abandon(Ticket) noexcept override {}

private:
    const LightOp& op_;
};

class Rig {
public:
    using Params = std::map<std::string, Value>;

    /// `shares`: do nodes share scratch space, as those of one place do? Else each is as on a host of its own.
    explicit Rig(const Scene& scene, std::uint64_t seed = 1, bool shares = true)
        : scene_(scene), seed_(seed), shares_(shares) {}

    /// Makes a node; parameters that aren't given have their defaults.
    const LightOp& add(const std::string& kind, const std::string& name, const std::vector<std::string>& inputs = {},
                       const Params& params = {}) {
        const Kind& known = kind_of(kind);
        const NodeContext here(node(known, name, params), ports(inputs, 0), scene_, seed_, services());
        return *ops_.emplace(name, known.make_light(here)).first->second;
    }

    /// The renderer, with one layer for its own emission and one for all light.
    std::unique_ptr<Renderer> renderer(const std::string& input, const Params& params = {}) {
        const Kind& known = kind_of("RayTracer");
        return known.make_renderer(NodeContext(node(known, "image", params), ports({input}, 1), scene_, seed_));
    }

    /// What path tracing sees: direct light and indirect light.
    std::unique_ptr<Renderer> path_tracer(const Params& direct = {}, const Params& bounce = {}) {
        add("DirectLighting", "direct", {}, direct);
        add("PathTracing", "bounce", {}, bounce);
        add("Combine", "lighting", {"direct", "bounce"});
        return renderer("lighting");
    }

private:
    const Kind& kind_of(const std::string& name) const {
        for (const auto& kind : kinds_)
            if (kind.name == name) return kind;
        throw std::logic_error("no kind called " + name);
    }

    NodeServices services() { return {.scratch = shares_ ? &scratch_ : nullptr}; }

    const Node& node(const Kind& kind, const std::string& name, const Params& params) {
        auto made = std::make_unique<Node>(Node{name, kind.name, {}, params, {}});
        for (const auto& param : kind.params)
            if (param.initial) made->params.emplace(param.name, *param.initial);
        return *nodes_.emplace_back(std::move(made));
    }

    Inputs ports(const std::vector<std::string>& names, std::uint32_t first_layer) {
        std::vector<Input> inputs;
        for (const auto& name : names) {
            ports_.push_back(std::make_unique<CallPort>(*ops_.at(name)));
            inputs.push_back({name, ports_.back().get(), {first_layer}});
        }
        return {std::move(inputs), first_layer + 1};
    }

    const Scene& scene_;
    std::uint64_t seed_;
    bool shares_;
    Scratch scratch_;
    std::vector<Kind> kinds_ = standard_nodes();
    std::vector<std::unique_ptr<Node>> nodes_;
    std::vector<std::unique_ptr<CallPort>> ports_;
    std::map<std::string, std::unique_ptr<LightOp>> ops_;
};

/// The mean radiance that a renderer finds per pixel, all layers added.
inline std::vector<Rgb> picture(const Renderer& renderer, std::uint32_t width, std::uint32_t height,
                                std::uint32_t samples) {
    std::vector<Rgb> sum(std::size_t{width} * height);
    for (std::uint32_t first = 0; first < samples; first += samples_per_block) {
        const Tile tile{0, 0, width, height, first, std::min(samples_per_block, samples - first)};
        std::vector<Rgb> block(2 * sum.size());
        renderer.render(tile, block);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += block[2 * i] + block[2 * i + 1];
    }
    for (auto& pixel : sum) pixel *= 1 / float(samples);
    return sum;
}

/// The mean of a picture's green, and its standard deviation, from the pixels, which are independent.
struct Measured {
    double mean = 0, error = 0;
};
inline Measured measure(const Renderer& renderer, std::uint32_t size, std::uint32_t samples) {
    const auto pixels = picture(renderer, size, size, samples);
    double sum = 0, squares = 0;
    for (const Rgb& pixel : pixels) {
        sum += pixel.g;
        squares += double{pixel.g} * pixel.g;
    }
    const double n = double(pixels.size()), mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

}  // namespace lightnet::test
