// Marble: the light of its input, darker along veins that libnoise makes. libnoise answers for one point at a time, in
// double precision, by an object that has been set up before: so each node has one, and asks it question by question.
#include <libnoise/noise.h>

#include <algorithm>
#include <memory>

#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/plugin.hpp"
#include "core/scene/scene.hpp"

namespace marble {
namespace {

using namespace lightnet;

class Marble final : public LightOp {
public:
    explicit Marble(const NodeContext& here)
        : scene_(here.scene()), inputs_(here.inputs()), scale_(1 / here.number("size")) {
        veins_.SetSeed(static_cast<int>(here.integer("pattern")));  // never by the clock: hosts would differ
        veins_.SetOctaveCount(5);
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        add(ask(inputs_, 0, questions), answers);
        const std::size_t layers = answers.size() / questions.size();
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const float left = brightness_at(scene_.surface(questions[i]).position);
            for (std::size_t layer = 0; layer < layers; ++layer) answers[i * layers + layer] *= left;
        }
    }

private:
    float brightness_at(Vec3 p) const {
        const double noise = veins_.GetValue(p.x * scale_, p.y * scale_, p.z * scale_);  // about -1 to 1
        return static_cast<float>(std::clamp(0.6 + 0.4 * noise, 0.0, 1.0));
    }

    const Scene& scene_;
    Inputs inputs_;
    double scale_;
    noise::module::RidgedMulti veins_;
};

Kind marble_kind() {
    Kind kind;
    kind.name = "Marble";
    kind.help = "its input, darker along veins (libnoise)";
    kind.inputs = {1, 1};
    kind.params = {
        {.name = "size", .help = "of a vein", .unit = "scene units", .initial = Value{200.0}, .least = 0.001},
        {.name = "pattern",
         .type = ParamType::integer,
         .help = "which one",
         .initial = Value{1.0},
         .least = 0,
         .most = 1e9}};
    kind.light.linear = true;
    kind.light.partial = true;
    kind.reads = reading(ScenePart::geometry);
    kind.make_light = [](const NodeContext& here) { return std::make_unique<Marble>(here); };
    return kind;
}

}  // namespace
}  // namespace marble

extern "C" const lightnet::PluginCard* lightnet_plugin() {
    static const lightnet::PluginCard card{
        .name = "marble", .version = "1.0", .add_kinds = [](std::vector<lightnet::Kind>& kinds) {
            kinds.push_back(marble::marble_kind());
        }};
    return &card;
}
