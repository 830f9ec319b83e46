// A trial of whether guided paths find more for the same work.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/estimate/light_guide.hpp"
#include "core/estimate/path_walk.hpp"

namespace lightnet {

/// Compares guided paths with paths that go by surfaces alone, which begin at the same points.
/// DECISIONS: guided-where-it-pays
class GuideTrial {
public:
    /// A path of the trial.
    struct Tried {
        PathRecord path;
        std::uint32_t point;  // at which it begins
        bool guided;
    };
    /// How many times more noise × work paths by surfaces alone have than guided ones, and its standard error.
    struct Gain {
        double times = 0, error = 0;
        /// It is hardly less: the odds are two to one.
        double low() const { return times - 0.5 * error; }
    };

    /// Paths begin at so many points: at most 2²³.
    explicit GuideTrial(std::size_t points) : points_(points) {}

    /// A whole path, among records of directions. A guide does not learn from it.
    static GuideRecord record_of(const Tried& tried);
    /// `judged`: of the round that the gain is of; of those before, paths count that go by surfaces alone. Records that
    /// are no paths of trials are passed over.
    void add(const GuideRecord& path, bool judged);
    /// Noise is a moment of order 3/2 of the light of paths, relative to what the other paths of a point have found;
    /// the darkest points count less. Variance would hang on the few brightest paths, which may be on either side. A
    /// guided surface counts as three tenths more work. Where nothing was found: 0.
    Gain gain() const;
    /// How much paths that go by surfaces alone differ: that moment of order 3/2, from 0 on, and its standard error. A
    /// guide can take nothing else away.
    Gain noise_alone() const;

private:
    static constexpr std::size_t groups = 16;  // disjoint ones of points, whose gains tell the error
    struct Path {
        std::size_t point;
        double radiance, surfaces;
    };
    struct Sums {
        double light = 0, moment = 0, surfaces = 0, paths = 0;
        void add(const Sums& more, double times);
        double noise() const;
        double cost() const;
    };
    template <class Of>
    Gain with_error(const Of& of) const;
    using Kinds = std::array<Sums, 2>;  // those that go by surfaces alone, and guided ones
    std::array<Kinds, groups> sums() const;

    std::size_t points_;
    std::array<std::vector<Path>, 2> kinds_;
};

/// A guide learns in so many rounds.
inline constexpr std::size_t guide_rounds = 4;

/// Does it pay to go on after the rounds of which these are the gains, in their order? The first round has none, as
/// nobody guides it. `noise`: of paths that nobody guides. At least one gain, at most one less than there are rounds.
bool guide_pays(std::span<const GuideTrial::Gain> gains, double noise);

}  // namespace lightnet
