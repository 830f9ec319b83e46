// Indirect light: everything that reaches a point by way of other surfaces.
#include <algorithm>

#include "core/graph/kind.hpp"
#include "core/light/light_op.hpp"
#include "core/light/node_context.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {
namespace {

/// Path tracing with next-event estimation, multiple importance sampling and Russian roulette. Leaves out what arrives
/// straight from lamps and environment at the point asked about: that is direct light. Light that comes from them by
/// way of mirrors or glass is counted here.
class PathTracing final : public LightOp {
public:
    explicit PathTracing(const NodeContext& here)
        : scene_(here.scene()),
          key_(here.key()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          max_depth_(static_cast<std::uint32_t>(here.integer("max_depth"))),
          roulette_depth_(static_cast<std::uint32_t>(here.integer("roulette_depth"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = answer(questions[i]);
    }

private:
    Rgb answer(const Query& question) const {
        const SurfacePoint point = scene_.surface(question);
        const Bsdf bsdf = scene_.bsdf(point);
        const Key stream = child(question.stream, key_);
        Rgb sum;
        for (std::uint32_t i = 0; i < samples_; ++i)
            sum +=
                path({point, bsdf, question.outgoing, question.lobes}, Samples(stream, question.sample * samples_ + i));
        return sum / float(samples_);
    }

    /// One path from a surface point into the scene.
    Rgb path(const Gathering& start, Samples samples) const {
        SurfacePoint point = start.point;
        Bsdf bsdf = start.bsdf;
        Vec3 outgoing = start.outgoing;
        std::uint8_t lobes = start.lobes;
        Rgb sum, weight{1, 1, 1};
        float squeezed = 1;  // by refraction, which is no loss: roulette must not see it
        for (std::uint32_t depth = 1;; ++depth) {
            const float choice = bsdf.chooses() ? samples.next() : samples.skip();
            const auto sample = bsdf.sample(outgoing, choice, samples.next_2d(), lobes);
            if (!sample) return sum;
            const float before = max_component(weight) * squeezed;
            weight *= sample->weight;
            squeezed *= sample->eta * sample->eta;
            if (!survives(depth, max_component(weight) * squeezed / before, samples, weight)) return sum;

            const auto hit = scene_.intersect({point.origin_towards(sample->incoming), sample->incoming});
            const Vec3 from = point.position;
            if (hit) point = scene_.surface(*hit);
            if (depth > 1) sum += weight * light_by_bsdf(scene_, from, *sample, hit ? &point : nullptr, heuristic);
            if (!hit || (max_depth_ && depth > max_depth_)) return sum;

            bsdf = scene_.bsdf(point);
            outgoing = -sample->incoming;
            lobes = lobe::all;
            sum += weight * light_by_lamp(scene_, {point, bsdf, outgoing, lobes}, samples, heuristic);
        }
    }

    /// Ends paths by chance, and makes the others carry more. `kept` is the share of light that the last surface
    /// leaves: by it alone, not by all that was lost before, paths end gradually from `roulette_depth` on. Measured on
    /// rooms, variance × rays is a quarter to a half less than with a chance by the whole weight.
    bool survives(std::uint32_t depth, float kept, Samples& samples, Rgb& weight) const {
        if (!(kept > 0)) return false;
        if (depth <= roulette_depth_) return true;
        const float chance = std::min(kept, 0.95f);
        if (samples.next() >= chance) return false;
        weight *= 1 / chance;
        return true;
    }

    static constexpr Heuristic heuristic = Heuristic::power;

    const Scene& scene_;
    Key key_;
    std::uint32_t samples_;
    std::uint32_t max_depth_;
    std::uint32_t roulette_depth_;
};

}  // namespace

Kind path_tracing_kind() {
    return {
        .name = "PathTracing",
        .help = "indirect light: all that arrives by way of other surfaces",
        .params =
            {
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "paths per question",
                 .unit = "samples",
                 .initial = Value{1.0},
                 .least = 1,
                 .most = 65536},
                {.name = "max_depth",
                 .type = ParamType::integer,
                 .help = "surfaces that light may meet on its way from a lamp to the point; 0: any number",
                 .initial = Value{0.0},
                 .least = 0,
                 .most = 65536},
                {.name = "roulette_depth",
                 .type = ParamType::integer,
                 .help = "surfaces after which paths may end by chance, as light is absorbed",
                 .initial = Value{3.0},
                 .least = 0,
                 .most = 65536},
            },
        .make_light = [](const NodeContext& here) { return std::make_unique<PathTracing>(here); },
    };
}

}  // namespace lightnet
