#include "core/estimate/path_walk.hpp"

#include <algorithm>

#include "core/base/math/columns.hpp"
#include "core/estimate/path_batch.hpp"
#include "core/estimate/path_chances.hpp"
#include "core/estimate/path_flights.hpp"
#include "core/estimate/through_media.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/path_kinds.hpp"

namespace lightnet {
namespace {

/// One call. `guided`: by a guide, or for one; apart, as what it takes costs a tenth of the time where there is none.
/// `tells`: sums are kept apart by what is known of paths (path_kinds.hpp).
template <bool guided, bool tells = false>
class Walker : PathDimensions {
public:
    /// `first`: null where paths begin by a guide, or for one.
    Walker(const Scene& scene, const PathPlan& plan, bool panes, Key key, const LightGuide* guide,
           SharedFirstRays* first)
        : scene_(scene),
          guide_(guide),
          first_rays_(plan.all ? nullptr : first),
          groups_(static_cast<std::uint32_t>(scene.lights().groups()) * (tells ? told::states : 1)),
          key_(key),
          samples_(plan.samples),
          max_depth_(plan.max_depth),
          roulette_depth_(plan.roulette_depth),
          all_(plan.all),
          looks_twice_(scene_.lights().has_environment() && !scene_.lights().samples_environment() && !panes),
          media_(scene.has_media()),
          panes_(panes) {}

    void walk(std::span<const Query> questions, std::span<Rgb> answers, Learnt* learnt) const {
        const std::size_t paths = questions.size() * samples_;
        if (first_rays_) first_rays_->begin(scene_, questions, samples_);
        Batch batch(scene_, guide_);
        Lessons lessons;
        if (learnt) batch.learn(lessons);
        std::vector<Rgb> totals;
        for (std::size_t first = 0; first < paths; first += paths_at_once) {
            const std::size_t last = std::min(paths, first + paths_at_once);
            if (learnt) {
                lessons.begin(last - first);
                totals.assign(last - first, Rgb{});
            }
            start(batch, questions, first, last);
            if (learnt) lessons.take(batch.sums, totals);
            for (std::uint32_t depth = 1; !batch.paths.empty(); ++depth) {
                go_on(batch, depth);
                if (learnt) lessons.take(batch.sums, totals);
            }
            if (learnt) {
                lessons.end(learnt->records);
                batch.sums.swap(totals);
                for (std::size_t i = 0; i < last - first; ++i)
                    learnt->paths.push_back({luminance(batch.sums[i]), float(lessons.surfaces(i))});
            }
            for (std::size_t path = first; path < last; ++path)
                for (std::size_t g = 0; g < groups_; ++g)
                    answers[batch.asked[path - first] * groups_ + g] += batch.sums[(path - first) * groups_ + g];
        }
        for (Rgb& answer : answers) answer = answer / float(samples_);
    }

private:
    using Step = PathVertices::Step;
    using Sums = PathSums<tells>;
    static constexpr std::size_t paths_at_once = 256;
    static constexpr std::size_t vertices_at_once = lanes;
    using Batch = PathBatch;
    using Path = PathBatch::Path;
    using Numbers = PathBatch::Numbers;

    void start(Batch& batch, std::span<const Query> questions, std::size_t first, std::size_t last) const {
        batch.sums.assign((last - first) * groups_, Rgb{});
        batch.paths.clear();
        batch.samples.keep(0);
        batch.flights.keep(0);
        batch.asked.clear();
        for (std::size_t path = first; path < last;) {
            const std::size_t q = path / samples_, end = std::min(last, (q + 1) * samples_);
            const Key key = child(questions[q].stream, key_);
            auto index = questions[q].sample * samples_ + static_cast<std::uint32_t>(path - q * samples_);
            for (; path < end; ++path, ++index) {
                batch.asked.push_back(q);
                batch.samples.add(key, index);
                if (media_) batch.flights.add(child(key, flights::key), index);
                const std::uint32_t sum = Sums::beginning(static_cast<std::uint32_t>(path - first), groups_);
                batch.paths.push_back({sum, 1, {1, 1, 1}, nullptr, {}, {}});
            }
        }
        batch.rays.resize(batch.paths.size());
        if constexpr (guided) batch.part(guide_);
        draw(batch, 0);
        batch.kept = 0;
        const auto question = [&](std::size_t path) -> const Query& { return questions[batch.asked[path]]; };
        if (first_rays_) {
            if (panes_) look_through_panes(batch, question);
            batch.first_rays = first_rays_->some(first, last);
            if (!first_rays_->known(last)) find_first_rays(batch, question, first);
            first_rays_->set_known(last);
            begin_by_first_rays(batch);
        } else {
            for (std::size_t next = 0; next < batch.paths.size();) {
                next = batch.vertices.begin(next, batch.paths.size(), question);
                go_round(batch, 0);
            }
        }
        close(batch, 0);
    }

