// A path through mirrors and glass alone: specular reflections and refractions.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/base/math/rgb.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"
#include "core/scene/media/flight.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Followed against the light, from surface to surface; what is done at a surface is up to whoever follows it.
class SpecularPath {
public:
    explicit SpecularPath(const Ray& ray) : ray_(ray) {}

    const Ray& ray() const { return ray_; }
    /// Its throughput: how much of what is met now reaches the path's beginning.
    const Rgb& weight() const { return weight_; }

    /// The ray meets a surface at this distance.
    void arrive(float distance);
    /// Media leave so much of what follows.
    void dim(const Rgb& left) { weight_ *= left; }
    /// The question about a collision on the ray, after `depth` scattering events; whose it is, the asker adds.
    Query question_about(const Collision& at, std::uint32_t depth) const {
        Query question{
            .outgoing = -ray_.direction, .depth = static_cast<std::uint8_t>(std::min(depth, 255u)), .time = ray_.time};
        question.put_into_space(ray_.origin + ray_.direction * at.distance, at.medium);
        return question;
    }
    /// The question about rough lobes of that surface, after `depth` scattering events; whose it is, the asker adds.
    Query question_about(const Hit& hit, std::uint8_t lobes, std::uint32_t depth) const {
        return {.instance = hit.instance,
                .geometry = hit.geometry,
                .primitive = hit.primitive,
                .u = hit.u,
                .v = hit.v,
                .outgoing = -ray_.direction,
                .lobes = static_cast<std::uint8_t>(lobes & lobe::rough),
                .depth = static_cast<std::uint8_t>(std::min(depth, 255u)),
                .time = ray_.time};
    }
    /// Goes on from that surface by one sample of its specular lobes; false: it ends. Paths whose weight is below
    /// 1 / `keep` are followed seldom, and count more for it: Russian roulette.
    bool go_on(const SurfacePoint& point, const Bsdf& bsdf, Samples samples, float keep);
    /// Where that surface is smooth glass, goes on through it, and returns the path that it reflects. None: it isn't,
    /// or one of the two would carry less than `least`; nothing has changed.
    std::optional<SpecularPath> split(const SurfacePoint& point, const Bsdf& bsdf, float least);

private:
    void take(const SurfacePoint& point, const Bsdf& bsdf, const BsdfSample& sample);

    Ray ray_;
    Rgb weight_{1, 1, 1};
    const Rgb* inside_ = nullptr;  // what fills the space that it crosses; may be null
    float eta_scale_ = 1;          // of radiance by refraction, which is no loss: roulette must not see it
};

}  // namespace lightnet
