// Operators and renderers that answer falsely now and then, as on a host with bad memory, or one that means ill.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::test {

/// Decides when to lie: in such a part of all calls, and otherwise in each process than in others.
class Whim {
public:
    explicit Whim(double part) : part_(part) {}
    bool strikes() { return static_cast<double>(child(seed_, 0, count_++) >> 11) * 0x1p-53 < part_; }

private:
    double part_;
    Key seed_ = mix(reinterpret_cast<std::uintptr_t>(this));
    std::atomic<std::uint64_t> count_{0};
};

/// One of its answers is a bit off, where the whim strikes.
class LyingOp final : public LightOp {
public:
    LyingOp(std::unique_ptr<LightOp> honest, std::shared_ptr<Whim> whim)
        : honest_(std::move(honest)), whim_(std::move(whim)) {}
    void prepare(Services& services) override { honest_->prepare(services); }
    Frozen frozen() const override { return honest_->frozen(); }
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        honest_->light(questions, answers);
        if (!answers.empty() && whim_->strikes()) answers.front() += Rgb{0.01f, 0, 0};
    }

private:
    std::unique_ptr<LightOp> honest_;
    std::shared_ptr<Whim> whim_;
};

/// The same for blocks of tiles.
class LyingRenderer final : public Renderer {
public:
    LyingRenderer(std::unique_ptr<Renderer> honest, std::shared_ptr<Whim> whim)
        : honest_(std::move(honest)), whim_(std::move(whim)) {}

private:
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        honest_->render(tile, pixels);
        if (!pixels.empty() && !tile.rehearses() && whim_->strikes()) pixels.front() += Rgb{0.01f, 0, 0};
    }

    std::unique_ptr<Renderer> honest_;
    std::shared_ptr<Whim> whim_;
};

/// All kinds of the product; that of this name lies.
inline Registry with_liar(const std::string& name, double part) {
    auto kinds = standard_nodes();
    const auto whim = std::make_shared<Whim>(part);
    for (auto& kind : kinds) {
        if (kind.name != name) continue;
        if (kind.make_light)
            kind.make_light = [whim, honest = kind.make_light](const NodeContext& here) {
                return std::make_unique<LyingOp>(honest(here), whim);
            };
        if (kind.make_renderer)
            kind.make_renderer = [whim, honest = kind.make_renderer](const NodeContext& here) {
                return std::make_unique<LyingRenderer>(honest(here), whim);
            };
    }
    return Registry(std::move(kinds));
}

}  // namespace lightnet::test