    /// Of the paths that begin: `before` of the call's were before them.
    template <class Question>
    void find_first_rays(Batch& batch, const Question& question, std::size_t before) const {
        ManySamples& samples = batch.first_samples;
        samples.keep(0);
        for (std::size_t i = 0; i < batch.asked.size(); ++i) {
            const Query& asked = question(i);
            const auto sample = static_cast<std::uint32_t>((before + i) % samples_);
            samples.add(SharedFirstRays::stream(asked), asked.sample * samples_ + sample);
        }
        samples.draw(SharedFirstRays::direction, batch.numbers.directions);
        for (std::size_t next = 0; next < batch.asked.size();) {
            next = batch.vertices.begin(next, batch.asked.size(), question);
            batch.vertices.find_bsdfs();
            SharedFirstRays::draw(batch.vertices, batch.numbers.directions, samples, batch.first_rays);
        }
    }
    /// For lamps that direct light does not find.
    template <class Question>
    void look_through_panes(Batch& batch, const Question& question) const {
        for (std::size_t next = 0; next < batch.asked.size();) {
            next = batch.vertices.begin(next, batch.asked.size(), question);
            batch.vertices.find_bsdfs();
            look_around(batch, 0);
        }
    }
    void begin_by_first_rays(Batch& batch) const {
        batch.begun.clear();
        for (std::uint32_t i = 0; i < batch.first_rays.size(); ++i) {
            if (!batch.first_rays[i].goes_on) continue;
            const std::size_t before = batch.kept;
            send_on(batch, i, batch.first_rays[i].step, 0);
            if (batch.kept > before) batch.begun.push_back(i);
        }
    }
    /// What paths meet next.
    void trace(Batch& batch, std::uint32_t depth) const {
        batch.hits.resize(batch.rays.size());
        if (!first_rays_ || depth > 1) return scene_.intersect(batch.rays, batch.hits);
        first_rays_->trace(batch.first_rays, batch.begun);
        for (std::size_t i = 0; i < batch.begun.size(); ++i) batch.hits[i] = batch.first_rays[batch.begun[i]].hit;
    }

    /// Takes all paths over their next vertex: the one of number `depth`.
    void go_on(Batch& batch, std::uint32_t depth) const {
        trace(batch, depth);
        if (media_) flights::go(scene_, batch, groups_, 2 * depth);
        draw(batch, depth);
        batch.kept = 0;
        for (std::size_t first = 0; first < batch.paths.size(); first += vertices_at_once)
            visit(batch, first, std::min(batch.paths.size(), first + vertices_at_once), depth);
        close(batch, depth);
    }

    /// Keeps the paths that go on, and adds what shadow rays found where nothing is in between.
    void close(Batch& batch, std::uint32_t depth) const {
        batch.paths.resize(batch.kept);
        batch.rays.resize(batch.kept);
        batch.samples.keep(batch.kept);
        ShadowRays& found = batch.shadow_rays;
        batch.occluded.resize(found.rays.size());
        scene_.occluded(found.rays, batch.occluded);
        if (panes_) pass_through_panes(scene_, depth == 0 && !all_, batch.occluded, found);
        if (media_)
            pass_through_media(scene_, batch.occluded, found,
                               [&](std::uint32_t sum) { return flights::numbers(batch, groups_, sum, 2 * depth + 1); });
        for (std::size_t i = 0; i < found.sums.size(); ++i)
            batch.sums[found.sums[i]] += nothing_if(batch.occluded[i], found.light[i]);
        found.resize(0);
    }

    void draw(Batch& batch, std::uint32_t depth) const {
        const ManySamples& samples = batch.samples;
        Numbers& numbers = batch.numbers;
        const std::uint32_t first = depth * dimensions;
        if (!scene_.lights().empty() && (all_ || panes_ || depth > 0))
            samples.draw(first + place_on_lamp, numbers.places);
        if (scene_.lights().many()) samples.draw(first + choice_of_lamp, numbers.choices);
        if (depth > 0 || !first_rays_) samples.draw(first + direction, numbers.directions);
        if (guided || depth >= roulette_depth_) samples.draw(first + survival, numbers.survivals);
    }

