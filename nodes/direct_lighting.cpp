// Direct light: what comes straight from lamps and environment.
#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/math/many_samples.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {
namespace {

Heuristic heuristic_called(const std::string& name) {
    if (name == "balance") return Heuristic::balance;
    if (name == "lamps") return Heuristic::lamps;
    return name == "directions" ? Heuristic::directions : Heuristic::power;
}

/// Two strategies find each light, a point on a lamp (next event estimation) and a direction drawn from the BSDF,
/// weighted by multiple importance sampling (Veach 1997, chapter 9). The samples of many questions are worked out at
/// once; what each finds does not depend on the others.
class DirectLighting final : public LightOp {
public:
    explicit DirectLighting(const NodeContext& here)
        : scene_(here.scene()),
          groups_(scene_.groups()),
          key_(here.key()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          most_(std::bit_ceil(static_cast<std::uint32_t>(here.integer("most_samples")))),
          error_(static_cast<float>(here.number("error"))),
          faint_(0.01 / (double(scene_.film().scale) * scene_.film().scale)),
          heuristic_(heuristic_called(here.text("heuristic"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        Samplers samplers(scene_);
        Wanted wanted{questions, std::vector<std::uint32_t>(questions.size(), samples_), samples_, {}};
        if (error_ > 0) wanted = enough_for_error(samplers, questions);
        std::fill(answers.begin(), answers.end(), Rgb{});
        each_sample(samplers, wanted, [&](std::size_t q, std::span<const Rgb> found) {
            for (std::size_t g = 0; g < groups_; ++g) answers[q * groups_ + g] += found[g];
        });
        for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = answers[i] / float(wanted.counts[i / groups_]);
    }

private:
    static constexpr std::size_t samples_at_once = 256;

    /// How many samples of each question.
    struct Wanted {
        std::span<const Query> questions;
        std::vector<std::uint32_t> counts;
        std::uint32_t room;  // numbers of a question's samples: more than counts
        Key key;             // of their random numbers; 0: those of the answer
    };
    /// A ray that a sample draws from the BSDF.
    struct BsdfRay {
        std::uint32_t sample;
        PathVertices::Step step;
    };
    /// Some samples, and scratch space for them.
    struct Samplers {
        explicit Samplers(const Scene& scene) : vertices(scene) {}

        std::vector<std::size_t> asked;  // whose each sample is
        std::vector<Rgb> found;          // by each, group by group of lamps
        ManySamples numbers;             // of each
        std::vector<float> choices;
        std::vector<Vec2> places, directions;
        PathVertices vertices;
        ShadowRays shadow_rays;
        std::vector<std::uint8_t> occluded;
        std::vector<BsdfRay> bsdf_rays;
        std::vector<Ray> rays;  // the same
        std::vector<std::optional<Hit>> hits;
        std::vector<std::size_t> leaving;  // of these rays: they meet nothing
    };
    /// Numbers of a sample.
    enum Dimension : std::uint32_t { choice_of_lamp, place_on_lamp, choice_of_lobe, direction };

    /// take(index of question, what one sample of it finds of each group), in the order of questions and samples.
    template <class Take>
    void each_sample(Samplers& some, const Wanted& wanted, Take&& take) const {
        const auto& questions = wanted.questions;
        for (std::size_t q = 0; q < questions.size(); ++q) {
            const Key stream = child(questions[q].stream, key_), key = wanted.key ? child(stream, wanted.key) : stream;
            for (std::uint32_t i = 0; i < wanted.counts[q]; ++i) {
                some.asked.push_back(q);
                some.numbers.add(key, questions[q].sample * wanted.room + i);
                if (some.asked.size() == samples_at_once) finish(some, questions, take);
            }
        }
        finish(some, questions, take);
    }

    template <class Take>
    void finish(Samplers& some, std::span<const Query> questions, Take&& take) const {
        some.found.assign(some.asked.size() * groups_, Rgb{});
        if (scene_.has_lamps()) some.numbers.draw(place_on_lamp, some.places);
        if (scene_.has_many_lamps()) some.numbers.draw(choice_of_lamp, some.choices);
        some.numbers.draw(direction, some.directions);
        for (std::size_t next = 0; next < some.asked.size();) next = draw_rays(some, questions, next);
        find_lamps(some);
        find_by_direction(some);
        for (std::size_t i = 0; i < some.asked.size(); ++i)
            take(some.asked[i], std::span(some.found).subspan(i * groups_, groups_));
        some.asked.clear();
        some.numbers.keep(0);
    }

    /// Draws the rays by which some samples from `next` on look for light. Returns where the next ones begin.
    std::size_t draw_rays(Samplers& some, std::span<const Query> questions, std::size_t next) const {
        next = some.vertices.begin(next, some.asked.size(),
                                   [&](std::size_t i) -> const Query& { return questions[some.asked[i]]; });
        some.vertices.find_bsdfs();
        if (scene_.has_lamps())
            some.vertices.sample_lamps(
                {some.choices, some.places}, heuristic_, some.shadow_rays,
                [](std::uint32_t) {
                    return Rgb{1, 1, 1};
                },
                [&](std::uint32_t i) { return i * static_cast<std::uint32_t>(groups_); });
        const auto choice = [&](std::uint32_t i) { return some.numbers.at(i, choice_of_lobe).next(); };
        some.vertices.scatter(some.directions, choice, [&](std::uint32_t i, const PathVertices::Step& step) {
            if (!scene_.may_shine(step.ray)) return;
            some.bsdf_rays.push_back({i, step});
            some.rays.push_back(step.ray);
        });
        return next;
    }

    void find_lamps(Samplers& some) const {
        ShadowRays& rays = some.shadow_rays;
        some.occluded.resize(rays.rays.size());
        scene_.occluded(rays.rays, some.occluded);
        for (std::size_t i = 0; i < some.occluded.size(); ++i)
            if (!some.occluded[i]) some.found[rays.sums[i]] += rays.light[i];
        rays.resize(0);
    }

    void find_by_direction(Samplers& some) const {
        some.hits.resize(some.rays.size());
        scene_.intersect(some.rays, some.hits);
        for (std::size_t i = 0; i < some.bsdf_rays.size(); ++i) {
            if (!some.hits[i])
                some.leaving.push_back(i);
            else if (scene_.shines(*some.hits[i]))
                meet_lamp(some, some.bsdf_rays[i], *some.hits[i]);
        }
        if (scene_.has_suns()) meet_suns(some);
        for (std::size_t i = 0; scene_.has_environment() && i < some.leaving.size(); i += lanes)
            leave(some, std::span(some.leaving).subspan(i, std::min(lanes, some.leaving.size() - i)));
        some.leaving.clear();
        some.bsdf_rays.clear();
        some.rays.clear();
    }
    void meet_lamp(Samplers& some, const BsdfRay& ray, const Hit& hit) const {
        const SurfacePoint end = scene_.surface(hit);
        const Rgb arriving = light_by_bsdf(scene_, ray.step.from, ray.step.sample, &end, heuristic_);
        if (is_black(arriving)) return;
        some.found[ray.sample * groups_ + scene_.group_of(end)] +=
            ray.step.sample.weight * left_after(ray.step.inside, hit.distance) * arriving;
    }
    void meet_suns(Samplers& some) const {
        for (const std::size_t ray : some.leaving) {
            const auto& [sample, step] = some.bsdf_rays[ray];
            if (const auto sun = scene_.sun(step.ray.direction))
                some.found[sample * groups_ + sun->group] +=
                    step.sample.weight * sky_by_bsdf(sun->light, step.sample, heuristic_);
        }
    }
    void leave(Samplers& some, std::span<const std::size_t> rays) const {
        std::array<Vec3, lanes> directions;
        std::array<SkyRadiance, lanes> sky;
        for (std::size_t k = 0; k < rays.size(); ++k) directions[k] = some.rays[rays[k]].direction;
        scene_.look_at_sky(std::span(directions).first(rays.size()), sky);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            const auto& [sample, step] = some.bsdf_rays[rays[k]];
            some.found[sample * groups_ + scene_.environment_group()] +=
                step.sample.weight * sky_by_bsdf(sky[k], step.sample, heuristic_);
        }
    }

    /// How many samples bring the root of the mean square error, relative to the answer, to what is wanted, as some
    /// trials tell. They have random numbers of their own and are no part of the answer, which stays without bias.
    // DECISIONS: trials-decide-samples
    Wanted enough_for_error(Samplers& some, std::span<const Query> questions) const {
        struct Statistics {
            double mean = 0, squares = 0;
            std::uint32_t trials = 0;
        };
        std::vector<Statistics> found(questions.size());
        const Wanted tried{questions, std::vector<std::uint32_t>(questions.size(), trials), trials, trial_key};
        each_sample(some, tried, [&](std::size_t q, std::span<const Rgb> light) {
            auto& [mean, squares, count] = found[q];
            const double value = luminance(std::accumulate(light.begin(), light.end(), Rgb{})), step = value - mean;
            mean += step / ++count;
            squares += step * (value - mean);
        });
        Wanted wanted{questions, {}, most_, {}};
        for (const auto& [mean, squares, count] : found) wanted.counts.push_back(enough(mean, squares));
        return wanted;
    }

    std::uint32_t enough(double mean, double squares) const {
        const double variance = surely * squares / (trials - 1),
                     wanted = double(error_) * error_ * (mean * mean + faint_);
        // Aligned powers of two, so that they are stratified.
        std::uint32_t count = std::min(std::bit_ceil(samples_), most_);
        while (count < most_ && variance > wanted * count) count *= 2;
        return count;
    }

    const Scene& scene_;
    std::size_t groups_;  // of lamps
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
        .help = "direct light: what comes straight from lamps and environment",
        .params =
            {
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "points on lamps, and directions drawn from the BSDF, per question; with an error: at least",
                 .unit = "samples",
                 .initial = Value{1.0},
                 .least = 1,
                 .most = 65536},
                {.name = "error",
                 .type = ParamType::number,
                 .help = "noise threshold: takes as many samples as bring the error of each answer, relative to it, to "
                         "this, as sixteen trials tell; 0: takes the same number everywhere",
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
                 .help =
                     "by which multiple importance sampling weights both ways to find a light; or lamps, directions: "
                     "what points on lamps, or directions from the BSDF, find alone, to see what each is good for",
                 .initial = Value{"power"},
                 .choices = {"power", "balance", "lamps", "directions"}},
            },
        .light = {.lamps = true, .groups = true, .paths = always({"LD"})},
        .make_light = [](const NodeContext& here) { return std::make_unique<DirectLighting>(here); },
    };
}

}  // namespace lightnet
