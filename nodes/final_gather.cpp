// Light by way of one more surface, as another operator sees it there.
#include <algorithm>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/estimate/gather.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

/// Looks into directions that the surface scatters to the asker, and asks its input about what is there: Reichert 1992,
/// as Jensen 1996 uses it to look at a photon map through. Adds no bias of its own.
class FinalGather final : public LightOp {
public:
    explicit FinalGather(const NodeContext& here)
        : scene_(here.scene()),
          inputs_(here.inputs()),
          key_(here.key()),
          rays_(static_cast<std::uint32_t>(here.integer("rays"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        const std::size_t at_once = std::max<std::size_t>(1, looks_at_once / rays_);
        for (std::size_t first = 0; first < questions.size(); first += at_once) {
            const std::size_t count = std::min(at_once, questions.size() - first);
            gather(questions.subspan(first, count), answers.subspan(first, count));
        }
    }

private:
    void gather(std::span<const Query> questions, std::span<Rgb> answers) const {
        std::vector<SurfaceLook> looks;
        std::vector<Rgb> weights;
        std::vector<std::size_t> askers;
        for (std::size_t q = 0; q < questions.size(); ++q) {
            const Query& question = questions[q];
            const SurfacePoint point = scene_.surface(question);
            const Bsdf bsdf = scene_.bsdf(point);
            const Key stream = child(question.stream, key_);
            for (std::uint32_t i = 0; i < rays_; ++i) {
                const std::uint32_t index = question.sample * rays_ + i;
                Samples samples(stream, index);
                const float choice = bsdf.chooses() ? samples.next() : samples.skip();
                const auto step = bsdf.sample(question.outgoing, choice, samples.next_2d(), question.lobes);
                if (!step || !(max_component(step->weight) > 0)) continue;
                looks.push_back({{point.origin_towards(step->incoming), step->incoming},
                                 child(stream, key_, i),
                                 question.sample,
                                 question.depth});
                weights.push_back(step->weight * (1 / float(rays_)));
                askers.push_back(q);
            }
        }
        std::vector<Seen> seen(looks.size());
        look_around(scene_, inputs_, 0, looks, seen);
        for (std::size_t i = 0; i < looks.size(); ++i) answers[askers[i]] += weights[i] * seen[i].light;
    }

    static constexpr std::size_t looks_at_once = 4096;

    const Scene& scene_;
    Inputs inputs_;
    Key key_;
    std::uint32_t rays_;
};

}  // namespace

Kind final_gather_kind() {
    return {
        .name = "FinalGather",
        .help = "light by way of one more rough surface: what its input says of the surfaces that the point sees",
        .inputs = {1, 1},
        .params = {{.name = "rays",
                    .type = ParamType::integer,
                    .help = "directions per question",
                    .unit = "rays",
                    .initial = Value{1.0},
                    .least = 1,
                    .most = 65536}},
        .light = {.onward = "S*D"},
        .make_light = [](const NodeContext& here) { return std::make_unique<FinalGather>(here); },
    };
}

}  // namespace lightnet