    void visit(Batch& batch, std::size_t first, std::size_t last, std::uint32_t depth) const {
        batch.vertices.clear();
        scene_.expect(std::span(batch.hits).subspan(first, last - first));
        std::size_t leaving = 0;
        for (std::size_t i = first; i < last; ++i) {
            Path& path = batch.paths[i];
            if (media_ && batch.collisions[i]) {
                flights::collide(batch, i);
                continue;
            }
            if (!batch.hits[i]) {
                batch.leaving[leaving] = static_cast<std::uint32_t>(i);
                batch.skywards[leaving++] = batch.rays[i];
                continue;
            }
            const Hit& hit = *batch.hits[i];
            if (path.inside) path.weight *= left_after(path.inside, hit.distance);
            batch.vertices.add(static_cast<std::uint32_t>(i), hit, -path.incoming, lobe::all, path.inside);
        }
        if (all_ || depth > 1) leave(batch, leaving, depth);
        batch.vertices.find_points();
        if (all_ || depth > 1) meet_lamps(batch);
        if (panes_ || !max_depth_ || depth <= max_depth_) go_round(batch, depth);
    }
    /// Has the path come to more surfaces than it may? Then it only goes on through panes.
    bool at_its_end(const Path& path, std::uint32_t depth) const {
        return panes_ && max_depth_ && depth > max_depth_ + path.panes;
    }

    /// What paths do at the surfaces that they have come to.
    void go_round(Batch& batch, std::uint32_t depth) const {
        batch.vertices.find_bsdfs();
        if (depth > 0 || all_ || panes_) look_around(batch, depth);
        scatter(batch, depth);
    }

    static BsdfSample step_of(const Path& path) { return {path.incoming, {}, path.pdf, path.lobe}; }

    /// What so many paths find that meet nothing any more.
    void leave(Batch& batch, std::size_t count, std::uint32_t depth) const {
        if (scene_.lights().has_suns()) meet_suns(batch, count);
        if (count == 0 || !scene_.lights().has_environment()) return;
        scene_.lights().look_at_sky(std::span(batch.skywards).first(count), batch.sky);
        const float part = two_looks(depth - 1) ? 0.5f : 1.0f;
        for (std::size_t k = 0; k < count; ++k) {
            const Path& path = batch.paths[batch.leaving[k]];
            batch.sums[path.sum + scene_.lights().environment_group()] +=
                part * path.weight * sky_by_bsdf(batch.sky[k], step_of(path), heuristic);
        }
    }

    void meet_suns(Batch& batch, std::size_t count) const {
        for (std::size_t k = 0; k < count; ++k) {
            const auto sun = scene_.lights().sun(batch.skywards[k].direction);
            if (!sun) continue;
            const Path& path = batch.paths[batch.leaving[k]];
            batch.sums[path.sum + sun->group] += path.weight * sky_by_bsdf(sun->light, step_of(path), heuristic);
        }
    }

    /// What paths find that have come to lamps.
    void meet_lamps(Batch& batch) const {
        const auto& paths = batch.paths;
        batch.vertices.each_that_may_shine([&](std::uint32_t i, const SurfacePoint& point) {
            batch.lamps_met.add(scene_, i, paths[i].from, step_of(paths[i]), point);
        });
        batch.lamps_met.find(scene_, heuristic, [&](std::uint32_t i, Rgb light, std::uint32_t group) {
            batch.sums[paths[i].sum + group] += paths[i].weight * light;
        });
    }

