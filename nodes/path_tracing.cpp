// Indirect light, or all light: what reaches a point by way of other surfaces.
#include <algorithm>
#include <optional>
#include <vector>

#include "core/graph/kind.hpp"
#include "core/light/light_op.hpp"
#include "core/light/node_context.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {
namespace {

/// Path tracing with next-event estimation, multiple importance sampling and Russian roulette. Unless asked for all
/// paths it leaves out what arrives straight from lamps and environment at the point asked about: that is direct light.
/// Light that comes from them by way of mirrors or glass is counted here.
///
/// Points on lamps can't find an environment without a map. There, where it counts first, the path's own direction and
/// a second one, of which only the sky counts, share what they see of it half and half: the second one costs no more
/// than a shadow, and on open ground it halves the variance.
///
/// Many paths go on together, surface by surface, so that their rays are traced in packets. What a path finds does not
/// depend on the others: hits are those of single rays, and each path adds up its light in its own order.
class PathTracing final : public LightOp {
public:
    explicit PathTracing(const NodeContext& here)
        : scene_(here.scene()),
          key_(here.key()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          max_depth_(static_cast<std::uint32_t>(here.integer("max_depth"))),
          roulette_depth_(static_cast<std::uint32_t>(here.integer("roulette_depth"))),
          all_(here.text("paths") == "all"),
          looks_twice_(scene_.has_environment() && scene_.environment_pdf({0, 0, 1}) == 0) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{});
        const std::size_t paths = questions.size() * samples_;
        Paths going;
        for (std::size_t first = 0; first < paths; first += paths_at_once) {
            const std::size_t last = std::min(paths, first + paths_at_once);
            start(going, questions, first, last);
            for (std::uint32_t depth = 1; !going.walks.empty(); ++depth) go_on(going, depth);
            for (std::size_t path = first; path < last; ++path) answers[path / samples_] += going.sums[path - first];
        }
        for (Rgb& answer : answers) answer = answer / float(samples_);
    }

private:
    /// A path on its way from one surface to the next.
    struct Walk {
        Samples samples;
        std::uint32_t path;  // index into Paths::sums
        Vec3 from;
        BsdfSample step;
        const Rgb* inside;  // what it leads through; may be null
        Rgb weight;
        float squeezed;  // by refraction, which is no loss: roulette must not see it
    };
    /// Some paths, and scratch space for them.
    struct Paths {
        std::vector<Walk> walks, before;
        std::vector<Ray> rays;  // of each walk
        std::vector<std::optional<Hit>> hits;
        std::vector<Rgb> sums;           // of each path
        std::vector<Ray> to_lamps;       // on which nothing may be
        std::vector<Rgb> from_lamps;     // what they bring
        std::vector<std::uint32_t> lit;  // whom they bring it
        std::vector<std::uint8_t> hidden;
    };

    void start(Paths& going, std::span<const Query> questions, std::size_t first, std::size_t last) const {
        going.sums.assign(last - first, Rgb{});
        for (std::size_t path = first; path < last;) {
            const std::size_t q = path / samples_, end = std::min(last, (q + 1) * samples_);
            const Query& question = questions[q];
            const SurfacePoint point = scene_.surface(question);
            const Bsdf bsdf = scene_.bsdf(point);
            const Gathering at{point, bsdf, question.outgoing, question.lobes};
            const Key stream = child(question.stream, key_);
            for (; path < end; ++path) {
                const auto index = question.sample * samples_ + static_cast<std::uint32_t>(path % samples_);
                Walk walk{Samples(stream, index), static_cast<std::uint32_t>(path - first), {}, {}, {}, {1, 1, 1}, 1};
                if (all_) look_around(walk, at, 0, going);
                scatter(walk, at, 1, going);
            }
        }
        take_in(going);
    }

    /// What a path finds at a surface by looking for light, rather than by going on.
    void look_around(Walk& walk, const Gathering& at, std::uint32_t depth, Paths& going) const {
        const auto add = [&](const Ray& ray, Rgb light) {
            going.to_lamps.push_back(ray);
            going.from_lamps.push_back(walk.weight * light);
            going.lit.push_back(walk.path);
        };
        if (const auto lamp = ray_to_lamp(scene_, at, walk.samples, heuristic)) add(lamp->ray, lamp->light);
        if (!two_looks(depth)) return;
        const float choice = at.bsdf.chooses() ? walk.samples.next() : walk.samples.skip();
        if (const auto look = at.bsdf.sample(at.outgoing, choice, walk.samples.next_2d(), at.lobes)) {
            const Rgb sky = look->weight * light_by_bsdf(scene_, at.point.position, *look, nullptr, heuristic);
            if (!is_black(sky)) add({at.point.origin_towards(look->incoming), look->incoming}, 0.5f * sky);
        }
    }

    /// Is the environment seen from the surface number `depth` looked at by two directions?
    bool two_looks(std::uint32_t depth) const { return looks_twice_ && depth == (all_ ? 0 : 1); }

