// Irradiance caching: light by one more bounce, computed at few points and interpolated between them.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/estimate/even_scattering.hpp"
#include "core/estimate/gather.hpp"
#include "core/estimate/hemisphere.hpp"
#include "core/estimate/irradiance_octree.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/network/light/services.hpp"
#include "core/scene/lamps/lights.hpp"

namespace lightnet {
namespace {

/// Irradiance caching: Ward, Rubinstein & Clear 1988, "A ray tracing solution for diffuse interreflection", with
/// gradients (Ward & Heckbert 1992). Rehearsals find the points, from coarse to fine; all places compute the irradiance
/// there; then the records are frozen. Where none reaches, the irradiance is computed for the question alone, with a
/// sixteenth of the rays (the samples of a pixel add up), and not kept. Only what a surface scatters diffusely is
/// interpolated; for gloss and media rays are drawn anew each time. The bias is that of interpolation, by `accuracy`.
class IrradianceCache final : public LightOp {
public:
    explicit IrradianceCache(const NodeContext& here)
        : scene_(here.scene()),
          groups_(scene_.lights().groups()),
          inputs_(here.inputs()),
          rehearsal_(here.rehearsal()),
          key_(here.key()),
          wanted_noise_(here.integer("rays") > 0 ? 0 : records_beside * here.number("error")),
          hemisphere_(wanted_noise_ > 0 ? least_rays : static_cast<std::size_t>(here.integer("rays"))),
          lone_(lone_rays()),
          glossy_rays_(static_cast<std::uint32_t>(here.integer("glossy_rays"))),
          finest_(static_cast<std::uint32_t>(here.integer("stride"))),
          kept_(here.kept()),
          keeps_(!here.text("keep").empty()) {
        const auto spacing = [&](const char* name, float usual) {
            const auto given = static_cast<float>(here.number(name));
            return given > 0 ? given : usual * scene_.radius();
        };
        const double accuracy = here.number("accuracy");
        // With gradients, what an interpolation misses is of second order.
        spacing_ = {std::max(0.01f, static_cast<float>(accuracy > 0 ? accuracy : std::sqrt(here.number("error")))),
                    spacing("min_spacing", 0.01f), spacing("max_spacing", 0.2f)};
        spacing_.most = std::max(spacing_.least, spacing_.most);
    }

    void prepare(Services& services) override {
        std::vector<IrradianceRecord> records = older();
        const std::size_t known = records.size() / groups_;
        if (!records.empty()) freeze(services, records);
        for (std::uint32_t stride = coarsest; stride >= finest_; stride /= 2) {
            services.doing("looks where records lack, every " + std::to_string(stride) + " pixels");
            std::vector<Query> noted = services.rehearse(stride);
            if (stride == coarsest && wanted_noise_ > 0) choose_rays(services, noted);
            learn(services, std::move(noted), records);
        }
        services.say(std::to_string(records.size() / groups_) + " records" +
                     (known > 0 ? ", " + std::to_string(known) + " of them from an earlier run" : ""));
        if (keeps_) keep(services, records);
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::vector<Wanted> wanted;
        std::vector<Rgb> found(groups_);
        for (std::size_t i = 0; i < questions.size(); ++i) {
            if (questions[i].is_in_space()) continue;
            bool known = true;
            for (const Side& side : sides_of(questions[i])) {
                if (is_black(side.scattered)) continue;
                if (rehearsal_.on()) {
                    known = known && covered(side);
                } else if (look_up(side, found)) {
                    for (std::size_t g = 0; g < groups_; ++g) answers[i * groups_ + g] += side.scattered * found[g];
                } else {
                    wanted.push_back({i, side});
                }
            }
            if (!known) rehearsal_.note(questions[i]);
        }
        if (rehearsal_.on()) return;
        add_computed(questions, wanted, answers);
        add_gathered(questions, answers);
    }

    Frozen frozen() const override { return Frozen(records_); }

private:
    /// One side of a surface, as a question sees it.
    struct Side {
        Vec3 position, origin, normal;
        Rgb scattered;  // radiance per irradiance on that side, sr⁻¹
    };
    using Sides = std::array<Side, 2>;
    /// How noisy a record would be, relative.
    struct Trial {
        float noise;
    };
    /// A side without records.
    struct Wanted {
        std::size_t question;
        Side side;
    };

