// Surfaces that many light paths have come to at once.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/estimate/glossy_groups.hpp"
#include "core/estimate/guided_columns.hpp"
#include "core/estimate/light_guide.hpp"
#include "core/estimate/shadow_rays.hpp"
#include "core/scene/batch/lambertian_surfaces.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Where each of some paths has come to: its vertex. Meshes of the most usual materials go through the formulas many at
/// once, as structures of arrays, the others one by one: what each path is told is the same, to the bit. One thread.
class PathVertices {
public:
    /// `guide`: by which paths go on; null: by surfaces alone.
    explicit PathVertices(const Scene& scene, const LightGuide* guide = nullptr)
        : scene_(scene), guide_(guide), shapes_(scene.column_shapes()), only_lamp_(scene.lights().only_flat_lamp()) {}

    void clear() {
        plain_.clear(), glossy_.clear();
        points_.clear(), views_.clear(), bsdfs_.clear(), visitors_.clear(), guided_.clear();
        stop_count_ = 0;
    }
    bool full() const { return stop_count_ == lanes; }
    /// Path `path`, after those added before, has come to a surface, as seen from `outgoing`, through `inside`. Not
    /// when it is full. Only these `lobes` count.
    void add(std::uint32_t path, const Hit& hit, Vec3 outgoing, std::uint8_t lobes, const Rgb* inside) {
        last_ = kind_of(hit, lobes, inside);
        if (last_ == Kind::none) {
            scene_.add_surface(hit, points_);
            views_.push_back({outgoing, lobes, inside});
        }
        add_to_last(path, hit, outgoing, lobes);
    }
    /// A point in a medium, at a time.
    struct PlaceInSpace {
        Vec3 position;
        std::uint16_t medium;
        ShutterTime time;
    };
    /// Path `path`, after those added before, has collided with a medium. Not when it is full.
    void add_in_space(std::uint32_t path, const PlaceInSpace& place, Vec3 outgoing, std::uint8_t lobes,
                      const Rgb* inside) {
        last_ = Kind::none;
        points_.push_back(scene_.point_in_space(place.position, place.medium, place.time));
        views_.push_back({outgoing, lobes, inside});
        add_to_last(path, {}, outgoing, lobes);
    }
    /// The place of the one added last again.
    void add_again(std::uint32_t path, const Hit& hit, Vec3 outgoing, std::uint8_t lobes) {
        add_to_last(path, hit, outgoing, lobes);
    }
    /// Begins anew: `first` and the paths after it stand where questions are asked about, question(path), as many as
    /// there is room for. Those of one question follow one another. Returns the first path for which there was no room.
    template <class Question>
    std::size_t begin(std::size_t first, std::size_t last, Question&& question) {
        clear();
        Hit hit;
        const Query* before = nullptr;
        std::size_t path = first;
        for (; path < last && !full(); ++path) {
            const Query& asked = question(path);
            if (before == &asked) {
                add_again(static_cast<std::uint32_t>(path), hit, asked.outgoing, asked.lobes);
                continue;
            }
            before = &asked;
            if (asked.is_in_space()) {
                add_in_space(static_cast<std::uint32_t>(path), {asked.place_in_space(), asked.medium, asked.time},
                             asked.outgoing, asked.lobes, nullptr);
                continue;
            }
            hit = scene_.hit(asked);
            add(static_cast<std::uint32_t>(path), hit, asked.outgoing, asked.lobes, nullptr);
        }
        find_points();
        return path;
    }
    /// All have been added.
    void find_points() {
        if (plain_.size() > 0) plain_.find_points();
        glossy_.each([](auto& group) { group.find_points(); });
    }

    /// with(path, point) of all that may be lamps, of what add() added.
    template <class With>
    void each_that_may_shine(With&& with) const {
        each_group([&](const auto& group) {
            for (const std::uint32_t i : group.shining()) with(group.who(i), group.point(i));
        });
        for (const auto [path, point] : visitors_)
            if (!points_[point].is_in_space()) with(path, points_[point]);
    }

    /// How they scatter: before anything of the following is asked.
    void find_bsdfs() {
        scene_.add_bsdfs(points_, bsdfs_);
        glossy_.each([](auto& group) { group.find_bsdfs(); });
        if (guide_) find_guided();
    }

