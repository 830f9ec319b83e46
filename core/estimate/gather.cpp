#include "core/estimate/gather.hpp"

#include "core/base/math/samples.hpp"
#include "core/estimate/specular_path.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene_media.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace lightnet {
namespace {

constexpr std::uint32_t most_mirrors = 100;  // in a row
constexpr float contrast = 4;                // what is fainter than its inverse is followed seldom
constexpr Key chain_key = key_of("chain of mirrors");
constexpr Key flight_key = key_of("flights");

/// Questions about what rays meet, in order of ray and depth.
struct RayQuestions {
    std::vector<Query> questions;
    std::vector<std::size_t> rays;  // whose they are
    std::vector<Rgb> weights;
};

void add(Query question, const GatherRay& ray, const SpecularPath& path, std::uint32_t mirrors, std::size_t index,
         RayQuestions& met) {
    question.stream = mirrors ? child(ray.stream, chain_key, mirrors) : ray.stream;
    question.sample = ray.sample;
    question.pass = ray.pass;
    met.questions.push_back(question);
    met.rays.push_back(index);
    met.weights.push_back(path.weight());
}

// Does a medium scatter what the path would meet? Then that is asked about. What media emit on the way counts as
// scattered by them, as in paths and photon maps.
bool collides(const Scene& scene, const GatherRay& ray, const std::optional<Hit>& hit, std::uint32_t mirrors,
              std::size_t index, SpecularPath& path, RayQuestions& met, Rgb& shine) {
    Ray way = path.ray();
    if (hit) way.far = hit->distance;
    Samples samples(child(ray.stream, flight_key, mirrors), ray.sample);
    const Flight flight = scene.media().fly(way, path.weight(), samples.next_2d());
    shine += path.weight() * flight.emitted;
    path.dim(flight.weight);
    if (!flight.collision) return false;
    path.arrive(flight.collision->distance);
    add(path.question_about(*flight.collision, ray.depth + 1u + mirrors), ray, path, mirrors, index, met);
    return true;
}

void follow(const Scene& scene, const GatherRay& ray, std::optional<Hit> hit, std::size_t index, RayQuestions& met,
            Rgb& shine) {
    SpecularPath path(ray.ray);
    for (std::uint32_t mirrors = 0;; ++mirrors) {
        if (scene.has_media() && collides(scene, ray, hit, mirrors, index, path, met, shine)) return;
        if (!hit) return;
        path.arrive(hit->distance);
        const SurfacePoint point = scene.surface(*hit);
        const Bsdf bsdf = scene.bsdf(point);
        const std::uint8_t lobes = bsdf.lobes();
        if (lobes & lobe::rough)
            add(path.question_about(*hit, lobes, ray.depth + 1u + mirrors), ray, path, mirrors, index, met);
        if (!(lobes & lobe::specular) || mirrors >= most_mirrors) return;
        if (!path.go_on(point, bsdf, Samples(child(ray.stream, chain_key, 256 + mirrors), ray.sample), contrast))
            return;
        hit = scene.intersect(path.ray());
    }
}

}  // namespace

void gather(const Scene& scene, const Inputs& inputs, std::size_t index, std::span<const GatherRay> rays,
            std::span<GatherResult> results) {
    const std::size_t width = inputs[index].width();
    const std::size_t of_media = width > 1 ? scene.lights().environment_group() : 0;
    std::vector<Ray> first;
    first.reserve(rays.size());
    for (const GatherRay& ray : rays) first.push_back(ray.ray);
    std::vector<std::optional<Hit>> hits(first.size());
    scene.intersect(first, hits);
    RayQuestions met;
    met.questions.reserve(rays.size());
    met.rays.reserve(rays.size());
    met.weights.reserve(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float distance = hits[i] ? hits[i]->distance : std::numeric_limits<float>::infinity();
        std::fill_n(results.begin() + std::ptrdiff_t(i * width), width, GatherResult{{}, distance});
        follow(scene, rays[i], hits[i], i, met, results[i * width + of_media].light);
    }
    if (met.questions.empty()) return;
    each_colour(ask(inputs, index, met.questions), [&](std::size_t q, std::size_t layer, const Rgb& colour) {
        results[met.rays[q] * width + layer].light += colour * met.weights[q];
    });
}

void BsdfGather::add(std::size_t asker, const Query& question, const SurfacePoint& point, const Bsdf& bsdf,
                     std::uint8_t lobes, Key stream) {
    for (std::uint32_t i = 0; i < rays_per_question_; ++i) {
        Samples samples(stream, question.sample * rays_per_question_ + i);
        const float choice = bsdf.chooses() ? samples.next() : samples.skip();
        const auto step = bsdf.sample(question.outgoing, choice, samples.next_2d(), lobes);
        if (!step || !(max_component(step->weight) > 0)) continue;
        rays_.push_back({point.ray_towards(step->incoming), child(stream, key_, i), question.sample, question.depth,
                         question.pass});
        weights_.push_back(step->weight * (1 / float(rays_per_question_)));
        askers_.push_back(asker);
    }
}

void BsdfGather::answer(const Inputs& inputs, std::span<Rgb> answers) const {
    if (rays_.empty()) return;
    const std::size_t width = inputs[0].width();
    std::vector<GatherResult> results(rays_.size() * width);
    gather(scene_, inputs, 0, rays_, results);
    for (std::size_t i = 0; i < rays_.size(); ++i)
        for (std::size_t k = 0; k < width; ++k)
            answers[askers_[i] * width + k] += weights_[i] * results[i * width + k].light;
}

}  // namespace lightnet