    /// The side that the question sees, and the other one, whose light may come through.
    Sides sides_of(const Query& question) const {
        const SurfacePoint point = scene_.surface(question);
        const Bsdf bsdf = scene_.bsdf(point);
        const std::uint8_t lobes = bsdf.lobes() & question.lobes & lobe::diffuse;
        Sides sides;
        if (!lobes) return sides;
        const bool front = dot(question.outgoing, point.normal) > 0;
        const bool agree = front == (dot(question.outgoing, point.shading.z) > 0);
        Vec3 normal = agree ? point.shading.z : point.normal;
        if (!front) normal = -normal;
        for (Side& side : sides) {
            side = {point.position, point.origin_towards(normal), normal,
                    evenly_scattered(bsdf, question.outgoing, normal, lobes)};
            normal = -normal;
        }
        return sides;
    }

    // What an earlier run has kept of the same scene.
    std::vector<IrradianceRecord> older() const {
        if (!kept_) return {};
        const Mapped<IrradianceRecord> records(kept_);
        return {records.begin(), records.end()};
    }

    // The result of the last call is what is kept.
    static void keep(Services& services, std::span<const IrradianceRecord> records) {
        services.map<IrradianceRecord>(
            (records.size() + records_per_shard - 1) / records_per_shard, [&](std::size_t shard, auto& out) {
                const auto some = records.subspan(shard * records_per_shard);
                out.assign(some.begin(), some.begin() + std::ptrdiff_t(std::min(some.size(), records_per_shard)));
            });
    }

    bool covered(const Side& side) const { return records_ && records_->covers(side.position, side.normal); }
    // For each group of lamps.
    bool look_up(const Side& side, std::span<Rgb> found) const {
        return records_ && records_->irradiance(side.position, side.normal, IrradianceOctree::most_stretch, found);
    }
    void freeze(Services& services, const std::vector<IrradianceRecord>& records) {
        records_ = services.once<IrradianceOctree>(
            [&] { return IrradianceOctree(records, spacing_, scene_.bounds(), groups_); });
    }

    /// Computes records for some of the noted questions, on all places, until each of them is near enough to one. The
    /// first ones come in the order of their keys, which is none: all over the image.
    void learn(Services& services, std::vector<Query> noted, std::vector<IrradianceRecord>& records) {
        const std::size_t all = noted.size();
        while (!noted.empty()) {
            services.doing("computes records", all - noted.size(), all);
            const std::size_t count = std::min(noted.size(), std::max(least_batch, noted.size() / 3));
            const std::span batch(noted.data(), count);
            const auto computed = services.map<IrradianceRecord>(
                (count + points_per_shard - 1) / points_per_shard, [&](std::size_t shard, auto& out) {
                    const std::size_t first = shard * points_per_shard;
                    out = records_for(batch.subspan(first, std::min(points_per_shard, count - first)));
                });
            records.insert(records.end(), computed.begin(), computed.end());
            freeze(services, records);
            noted.erase(noted.begin(), noted.begin() + std::ptrdiff_t(count));
            std::erase_if(noted, [&](const Query& question) {
                services.look();
                const Sides sides = sides_of(question);
                return std::all_of(sides.begin(), sides.end(),
                                   [&](const Side& side) { return is_black(side.scattered) || covered(side); });
            });
        }
    }

    std::vector<Wanted> without_records(std::span<const Query> questions) const {
        std::vector<Wanted> wanted;
        for (std::size_t i = 0; i < questions.size(); ++i)
            for (const Side& side : sides_of(questions[i]))
                if (!is_black(side.scattered) && !covered(side)) wanted.push_back({i, side});
        return wanted;
    }

    std::vector<IrradianceRecord> records_for(std::span<const Query> questions) const {
        return compute(questions, without_records(questions), hemisphere_);
    }

