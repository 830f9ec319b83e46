// Adds up light.
#include "core/base/error.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

/// Sums its inputs, in the order in which the graph lists them, each times its weight.
class Combine final : public LightOp {
public:
    explicit Combine(const NodeContext& here) : inputs_(here.inputs()) {
        for (const double weight : here.numbers("weights")) weights_.push_back(static_cast<float>(weight));
        if (weights_.empty()) weights_.assign(inputs_.size(), 1.0f);
        if (weights_.size() != inputs_.size())
            throw Error("Combine '" + here.name() + "'", "has " + std::to_string(inputs_.size()) + " inputs but " +
                                                             std::to_string(weights_.size()) + " weights");
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (const auto& part : ask_all(inputs_, questions)) add(part, answers, weights_[part.index]);
    }

private:
    Inputs inputs_;
    std::vector<float> weights_;
};

}  // namespace

Kind combine_kind() {
    return {
        .name = "Combine",
        .help = "the sum of its inputs, each times its weight",
        .inputs = {1, 64},
        .params = {{.name = "weights",
                    .type = ParamType::numbers,
                    .help = "one per input; none: all 1",
                    .initial = Value{Table{}},
                    .per_input = true}},
        .light = {.linear = true, .space = true},
        .reads = reading(SceneParts()),
        .make_light = [](const NodeContext& here) { return std::make_unique<Combine>(here); },
    };
}

}  // namespace lightnet
