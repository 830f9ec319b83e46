#include "core/estimate/gather.hpp"

#include "core/base/math/samples.hpp"
#include "core/estimate/mirror_way.hpp"

#include <algorithm>
#include <limits>

namespace lightnet {
namespace {

constexpr std::uint32_t most_mirrors = 100;  // in a row
constexpr float keep = 4;                    // what is fainter than its inverse is followed seldom
constexpr Key chain_key = key_of("chain of mirrors");

/// Questions about what looks meet, in order of look and depth.
struct Met {
    std::vector<Query> questions;
    std::vector<std::size_t> looks;  // whose they are
    std::vector<Rgb> weights;
};

Query question_about(const SurfaceLook& look, const MirrorWay& way, const Hit& hit, std::uint8_t lobes,
                     std::uint32_t mirrors) {
    Query question = way.question_about(hit, lobes, look.depth + 1u + mirrors);
    question.stream = mirrors ? child(look.stream, chain_key, mirrors) : look.stream;
    question.sample = look.sample;
    return question;
}

void follow(const Scene& scene, const SurfaceLook& look, std::optional<Hit> hit, std::size_t index, Met& met) {
    MirrorWay way(look.ray);
    for (std::uint32_t mirrors = 0; hit; ++mirrors) {
        way.arrive(hit->distance);
        const SurfacePoint point = scene.surface(*hit);
        const Bsdf bsdf = scene.bsdf(point);
        const std::uint8_t lobes = bsdf.lobes();
        if (lobes & lobe::rough) {
            met.questions.push_back(question_about(look, way, *hit, lobes, mirrors));
            met.looks.push_back(index);
            met.weights.push_back(way.weight());
        }
        if (!(lobes & lobe::specular) || mirrors >= most_mirrors) return;
        if (!way.go_on(point, bsdf, Samples(child(look.stream, chain_key, 256 + mirrors), look.sample), keep)) return;
        hit = scene.intersect(way.ray());
    }
}

}  // namespace

void look_around(const Scene& scene, const Inputs& inputs, std::size_t index, std::span<const SurfaceLook> looks,
                 std::span<Seen> seen) {
    std::vector<Ray> rays;
    rays.reserve(looks.size());
    for (const SurfaceLook& look : looks) rays.push_back(look.ray);
    std::vector<std::optional<Hit>> hits(rays.size());
    scene.intersect(rays, hits);
    Met met;
    met.questions.reserve(looks.size());
    met.looks.reserve(looks.size());
    met.weights.reserve(looks.size());
    for (std::size_t i = 0; i < looks.size(); ++i) {
        seen[i] = {{}, hits[i] ? hits[i]->distance : std::numeric_limits<float>::infinity()};
        follow(scene, looks[i], hits[i], i, met);
    }
    if (met.questions.empty()) return;
    const Part part = ask(inputs, index, met.questions);
    const std::size_t width = part.input->width();
    for (std::size_t q = 0; q < met.questions.size(); ++q)
        for (std::size_t k = 0; k < width; ++k)
            seen[met.looks[q]].light += part.answers[q * width + k] * met.weights[q];
}

}  // namespace lightnet
