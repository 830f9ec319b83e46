// A node that uses every service of preparing, for tests: it keeps the light of the points that a rehearsal met.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/network/light/services.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::test {

/// Answers with the light of its input at the point of the rehearsal that is nearest on the same primitive, tinted by
/// what its shards computed; asks its input where there is no such point.
class Learner final : public LightOp {
public:
    explicit Learner(const NodeContext& here)
        : here_(here),
          inputs_(here.inputs()),
          rehearsal_(here.rehearsal()),
          stride_(static_cast<std::uint32_t>(here.integer("stride"))) {}

    void prepare(Services& services) override {
        const auto numbers = services.map<std::uint64_t>(9, [](std::size_t shard, std::vector<std::uint64_t>& out) {
            for (std::size_t i = 0; i < shard; ++i) out.push_back(child(7, shard, i));
        });
        std::uint64_t sum = 0, turn = 1;
        for (const auto number : numbers) sum += number % 1000 * ++turn;
        tint_ = 1 + static_cast<float>(sum % 97) / 100;
        for (const auto stride : {2 * stride_, stride_}) {
            const auto noted = services.rehearse(stride);
            constexpr std::size_t at_once = 20;
            const auto lit = services.map<Rgb>((noted.size() + at_once - 1) / at_once, [&](auto shard, auto& out) {
                const auto first = shard * at_once, count = std::min(at_once, noted.size() - first);
                out = ask(inputs_, 0, std::span(noted).subspan(first, count)).answers;
            });
            for (std::size_t i = 0; i < noted.size(); ++i) known_.push_back({noted[i], lit.all()[i]});
        }
        services.say(std::to_string(known_.size()) + " points at " + std::to_string(here_.whereabouts().places) +
                     " places");
        order_ = services.once<std::vector<std::uint32_t>>([&] {
            std::vector<std::uint32_t> order(known_.size());
            for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
            return order;
        });
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) {
            if (const auto* point = nearest(questions[i])) {
                answers[i] = point->second * tint_;
            } else {
                rehearsal_.note(questions[i]);
                answers[i] = ask(inputs_, 0, questions.subspan(i, 1)).answers[0] * 0.5f;
            }
        }
    }

private:
    using Known = std::pair<Query, Rgb>;

    const Known* nearest(const Query& q) const {
        const Known* best = nullptr;
        float least = 0.02f;
        for (const auto& known : known_) {
            const auto& k = known.first;
            const float d = (k.u - q.u) * (k.u - q.u) + (k.v - q.v) * (k.v - q.v);
            if (k.geometry == q.geometry && k.primitive == q.primitive && d < least) best = &known, least = d;
        }
        return best;
    }

    NodeContext here_;
    Inputs inputs_;
    Rehearsal& rehearsal_;
    std::uint32_t stride_;
    float tint_ = 0;
    std::vector<Known> known_;
    std::shared_ptr<const std::vector<std::uint32_t>> order_;
};

inline Kind learner() {
    Kind kind{.name = "Learner", .help = "remembers light that it has met", .inputs = {1, 1}};
    kind.run.prepares = kind.run.rehearses = true;
    kind.params = {{.name = "stride",
                    .type = ParamType::integer,
                    .help = "of the rehearsals",
                    .unit = "pixels",
                    .initial = Value{4.0},
                    .least = 1,
                    .most = 16}};
    kind.make_light = [](const NodeContext& here) { return std::make_unique<Learner>(here); };
    return kind;
}

/// All kinds of the product, and the learner.
inline Registry with_learner() {
    auto kinds = standard_nodes();
    kinds.push_back(learner());
    return Registry(std::move(kinds));
}

}  // namespace lightnet::test
