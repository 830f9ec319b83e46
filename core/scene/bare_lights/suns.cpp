#include "core/scene/bare_lights/suns.hpp"

#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {

void Suns::add(const SunDisk& disk, std::uint32_t group) {
    if (disk.drop > 0 && !is_black(disk.radiance)) visible_.push_back(std::uint32_t(lights_.size()));
    lights_.push_back({disk, group});
}

Vec3 Suns::towards(const SunDisk& disk, Vec2 u) const {
    return disk.drop > 0 ? normalize(disk.axes.to_world(cone(u, disk.drop))) : disk.axes.z;
}

std::optional<LightSample> Suns::sample(std::size_t light, Vec2 u) const {
    const Disk& disk = lights_[light];
    if (is_black(disk.total)) return {};
    const Vec3 direction = towards(disk, u);
    if (!(disk.drop > 0)) return LightSample{{}, direction, disk.total, 1, true, true, disk.group};
    if (visible_.size() > 1)
        if (const auto seen = look(direction); seen && seen->light.pdf >= disk.density)
            return LightSample{{}, direction, seen->light.radiance, seen->light.pdf, false, true, seen->group};
    return LightSample{{}, direction, disk.radiance, disk.density, false, true, disk.group};
}

// Of unit vectors, |a - b|² = 2 (1 - cos) keeps its digits where the cosine has none left.
std::optional<SeenSun> Suns::look(Vec3 direction) const {
    std::optional<SeenSun> found;
    for (const auto index : visible_) {
        const Disk& disk = lights_[index];
        if (!(length_squared(direction - disk.axes.z) <= 2 * disk.drop)) continue;
        if (!found) found = SeenSun{{direction, {}, 0}, disk.group};
        found->light.radiance += disk.radiance;
        found->light.pdf += disk.density;
    }
    return found;
}

Vec3 Suns::shines_along(std::size_t light, Vec2 u) const { return -towards(lights_[light], u); }

}  // namespace lightnet
