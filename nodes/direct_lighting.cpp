// Light that comes straight from lamps and environment.
#include <algorithm>
#include <bit>

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
          most_(std::bit_ceil(static_cast<std::uint32_t>(here.integer("most_samples")))),
          error_(static_cast<float>(here.number("error"))),
          faint_(0.01 / (double(scene_.film().scale) * scene_.film().scale)),
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
        const std::uint32_t count = error_ > 0 ? samples_for_error(at, stream, question.sample) : samples_;
        const std::uint32_t room = error_ > 0 ? most_ : samples_;
        Rgb sum;
        for (std::uint32_t i = 0; i < count; ++i) add_one(at, stream, question.sample * room + i, sum);
        return sum / float(count);
    }

    void add_one(const Gathering& at, Key stream, std::uint32_t index, Rgb& sum) const {
        Samples samples(stream, index);
        sum += light_by_lamp(scene_, at, samples, heuristic_);
        sum += from_direction(at, samples);
    }

    /// How many samples bring the root of the mean square error, relative to the answer, to what is wanted, as some
    /// trials tell. They have random numbers of their own and are no part of the answer, which stays without bias.
    std::uint32_t samples_for_error(const Gathering& at, Key stream, std::uint32_t sample) const {
        double mean = 0, squares = 0;
        for (std::uint32_t i = 0; i < trials; ++i) {
            Rgb one;
            add_one(at, child(stream, trial_key), sample * trials + i, one);
            const double value = luminance(one);
            const double step = value - mean;
            mean += step / (i + 1);
            squares += step * (value - mean);
        }
        const double variance = surely * squares / (trials - 1),
                     wanted = double(error_) * error_ * (mean * mean + faint_);
        // Aligned powers of two, so that they are stratified.
        std::uint32_t count = std::min(std::bit_ceil(samples_), most_);
        while (count < most_ && variance > wanted * count) count *= 2;
        return count;
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
    static constexpr std::uint32_t trials = 16;
    static constexpr double surely = 2.07;  // 95 of 100 variances are below so many times what 16 normal values show
    static constexpr Key trial_key = key_of("trials");

    std::uint32_t samples_, most_;
    float error_;   // 0: samples_ are enough
    double faint_;  // a square radiance that is seen as black, as RayTracer's error takes it
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
                 .help = "points on lamps, and directions, per question; with an error: at least",
                 .unit = "samples",
                 .initial = Value{1.0},
                 .least = 1,
                 .most = 65536},
                {.name = "error",
                 .type = ParamType::number,
                 .help = "takes as many samples as bring the error of each answer, relative to it, to this, as sixteen "
                         "trials tell; 0: takes the same number everywhere",
                 .initial = Value{0.0},
                 .least = 0,
                 .most = 1},
                {.name = "most_samples",
                 .type = ParamType::integer,
                 .help = "with an error: at most, taken up to a power of two",
                 .unit = "samples",
                 .initial = Value{64.0},
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