    /// Decides how many rays records have: as many that their noise is what is wanted, on average of some points all
    /// over the image, each of which looks around twice. A number for each record by itself, from its own first rays,
    /// would be too small where these missed what is bright, and the picture too dark.
    void choose_rays(Services& services, std::span<const Query> noted) {
        std::vector<Query> some;  // all over the image, as questions are noted in its order
        const std::size_t count = std::min(noted.size(), trial_points);
        for (std::size_t i = 0; i < count; ++i) some.push_back(noted[i * noted.size() / count]);
        const auto trials = services.map<Trial>(
            (some.size() + points_per_shard - 1) / points_per_shard, [&](std::size_t shard, std::vector<Trial>& out) {
                const std::size_t first = shard * points_per_shard;
                const auto questions = std::span(some).subspan(first, std::min(points_per_shard, count - first));
                const auto wanted = without_records(questions);
                const std::array<std::vector<GatherResult>, 2> found{looked_around(questions, wanted, hemisphere_, 1),
                                                                     looked_around(questions, wanted, hemisphere_, 2)};
                const std::size_t each = hemisphere_.size() * groups_;
                for (std::size_t i = 0; i < wanted.size(); ++i)
                    out.push_back({Hemisphere::noise({found[0].data() + i * each, each},
                                                     {found[1].data() + i * each, each}, groups_)});
            });
        double noise = 0;
        for (const Trial& trial : trials) noise += double{trial.noise} / double(trials.size());
        const double times = std::pow(noise / wanted_noise_, 2);
        hemisphere_ = Hemisphere(std::size_t(double(least_rays) * std::clamp(times, 1.0, most_times)));
        services.say(std::to_string(hemisphere_.size()) + " rays of each record, as the error wants");
    }

    std::size_t lone_rays() const { return std::max<std::size_t>(least_lone_rays, hemisphere_.size() / 16); }

    static constexpr std::size_t least_lone_rays = 16;
    // DECISIONS: rays-by-error
    static constexpr std::size_t least_rays = 384, trial_points = 128;
    static constexpr double most_times = 4;
    static constexpr double records_beside = 4;  // what is seen of one is between others, whose noise is their own

    // What rays find all around each point, a result for each group of lamps side by side. `trial`: 0, it counts.
    std::vector<GatherResult> looked_around(std::span<const Query> questions, std::span<const Wanted> wanted,
                                            const Hemisphere& hemisphere, Key trial) const {
        std::vector<GatherRay> rays;
        rays.reserve(wanted.size() * hemisphere.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const Query& question = questions[wanted[i].question];
            const bool second = i > 0 && wanted[i - 1].question == wanted[i].question;
            const Key own = child(child(question.stream, key_, second), question.sample);
            const std::size_t before = rays.size();
            hemisphere.add_rays(wanted[i].side.origin, wanted[i].side.normal,
                                trial ? child(own, key_of("trial"), trial) : own, question.depth, rays);
            const bool spread = scene_.moves() && !scene_.moves(scene_.hit(question));  // it holds while all moves
            for (GatherRay& ray : std::span(rays).subspan(before))
                ray.pass = question.pass,
                ray.ray.time = spread ? time_in_shutter(Samples(own, ray.sample, 2).next()) : question.time;
        }
        std::vector<GatherResult> results(rays.size() * groups_);
        gather(scene_, inputs_, 0, rays, results);
        return results;
    }

    // A record for each group of lamps, side by side.
    std::vector<IrradianceRecord> compute(std::span<const Query> questions, std::span<const Wanted> wanted,
                                          const Hemisphere& hemisphere) const {
        const auto results = looked_around(questions, wanted, hemisphere, 0);
        std::vector<GatherResult> of_group(hemisphere.size());
        std::vector<IrradianceRecord> records;
        for (std::size_t i = 0; i < wanted.size(); ++i)
            for (std::size_t g = 0; g < groups_; ++g) {
                for (std::size_t r = 0; r < hemisphere.size(); ++r)
                    of_group[r] = results[(i * hemisphere.size() + r) * groups_ + g];
                records.push_back(hemisphere.record(wanted[i].side.position, wanted[i].side.normal, of_group));
            }
        return records;
    }

    void add_computed(std::span<const Query> questions, std::span<const Wanted> wanted, std::span<Rgb> answers) const {
        const std::size_t at_once = std::max<std::size_t>(1, rays_at_once / lone_.size());
        for (std::size_t first = 0; first < wanted.size(); first += at_once) {
            const auto some = wanted.subspan(first, std::min(at_once, wanted.size() - first));
            const auto records = compute(questions, some, lone_);
            for (std::size_t i = 0; i < records.size(); ++i) {
                const auto& [question, side] = some[i / groups_];
                answers[question * groups_ + i % groups_] += side.scattered * records[i].irradiance;
            }
        }
    }

    void add_gathered(std::span<const Query> questions, std::span<Rgb> answers) const {
        BsdfGather gathered(scene_, key_, glossy_rays_);
        for (std::size_t q = 0; q < questions.size(); ++q) {
            const Query& question = questions[q];
            const std::uint8_t lobes = question.is_in_space() ? lobe::all : question.lobes & lobe::glossy;
            if (!lobes) continue;
            const SurfacePoint point = scene_.surface(question);
            gathered.add(q, question, point, scene_.bsdf(point), lobes, child(question.stream, key_, 2));
        }
        gathered.answer(inputs_, answers);
    }

