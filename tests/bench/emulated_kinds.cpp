#include "tests/bench/emulated_kinds.hpp"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"

namespace lightnet::bench {
namespace {

using Clock = std::chrono::steady_clock;

// One replica's share of the waiting. Waits that the system made too long are taken off the next ones.
class Cost {
public:
    Cost(double seconds, std::shared_ptr<Slowness> slowness)
        : seconds_(seconds), slowness_(std::move(slowness)), replica_(slowness_ ? slowness_->made++ : 0) {}

    void pay(double units) const {
        const double factor = slowness_ ? slowness_->of(replica_) : 1;
        const auto wanted =
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds_ * units * factor));
        const auto begun = Clock::now();
        std::this_thread::sleep_until(begun + wanted - std::min(*owed_, wanted));
        *owed_ = std::max(Clock::duration{}, *owed_ + (Clock::now() - begun) - wanted);
        *owed_ = std::min(*owed_, most_owed);
    }

private:
    static constexpr Clock::duration most_owed = std::chrono::milliseconds(20);
    double seconds_;
    std::shared_ptr<Slowness> slowness_;
    int replica_;
    std::unique_ptr<Clock::duration> owed_ = std::make_unique<Clock::duration>();
};

class EmulatedLight final : public LightOp {
public:
    EmulatedLight(const NodeContext& here, std::shared_ptr<Slowness> slowness)
        : inputs_(here.inputs()), cost_(here.number("microseconds") * 1e-6, std::move(slowness)) {}
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        cost_.pay(static_cast<double>(questions.size()));
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = {1, questions[i].u, 0};
        for (const auto& part : ask_all(inputs_, questions)) lightnet::add(part, answers);
    }

private:
    Inputs inputs_;
    Cost cost_;
};

class EmulatedImage final : public Renderer {
public:
    EmulatedImage(const NodeContext& here, std::shared_ptr<Slowness> slowness)
        : inputs_(here.inputs()),
          questions_(static_cast<std::size_t>(here.number("questions"))),
          cost_(here.number("milliseconds") * 1e-3, std::move(slowness)) {}
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        cost_.pay(1);
        if (inputs_.empty()) return;
        std::vector<Query> questions(questions_);
        for (std::size_t i = 0; i < questions.size(); ++i) {
            questions[i].geometry = tile.x;
            questions[i].sample = static_cast<std::uint32_t>(i);
        }
        std::vector<Rgb> answers(questions.size() * inputs_.layers());
        for (const auto& part : ask_all(inputs_, questions)) lightnet::add(part, answers);
        for (std::size_t i = 0; i < answers.size(); ++i) pixels[i % inputs_.layers()] += answers[i];
    }

private:
    Inputs inputs_;
    std::size_t questions_;
    Cost cost_;
};

}  // namespace

double Slowness::of(int replica) const {
    const auto known = static_cast<std::size_t>(replica) < of_replica.size();
    const double usual = known ? of_replica[static_cast<std::size_t>(replica)] : of_others;
    return replica == slowed && Clock::now() >= slowed_at ? 10 * usual : usual;
}

std::vector<Kind> emulated_kinds_with(std::shared_ptr<Slowness> light, std::shared_ptr<Slowness> image) {
    return {{.name = "EmulatedLight",
             .help = "waits",
             .inputs = {0, 8},
             .params = {{.name = "microseconds", .help = "per question"}},
             .make_light = [=](const NodeContext& here) { return std::make_unique<EmulatedLight>(here, light); }},
            {.name = "EmulatedImage",
             .role = Role::image,
             .help = "waits, and asks",
             .inputs = {0, 8},
             .params = {{.name = "milliseconds", .help = "per tile"},
                        {.name = "questions", .help = "per tile"},
                        {.name = "samples", .help = "per pixel, which launchers want", .optional = true},
                        {.name = "scene", .type = ParamType::scene, .help = "is not seen", .optional = true},
                        {.name = "film", .type = ParamType::film, .help = "which jobs have to have"}},
             .make_renderer = [=](const NodeContext& here) { return std::make_unique<EmulatedImage>(here, image); }}};
}

}  // namespace lightnet::bench
