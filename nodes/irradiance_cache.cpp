// Light by way of one more surface, computed at few points and interpolated between them.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/estimate/even_scattering.hpp"
#include "core/estimate/gather.hpp"
#include "core/estimate/hemisphere.hpp"
#include "core/estimate/irradiance_octree.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/network/light/services.hpp"

namespace lightnet {
namespace {

/// Ward, Rubinstein & Clear 1988, "A ray tracing solution for diffuse interreflection", with gradients (Ward & Heckbert
/// 1992). Rehearsals find the points, from coarse to fine; all places compute the irradiance there; then the records
/// are frozen. Where none reaches, the irradiance is computed for the question alone, with a sixteenth of the rays (the
/// samples of a pixel add up), and not kept. Only what a surface
/// scatters evenly is interpolated; for the glossy rest the point looks around anew each time. The bias is that of the
/// interpolation: `accuracy` bounds it.
class IrradianceCache final : public LightOp {
public:
    explicit IrradianceCache(const NodeContext& here)
        : scene_(here.scene()),
          inputs_(here.inputs()),
          rehearsal_(here.rehearsal()),
          key_(here.key()),
          hemisphere_(static_cast<std::size_t>(here.integer("rays"))),
          lone_(std::max<std::size_t>(least_lone_rays, static_cast<std::size_t>(here.integer("rays")) / 16)),
          glossy_rays_(static_cast<std::uint32_t>(here.integer("glossy_rays"))),
          finest_(static_cast<std::uint32_t>(here.integer("stride"))),
          name_(here.name()),
          keeps_(!here.text("keep").empty()) {
        const auto spacing = [&](const char* name, float usual) {
            const auto given = static_cast<float>(here.number(name));
            return given > 0 ? given : usual * scene_.radius();
        };
        spacing_ = {static_cast<float>(here.number("accuracy")), spacing("min_spacing", 0.01f),
                    spacing("max_spacing", 0.2f)};
        spacing_.most = std::max(spacing_.least, spacing_.most);
    }

    void prepare(Services& services) override {
        std::vector<IrradianceRecord> records = older();
        const std::size_t known = records.size();
        if (!records.empty())
            records_ =
                services.once<IrradianceOctree>([&] { return IrradianceOctree(records, spacing_, scene_.bounds()); });
        for (std::uint32_t stride = coarsest; stride >= finest_; stride /= 2)
            learn(services, services.rehearse(stride), records);
        services.say(std::to_string(records.size()) + " records" +
                     (known > 0 ? ", " + std::to_string(known) + " of them from an earlier run" : ""));
        if (keeps_) keep(services, records);
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::vector<Wanted> wanted;
        for (std::size_t i = 0; i < questions.size(); ++i) {
            bool known = true;
            for (const Side& side : sides_of(questions[i])) {
                if (is_black(side.scattered)) continue;
                if (rehearsal_.on()) {
                    known = known && covered(side);
                } else if (const auto found = look_up(side)) {
                    answers[i] += side.scattered * *found;
                } else {
                    wanted.push_back({i, side});
                }
            }
            if (!known) rehearsal_.note(questions[i]);
        }
        if (rehearsal_.on()) return;
        add_computed(questions, wanted, answers);
        add_glossy(questions, answers);
    }

    Frozen frozen() const override { return Frozen(records_); }

private:
    /// One side of a surface, as a question sees it.
    struct Side {
        Vec3 position, origin, normal;
        Rgb scattered;  // radiance per irradiance on that side, sr⁻¹
    };
    using Sides = std::array<Side, 2>;
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
        const auto kept = scene_.data().kept.find(name_);
        if (kept == scene_.data().kept.end()) return {};
        const Mapped<IrradianceRecord> records(kept->second);
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
    std::optional<Rgb> look_up(const Side& side) const {
        if (!records_) return {};
        return records_->irradiance(side.position, side.normal, IrradianceOctree::most_stretch);
    }

    /// Computes records for some of the noted questions, on all places, until each of them is near enough to one. The
    /// first ones come in the order of their keys, which is none: all over the picture.
    void learn(Services& services, std::vector<Query> noted, std::vector<IrradianceRecord>& records) {
        while (!noted.empty()) {
            const std::size_t count = std::min(noted.size(), std::max(least_batch, noted.size() / 3));
            const std::span batch(noted.data(), count);
            const auto computed = services.map<IrradianceRecord>(
                (count + points_per_shard - 1) / points_per_shard, [&](std::size_t shard, auto& out) {
                    const std::size_t first = shard * points_per_shard;
                    out = records_for(batch.subspan(first, std::min(points_per_shard, count - first)));
                });
            records.insert(records.end(), computed.begin(), computed.end());
            records_ =
                services.once<IrradianceOctree>([&] { return IrradianceOctree(records, spacing_, scene_.bounds()); });
            noted.erase(noted.begin(), noted.begin() + std::ptrdiff_t(count));
            std::erase_if(noted, [&](const Query& question) {
                const Sides sides = sides_of(question);
                return std::all_of(sides.begin(), sides.end(),
                                   [&](const Side& side) { return is_black(side.scattered) || covered(side); });
            });
        }
    }

    std::vector<IrradianceRecord> records_for(std::span<const Query> questions) const {
        std::vector<Wanted> wanted;
        for (std::size_t i = 0; i < questions.size(); ++i)
            for (const Side& side : sides_of(questions[i]))
                if (!is_black(side.scattered) && !covered(side)) wanted.push_back({i, side});
        return compute(questions, wanted, hemisphere_);
    }

