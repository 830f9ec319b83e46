#include "core/estimate/shared_first_rays.hpp"

#include <algorithm>

namespace lightnet {

void SharedFirstRays::begin(const Scene& scene, std::span<const Query> questions, std::uint32_t samples) {
    if (kept_ && scene_ == &scene && samples_ == samples && std::ranges::equal(questions_, questions)) return;
    begin_alone(scene);
    kept_ = questions.size() * samples <= most;
    if (!kept_) return;
    samples_ = samples;
    questions_.assign(questions.begin(), questions.end());
    forget(questions.size() * samples);
}

void SharedFirstRays::begin_alone(const Scene& scene) {
    scene_ = &scene;
    kept_ = false;
    found_ = 0;
}

// Writes no more than says that nothing is known: what they were takes as much as the nearest cache.
void SharedFirstRays::forget(std::size_t count) {
    if (all_.size() < count) all_.resize(count);
    for (One& one : std::span(all_).first(count)) one.goes_on = one.traced = false;
}

std::span<SharedFirstRays::One> SharedFirstRays::some(std::size_t first, std::size_t last) {
    if (kept_) return std::span(all_).subspan(first, last - first);
    forget(last - first);
    return std::span(all_).first(last - first);
}

void SharedFirstRays::trace(std::span<One> some, std::span<const std::uint32_t> which) {
    traced_.clear(), rays_.clear();
    for (const std::uint32_t i : which) {
        if (some[i].traced) continue;
        traced_.push_back(i);
        rays_.push_back(some[i].step.ray);
    }
    hits_.resize(rays_.size());
    scene_->intersect(rays_, hits_);
    for (std::size_t k = 0; k < traced_.size(); ++k) {
        some[traced_[k]].hit = hits_[k];
        some[traced_[k]].traced = true;
    }
}

}  // namespace lightnet
