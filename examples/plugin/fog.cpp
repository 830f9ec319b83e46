// Fog: the light of its input, weaker the farther it is from a point, as if through haze. A plugin: it is built against
// an installed lightnet, and knows nothing of where it runs.
#include <cmath>
#include <memory>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/plugin.hpp"
#include "core/scene/scene.hpp"

namespace fog {
namespace {

using namespace lightnet;

class Fog final : public LightOp {
public:
    explicit Fog(const NodeContext& here)
        : scene_(here.scene()), inputs_(here.inputs()), from_(here.numbers("from")), half_(here.number("half")) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        add(ask(inputs_, 0, questions), answers);
        const std::size_t layers = answers.size() / questions.size();
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const float clear = clearness_at(scene_.surface(questions[i]).position);
            for (std::size_t layer = 0; layer < layers; ++layer) answers[i * layers + layer] *= clear;
        }
    }

private:
    float clearness_at(Vec3 p) const {
        const float x = p.x - static_cast<float>(from_[0]), y = p.y - static_cast<float>(from_[1]),
                    z = p.z - static_cast<float>(from_[2]);
        return static_cast<float>(half_ / (half_ + std::sqrt(x * x + y * y + z * z)));
    }

    const Scene& scene_;
    Inputs inputs_;
    std::vector<double> from_;
    double half_;
};

Kind fog_kind() {
    return {.name = "Fog",
            .help = "its input, weaker with the distance from a point",
            .inputs = {1, 1},
            .params = {{.name = "from",
                        .type = ParamType::numbers,
                        .help = "where it is clear",
                        .unit = "scene units",
                        .count = 3},
                       {.name = "half",
                        .help = "at this distance half of the light is left",
                        .unit = "scene units",
                        .initial = Value{500.0},
                        .least = 0.001}},
            .light = {.linear = true, .partial = true},
            .reads = lightnet::reading(lightnet::ScenePart::geometry),
            .make_light = [](const NodeContext& here) { return std::make_unique<Fog>(here); }};
}

}  // namespace
}  // namespace fog

extern "C" const lightnet::PluginCard* lightnet_plugin() {
    static const lightnet::PluginCard card{
        .name = "fog", .version = "1.0", .add_kinds = [](std::vector<lightnet::Kind>& kinds) {
            kinds.push_back(fog::fog_kind());
        }};
    return &card;
}
