#include "core/estimate/question_batch.hpp"

#include <limits>

#include "core/base/math/samples.hpp"
#include "core/estimate/gather.hpp"

namespace lightnet {

const std::vector<QuestionBatch::Place>& QuestionBatch::places() {
    if (!places_.empty()) return places_;
    places_.reserve(questions_.size());
    for (const Query& question : questions_) {
        const SurfacePoint point = scene_.surface(question);
        places_.push_back({point, dot(question.outgoing, point.normal) < 0 ? -point.normal : point.normal});
    }
    return places_;
}

Rgb QuestionBatch::albedo(std::size_t i) {
    const auto bsdf = scene_.bsdf(places()[i].point);
    const Rgb* const albedo = bsdf.diffuse_albedo();
    return albedo ? *albedo : Rgb{};
}

Vec2 QuestionBatch::random(std::size_t i, std::uint32_t which, std::uint32_t of) const {
    const Query& question = questions_[i];
    return Samples(child(question.stream, key_), question.sample * of + which).next_2d();
}

bool QuestionBatch::open(std::size_t i, Vec3 direction, float distance) {
    const auto& [point, up] = places()[i];
    const float far = distance > 0 ? distance : std::numeric_limits<float>::infinity();
    return !scene_.occluded({point.origin_towards(up), direction, far});
}

std::vector<Rgb> QuestionBatch::ask(std::size_t input) const {
    std::vector<Rgb> light(size());
    each_colour(lightnet::ask(inputs_, input, questions_),
                [&](std::size_t q, std::size_t, const Rgb& colour) { light[q] += colour; });
    return light;
}

std::vector<Rgb> QuestionBatch::ask(std::size_t input, std::span<const Vec3> directions) {
    std::vector<GatherRay> rays;
    rays.reserve(size());
    for (std::size_t i = 0; i < size(); ++i) {
        const Query& question = questions_[i];
        rays.push_back({{places()[i].point.origin_towards(directions[i]), directions[i]},
                        child(question.stream, key_, 1),
                        question.sample,
                        question.depth,
                        question.pass});
    }
    std::vector<GatherResult> results(size());
    gather(scene_, inputs_, input, rays, results);
    std::vector<Rgb> light(size());
    for (std::size_t i = 0; i < size(); ++i) light[i] = results[i].light;
    return light;
}

}  // namespace lightnet
