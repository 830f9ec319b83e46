// Surfaces that many light paths have come to at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/direct_light.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surfaces/lambertian_surfaces.hpp"

namespace lightnet {

/// Shadow rays: to points on lamps, and what arrives if nothing is in between.
struct ShadowRays {
    std::vector<Ray> rays;
    std::vector<Rgb> light;
    std::vector<std::uint32_t> sums;  // to which it is added

    void add(const Ray& ray, Rgb arriving, std::uint32_t sum) {
        rays.push_back(ray);
        light.push_back(arriving);
        sums.push_back(sum);
    }
    void resize(std::size_t count) { rays.resize(count), light.resize(count), sums.resize(count); }
};

/// Where each of some paths has come to: its vertex. Plain surfaces go through the formulas many at once, as a
/// structure of arrays, the others one by one: what each path is told is the same, to the bit. One thread.
class PathVertices {
public:
    explicit PathVertices(const Scene& scene)
        : scene_(scene), lambertian_shapes_(scene.lambertian_shapes()), only_lamp_(scene.only_flat_lamp()) {}

    void clear() { plain_.clear(), points_.clear(), views_.clear(), bsdfs_.clear(), visitors_.clear(); }
    bool full() const { return plain_.full(); }
    /// Path `path`, after those added before, has come to a surface, as seen from `outgoing`, through `inside`. Not
    /// when it is full. Only these `lobes` count.
    void add(std::uint32_t path, const Hit& hit, Vec3 outgoing, std::uint8_t lobes, const Rgb* inside) {
        plain_last_ = hit.instance == Query::no_instance && lambertian_shapes_[hit.geometry].mesh && !inside &&
                      (lobes & lobe::diffuse);
        if (plain_last_) {
            plain_.add(path, lambertian_shapes_[hit.geometry], hit, outgoing);
            return;
        }
        points_.push_back(scene_.surface(hit));
        views_.push_back({outgoing, lobes, inside});
        add_to_last(path);
    }
    /// The place of the one added last again.
    void add_again(std::uint32_t path, const Hit& hit, Vec3 outgoing) {
        if (plain_last_)
            plain_.add(path, lambertian_shapes_[hit.geometry], hit, outgoing);
        else
            add_to_last(path);
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
                add_again(static_cast<std::uint32_t>(path), hit, asked.outgoing);
                continue;
            }
            before = &asked;
            hit = scene_.hit(asked);
            add(static_cast<std::uint32_t>(path), hit, asked.outgoing, asked.lobes, nullptr);
        }
        find_points();
        return path;
    }
    /// All have been added.
    void find_points() { plain_.find_points(); }

    /// with(path, point) of all that may be lamps.
    template <class With>
    void each_that_may_shine(With&& with) const {
        for (const auto [path, point] : visitors_) with(path, points_[point]);
    }

    /// How they scatter: before anything of the following is asked.
    void find_bsdfs() {
        for (const SurfacePoint& point : points_) scene_.add_bsdf(point, bsdfs_);
    }

    /// with(path, Gathering) of each.
    template <class With>
    void each(With&& with) const {
        for (const auto& visitor : visitors_) with(visitor.path, gathering(visitor));
        for (std::size_t i = 0; i < plain_.size(); ++i) {
            const SurfacePoint point = plain_.point(i);
            const Bsdf bsdf = plain_.bsdf(i);
            with(plain_.who(i), Gathering{point, bsdf, plain_.outgoing(i), lobe::all});
        }
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
        const auto sample = [&](std::uint32_t path, const Gathering& at) {
            const float choice = numbers.choices.empty() ? 0 : numbers.choices[path];
            const auto found = ray_to_lamp(scene_, at, {choice, numbers.places[path]}, heuristic);
            if (found) to.add(found->ray, weight(path) * found->light, sum(path) + found->group);
        };
        if (!only_lamp_) expect_lights(numbers);
        if (!only_lamp_ || !shares(heuristic)) return each(sample);
        for (const auto& visitor : visitors_) sample(visitor.path, gathering(visitor));
        for (std::size_t i = 0; i < plain_.size(); ++i) plain_.set_numbers(i, numbers.places[plain_.who(i)]);
        const auto& found = plain_.look_at(*only_lamp_, heuristic == Heuristic::power);
        // Also what finds nothing is written, and then written over: what a point finds can't be foretold.
        std::size_t end = to.rays.size();
        to.resize(end + plain_.size());
        for (std::size_t i = 0; i < plain_.size(); ++i) {
            const std::uint32_t path = plain_.who(i);
            const Vec3 light = found.light[i];
            to.rays[end] = {found.origin[i], found.direction[i], found.far[i]};
            to.light[end] = weight(path) * Rgb{light.x, light.y, light.z};
            to.sums[end] = sum(path) + only_lamp_->group;
            end += found.found[i];
        }
        to.resize(end);
    }

    /// A scattering event, and the ray by which the path goes on.
    struct Step {
        BsdfSample sample;
        Ray ray;
        LitPoint from;
        const Rgb* inside;  // what fills the space that it crosses; may be null
    };
    /// on(path, Step) of each whose light is not absorbed, in the order in which they were added. choice(path) for
    /// those who need it.
    template <class Choice, class On>
    void scatter(std::span<const Vec2> directions, Choice&& choice, On&& on) {
        for (std::size_t i = 0; i < plain_.size(); ++i) plain_.set_numbers(i, directions[plain_.who(i)]);
        const auto& steps = plain_.sample();
        for (std::size_t i = 0, other = 0; i < plain_.size() || other < visitors_.size();) {
            if (other < visitors_.size() && (i == plain_.size() || visitors_[other].path < plain_.who(i))) {
                const auto& visitor = visitors_[other++];
                const Gathering at = gathering(visitor);
                const float chosen = at.bsdf.chooses() ? choice(visitor.path) : 0;
                if (const auto step = at.bsdf.sample(at.outgoing, chosen, directions[visitor.path], at.lobes))
                    on(visitor.path, step_to(at, *step));
                continue;
            }
            if (steps.pdf[i] != 0) {
                const BsdfSample step{steps.incoming[i], plain_.albedo(i), steps.pdf[i], lobe::diffuse};
                const LitPoint from = lit_point(plain_.position(i), plain_.normal(i), plain_.outgoing(i));
                on(plain_.who(i), Step{step, plain_.ray_from(i, step.incoming), from, nullptr});
            }
            ++i;
        }
    }