    /// with(path, Gathering) of each.
    template <class With>
    void each(With&& with) const {
        for (const auto& visitor : visitors_) with(visitor.path, gathering(visitor));
        for (std::size_t i = 0; i < plain_.size(); ++i) {
            const SurfacePoint point = plain_.point(i);
            const Bsdf bsdf = plain_.bsdf(i);
            const GuidedPoint guided = plain_.guided.point(i, plain_.cosine_choices(i));
            with(plain_.who(i),
                 Gathering{point, bsdf, plain_.outgoing(i), lobe::all, nullptr, guided ? &guided : nullptr});
        }
        glossy_.each([&](const auto& group) {
            for (std::size_t i = 0; i < group.size(); ++i) {
                const SurfacePoint point = group.point(i);
                const Bsdf bsdf = group.bsdf(i);
                const GuidedPoint guided = group.guided.point(i, group.cosine_choices(i));
                with(group.who(i),
                     Gathering{point, bsdf, group.outgoing(i), group.lobes(i), nullptr, guided ? &guided : nullptr});
            }
        });
    }

    /// Random numbers of each path, by its index. Empty: nobody needs them.
    struct Numbers {
        std::span<const float> choices;
        std::span<const Vec2> places;
    };
    /// Next event estimation: appends the shadow rays that ray_to_lamp() gives, their light times weight(path), to be
    /// added to sum(path), or to one of those behind it: one for each group of lamps.
    template <class Weight, class Sum>
    void sample_lamps(const Numbers& numbers, Heuristic heuristic, ShadowRays& to, Weight&& weight, Sum&& sum) {
        const auto add = [&](std::uint32_t path, const std::optional<LampRay>& found) {
            if (found) to.add(found->ray, weight(path) * found->light, sum(path) + found->group);
        };
        if (!shares(heuristic))
            return each([&](std::uint32_t path, const Gathering& at) {
                const float choice = numbers.choices.empty() ? 0 : numbers.choices[path];
                add(path, ray_to_lamp(scene_, at, LampNumbers{choice, numbers.places[path]}, heuristic));
            });
        for (std::size_t next = 0; next < visitors_.size();) next = look_from_some(next, numbers, heuristic, add);
        each_group([&](auto& group) {
            if (group.size() == 0) return;
            const RaysToLamp& found = look_from(group, numbers, heuristic);
            if (guide_) group.guided.share(found, heuristic);
            // Also what finds nothing is written, and then written over: what a point finds can't be foretold.
            std::size_t end = to.rays.size();
            to.resize(end + group.size());
            for (std::size_t i = 0; i < group.size(); ++i) {
                const std::uint32_t path = group.who(i);
                const Vec3 light = found.light[i];
                to.rays[end] = {found.origin[i], found.direction[i], found.far[i], group.time(i)};
                to.light[end] = weight(path) * Rgb{light.x, light.y, light.z};
                if (guide_) to.light[end] *= group.guided.share(i);
                to.sums[end] = sum(path) + found.group[i];
                end += found.found[i];
            }
            to.resize(end);
        });
    }

