// Direct light: what comes straight from lamps and environment.
#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/math/many_samples.hpp"
#include "core/estimate/lamps_met.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/estimate/shared_first_rays.hpp"
#include "core/estimate/through_media.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene_media.hpp"

namespace lightnet {
namespace {

Heuristic heuristic_called(const std::string& name) {
    if (name == "balance") return Heuristic::balance;
    if (name == "power") return Heuristic::power;
    if (name == "lamps") return Heuristic::lamps;
    return name == "directions" ? Heuristic::directions : Heuristic::automatic;
}

/// Two strategies find each light, a point on a lamp (next event estimation) and a direction drawn from the BSDF,
/// weighted by multiple importance sampling (Veach 1997, chapter 9). The samples of many questions are worked out at
/// once; what each finds does not depend on the others.
class DirectLighting final : public LightOp {
public:
    explicit DirectLighting(const NodeContext& here)
        : scene_(here.scene()),
          groups_(scene_.lights().groups()),
          key_(here.key()),
          first_rays_(here.shared<SharedFirstRays>()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          most_(std::bit_ceil(static_cast<std::uint32_t>(here.integer("most_samples")))),
          error_(static_cast<float>(here.number("error"))),
          faint_(error_ > 0 ? 0.01 / (double(scene_.film().scale) * scene_.film().scale) : 0),
          heuristic_(heuristic_called(here.text("heuristic"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        SharedFirstRays own;
        Samplers samplers(scene_, error_ > 0 ? own : *first_rays_);
        Wanted wanted{questions, std::vector<std::uint32_t>(questions.size(), samples_), samples_, {}};
        if (error_ > 0) {
            own.begin_alone(scene_);
            wanted = enough_for_error(samplers, questions);
        } else {
            first_rays_->begin(scene_, questions, samples_);
        }
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
    /// Some samples, and scratch space for them.
    struct Samplers {
        Samplers(const Scene& scene, SharedFirstRays& rays) : first_rays(rays), vertices(scene) {}

        SharedFirstRays& first_rays;
        std::size_t before = 0;          // so many samples were taken before
        std::vector<std::size_t> asked;  // whose each sample is
        std::vector<Rgb> found;          // by each, group by group of lamps
        ManySamples numbers;             // of each
        ManySamples first_numbers;       // of the directions of each
        std::vector<float> choices;
        std::vector<Vec2> places, directions;
        PathVertices vertices;
        ShadowRays shadow_rays;
        std::vector<std::uint8_t> occluded;
        std::span<SharedFirstRays::One> by_direction;  // of each
        std::vector<std::uint32_t> looking;            // those whose direction may find light
        std::vector<std::uint32_t> leaving;            // of these: they meet nothing
        LampsMet lamps_met;                            // of these
    };
    /// Numbers of a sample, beside those of its direction.
    enum Dimension : std::uint32_t { choice_of_lamp, place_on_lamp, media_before_lamp, media_on_direction };

    /// take(index of question, what one sample of it finds of each group), in the order of questions and samples.
    template <class Take>
    void each_sample(Samplers& some, const Wanted& wanted, Take&& take) const {
        const auto& questions = wanted.questions;
        some.before = 0;
        for (std::size_t q = 0; q < questions.size(); ++q) {
            const auto apart = [&](Key stream) { return wanted.key ? child(stream, wanted.key) : stream; };
            const Key key = apart(child(questions[q].stream, key_)),
                      first_key = apart(SharedFirstRays::stream(questions[q]));
            for (std::uint32_t i = 0; i < wanted.counts[q]; ++i) {
                some.asked.push_back(q);
                const auto index = questions[q].sample * wanted.room + i;
                some.numbers.add(key, index);
                some.first_numbers.add(first_key, index);
                if (some.asked.size() == samples_at_once) finish(some, questions, take);
            }
        }
        finish(some, questions, take);
    }

    template <class Take>
    void finish(Samplers& some, std::span<const Query> questions, Take&& take) const {
        some.found.assign(some.asked.size() * groups_, Rgb{});
        if (!scene_.lights().empty()) some.numbers.draw(place_on_lamp, some.places);
        if (scene_.lights().many()) some.numbers.draw(choice_of_lamp, some.choices);
        const std::size_t end = some.before + some.asked.size();
        some.by_direction = some.first_rays.some(some.before, end);
        const bool known = some.first_rays.known(end);
        if (!known) some.first_numbers.draw(SharedFirstRays::direction, some.directions);
        for (std::size_t next = 0; next < some.asked.size();) next = draw_rays(some, questions, next, known);
        some.first_rays.set_known(end);
        find_lamps(some);
        find_by_direction(some);
        some.before = end;
        for (std::size_t i = 0; i < some.asked.size(); ++i)
            take(some.asked[i], std::span(some.found).subspan(i * groups_, groups_));
        some.asked.clear();
        some.numbers.keep(0);
        some.first_numbers.keep(0);
    }

    /// Draws the rays by which some samples from `next` on look for light. `known`: but for their directions. Returns
    /// where the next ones begin.
    std::size_t draw_rays(Samplers& some, std::span<const Query> questions, std::size_t next, bool known) const {
        next = some.vertices.begin(next, some.asked.size(),
                                   [&](std::size_t i) -> const Query& { return questions[some.asked[i]]; });
        some.vertices.find_bsdfs();
        if (!scene_.lights().empty())
            some.vertices.sample_lamps(
                {some.choices, some.places}, heuristic_, some.shadow_rays,
                [](std::uint32_t) {
                    return Rgb{1, 1, 1};
                },
                [&](std::uint32_t i) { return i * static_cast<std::uint32_t>(groups_); });
        if (known) return next;
        SharedFirstRays::draw(some.vertices, some.directions, some.first_numbers, some.by_direction);
        return next;
    }

    void find_lamps(Samplers& some) const {
        ShadowRays& rays = some.shadow_rays;
        some.occluded.resize(rays.rays.size());
        scene_.occluded(rays.rays, some.occluded);
        if (scene_.has_media())
            pass_through_media(scene_, some.occluded, rays, [&](std::uint32_t sum) {
                return some.numbers.at(sum / groups_, media_before_lamp).next_2d();
            });
        for (std::size_t i = 0; i < some.occluded.size(); ++i)
            if (!some.occluded[i]) some.found[rays.sums[i]] += rays.light[i];
        rays.resize(0);
    }

    void find_by_direction(Samplers& some) const {
        for (std::uint32_t i = 0; i < some.by_direction.size(); ++i)
            if (some.by_direction[i].goes_on && scene_.may_shine(some.by_direction[i].step.ray))
                some.looking.push_back(i);
        some.first_rays.trace(some.by_direction, some.looking);
        for (const std::uint32_t i : some.looking) {
            const SharedFirstRays::One& one = some.by_direction[i];
            if (!one.hit)
                some.leaving.push_back(i);
            else if (scene_.lights().shines(one.hit->geometry))
                some.lamps_met.add(scene_, i, one.step.from, one.step.sample, scene_.surface(*one.hit));
        }
        meet_lamps(some);
        if (scene_.lights().has_suns()) meet_suns(some);
        for (std::size_t i = 0; scene_.lights().has_environment() && i < some.leaving.size(); i += lanes)
            leave(some, std::span(some.leaving).subspan(i, std::min(lanes, some.leaving.size() - i)));
        some.leaving.clear();
        some.looking.clear();
    }
    /// What media leave of the light that a sample finds by its direction.
    Rgb through_media(const Samplers& some, std::uint32_t i) const {
        if (!scene_.has_media()) return {1, 1, 1};
        const SharedFirstRays::One& one = some.by_direction[i];
        Ray way = one.step.ray;
        if (one.hit) way.far = one.hit->distance;
        return scene_.media().transmittance(way, some.numbers.at(i, media_on_direction).next_2d());
    }
    void meet_lamps(Samplers& some) const {
        some.lamps_met.find(scene_, heuristic_, [&](std::uint32_t i, Rgb arriving, std::uint32_t group) {
            const SharedFirstRays::One& one = some.by_direction[i];
            some.found[i * groups_ + group] += one.step.sample.weight * left_after(one.step.inside, one.hit->distance) *
                                               arriving * through_media(some, i);
        });
    }
    void meet_suns(Samplers& some) const {
        for (const std::uint32_t i : some.leaving) {
            const PathVertices::Step& step = some.by_direction[i].step;
            if (const auto sun = scene_.lights().sun(step.ray.direction))
                some.found[i * groups_ + sun->group] +=
                    step.sample.weight * sky_by_bsdf(sun->light, step.sample, heuristic_) * through_media(some, i);
        }
    }
    void leave(Samplers& some, std::span<const std::uint32_t> samples) const {
        std::array<Ray, lanes> rays;
        std::array<SkyRadiance, lanes> sky;
        for (std::size_t k = 0; k < samples.size(); ++k) rays[k] = some.by_direction[samples[k]].step.ray;
        scene_.lights().look_at_sky(std::span(rays).first(samples.size()), sky);
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const BsdfSample& sample = some.by_direction[samples[k]].step.sample;
            some.found[samples[k] * groups_ + scene_.lights().environment_group()] +=
                sample.weight * sky_by_bsdf(sky[k], sample, heuristic_) * through_media(some, samples[k]);
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
    std::shared_ptr<SharedFirstRays> first_rays_;
    static constexpr std::uint32_t trials = 16;
    static constexpr double surely = 2.07;  // 95 of 100 variances are below so many times what 16 normal values show
    static constexpr Key trial_key = key_of("trials");

    std::uint32_t samples_, most_;
    float error_;   // 0: samples_ are enough
    double faint_;  // a square radiance that is seen as black, as RayTracer's error takes it
    Heuristic heuristic_;
};

// Noise is seen on the film alone, so the exposure counts where an error is wanted.
SceneParts read_by(const Node& node) {
    const bool has_error = std::get<double>(node.params.at("error").data) > 0;
    return has_error ? scene_of_light | ScenePart::film : scene_of_light;
}

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
                     "by which multiple importance sampling weights both ways to find a light; auto: by power for "
                     "lamps, "
                     "by balance for the sky and suns; or lamps, directions: what points on lamps, or directions from "
                     "the BSDF, find alone, to see what each is good for",
                 .initial = Value{"auto"},
                 .choices = {"auto", "power", "balance", "lamps", "directions"}},
            },
        .light = {.space = true, .lamps = true, .groups = true, .paths = always({"L(D|V)"})},
        .reads = read_by,
        .make_light = [](const NodeContext& here) { return std::make_unique<DirectLighting>(here); },
    };
}

}  // namespace lightnet