    /// What paths find at surfaces by looking for light, rather than by batch on.
    void look_around(Batch& batch, std::uint32_t depth) const {
        const auto& paths = batch.paths;
        if (!scene_.lights().empty()) {
            const Numbers& numbers = batch.numbers;
            batch.vertices.sample_lamps(
                {numbers.choices, numbers.places}, heuristic, batch.shadow_rays,
                [&](std::uint32_t i) { return at_its_end(paths[i], depth) ? Rgb{} : paths[i].weight; },
                [&](std::uint32_t i) { return Sums::looking(paths[i].sum, groups_); });
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
        const Ray ray = at.point.ray_towards(found->incoming);
        SkyRadiance seen;
        scene_.lights().look_at_sky({&ray, 1}, {&seen, 1});
        const Rgb sky = found->weight * sky_by_bsdf(seen, *found, heuristic);
        if (is_black(sky)) return;
        batch.shadow_rays.add(ray, path.weight * (0.5f * sky),
                              Sums::looking(path.sum, groups_) + scene_.lights().environment_group());
    }

    /// Is the environment seen from the surface number `depth` looked at by two directions?
    bool two_looks(std::uint32_t depth) const { return looks_twice_ && depth == (all_ ? 0 : 1); }

    /// Sends paths on from surfaces, if they aren't absorbed.
    void scatter(Batch& batch, std::uint32_t depth) const {
        const auto choice = [&](std::uint32_t i) {
            return batch.samples.at(i, depth * dimensions + choice_of_lobe).next();
        };
        // Inlined wherever surfaces send paths on: a step is too large to be handed over.
        const auto on = [&](std::uint32_t i, const Step& step) __attribute__((always_inline)) {
            send_on(batch, i, step, depth);
        };
        batch.vertices.template scatter<guided>(batch.numbers.directions, choice, on, batch.alone);
    }

    /// Puts a path that goes on into the place of one that was here before, or of itself. Who ends by chance, which
    /// can't be foretold, is put there as well, and written over by the next.
    [[gnu::always_inline]] void send_on(Batch& batch, std::size_t i, const Step& on, std::uint32_t depth) const {
        const std::size_t to = batch.kept;
        const Path& path = batch.paths[i];
        if (at_its_end(path, depth) && !on.passes) return;
        Rgb weight = path.weight * on.sample.weight;
        const float eta_scale = path.eta_scale * on.sample.eta * on.sample.eta;
        const float kept = max_component(weight) * eta_scale / (max_component(path.weight) * path.eta_scale);
        if (!(kept > 0)) return;
        AloneOdds odds = path.odds;
        float chance = depth >= roulette_depth_ ? chance_to_survive(kept) : 1, hoped = 0;
        if constexpr (guided) {
            const float times = odds.take(on.favour);
            weight *= 1 / times;
            if (batch.lessons)
                batch.lessons->add(path.sum, batch.vertices.step_record(times / on.favour), weight,
                                   on.known >= 0 ? std::min(kept, 1.0f) * on.known : -1);
            const bool known = on.known >= 0;
            const float hope = known ? max_component(path.weight) * std::min(kept, 1.0f) * on.known : 0;
            hoped = known && depth == 0 ? hope : path.hoped;
            if (known && depth > 0 && hoped > 0) chance = chance_by_hope(hope / hoped);
            chance = chance_by_weight(chance, max_component(weight) * eta_scale);
        }
        bool survives = true;
        if (guided || depth >= roulette_depth_) {  // with a chance of 1 nothing changes
            survives = batch.numbers.survivals[i] < chance;
            weight *= 1 / chance;
        }
        batch.kept += survives;
        batch.samples.move(i, to);
        if constexpr (guided) batch.alone[to] = batch.alone[i];
        batch.rays[to] = on.ray;
        const BsdfSample& by = on.sample;
        const std::uint32_t sum = Sums::gone_on(path.sum, groups_, by.lobe);
        if (on.passes && depth > 0)
            batch.paths[to] = path.after_pane(eta_scale, weight, on.inside, hoped, odds);
        else
            batch.paths[to] = {sum,    eta_scale, weight,     on.inside, on.from, by.incoming,
                               by.pdf, by.lobe,   path.panes, hoped,     odds};
    }

    static constexpr Heuristic heuristic = Heuristic::automatic;

    const Scene& scene_;
    const LightGuide* guide_;
    SharedFirstRays* first_rays_;  // null: found anew
    std::uint32_t groups_;         // of lamps; where kinds are told, as many for each
    Key key_;
    std::uint32_t samples_;
    std::uint32_t max_depth_;
    std::uint32_t roulette_depth_;
    bool all_;          // direct light as well
    bool looks_twice_;  // for the environment
    bool media_;        // are there any?
    bool panes_;        // are there any?
};

template <bool guided, class... Way>
void follow(const Scene& scene, std::span<const Query> questions, std::span<Rgb> answers, const Way&... way) {
    PathKindWatch* const watch = PathKindWatch::here();
    if (!watch) return Walker<guided>(scene, way...).walk(questions, answers, nullptr);
    std::vector<Rgb> sums(answers.size() * told::states);
    Walker<guided, true>(scene, way...).walk(questions, sums, nullptr);
    watch->tell(sums, scene.lights().groups(), answers);
}

}  // namespace

void PathWalk::light(std::span<const Query> questions, Key key, SharedFirstRays& first, std::span<Rgb> answers) const {
    follow<false>(scene_, questions, answers, plan_, panes_, key, nullptr, &first);
}

void PathWalk::light(std::span<const Query> questions, Key key, const LightGuide& guide, std::span<Rgb> answers) const {
    follow<true>(scene_, questions, answers, plan_, panes_, key, &guide, nullptr);
}

void PathWalk::learn(std::span<const Query> questions, Key key, const LightGuide* guide, Learnt& learnt) const {
    std::vector<Rgb> answers(questions.size());
    Walker<true>(scene_, plan_, panes_, key, guide, nullptr).walk(questions, answers, &learnt);
}

}  // namespace lightnet
