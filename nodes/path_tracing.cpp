// Path tracing: indirect light, or all light.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/columns.hpp"
#include "core/base/math/many_samples.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
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
/// depend on the others: hits are those of single rays, and each path adds up its light in its own order. Where groups
/// of lamps are kept apart, the same paths put what they find into one of several sums.
class PathTracing final : public LightOp {
public:
    explicit PathTracing(const NodeContext& here)
        : scene_(here.scene()),
          groups_(static_cast<std::uint32_t>(scene_.groups())),
          key_(here.key()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          max_depth_(static_cast<std::uint32_t>(here.integer("max_depth"))),
          roulette_depth_(static_cast<std::uint32_t>(here.integer("roulette_depth"))),
          all_(here.text("paths") == "all"),
          looks_twice_(scene_.has_environment() && scene_.environment_pdf({0, 0, 1}) == 0) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{});
        const std::size_t paths = questions.size() * samples_;
        Batch batch(scene_);
        for (std::size_t first = 0; first < paths; first += paths_at_once) {
            const std::size_t last = std::min(paths, first + paths_at_once);
            start(batch, questions, first, last);
            for (std::uint32_t depth = 1; !batch.paths.empty(); ++depth) go_on(batch, depth);
            for (std::size_t path = first; path < last; ++path)
                for (std::size_t g = 0; g < groups_; ++g)
                    answers[batch.asked[path - first] * groups_ + g] += batch.sums[(path - first) * groups_ + g];
        }
        for (Rgb& answer : answers) answer = answer / float(samples_);
    }

