// Surfaces that many ways of light have come to at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/direct_light.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surfaces/lambertian_surfaces.hpp"

namespace lightnet {

/// Rays to lamps, and what arrives if nothing is in the way.
struct LampRays {
    std::vector<Ray> rays;
    std::vector<Rgb> light;
    std::vector<std::uint32_t> paths;

    void add(const Ray& ray, Rgb arriving, std::uint32_t path) {
        rays.push_back(ray);
        light.push_back(arriving);
        paths.push_back(path);
    }
    void resize(std::size_t count) { rays.resize(count), light.resize(count), paths.resize(count); }
};

/// Where each of some walks has come to. Plain surfaces go through the formulas side by side, the others one by one:
/// what each walk is told is the same, to the bit. One thread.
class Stops {
public:
    explicit Stops(const Scene& scene)
        : scene_(scene), lambertian_shapes_(scene.lambertian_shapes()), only_lamp_(scene.only_flat_lamp()) {}

    void clear() { plain_.clear(), points_.clear(), seen_.clear(), bsdfs_.clear(), visitors_.clear(); }
    bool full() const { return plain_.full(); }
    /// Walk `walk`, after those added before, has come to a surface, as seen from `outgoing`, through `inside`; this
    /// has not been full. Only these `lobes` are looked at.
    void add(std::uint32_t walk, const Hit& hit, Vec3 outgoing, std::uint8_t lobes, const Rgb* inside) {
        plain_last_ = hit.instance == Query::no_instance && lambertian_shapes_[hit.geometry].mesh && !inside &&
                      (lobes & lobe::diffuse);
        if (plain_last_) {
            plain_.add(walk, lambertian_shapes_[hit.geometry], hit, outgoing);
            return;
        }
        points_.push_back(scene_.surface(hit));
        seen_.push_back({outgoing, lobes, inside});
        add_to_last(walk);
    }
    /// The same place again.
    void add_again(std::uint32_t walk, const Hit& hit, Vec3 outgoing) {
        if (plain_last_)
            plain_.add(walk, lambertian_shapes_[hit.geometry], hit, outgoing);
        else
            add_to_last(walk);
    }
    /// All have been added.
    void find_points() { plain_.find_points(); }

    /// with(walk, point) of all that may be lamps.
    template <class With>
    void each_that_may_shine(With&& with) const {
        for (const auto [walk, stop] : visitors_) with(walk, points_[stop]);
    }

    /// How they scatter: before anything of the following is asked.
    void find_bsdfs() {
        for (const SurfacePoint& point : points_) scene_.add_bsdf(point, bsdfs_);
    }

    /// with(walk, Gathering) of each.
    template <class With>
    void each(With&& with) const {
        for (const auto& visitor : visitors_) with(visitor.walk, gathering(visitor));
        for (std::size_t i = 0; i < plain_.size(); ++i) {
            const SurfacePoint point = plain_.point(i);
            const Bsdf bsdf = plain_.bsdf(i);
            with(plain_.who(i), Gathering{point, bsdf, plain_.outgoing(i), lobe::all});
        }
    }

    /// Numbers of each walk, by its index. Empty: nobody needs them.
    struct Numbers {
        std::span<const float> choices;
        std::span<const Vec2> places;
    };
    /// Appends the rays that ray_to_lamp() gives, their light times weight(walk), for path(walk).
    template <class Weight, class Path>
    void look_for_lamps(const Numbers& numbers, Heuristic heuristic, LampRays& to, Weight&& weight, Path&& path) {
        const auto look = [&](std::uint32_t walk, const Gathering& at) {
            const float choice = numbers.choices.empty() ? 0 : numbers.choices[walk];
            const auto found = ray_to_lamp(scene_, at, {choice, numbers.places[walk]}, heuristic);
            if (found) to.add(found->ray, weight(walk) * found->light, path(walk));
        };
        if (!only_lamp_) return each(look);
        for (const auto& visitor : visitors_) look(visitor.walk, gathering(visitor));
        for (std::size_t i = 0; i < plain_.size(); ++i) plain_.set_numbers(i, numbers.places[plain_.who(i)]);
        const auto& found = plain_.look_at(*only_lamp_, heuristic == Heuristic::power);
        // Also what finds nothing is written, and then written over: what a point finds can't be foretold.
        std::size_t end = to.rays.size();
        to.resize(end + plain_.size());
        for (std::size_t i = 0; i < plain_.size(); ++i) {
            const std::uint32_t walk = plain_.who(i);
            const Vec3 light = found.light[i];
            to.rays[end] = {found.origin[i], found.direction[i], found.far[i]};
            to.light[end] = weight(walk) * Rgb{light.x, light.y, light.z};
            to.paths[end] = path(walk);
            end += found.found[i];
        }
        to.resize(end);
    }

