// Light that comes straight from lamps and environment.
#include "core/graph/kind.hpp"
#include "core/light/light_op.hpp"
#include "core/light/node_context.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {
namespace {

/// Two ways to find each light, by a point on a lamp and by a direction from the surface, weighted by multiple
/// importance sampling (Veach 1997, chapter 9).
class DirectLighting final : public LightOp {
public:
    explicit DirectLighting(const NodeContext& here)
        : scene_(here.scene()),
          key_(here.key()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          heuristic_(here.text("heuristic") == "balance" ? Heuristic::balance : Heuristic::power) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = answer(questions[i]);
    }

private:
    Rgb answer(const Query& question) const {
        const SurfacePoint point = scene_.surface(question);
        const Bsdf bsdf = scene_.bsdf(point);
        const Gathering at{point, bsdf, question.outgoing, question.lobes};
        const Key stream = child(question.stream, key_);
        Rgb sum;
        for (std::uint32_t i = 0; i < samples_; ++i) {
            Samples samples(stream, question.sample * samples_ + i);
            sum += light_by_lamp(scene_, at, samples, heuristic_);
            sum += from_direction(at, samples);
        }
        return sum / float(samples_);
    }

    Rgb from_direction(const Gathering& at, Samples& samples) const {
        const float choice = at.bsdf.chooses() ? samples.next() : samples.skip();
        const auto sample = at.bsdf.sample(at.outgoing, choice, samples.next_2d(), at.lobes);
        if (!sample) return {};
        const Ray ray{at.point.origin_towards(sample->incoming), sample->incoming};
        if (!scene_.may_shine(ray)) return {};
        const auto hit = scene_.intersect(ray);
        if (!hit) return sample->weight * light_by_bsdf(scene_, at.point.position, *sample, nullptr, heuristic_);
        const SurfacePoint end = scene_.surface(*hit);
        const Rgb left = left_after(at.bsdf.absorption(ray.direction), hit->distance);
        return sample->weight * left * light_by_bsdf(scene_, at.point.position, *sample, &end, heuristic_);
    }

    const Scene& scene_;
    Key key_;
    std::uint32_t samples_;
    Heuristic heuristic_;
};

}  // namespace

Kind direct_lighting_kind() {
    return {
        .name = "DirectLighting",
        .help = "light that comes straight from lamps and environment",
        .paths = [](const Node&) { return std::vector<std::string>{"LD"}; },
        .params =
            {
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "points on lamps, and directions, per question",
                 .unit = "samples",
                 .initial = Value{1.0},
                 .least = 1,
                 .most = 65536},
                {.name = "heuristic",
                 .type = ParamType::text,
                 .help = "how both ways to find a light share it",
                 .initial = Value{"power"},
                 .choices = {"power", "balance"}},
            },
        .make_light = [](const NodeContext& here) { return std::make_unique<DirectLighting>(here); },
    };
}

}  // namespace lightnet
