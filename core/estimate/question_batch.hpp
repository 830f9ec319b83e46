// The questions of one call, as a function that a user wrote sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/network/light/inputs.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// What such a function may learn of the questions that it answers. Entry i of what it is told is of question i alone.
/// Refers to all that it is made of.
class QuestionBatch {
public:
    QuestionBatch(const Scene& scene, const Inputs& inputs, Key key, std::span<const Query> questions)
        : scene_(scene), inputs_(inputs), key_(key), questions_(questions) {}

    /// Where a question lies.
    struct Place {
        SurfacePoint point;
        Vec3 up;  // the normal on the side that is asked about
    };

    std::size_t size() const { return questions_.size(); }
    const Query& operator[](std::size_t i) const { return questions_[i]; }
    /// Of all questions; looked up at the first call.
    const std::vector<Place>& places();
    /// The part of the surface that scatters evenly; black: it has none.
    Rgb albedo(std::size_t i);
    /// Point `which` (from 0) of `of` in the unit square, well spread over all samples of a pixel.
    Vec2 random(std::size_t i, std::uint32_t which, std::uint32_t of) const;
    /// Is nothing in the way, as far as `distance` (scene units)? 0: however far.
    bool open(std::size_t i, Vec3 direction, float distance);
    /// What an input says of the same questions: radiance, one colour each.
    std::vector<Rgb> ask(std::size_t input) const;
    /// Radiance that arrives from these directions, one for each question, and that some surface has scattered.
    std::vector<Rgb> ask(std::size_t input, std::span<const Vec3> directions);

private:
    const Scene& scene_;
    const Inputs& inputs_;
    Key key_;
    std::span<const Query> questions_;
    std::vector<Place> places_;
};

}  // namespace lightnet
