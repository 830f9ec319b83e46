#include "core/estimate/even_scattering.hpp"

#include <array>

#include "core/base/math/frame.hpp"

namespace lightnet {

Rgb evenly_scattered(const Bsdf& bsdf, Vec3 outgoing, Vec3 normal, std::uint8_t lobes) {
    static constexpr std::array<Vec3, 4> around{
        Vec3{0.5f, 0, 0.8660254f}, {-0.5f, 0, 0.8660254f}, {0, 0.8660254f, 0.5f}, {0, -0.8660254f, 0.5f}};
    const Frame frame = Frame::around(normal);
    Rgb sum;
    for (const Vec3& direction : around) {
        const Rgb value = bsdf.evaluate(outgoing, frame.to_world(direction), lobes);
        if (is_black(value) && is_black(sum)) return {};  // opaque: most surfaces, seen from behind
        sum += value * (0.25f / direction.z);
    }
    return sum;
}

}  // namespace lightnet
