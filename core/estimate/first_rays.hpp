// The rays by which light paths leave the points that they begin at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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
class FirstRays {
public:
    /// The first ray of a path.
    struct One {
        std::optional<PathVertices::Step> step;  // none: the light is absorbed
        bool traced = false;
        std::optional<Hit> hit;  // if it has been traced; none: it meets nothing
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