    /// A way on.
    struct Step {
        BsdfSample sample;
        Ray ray;
        Vec3 from;
        const Rgb* inside;  // what it leads through; may be null
    };
    /// on(walk, Step) of each whose light is not absorbed, in the order in which they were added. choice(walk) for
    /// those who need it.
    template <class Choice, class On>
    void scatter(std::span<const Vec2> ways, Choice&& choice, On&& on) {
        for (std::size_t i = 0; i < plain_.size(); ++i) plain_.set_numbers(i, ways[plain_.who(i)]);
        const auto& steps = plain_.sample();
        for (std::size_t i = 0, other = 0; i < plain_.size() || other < visitors_.size();) {
            if (other < visitors_.size() && (i == plain_.size() || visitors_[other].walk < plain_.who(i))) {
                const auto& visitor = visitors_[other++];
                const Gathering at = gathering(visitor);
                const float chosen = at.bsdf.chooses() ? choice(visitor.walk) : 0;
                if (const auto step = at.bsdf.sample(at.outgoing, chosen, ways[visitor.walk], at.lobes))
                    on(visitor.walk, step_to(at, *step));
                continue;
            }
            if (steps.pdf[i] != 0) {
                const BsdfSample step{steps.incoming[i], plain_.albedo(i), steps.pdf[i], lobe::diffuse};
                on(plain_.who(i), Step{step, plain_.ray_from(i, step.incoming), plain_.position(i), nullptr});
            }
            ++i;
        }
    }

private:
    struct Visitor {
        std::uint32_t walk, stop;
    };
    struct Seen {
        Vec3 outgoing;
        std::uint8_t lobes;
        const Rgb* inside;
    };
    void add_to_last(std::uint32_t walk) {
        visitors_.push_back({walk, static_cast<std::uint32_t>(points_.size() - 1)});
    }
    Gathering gathering(const Visitor& visitor) const {
        const auto& [outgoing, lobes, inside] = seen_[visitor.stop];
        return {points_[visitor.stop], bsdfs_[visitor.stop], outgoing, lobes, inside};
    }
    static Step step_to(const Gathering& at, const BsdfSample& sample) {
        return {sample,
                {at.point.origin_towards(sample.incoming), sample.incoming},
                at.point.position,
                filling(at.bsdf, at.point, at.outgoing, sample.incoming, at.inside)};
    }

    const Scene& scene_;
    std::span<const LambertianShape> lambertian_shapes_;
    const FlatLamp* only_lamp_;
    LambertianSurfaces plain_;
    bool plain_last_ = false;
    // the others, and who has come to which
    std::vector<SurfacePoint> points_;
    std::vector<Seen> seen_;
    std::vector<Bsdf> bsdfs_;
    std::vector<Visitor> visitors_;
};

/// with(index, Gathering) of each question, in another order than theirs.
template <class With>
void gather_each(const Scene& scene, std::span<const Query> questions, With&& with) {
    Stops stops(scene);
    for (std::size_t next = 0; next < questions.size();) {
        stops.clear();
        for (; next < questions.size() && !stops.full(); ++next) {
            const Query& question = questions[next];
            stops.add(static_cast<std::uint32_t>(next), scene.hit(question), question.outgoing, question.lobes,
                      nullptr);
        }
        stops.find_points();
        stops.find_bsdfs();
        stops.each(with);
    }
}

}  // namespace lightnet
