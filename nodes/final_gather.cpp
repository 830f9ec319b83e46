// Final gathering: light by one more bounce, from surfaces as another operator sees them.
#include <algorithm>

#include "core/estimate/gather.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

/// Final gathering: samples directions by the BSDF, and asks its input about what is there. Reichert 1992, as Jensen
/// 1996 uses it over a photon map. Adds no bias of its own.
class FinalGather final : public LightOp {
public:
    explicit FinalGather(const NodeContext& here)
        : scene_(here.scene()),
          inputs_(here.inputs()),
          key_(here.key()),
          rays_(static_cast<std::uint32_t>(here.integer("rays"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        const std::size_t width = inputs_[0].width();
        const std::size_t at_once = std::max<std::size_t>(1, rays_at_once / rays_);
        for (std::size_t first = 0; first < questions.size(); first += at_once) {
            const std::size_t count = std::min(at_once, questions.size() - first);
            gather_some(questions.subspan(first, count), answers.subspan(first * width, count * width));
        }
    }

private:
    void gather_some(std::span<const Query> questions, std::span<Rgb> answers) const {
        BsdfGather gathered(scene_, key_, rays_);
        for (std::size_t q = 0; q < questions.size(); ++q) {
            const SurfacePoint point = scene_.surface(questions[q]);
            gathered.add(q, questions[q], point, scene_.bsdf(point), questions[q].lobes,
                         child(questions[q].stream, key_));
        }
        gathered.answer(inputs_, answers);
    }

    static constexpr std::size_t rays_at_once = 4096;

    const Scene& scene_;
    Inputs inputs_;
    Key key_;
    std::uint32_t rays_;
};

}  // namespace

Kind final_gather_kind() {
    return {
        .name = "FinalGather",
        .help = "final gathering: light by one more bounce, off surfaces that its input tells the brightness of",
        .inputs = {1, 1},
        .params = {{.name = "rays",
                    .type = ParamType::integer,
                    .help = "directions per question",
                    .unit = "rays",
                    .initial = Value{1.0},
                    .least = 1,
                    .most = 65536}},
        .light = {.space = true, .groups = true, .onward = "S*(D|V)"},
        .reads = reading(ScenePart::geometry | ScenePart::materials | ScenePart::media | ScenePart::lamps),
        .make_light = [](const NodeContext& here) { return std::make_unique<FinalGather>(here); },
    };
}

}  // namespace lightnet