    /// A scattering event, and the ray by which the path goes on.
    struct Step {
        BsdfSample sample;  // its weight is by the surface alone
        Ray ray;
        LitPoint from;
        const Rgb* inside;    // what fills the space that it crosses; may be null
        float known = -1;     // mean radiance that arrives there, by the guide; below 0: it does not know
        float favour = 1;     // how much denser the direction is sampled than by the surface alone
        bool passes = false;  // straight through a pane
    };
    /// From now on step_record() can be asked: before the first surface is added.
    void learn() { learns_ = true; }
    /// In on() of scatter(): what of the last step a guide can learn from, without its light. None: nothing.
    /// `times`: its density is so many times as high as the step says.
    std::optional<GuideStep> step_record(float times) const {
        auto record = record_;
        if (record) record->density *= times;
        return record;
    }
    /// on(path, Step) of each whose light is not absorbed, in the order in which they were added. choice(path) for
    /// those who need it.
    /// Not `guided`: nobody learns, and there is no guide. `alone`, of each path: does it go by surfaces alone, though
    /// there is one? Empty: nobody.
    template <bool guided = false, class Choice, class On>
    void scatter(std::span<const Vec2> directions, Choice&& choice, On&& on, std::span<const std::uint8_t> alone = {}) {
        for (std::size_t i = 0; i < plain_.size(); ++i) plain_.set_numbers(i, directions[plain_.who(i)]);
        const auto is_alone = [&](std::uint32_t path) { return !alone.empty() && alone[path]; };
        if (guided && guide_) plain_.guided.warp(plain_, is_alone);
        glossy_.each([&](auto& group) {
            for (std::size_t i = 0; i < group.size(); ++i) {
                group.set_numbers(i, directions[group.who(i)]);
                if (group.chooses) group.set_choice(i, choice(group.who(i)));
            }
            if (guided && guide_) group.guided.warp(group, is_alone);
            group.sample();
            if (guided && guide_)
                group.guided.find_favours(group.steps().incoming, group.steps().pdf, group.steps().rough);
        });
        if (plain_.size() > 0) plain_.sample();
        if (plain_.size() == stop_count_) {  // as in most scenes
            for (std::size_t i = 0; i < plain_.size(); ++i) go_on_from_plain<guided>(i, on);
            return;
        }
        for (std::size_t s = 0; s < stop_count_; ++s) {
            const Kind kind = stops_[s].kind;
            const std::size_t i = stops_[s].index;
            if (kind == Kind::none)
                go_on_from_visitor<guided>({visitors_[i], is_alone(visitors_[i].path)}, directions, choice, on);
            else if (kind == Kind::lambertian)
                go_on_from_plain<guided>(i, on);
            else
                glossy_.of(kind, [&](const auto& group) { go_on_from_glossy<guided>(group, i, on); });
        }
    }

private:
    using Kind = ColumnShape::Kind;
    using Plain = Guided<LambertianSurfaces>;
    /// Where a path has come to: which of those of its kind.
    struct Stop {
        Kind kind;
        std::uint32_t index;
    };
    struct Visitor {
        std::uint32_t path, point;
    };
    struct Leaving : Visitor {
        bool alone;
    };
    struct View {
        Vec3 outgoing;
        std::uint8_t lobes;
        const Rgb* inside;
    };
    template <class With>
    void each_group(With&& with) const {
        with(plain_), glossy_.each(with);
    }
    template <class With>
    void each_group(With&& with) {
        with(plain_), glossy_.each(with);
    }
    /// In which columns it goes; none: it is worked out alone.
    Kind kind_of(const Hit& hit, std::uint8_t lobes, const Rgb* inside) const {
        if (inside) return Kind::none;
        const ColumnShape& shape = shapes_[hit.geometry];
        return (lobes & shape.lobes) == shape.lobes ? shape.kind : Kind::none;
    }
    [[gnu::always_inline]] void add_to_last(std::uint32_t path, const Hit& hit, Vec3 outgoing, std::uint8_t lobes) {
        const auto put = [&](const auto& to) {
            stops_[stop_count_++] = {last_, static_cast<std::uint32_t>(to.size())};
        };
        if (last_ == Kind::none) {
            put(visitors_);
            visitors_.push_back({path, static_cast<std::uint32_t>(points_.size() - 1)});
        } else if (last_ == Kind::lambertian) {
            put(plain_);
            plain_.add(path, shapes_[hit.geometry], hit, outgoing);
        } else {
            glossy_.of(last_, [&](auto& group) {
                put(group);
                group.add(path, shapes_[hit.geometry], hit, outgoing, lobes);
            });
        }
    }
    // In path_steps.hpp.
    template <bool guided, class Choice, class On>
    void go_on_from_visitor(const Leaving& visitor, std::span<const Vec2> directions, Choice&& choice, On&& on);
    template <bool guided, class On>
    void go_on_from_plain(std::size_t i, On&& on);
    template <bool guided, class Glossy, class On>
    void go_on_from_glossy(const Glossy& glossy, std::size_t i, On&& on);
    template <class Group>
    static LitPoint lit_point_of(const Group& group, std::size_t i) {
        const Vec3 at = group.position(i);
        return group.has_gloss(i) ? LitPoint(at, group.time(i))
                                  : lit_point(at, group.normal(i), group.outgoing(i), group.time(i));
    }
    /// Lamps for points that were put into lit_, with the numbers of paths who(i).
    template <class Who>
    void sample_lit(const Numbers& numbers, Who&& who) {
        choices_.clear(), places_.clear();
        for (std::size_t i = 0; i < lit_.size(); ++i) {
            if (!numbers.choices.empty()) choices_.push_back(numbers.choices[who(i)]);
            places_.push_back(numbers.places[who(i)]);
        }
        scene_.lights().sample(lit_, choices_, places_, lamps_);
    }
    /// Of visitors from `next` on, as many as go at once: add(path, ray to its lamp). Returns the first that is left.
    template <class Add>
    std::size_t look_from_some(std::size_t next, const Numbers& numbers, Heuristic heuristic, Add&& add) {
        lit_.clear();
        std::array<std::size_t, lanes> some;
        for (; next < visitors_.size() && lit_.size() < lanes; ++next) {
            const Gathering at = gathering(visitors_[next]);
            if (!finds_lamps(scene_, at)) continue;
            some[lit_.size()] = next;
            lit_.push_back(lit_point(at));
        }
        sample_lit(numbers, [&](std::size_t i) { return visitors_[some[i]].path; });
        for (std::size_t i = 0; i < lit_.size(); ++i) {
            if (!lamps_.found[i]) continue;
            const Visitor& visitor = visitors_[some[i]];
            add(visitor.path, ray_to_lamp(scene_, gathering(visitor), lamps_[i], heuristic));
        }
        return next;
    }
    template <class Group>
    const RaysToLamp& look_from(Group& group, const Numbers& numbers, Heuristic heuristic) {
        if constexpr (std::is_same_v<Group, Plain>)
            if (only_lamp_) {
                for (std::size_t i = 0; i < plain_.size(); ++i) plain_.set_numbers(i, numbers.places[plain_.who(i)]);
                return guide_ ? plain_.look_at_whole(*only_lamp_) : plain_.look_at(*only_lamp_, heuristic);
            }
        lit_.clear();
        for (std::size_t i = 0; i < group.size(); ++i) lit_.push_back(lit_point_of(group, i));
        sample_lit(numbers, [&](std::size_t i) { return group.who(i); });
        return guide_ ? group.look_at_whole(lamps_) : group.look_at(lamps_, heuristic);
    }
    Gathering gathering(const Visitor& visitor) const {
        const auto& [outgoing, lobes, inside] = views_[visitor.point];
        const bool guided = guide_ && visitor.point < guided_.size() && guided_[visitor.point].leads();
        return {points_[visitor.point],
                bsdfs_[visitor.point],
                outgoing,
                lobes,
                inside,
                guided ? &guided_[visitor.point] : nullptr};
    }
    Step step_to(const Gathering& at, const BsdfSample& sample) const {
        Step step{sample, at.point.ray_towards(sample.incoming), lit_point(at),
                  filling(at.bsdf, at.point, at.outgoing, sample.incoming, at.inside)};
        step.passes = sample.transmitted && !at.point.is_in_space() && shapes_[at.point.geometry].pane;
        return step;
    }

