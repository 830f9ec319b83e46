// Lamps that paths come to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// What directions from BSDFs find where they come to lamps: as light_by_bsdf() for each, to the bit, but how likely
/// their lamps are is worked out for all at once. One thread's.
class LampsMet {
public:
    /// Sample `who` has gone from `from` by `sample` and has come to `end`, which may be on a lamp.
    void add(const Scene& scene, std::uint32_t who, const LitPoint& from, const BsdfSample& sample,
             const SurfacePoint& end) {
        const Rgb emitted = scene.lights().emission(end, -sample.incoming);
        if (is_black(emitted)) return;
        // What a specular surface sends on can't be found by a sampled light.
        const auto met = sample.lobe == lobe::specular ? std::nullopt : scene.lights().met(from, sample.incoming, end);
        all_.push_back({who, scene.lights().group_of(end), emitted, sample.pdf, met.has_value()});
        if (met) met_.push_back(*met);
    }
    /// found(who, light, group) of each, in the order in which they were added, and forgets them.
    template <class Found>
    void find(const Scene& scene, Heuristic heuristic, Found&& found) {
        if (all_.empty()) return;
        pdfs_.resize(met_.size());
        scene.lights().pdfs(met_, pdfs_);
        std::size_t next = 0;
        for (const One& one : all_) {
            const float other = one.met ? pdfs_[next++] : 0;
            found(one.who, lamp_by_bsdf(one.emitted, one.pdf, other, heuristic), one.group);
        }
        all_.clear(), met_.clear();
    }

private:
    struct One {
        std::uint32_t who, group;
        Rgb emitted;
        float pdf;
        bool met;
    };
    std::vector<One> all_;
    std::vector<LampMet> met_;  // of those that are met
    std::vector<float> pdfs_;
};

}  // namespace lightnet
