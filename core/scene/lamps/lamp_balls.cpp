#include "core/scene/lamps/lamp_balls.hpp"

namespace lightnet {

void LampBalls::add(Vec3 center, float radius) {
    constexpr float roundings = 1.001f;
    const std::size_t i = count_++;
    if (i >= lanes) return;
    centers_.set(i, center);
    radii2_[i] = radius * radius * (roundings * roundings);
}

struct LampBalls::Meeting {
    const LampBalls& all;
    Vec3 origin, direction;
    std::uint32_t met = 0;

    [[gnu::always_inline]] void work() {
        const Vec3 from = origin, along_ray = direction;
        std::uint32_t any = 0;
        for (std::size_t i = 0; i < all.count_; ++i) {
            const Vec3 to_center = all.centers_[i] - from;
            const float along = dot(to_center, along_ray), distance2 = length_squared(to_center);
            const float radius2 = all.radii2_[i];
            const bool inside = distance2 <= radius2;
            const bool ahead = (along > 0) & (distance2 - along * along <= radius2 + distance2 * 1e-5f);
            any |= inside | ahead;
        }
        met = any;
    }
};

bool LampBalls::may_meet(const Ray& ray) const {
    if (count_ > lanes) return true;
    Meeting meeting{*this, ray.origin, ray.direction};
    work_in_lanes(meeting);
    return meeting.met != 0;
}

}  // namespace lightnet