    static constexpr std::size_t least_lone_rays = 16;

    std::vector<IrradianceRecord> compute(std::span<const Query> questions, std::span<const Wanted> wanted,
                                          const Hemisphere& hemisphere) const {
        std::vector<SurfaceLook> looks;
        looks.reserve(wanted.size() * hemisphere.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const Query& question = questions[wanted[i].question];
            const bool second = i > 0 && wanted[i - 1].question == wanted[i].question;
            const Key stream = child(child(question.stream, key_, second), question.sample);
            hemisphere.add_looks(wanted[i].side.origin, wanted[i].side.normal, stream, question.depth, looks);
        }
        std::vector<Seen> seen(looks.size());
        look_around(scene_, inputs_, 0, looks, seen);
        std::vector<IrradianceRecord> records;
        for (std::size_t i = 0; i < wanted.size(); ++i)
            records.push_back(hemisphere.record(wanted[i].side.position, wanted[i].side.normal,
                                                std::span(seen).subspan(i * hemisphere.size(), hemisphere.size())));
        return records;
    }

    void add_computed(std::span<const Query> questions, std::span<const Wanted> wanted, std::span<Rgb> answers) const {
        const std::size_t at_once = std::max<std::size_t>(1, looks_at_once / lone_.size());
        for (std::size_t first = 0; first < wanted.size(); first += at_once) {
            const auto some = wanted.subspan(first, std::min(at_once, wanted.size() - first));
            const auto records = compute(questions, some, lone_);
            for (std::size_t i = 0; i < some.size(); ++i)
                answers[some[i].question] += some[i].side.scattered * records[i].irradiance;
        }
    }

    void add_glossy(std::span<const Query> questions, std::span<Rgb> answers) const {
        std::vector<SurfaceLook> looks;
        std::vector<Rgb> weights;
        std::vector<std::size_t> askers;
        for (std::size_t q = 0; q < questions.size(); ++q) {
            const Query& question = questions[q];
            if (!(question.lobes & lobe::glossy)) continue;
            const SurfacePoint point = scene_.surface(question);
            const Bsdf bsdf = scene_.bsdf(point);
            if (!(bsdf.lobes() & lobe::glossy)) continue;
            const Key stream = child(question.stream, key_, 2);
            for (std::uint32_t i = 0; i < glossy_rays_; ++i) {
                Samples samples(stream, question.sample * glossy_rays_ + i);
                const float choice = bsdf.chooses() ? samples.next() : samples.skip();
                const auto step = bsdf.sample(question.outgoing, choice, samples.next_2d(), lobe::glossy);
                if (!step || !(max_component(step->weight) > 0)) continue;
                looks.push_back({{point.origin_towards(step->incoming), step->incoming},
                                 child(stream, key_, i),
                                 question.sample,
                                 question.depth});
                weights.push_back(step->weight * (1 / float(glossy_rays_)));
                askers.push_back(q);
            }
        }
        if (looks.empty()) return;
        std::vector<Seen> seen(looks.size());
        look_around(scene_, inputs_, 0, looks, seen);
        for (std::size_t i = 0; i < looks.size(); ++i) answers[askers[i]] += weights[i] * seen[i].light;
    }

    static constexpr std::uint32_t coarsest = 16;       // pixels between points of the first rehearsal
    static constexpr std::size_t least_batch = 256;     // points that are computed before the next are chosen
    static constexpr std::size_t points_per_shard = 8;  // some ms, over path tracing
    static constexpr std::size_t looks_at_once = 4096;
    static constexpr std::size_t records_per_shard = 65536;

    const Scene& scene_;
    Inputs inputs_;
    Rehearsal& rehearsal_;
    Key key_;
    Hemisphere hemisphere_;
    Hemisphere lone_;  // of points that no record reaches: each sample of a pixel has one of its own
    std::uint32_t glossy_rays_;
    std::uint32_t finest_;
    Spacing spacing_;
    std::string name_;
    bool keeps_;
    std::shared_ptr<const IrradianceOctree> records_;
};

std::vector<Param> irradiance_cache_params() {
    return {
        {.name = "rays",
         .type = ParamType::integer,
         .help = "directions in which each record looks",
         .unit = "rays",
         .initial = Value{1024.0},
         .least = 8,
         .most = 1 << 20},
        {.name = "accuracy",
         .type = ParamType::number,
         .help = "how large the estimated error between records may be: less makes more of them",
         .initial = Value{0.25},
         .least = 0.01,
         .most = 1},
        {.name = "min_spacing",
         .type = ParamType::number,
         .help = "how far each record reaches at least; 0: a hundredth of the scene's radius",
         .unit = "m",
         .initial = Value{0.0},
         .least = 0},
        {.name = "max_spacing",
         .type = ParamType::number,
         .help = "how far each record reaches at most; 0: a fifth of the scene's radius",
         .unit = "m",
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
         .help = "directions in which glossy surfaces look, per question",
         .unit = "rays",
         .initial = Value{1.0},
         .least = 1,
         .most = 65536},
    };
}

}  // namespace

Kind irradiance_cache_kind() {
    return {
        .name = "IrradianceCache",
        .help = "light by way of one more rough surface, computed at few points and interpolated: for soft light",
        .least_inputs = 1,
        .most_inputs = 1,
        .prepares = true,
        .rehearses = true,
        .freezes = "irradiance records",
        .onward = "S*D",
        .keeps = true,
        .params = irradiance_cache_params(),
        .make_light = [](const NodeContext& here) { return std::make_unique<IrradianceCache>(here); },
    };
}

}  // namespace lightnet