private:
    static constexpr std::size_t paths_at_once = 256;
    static constexpr std::size_t vertices_at_once = lanes;

    /// A path between two of its vertices.
    struct Path {
        std::uint32_t sum;  // index into Batch::sums: of the first group of lamps
        float eta_scale;    // of radiance by refraction, which is no loss: roulette must not see it
        Rgb weight;
        const Rgb* inside;  // what fills the space that it crosses; may be null
        LitPoint from;
        BsdfSample step;
    };
    /// Random numbers of each path at its vertex, dimension by dimension.
    struct Numbers {
        std::vector<float> choices, survivals;
        std::vector<Vec2> places, directions;
    };
    /// Some paths, and scratch space for them.
    struct Batch {
        explicit Batch(const Scene& scene) : vertices(scene) {}

        std::vector<Rgb> sums;           // of each path that began, group by group of lamps
        std::vector<std::size_t> asked;  // the same: which question it's for
        std::vector<Path> paths;
        std::vector<Ray> rays;  // of each path
        std::vector<std::optional<Hit>> hits;
        ManySamples samples;  // of each path
        Numbers numbers;
        PathVertices vertices;
        ShadowRays shadow_rays;
        std::vector<std::uint8_t> occluded;
        std::size_t kept = 0;  // paths and rays that go on
    };
    /// Each vertex of a path has these dimensions of its own, used or not.
    enum Dimension : std::uint32_t {
        choice_of_lamp,
        place_on_lamp,
        choice_of_second,
        second_direction,
        choice_of_lobe,
        direction,
        survival
    };
    static constexpr std::uint32_t dimensions = 7;

    void start(Batch& batch, std::span<const Query> questions, std::size_t first, std::size_t last) const {
        batch.sums.assign((last - first) * groups_, Rgb{});
        batch.paths.clear();
        batch.samples.keep(0);
        batch.asked.clear();
        for (std::size_t path = first; path < last;) {
            const std::size_t q = path / samples_, end = std::min(last, (q + 1) * samples_);
            const Key key = child(questions[q].stream, key_);
            auto index = questions[q].sample * samples_ + static_cast<std::uint32_t>(path - q * samples_);
            for (; path < end; ++path, ++index) {
                batch.asked.push_back(q);
                batch.samples.add(key, index);
                batch.paths.push_back(
                    {static_cast<std::uint32_t>(path - first) * groups_, 1, {1, 1, 1}, nullptr, {}, {}});
            }
        }
        batch.rays.resize(batch.paths.size());
        draw(batch, 0);
        batch.kept = 0;
        const auto question = [&](std::size_t path) -> const Query& { return questions[batch.asked[path]]; };
        for (std::size_t next = 0; next < batch.paths.size();) {
            next = batch.vertices.begin(next, batch.paths.size(), question);
            go_round(batch, 0);
        }
        close(batch);
    }

    /// Takes all paths over their next vertex: the one of number `depth`.
    void go_on(Batch& batch, std::uint32_t depth) const {
        batch.hits.resize(batch.rays.size());
        scene_.intersect(batch.rays, batch.hits);
        draw(batch, depth);
        batch.kept = 0;
        for (std::size_t first = 0; first < batch.paths.size(); first += vertices_at_once)
            visit(batch, first, std::min(batch.paths.size(), first + vertices_at_once), depth);
        close(batch);
    }

    /// Keeps the paths that go on, and adds what shadow rays found where nothing is in between.
    void close(Batch& batch) const {
        batch.paths.resize(batch.kept);
        batch.rays.resize(batch.kept);
        batch.samples.keep(batch.kept);
        ShadowRays& found = batch.shadow_rays;
        batch.occluded.resize(found.rays.size());
        scene_.occluded(found.rays, batch.occluded);
        for (std::size_t i = 0; i < found.sums.size(); ++i)
            batch.sums[found.sums[i]] += nothing_if(batch.occluded[i], found.light[i]);
        found.resize(0);
    }

    /// Without a branch, as what is in the way can't be foretold.
    static Rgb nothing_if(bool occluded, Rgb light) {
        const std::uint32_t mask = std::uint32_t{occluded} - 1;
        const auto masked = [&](float x) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) & mask); };
        return {masked(light.r), masked(light.g), masked(light.b)};
    }

    void draw(Batch& batch, std::uint32_t depth) const {
        const ManySamples& samples = batch.samples;
        Numbers& numbers = batch.numbers;
        const std::uint32_t first = depth * dimensions;
        if (scene_.has_lamps() && (all_ || depth > 0)) samples.draw(first + place_on_lamp, numbers.places);
        if (scene_.has_many_lamps()) samples.draw(first + choice_of_lamp, numbers.choices);
        samples.draw(first + direction, numbers.directions);
        if (depth >= roulette_depth_) samples.draw(first + survival, numbers.survivals);
    }

    void visit(Batch& batch, std::size_t first, std::size_t last, std::uint32_t depth) const {
        batch.vertices.clear();
        for (std::size_t i = first; i < last; ++i) {
            Path& path = batch.paths[i];
            if (!batch.hits[i]) {
                leave(path, depth, batch);
                continue;
            }
            const Hit& hit = *batch.hits[i];
            if (path.inside) path.weight *= left_after(path.inside, hit.distance);
            batch.vertices.add(static_cast<std::uint32_t>(i), hit, -path.step.incoming, lobe::all, path.inside);
        }
        batch.vertices.find_points();
        if (all_ || depth > 1)
            batch.vertices.each_that_may_shine(
                [&](std::uint32_t i, const SurfacePoint& point) { meet_lamp(batch.paths[i], point, batch); });
        if (!max_depth_ || depth <= max_depth_) go_round(batch, depth);
    }

    /// What paths do at the surfaces that they have come to.
    void go_round(Batch& batch, std::uint32_t depth) const {
        batch.vertices.find_bsdfs();
        if (depth > 0 || all_) look_around(batch, depth);
        scatter(batch, depth);
    }

    /// What a path finds that meets nothing any more.
    void leave(const Path& path, std::uint32_t depth, Batch& batch) const {
        if (!all_ && depth == 1) return;
        const float part = two_looks(depth - 1) ? 0.5f : 1.0f;
        batch.sums[path.sum + scene_.environment_group()] +=
            part * path.weight * light_by_bsdf(scene_, path.from, path.step, nullptr, heuristic);
    }

    /// What a path finds that may have come to a lamp.
    void meet_lamp(const Path& path, const SurfacePoint& point, Batch& batch) const {
        const Rgb light = light_by_bsdf(scene_, path.from, path.step, &point, heuristic);
        if (!is_black(light)) batch.sums[path.sum + scene_.group_of(point)] += path.weight * light;
    }

    /// What paths find at surfaces by looking for light, rather than by batch on.
    void look_around(Batch& batch, std::uint32_t depth) const {
        const auto& paths = batch.paths;
        if (scene_.has_lamps()) {
            const Numbers& numbers = batch.numbers;
            batch.vertices.sample_lamps(
                {numbers.choices, numbers.places}, heuristic, batch.shadow_rays,
                [&](std::uint32_t i) { return paths[i].weight; }, [&](std::uint32_t i) { return paths[i].sum; });
        }
        if (two_looks(depth))
            batch.vertices.each([&](std::uint32_t i, const Gathering& at) { look_at_sky(batch, i, at, depth); });
    }

    void look_at_sky(Batch& batch, std::uint32_t i, const Gathering& at, std::uint32_t depth) const {
        const Path& path = batch.paths[i];
        Samples samples = batch.samples.at(i, depth * dimensions + choice_of_second);
        const float choice = at.bsdf.chooses() ? samples.next() : samples.skip();
        const auto found = at.bsdf.sample(at.outgoing, choice, samples.next_2d(), at.lobes);
        if (!found) return;
        const Rgb sky = found->weight * light_by_bsdf(scene_, lit_point(at), *found, nullptr, heuristic);
        if (is_black(sky)) return;
        batch.shadow_rays.add({at.point.origin_towards(found->incoming), found->incoming}, path.weight * (0.5f * sky),
                              path.sum + scene_.environment_group());
    }

    /// Is the environment seen from the surface number `depth` looked at by two directions?
    bool two_looks(std::uint32_t depth) const { return looks_twice_ && depth == (all_ ? 0 : 1); }

    /// Sends paths on from surfaces, if they aren't absorbed.
    void scatter(Batch& batch, std::uint32_t depth) const {
        const auto choice = [&](std::uint32_t i) {
            return batch.samples.at(i, depth * dimensions + choice_of_lobe).next();
        };
        batch.vertices.scatter(batch.numbers.directions, choice, [&](std::uint32_t i, const PathVertices::Step& step) {
            send_on(batch, i, step, depth);
        });
    }

    /// Puts a path that goes on into the place of one that was here before, or of itself. Who ends by chance, which
    /// can't be foretold, is put there as well, and written over by the next.
    void send_on(Batch& batch, std::size_t i, const PathVertices::Step& on, std::uint32_t depth) const {
        const std::size_t to = batch.kept;
        const Path& path = batch.paths[i];
        Rgb weight = path.weight * on.sample.weight;
        const float eta_scale = path.eta_scale * on.sample.eta * on.sample.eta;
        const float kept = max_component(weight) * eta_scale / (max_component(path.weight) * path.eta_scale);
        if (!(kept > 0)) return;
        bool survives = true;
        if (depth >= roulette_depth_) {
            const float chance = chance_to_survive(kept);
            survives = batch.numbers.survivals[i] < chance;
            weight *= 1 / chance;
        }
        batch.kept += survives;
        batch.samples.move(i, to);
        batch.rays[to] = on.ray;
        batch.paths[to] = {path.sum, eta_scale, weight, on.inside, on.from, on.sample};
    }

    /// Russian roulette: paths end by chance, and the others carry more. `kept` is the share of light that the last
    /// surface leaves: by it alone, not by all that was lost before, paths end gradually from `roulette_depth` on.
    /// Measured on rooms, variance × rays is a quarter to a half less than with a chance by the whole weight.
    static float chance_to_survive(float kept) { return std::min(kept, 0.95f); }

    static constexpr Heuristic heuristic = Heuristic::power;

    const Scene& scene_;
    std::uint32_t groups_;  // of lamps
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
        .help = "path tracing: indirect light, all that arrives by way of other surfaces; or all light",
        .params =
            {
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "light paths per question",
                 .unit = "samples",
                 .initial = Value{1.0},
                 .least = 1,
                 .most = 65536},
                {.name = "max_depth",
                 .type = ParamType::integer,
                 .help = "surfaces that a light path may have between a lamp and the point; 0: any number",
                 .initial = Value{0.0},
                 .least = 0,
                 .most = 65536},
                {.name = "roulette_depth",
                 .type = ParamType::integer,
                 .help = "surfaces after which paths may end by chance: Russian roulette",
                 .initial = Value{3.0},
                 .least = 0,
                 .most = 65536},
                {.name = "paths",
                 .type = ParamType::text,
                 .help = "which light: what comes by way of other surfaces, or direct light as well",
                 .initial = Value{"indirect"},
                 .choices = {"indirect", "all"}},
            },
        .light = {.lamps = true, .groups = true, .paths = paths_of},
        .make_light = [](const NodeContext& here) { return std::make_unique<PathTracing>(here); },
    };
}

}  // namespace lightnet
