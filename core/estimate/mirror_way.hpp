// A ray on its way through mirrors and glass.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/rgb.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Followed backwards, from surface to surface, by those who look at something; what it meets is theirs to see to.
class MirrorWay {
public:
    explicit MirrorWay(const Ray& ray) : ray_(ray) {}

    const Ray& ray() const { return ray_; }
    /// How much of what is met now reaches the way's beginning.
    const Rgb& weight() const { return weight_; }

    /// It has led to a surface, so far away.
    void arrive(float distance);
    /// The question about rough lobes of that surface, after `depth` scattering events; whose it is, the asker adds.
    Query question_about(const Hit& hit, std::uint8_t lobes, std::uint32_t depth) const;
    /// Leads on from that surface by one sample of its specular lobes; false: it doesn't. Those whose weight is below
    /// 1 / `keep` are followed seldom, and count more for it.
    bool go_on(const SurfacePoint& point, const Bsdf& bsdf, Samples samples, float keep);
    /// Where that surface is smooth glass, leads on through it, and returns the way that it reflects. None: it isn't,
    /// or one of the two would carry less than `least`; nothing has changed.
    std::optional<MirrorWay> split(const SurfacePoint& point, const Bsdf& bsdf, float least);

private:
    void take(const SurfacePoint& point, const Bsdf& bsdf, const BsdfSample& sample);

    Ray ray_;
    Rgb weight_{1, 1, 1};
    const Rgb* inside_ = nullptr;  // what it leads through
    float squeezed_ = 1;           // by refraction, which is no loss: roulette must not see it
};

}  // namespace lightnet
