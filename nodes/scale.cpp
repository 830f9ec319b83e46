// Light, made stronger, weaker or coloured.
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

/// Its input, times a number and a colour; each layer of it alike.
class Scale final : public LightOp {
public:
    explicit Scale(const NodeContext& here) : inputs_(here.inputs()) {
        const auto factor = static_cast<float>(here.number("factor"));
        const auto colour = here.numbers("colour");
        factor_ = {factor, factor, factor};
        if (colour.size() == 3)
            factor_ *= Rgb{static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2])};
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        add(ask(inputs_, 0, questions), answers);
        for (Rgb& answer : answers) answer *= factor_;
    }

private:
    Inputs inputs_;
    Rgb factor_;
};

}  // namespace

Kind scale_kind() {
    return {
        .name = "Scale",
        .help = "its input times a number, and times a colour",
        .inputs = {1, 1},
        .params = {{.name = "factor", .help = "for all colours", .initial = Value{1.0}, .least = 0},
                   {.name = "colour",
                    .type = ParamType::numbers,
                    .help = "factors for red, green and blue; none: all 1",
                    .initial = Value{Table{}},
                    .least = 0,
                    .count = 3}},
        .light = {.linear = true, .partial = true, .space = true},
        .reads = reading(SceneParts()),
        .make_light = [](const NodeContext& here) { return std::make_unique<Scale>(here); },
    };
}

}  // namespace lightnet
