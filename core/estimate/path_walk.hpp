// Light paths from many points at once: path tracing, and what a guide learns from it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/estimate/light_guide.hpp"
#include "core/estimate/shared_first_rays.hpp"
#include "core/estimate/through_panes.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Which paths are followed.
struct PathPlan {
    std::uint32_t samples = 1;         // of each question
    std::uint32_t max_depth = 0;       // surfaces that a path may have behind the point, but for panes that it passes
                                       // straight; 0: any number
    std::uint32_t roulette_depth = 3;  // surfaces after which paths may end by chance
    bool all = false;                  // direct light as well
};

/// A whole path: what it brought, and what it cost.
struct PathRecord {
    float radiance = 0;  // luminance, W·sr⁻¹·m⁻²
    float surfaces = 0;  // at which it was
};

/// What paths have found.
struct Learnt {
    std::vector<GuideRecord> records;  // of each direction
    std::vector<PathRecord> paths;
};

/// Path tracing with next-event estimation, multiple importance sampling and Russian roulette. Unless asked for all
/// paths it leaves out what arrives straight from lamps and environment at the point asked about: that is direct light.
/// Light that comes from them by way of mirrors or glass is counted here. Lamps are looked for through panes of glass
/// too, also from the point asked about, and those that a path passes straight don't count as surfaces.
///
/// Points on lamps can't find an environment without a map. There, where it counts first, the path's own direction and
/// a second one, of which only the sky counts, share what they see of it half and half: the second one costs no more
/// than a shadow, and on open ground it halves the variance.
///
/// Many paths go on together, surface by surface, so that their rays are traced in packets. What a path finds does not
/// depend on the others: hits are those of single rays, and each path adds up its light in its own order. Where groups
/// of lamps are kept apart, the same paths put what they find into one of several sums. Immutable; any thread may ask.
class PathWalk {
public:
    PathWalk(const Scene& scene, const PathPlan& plan) : scene_(scene), plan_(plan), panes_(has_panes(scene)) {}

    /// Adds the mean light of each question's paths to its answer, group by group of lamps. Random numbers come from
    /// child(question.stream, key), those of first directions from SharedFirstRays::stream(question).
    void light(std::span<const Query> questions, Key key, SharedFirstRays& first, std::span<Rgb> answers) const;
    /// Adds the mean light of paths that go on by a guide, and not by surfaces alone.
    void light(std::span<const Query> questions, Key key, const LightGuide& guide, std::span<Rgb> answers) const;

    /// Follows paths by a guide, or null, and appends what each of them has found. Of a scene that keeps no groups
    /// apart.
    void learn(std::span<const Query> questions, Key key, const LightGuide* guide, Learnt& learnt) const;

private:
    const Scene& scene_;
    PathPlan plan_;
    bool panes_;  // has the scene any?
};

}  // namespace lightnet
