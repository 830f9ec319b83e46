// Rays to lamps, and what comes along them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// Shadow rays: to points on lamps, and what arrives if nothing is in between.
struct ShadowRays {
    std::vector<Ray> rays;
    std::vector<Rgb> light;
    std::vector<std::uint32_t> sums;  // to which it is added

    void add(const Ray& ray, Rgb arriving, std::uint32_t sum) {
        rays.push_back(ray);
        light.push_back(arriving);
        sums.push_back(sum);
    }
    void resize(std::size_t count) { rays.resize(count), light.resize(count), sums.resize(count); }
};

}  // namespace lightnet