    static GuideSide side_of(const Gathering& at) {
        return GuideSide::of(at.point.normal, at.bsdf.shading().z, at.outgoing);
    }
    template <class Group>
    static GuideSide side_of(const Group& group, std::size_t i) {
        return GuideSide::of(group.normal(i), group.shading(i), group.outgoing(i));
    }
    void find_guided();
    /// What the surface alone makes of a direction by the guide.
    static std::optional<BsdfSample> led(const Gathering& at, const GuidedPoint& known, Vec2 u);
    /// The step as one that a guide knows, whose directions lie that much denser by it.
    static void follow(float known, float favour, Step& step) {
        step.known = known, step.favour = favour;
        step.sample.pdf *= favour;
    }

    void note_plain_step(std::size_t i, float favour) {
        record_ = GuideStep{plain_.position(i), favour, LightGuide::turn_of(side_of(plain_, i)), plain_.numbers(i)};
    }
    void note_step(const GuideSide& side, const Step& step);

    static constexpr float least_height = 1e-3f;

    const Scene& scene_;
    const LightGuide* guide_;
    std::span<const ColumnShape> shapes_;
    const FlatLamp* only_lamp_;
    std::size_t stop_count_ = 0;
    std::array<Stop, lanes> stops_;  // in the order of paths
    Kind last_ = Kind::none;         // where the last one was put
    Plain plain_;
    GlossyGroups glossy_;
    // the others, and who has come to which
    std::vector<SurfacePoint> points_;
    std::vector<View> views_;
    std::vector<Bsdf> bsdfs_;
    std::vector<Visitor> visitors_;
    // scratch space
    std::vector<LitPoint> lit_;
    std::vector<float> choices_;
    std::vector<Vec2> places_;
    LightSamples lamps_;
    // as the guide knows them
    std::vector<GuidedPoint> guided_;
    bool learns_ = false;
    std::optional<GuideStep> record_;
};

}  // namespace lightnet

#include "core/estimate/path_steps.hpp"
