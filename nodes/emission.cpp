// Emission: the light of what shines by itself.
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// Answers with the radiance that the surface itself emits. The renderer sees that anyhow; nodes that gather light from
/// other surfaces do not.
class SelfEmission final : public LightOp {
public:
    explicit SelfEmission(const NodeContext& here) : scene_(here.scene()) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const SurfacePoint point = scene_.surface(questions[i]);
            answers[i * scene_.lights().groups() + scene_.lights().group_of(point)] =
                scene_.lights().emission(point, questions[i].outgoing);
        }
    }

private:
    const Scene& scene_;
};

}  // namespace

Kind emission_kind() {
    return {
        .name = "Emission",
        .help =
            "emitted light: what surfaces shine by themselves; for nodes that gather light, as the renderer sees it "
            "anyhow",
        .light = {.lamps = true, .groups = true, .paths = always({"O"})},
        .reads = reading(ScenePart::geometry | ScenePart::lamps),
        .make_light = [](const NodeContext& here) { return std::make_unique<SelfEmission>(here); },
    };
}

}  // namespace lightnet
