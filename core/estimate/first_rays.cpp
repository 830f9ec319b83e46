#include "core/estimate/first_rays.hpp"

#include <algorithm>

namespace lightnet {

void FirstRays::begin(const Scene& scene, std::span<const Query> questions, std::uint32_t samples) {
    if (kept_ && scene_ == &scene && samples_ == samples && std::ranges::equal(questions_, questions)) return;
    begin_alone(scene);
    kept_ = questions.size() * samples <= most;
    if (!kept_) return;
    samples_ = samples;
    questions_.assign(questions.begin(), questions.end());
    all_.assign(questions.size() * samples, One{});
}

void FirstRays::begin_alone(const Scene& scene) {
    scene_ = &scene;
    kept_ = false;
    found_ = 0;
}

std::span<FirstRays::One> FirstRays::some(std::size_t first, std::size_t last) {
    if (kept_) return std::span(all_).subspan(first, last - first);
    all_.assign(last - first, One{});
    return all_;
}

void FirstRays::trace(std::span<One> some, std::span<const std::uint32_t> which) {
    traced_.clear(), rays_.clear();
    for (const std::uint32_t i : which) {
        if (some[i].traced) continue;
        traced_.push_back(i);
        rays_.push_back(some[i].step->ray);
    }
    hits_.resize(rays_.size());
    scene_->intersect(rays_, hits_);
    for (std::size_t k = 0; k < traced_.size(); ++k) {
        some[traced_[k]].hit = hits_[k];
        some[traced_[k]].traced = true;
    }
}

}  // namespace lightnet