private:
    struct Visitor {
        std::uint32_t path, point;
    };
    struct View {
        Vec3 outgoing;
        std::uint8_t lobes;
        const Rgb* inside;
    };
    void expect_lights(const Numbers& numbers) {
        expected_choices_.clear(), expected_places_.clear();
        const auto expect = [&](std::uint32_t path) {
            if (!numbers.choices.empty()) expected_choices_.push_back(numbers.choices[path]);
            expected_places_.push_back(numbers.places[path]);
        };
        for (const auto& visitor : visitors_) expect(visitor.path);
        for (std::size_t i = 0; i < plain_.size(); ++i) expect(plain_.who(i));
        scene_.expect_lights(expected_choices_, expected_places_);
    }
    void add_to_last(std::uint32_t path) {
        visitors_.push_back({path, static_cast<std::uint32_t>(points_.size() - 1)});
    }
    Gathering gathering(const Visitor& visitor) const {
        const auto& [outgoing, lobes, inside] = views_[visitor.point];
        return {points_[visitor.point], bsdfs_[visitor.point], outgoing, lobes, inside};
    }
    static Step step_to(const Gathering& at, const BsdfSample& sample) {
        return {sample,
                {at.point.origin_towards(sample.incoming), sample.incoming},
                lit_point(at),
                filling(at.bsdf, at.point, at.outgoing, sample.incoming, at.inside)};
    }

    const Scene& scene_;
    std::span<const LambertianShape> lambertian_shapes_;
    const FlatLamp* only_lamp_;
    LambertianSurfaces plain_;
    bool plain_last_ = false;
    // the others, and who has come to which
    std::vector<SurfacePoint> points_;
    std::vector<View> views_;
    std::vector<Bsdf> bsdfs_;
    std::vector<Visitor> visitors_;
    // scratch space
    std::vector<float> expected_choices_;
    std::vector<Vec2> expected_places_;
};

/// with(index, Gathering) of each question, in another order than theirs.
template <class With>
void gather_each(const Scene& scene, std::span<const Query> questions, With&& with) {
    PathVertices vertices(scene);
    for (std::size_t next = 0; next < questions.size();) {
        next = vertices.begin(next, questions.size(), [&](std::size_t i) -> const Query& { return questions[i]; });
        vertices.find_bsdfs();
        vertices.each(with);
    }
}

}  // namespace lightnet
