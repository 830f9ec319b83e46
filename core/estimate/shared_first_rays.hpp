// The rays by which light paths leave the points that they begin at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/many_samples.hpp"
#include "core/base/math/random.hpp"
#include "core/base/query.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Directions drawn from the BSDFs at questions' points, and what lies there. Direct light looks into them, and paths
/// of indirect light begin with them: both draw them from the same random numbers, those of the question. Who is asked
/// second about the same questions finds here what the first has worked out; who is asked alone, or on another host,
/// works out the same. So two layers take the time of one, and no answer depends on who was asked before. One thread's.
// DECISIONS: first-rays-once
class SharedFirstRays {
public:
    /// The first ray of a path.
    struct One {
        bool goes_on = false;  // else the light is absorbed, and the rest means nothing
        bool traced = false;
        PathVertices::Step step;
        std::optional<Hit> hit;  // if it has been traced; none: it meets nothing

        // Number by number, each from where it was worked out: a step that is copied whole has to lie in memory first.
        [[gnu::always_inline]] void go_on_by(const PathVertices::Step& by) {
            goes_on = true;
            step.sample.incoming = by.sample.incoming;
            step.sample.weight = by.sample.weight;
            step.sample.pdf = by.sample.pdf;
            step.sample.lobe = by.sample.lobe;
            step.sample.transmitted = by.sample.transmitted;
            step.sample.eta = by.sample.eta;
            step.ray.origin = by.ray.origin;
            step.ray.direction = by.ray.direction;
            step.ray.far = by.ray.far;
            step.ray.time = by.ray.time;
            step.from.position = by.from.position;
            step.from.normal = by.from.normal;
            step.from.time = by.from.time;
            step.inside = by.inside;
            step.known = by.known;
            step.favour = by.favour;
        }
    };
    /// The stream that they are drawn from, and its dimensions.
    static Key stream(const Query& question) { return child(question.stream, key_of("first rays")); }
    enum Dimension : std::uint32_t { choice_of_lobe, direction };

    /// What follows is about so many samples of each of these questions. Keeps looking at the scene.
    void begin(const Scene& scene, std::span<const Query> questions, std::uint32_t samples);
    /// What follows is nobody else's, and not kept.
    void begin_alone(const Scene& scene);

    /// Paths `first` … `last`, not with it, in the order of questions and samples: after those that were asked for
    /// before. Valid until the next call.
    std::span<One> some(std::size_t first, std::size_t last);
    /// Are all steps of paths before `last` known? If not, all of some() are unset: the caller finds them.
    bool known(std::size_t last) const { return last <= found_; }
    void set_known(std::size_t last) { found_ = kept_ ? last : 0; }
    /// Draws them for paths that begin at `vertices`, with the numbers of each.
    static void draw(PathVertices& vertices, std::span<const Vec2> directions, const ManySamples& numbers,
                     std::span<One> some) {
        const auto choice = [&](std::uint32_t i) { return numbers.at(i, choice_of_lobe).next(); };
        const auto on = [&](std::uint32_t i, const PathVertices::Step& step) __attribute__((always_inline)) {
            some[i].go_on_by(step);
        };
        vertices.scatter(directions, choice, on);
    }
    /// Traces those of some() that have not been yet.
    void trace(std::span<One> some, std::span<const std::uint32_t> which);

private:
    void forget(std::size_t count);

    // More would be out of the nearest caches before they are used again.
    static constexpr std::size_t most = 1024;

    const Scene* scene_ = nullptr;
    std::vector<Query> questions_;
    std::uint32_t samples_ = 0;
    bool kept_ = false;
    std::size_t found_ = 0;
    std::vector<One> all_;
    // scratch space
    std::vector<std::uint32_t> traced_;
    std::vector<Ray> rays_;
    std::vector<std::optional<Hit>> hits_;
};

}  // namespace lightnet
