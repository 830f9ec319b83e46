#include "core/scene/bare_lights/directional_light.hpp"

#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {

// A plane across it gets ∫ cos θ dω = π sin² of the radiance, and all of it together fills 2π (1 - cos).
SunDisk DirectionalLight::disk() const {
    SunDisk disk;
    disk.axes = Frame::around(-direction);
    const float half = std::sin(std::clamp(half_angle, 0.0f, pi / 2) / 2);
    disk.drop = 2 * half * half;
    disk.total = irradiance * (2 / (2 - disk.drop));
    if (disk.drop > 0) {
        disk.density = 1 / (2 * pi * disk.drop);
        disk.radiance = disk.total * disk.density;
    }
    return disk;
}

}  // namespace lightnet
