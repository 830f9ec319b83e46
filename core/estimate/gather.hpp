// Asks a node's input how bright other surfaces look from a point: final gathering.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/network/light/inputs.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// A ray from a surface to others.
struct GatherRay {
    Ray ray;
    Key stream = 0;            // of its own random numbers, and of the questions about what it meets
    std::uint32_t sample = 0;  // index within the stream
    std::uint8_t depth = 0;    // scattering events between the eye and the point that it leaves
    std::uint16_t pass = 0;    // of the question that it is followed for
};

/// What a ray found.
struct GatherResult {
    Rgb light;       // radiance arriving that surfaces or media have scattered, or media emit (lamps are direct light)
    float distance;  // m, to the first surface; infinite where there is none
};

/// Follows rays, through mirrors and glass, to surfaces that scatter in other ways too, and asks input `index` about
/// all of these at once; what a ray finds depends on no other ray. A
/// ray has a result for each colour that the input answers with, side by side.
void gather(const Scene& scene, const Inputs& inputs, std::size_t index, std::span<const GatherRay> rays,
            std::span<GatherResult> results);

/// Gathers for many questions at once what their surfaces scatter to them, with rays drawn from their BSDFs.
class BsdfGather {
public:
    /// `rays` for each question; `key` is the node's own.
    BsdfGather(const Scene& scene, Key key, std::uint32_t rays) : scene_(scene), key_(key), rays_per_question_(rays) {}

    /// Draws the rays of a question, which are for `asker`, from these lobes. `stream` is the root of their random
    /// numbers.
    void add(std::size_t asker, const Query& question, const SurfacePoint& point, const Bsdf& bsdf, std::uint8_t lobes,
             Key stream);
    /// answers[asker] += what the rays of all bring, as the node's input 0 says; each colour of that apart.
    void answer(const Inputs& inputs, std::span<Rgb> answers) const;

private:
    const Scene& scene_;
    Key key_;
    std::uint32_t rays_per_question_;
    std::vector<GatherRay> rays_;
    std::vector<Rgb> weights_;  // of what each brings
    std::vector<std::size_t> askers_;
};

}  // namespace lightnet
