// Lights that are infinitely far away and fill a cone of directions, or just one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/directional_light.hpp"
#include "core/scene/bare_lights/light_sample.hpp"

namespace lightnet {

/// All directional lights of a scene. Those with an angle are suns, which rays can meet: cones of directions of the
/// same radiance, sampled uniformly. Where suns overlap they count as one: of the group of the first of them.
/// DECISIONS: suns-beside-the-tree
class Suns {
public:
    void add(const SunDisk& disk, std::uint32_t group);

    std::size_t size() const { return lights_.size(); }
    /// Is there one that rays can meet?
    bool visible() const { return !visible_.empty(); }

    /// Towards the light of that index. The density is that of all suns there, each sampled alone. None: it is black.
    std::optional<LightSample> sample(std::size_t light, Vec2 u) const;
    /// What a ray meets that meets nothing else; the density as for samples. None: no sun.
    std::optional<SeenSun> look(Vec3 direction) const;

    /// ∫ radiance dω: irradiance, were all its light to arrive head-on, W·m⁻².
    Rgb total(std::size_t light) const { return lights_[light].total; }
    /// In which the light of that index shines: chosen as sample() does.
    Vec3 shines_along(std::size_t light, Vec2 u) const;
    std::uint32_t group(std::size_t light) const { return lights_[light].group; }

private:
    struct Disk : SunDisk {
        std::uint32_t group = 0;
    };
    Vec3 towards(const SunDisk& disk, Vec2 u) const;

    std::vector<Disk> lights_;
    std::vector<std::uint32_t> visible_;  // of these: they have an angle, and aren't black
};

}  // namespace lightnet
