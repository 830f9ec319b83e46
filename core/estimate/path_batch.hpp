// Light paths that go on together.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/columns.hpp"
#include "core/base/math/many_samples.hpp"
#include "core/estimate/lamps_met.hpp"
#include "core/estimate/path_chances.hpp"
#include "core/estimate/path_lessons.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/estimate/shadow_rays.hpp"
#include "core/estimate/shared_first_rays.hpp"
#include "core/scene/media/flight.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Each vertex of a path has these dimensions of its own, used or not.
struct PathDimensions {
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
};

/// Some paths between two of their vertices, and scratch space for them. One thread's.
struct PathBatch {
    /// A path between two of its vertices.
    struct Path {
        std::uint32_t sum;  // index into PathBatch::sums: of the first group of lamps
        float eta_scale;    // of radiance by refraction, which is no loss: roulette must not see it
        Rgb weight;
        const Rgb* inside;  // what fills the space that it crosses; may be null
        LitPoint from;
        // of the sample by which it goes on
        Vec3 incoming;
        float pdf = 0;
        std::uint8_t lobe = 0;
        std::uint8_t panes = 0;  // that it has passed: they count as no surfaces
        float hoped = 0;         // light that all of the path is thought to bring, by a guide; 0: nobody knows
        AloneOdds odds{};

        /// Seen from where it was before, whose lamps are looked for through panes.
        Path after_pane(float scale, Rgb left, const Rgb* filling, float hope, AloneOdds alone) const {
            Path next = *this;
            next.eta_scale = scale, next.weight = left, next.inside = filling, next.hoped = hope, next.odds = alone;
            next.panes = static_cast<std::uint8_t>(std::min(panes + 1, 255));
            return next;
        }
    };
    /// Random numbers of each path at its vertex, dimension by dimension.
    struct Numbers {
        std::vector<float> choices, survivals;
        std::vector<Vec2> places, directions;
    };
    PathBatch(const Scene& scene, const LightGuide* guide) : vertices(scene, guide) {}
    void learn(Lessons& from) {
        lessons = &from;
        vertices.learn();
    }

    /// Says which of the paths that begin go by surfaces alone: where there is no guide, none.
    void part(const LightGuide* guide) {
        constexpr std::uint32_t way = 0x80000000;  // a dimension that no vertex has
        samples.draw(way, numbers.survivals);
        alone.clear();
        for (const float number : numbers.survivals) alone.push_back(guide && number < AloneOdds::share);
    }

    std::vector<Rgb> sums;           // of each path that began, group by group of lamps
    std::vector<std::size_t> asked;  // the same: which question it's for
    std::vector<Path> paths;
    std::vector<Ray> rays;  // of each path
    std::vector<std::optional<Hit>> hits;
    ManySamples flights;                               // of each path that began, where there are media: of its flights
    std::vector<std::optional<Collision>> collisions;  // of each path, where there are media: before its hit
    ManySamples samples;                               // of each path
    std::span<SharedFirstRays::One> first_rays;        // of those that began
    ManySamples first_samples;                         // the same, of their random numbers
    std::vector<std::uint32_t> begun;                  // of paths that go on by them: which of those
    Numbers numbers;
    std::vector<std::uint8_t> alone;  // of each path, with a guide: does it go by surfaces alone?
    PathVertices vertices;
    ShadowRays shadow_rays;
    std::vector<std::uint8_t> occluded;
    std::size_t kept = 0;  // paths and rays that go on
    // some that meet nothing any more, and what they find there
    std::array<std::uint32_t, lanes> leaving;
    std::array<Ray, lanes> skywards;
    std::array<SkyRadiance, lanes> sky;
    LampsMet lamps_met;
    Lessons* lessons = nullptr;  // null: nobody learns
};

}  // namespace lightnet
