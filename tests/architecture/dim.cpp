// Dim: passes on a part of the light of its input. The example of CONTRIBUTING.md.
#include <memory>

#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

class Dim final : public LightOp {
public:
    explicit Dim(const NodeContext& here)
        : inputs_(here.inputs()), strength_(static_cast<float>(here.number("strength"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (const Part& part : ask_all(inputs_, questions)) add(part, answers, strength_);
    }

private:
    Inputs inputs_;
    float strength_;
};

}  // namespace

Kind dim_kind() {
    return {.name = "Dim",
            .help = "passes on a part of the light of its input",
            .inputs = {1, 1},
            .params = {{.name = "strength", .help = "the part", .initial = Value{0.5}, .least = 0}},
            .light = {.linear = true},
            .reads = reading(SceneParts()),
            .make_light = [](const NodeContext& here) { return std::make_unique<Dim>(here); }};
}

}  // namespace lightnet
