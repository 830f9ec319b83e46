#include "core/estimate/specular_path.hpp"

#include "core/scene/direct_light.hpp"

#include <algorithm>

namespace lightnet {

void SpecularPath::arrive(float distance) {
    if (inside_) weight_ *= left_after(inside_, distance);
}

bool SpecularPath::go_on(const SurfacePoint& point, const Bsdf& bsdf, Samples samples, float keep) {
    const Vec3 outgoing = -ray_.direction;
    const float choice = bsdf.chooses() ? samples.next() : samples.skip();
    const auto sample = bsdf.sample(outgoing, choice, samples.next_2d(), lobe::specular);
    if (!sample) return false;
    take(point, bsdf, *sample);
    const float chance = std::min(1.0f, max_component(weight_) * eta_scale_ * keep);
    if (!(samples.next() < chance)) return false;
    weight_ *= 1 / chance;
    return true;
}

std::optional<SpecularPath> SpecularPath::split(const SurfacePoint& point, const Bsdf& bsdf, float least) {
    const auto chance = bsdf.reflection_chance(-ray_.direction);
    const float carried = max_component(weight_) * eta_scale_;
    if (!chance || carried * std::min(*chance, 1 - *chance) < least) return {};
    const auto reflection = bsdf.sample(-ray_.direction, *chance / 2, {}, lobe::specular);
    const auto transmission = bsdf.sample(-ray_.direction, (1 + *chance) / 2, {}, lobe::specular);
    if (!reflection || !transmission) return {};
    SpecularPath reflected = *this;
    reflected.take(point, bsdf, *reflection);
    reflected.weight_ *= *chance;
    take(point, bsdf, *transmission);
    weight_ *= 1 - *chance;
    return reflected;
}

void SpecularPath::take(const SurfacePoint& point, const Bsdf& bsdf, const BsdfSample& sample) {
    inside_ = filling(bsdf, point, -ray_.direction, sample.incoming, inside_);
    weight_ *= sample.weight;
    eta_scale_ *= sample.eta * sample.eta;
    ray_ = point.ray_towards(sample.incoming);
}

}  // namespace lightnet
