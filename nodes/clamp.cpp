// Light without fireflies.
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

/// Its input, darkened to `most` in its strongest colour where it is brighter, the hue kept. That makes images
/// less noisy and too dark: a bias. The sum of the input's layers counts, so the image has one layer for all of them.
/// What isn't a number becomes black.
class Clamp final : public LightOp {
public:
    explicit Clamp(const NodeContext& here) : inputs_(here.inputs()), most_(static_cast<float>(here.number("most"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        const Part part = ask(inputs_, 0, questions);
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const Rgb given = part.answers[i];
            if (!finite(given)) continue;
            const float strongest = max_component(given);
            answers[i] = strongest > most_ ? given * (most_ / strongest) : given;
        }
    }

private:
    Inputs inputs_;
    float most_;
};

}  // namespace

Kind clamp_kind() {
    return {
        .name = "Clamp",
        .help = "its input without fireflies: less noise, and a little too dark",
        .inputs = {1, 1},
        .params = {{.name = "most",
                    .help = "of each answer, in its strongest colour",
                    .unit = "W·sr⁻¹·m⁻²",
                    .initial = Value{10.0},
                    .least = 0}},
        .light = {.space = true, .onward = ""},
        .reads = reading(SceneParts()),
        .make_light = [](const NodeContext& here) { return std::make_unique<Clamp>(here); },
    };
}

}  // namespace lightnet