    /// Adds what was found on lamps, where nothing is in the way.
    void take_in(Paths& going) const {
        going.hidden.resize(going.to_lamps.size());
        scene_.occluded(going.to_lamps, going.hidden);
        for (std::size_t i = 0; i < going.lit.size(); ++i)
            if (!going.hidden[i]) going.sums[going.lit[i]] += going.from_lamps[i];
        going.to_lamps.clear();
        going.from_lamps.clear();
        going.lit.clear();
    }

    /// Takes all paths over the next surface: number `depth` on their way.
    void go_on(Paths& going, std::uint32_t depth) const {
        going.hits.resize(going.rays.size());
        scene_.intersect(going.rays, going.hits);
        going.before.swap(going.walks);
        going.walks.clear();
        going.rays.clear();
        for (std::size_t i = 0; i < going.before.size(); ++i) visit(going.before[i], going.hits[i], depth, going);
        take_in(going);
    }

    void visit(Walk& walk, const std::optional<Hit>& hit, std::uint32_t depth, Paths& going) const {
        if (walk.inside && hit) walk.weight *= left_after(walk.inside, hit->distance);
        const SurfacePoint point = hit ? scene_.surface(*hit) : SurfacePoint{};
        if (all_ || depth > 1) {
            const float part = !hit && two_looks(depth - 1) ? 0.5f : 1.0f;
            going.sums[walk.path] +=
                part * walk.weight * light_by_bsdf(scene_, walk.from, walk.step, hit ? &point : nullptr, heuristic);
        }
        if (!hit || (max_depth_ && depth > max_depth_)) return;
        const Bsdf bsdf = scene_.bsdf(point);
        const Gathering at{point, bsdf, -walk.step.incoming, lobe::all, walk.inside};
        Walk next = walk;
        look_around(next, at, depth, going);
        scatter(next, at, depth + 1, going);
    }

    /// Sends a path on from a surface, if it isn't absorbed, as the `depth`-th leg of its way.
    void scatter(Walk walk, const Gathering& at, std::uint32_t depth, Paths& going) const {
        const float choice = at.bsdf.chooses() ? walk.samples.next() : walk.samples.skip();
        const auto step = at.bsdf.sample(at.outgoing, choice, walk.samples.next_2d(), at.lobes);
        if (!step) return;
        const float before = max_component(walk.weight) * walk.squeezed;
        walk.weight *= step->weight;
        walk.squeezed *= step->eta * step->eta;
        if (!survives(depth, max_component(walk.weight) * walk.squeezed / before, walk)) return;
        walk.from = at.point.position;
        walk.step = *step;
        walk.inside = filling(at.bsdf, at.point, at.outgoing, step->incoming, at.inside);
        going.walks.push_back(walk);
        going.rays.push_back({at.point.origin_towards(step->incoming), step->incoming});
    }

    /// Ends paths by chance, and makes the others carry more. `kept` is the share of light that the last surface
    /// leaves: by it alone, not by all that was lost before, paths end gradually from `roulette_depth` on. Measured on
    /// rooms, variance × rays is a quarter to a half less than with a chance by the whole weight.
    bool survives(std::uint32_t depth, float kept, Walk& walk) const {
        if (!(kept > 0)) return false;
        if (depth <= roulette_depth_) return true;
        const float chance = std::min(kept, 0.95f);
        if (walk.samples.next() >= chance) return false;
        walk.weight *= 1 / chance;
        return true;
    }

    static constexpr Heuristic heuristic = Heuristic::power;
    static constexpr std::size_t paths_at_once = 256;

    const Scene& scene_;
    Key key_;
    std::uint32_t samples_;
    std::uint32_t max_depth_;
    std::uint32_t roulette_depth_;
    bool all_;          // direct light as well
    bool looks_twice_;  // for the environment
};
// A limit counts the surfaces between the lamp and the one asked about.
std::vector<std::string> paths_of(const Node& node) {
    const bool all = std::get<std::string>(node.params.at("paths").data) == "all";
    const double most = std::get<double>(node.params.at("max_depth").data);
    const std::string least = all ? "0" : "1";
    if (most == 0) return {all ? "L(S|D)*D" : "L(S|D)+D"};
    return {"L(S|D){" + least + "," + std::to_string(static_cast<int>(most)) + "}D"};
}

}  // namespace

Kind path_tracing_kind() {
    return {
        .name = "PathTracing",
        .help = "indirect light, all that arrives by way of other surfaces; or all light",
        .paths = paths_of,
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
                {.name = "paths",
                 .type = ParamType::text,
                 .help = "which light: what comes by way of other surfaces, or direct light as well",
                 .initial = Value{"indirect"},
                 .choices = {"indirect", "all"}},
            },
        .make_light = [](const NodeContext& here) { return std::make_unique<PathTracing>(here); },
    };
}

}  // namespace lightnet