    static constexpr std::uint32_t coarsest = 16;       // pixels between points of the first rehearsal
    static constexpr std::size_t least_batch = 256;     // points that are computed before the next are chosen
    static constexpr std::size_t points_per_shard = 8;  // some ms, over path tracing
    static constexpr std::size_t rays_at_once = 4096;
    static constexpr std::size_t records_per_shard = 65536;

    const Scene& scene_;
    std::size_t groups_;  // of lamps
    Inputs inputs_;
    Rehearsal& rehearsal_;
    Key key_;
    double wanted_noise_;  // of a record, relative; 0: it has as many rays as somebody said
    Hemisphere hemisphere_;
    Hemisphere lone_;  // of points that no record reaches: each sample of a pixel has one of its own
    std::uint32_t glossy_rays_;
    std::uint32_t finest_;
    Spacing spacing_;
    Bytes kept_;  // what an earlier run has kept of the same scene
    bool keeps_;
    std::shared_ptr<const IrradianceOctree> records_;
};

std::vector<Param> irradiance_cache_params() {
    return {
        {.name = "rays",
         .type = ParamType::integer,
         .help = "rays of each record; 0: as many as the error wants, 384 to 1536",
         .unit = "rays",
         .initial = Value{0.0},
         .least = 0,
         .most = 1 << 20},
        {.name = "error",
         .type = ParamType::number,
         .help = "how far light may be off: less makes more records, and more rays of each",
         .initial = Value{0.01},
         .least = 0.0001,
         .most = 1},
        {.name = "accuracy",
         .type = ParamType::number,
         .help =
             "how far a record counts, as a part of how far its light stays about the same; 0: the root of the error",
         .initial = Value{0.0},
         .least = 0,
         .most = 1},
        {.name = "min_spacing",
         .type = ParamType::number,
         .help = "how far each record reaches at least; 0: a hundredth of the scene's radius",
         .unit = "scene units",
         .initial = Value{0.0},
         .least = 0},
        {.name = "max_spacing",
         .type = ParamType::number,
         .help = "how far each record reaches at most; 0: a fifth of the scene's radius",
         .unit = "scene units",
         .initial = Value{0.0},
         .least = 0},
        {.name = "stride",
         .type = ParamType::integer,
         .help = "pixels between the points of the last rehearsal: 1, 2, 4, 8 or 16",
         .unit = "pixels",
         .initial = Value{2.0},
         .least = 1,
         .most = 16},
        {.name = "extend",
         .type = ParamType::text,
         .help = "file of records that a run has kept of this scene, to go on from; empty: none",
         .initial = Value{""}},
        {.name = "keep",
         .type = ParamType::text,
         .help = "file in which all records are kept for later runs, from the graph's folder; empty: none",
         .initial = Value{""}},
        {.name = "glossy_rays",
         .type = ParamType::integer,
         .help = "rays of glossy surfaces and of points in media, per question",
         .unit = "rays",
         .initial = Value{1.0},
         .least = 1,
         .most = 65536},
    };
}

std::vector<std::string> irradiance_cache_mistakes(const Node& node, const SceneData*) {
    const auto given = [&](const char* name) { return !std::get<std::string>(node.params.at(name).data).empty(); };
    std::vector<std::string> mistakes;
    const double rays = std::get<double>(node.params.at("rays").data);
    if (rays > 0 && rays < 8) mistakes.push_back("'rays' must be 0, for as many as the error wants, or at least 8");
    // A file of records has no place for groups.
    if ((given("keep") || given("extend")) && std::get<bool>(node.params.at("groups").data))
        mistakes.push_back("'groups' exclude 'keep' and 'extend': files hold the light of all lamps together");
    return mistakes;
}

}  // namespace

Kind irradiance_cache_kind() {
    return {
        .name = "IrradianceCache",
        .help =
            "irradiance caching: light by one more bounce, computed at few points and interpolated; for diffuse light",
        .inputs = {1, 1},
        .params = irradiance_cache_params(),
        .mistakes = irradiance_cache_mistakes,
        .light = {.space = true, .groups = true, .onward = "S*(D|V)"},
        .run = {.prepares = true, .rehearses = true, .freezes = "irradiance records", .keeps = true},
        .reads = reading(scene_of_light),
        .make_light = [](const NodeContext& here) { return std::make_unique<IrradianceCache>(here); },
    };
}

}  // namespace lightnet
