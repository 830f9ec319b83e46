#include "core/scene/lamps/few_lights.hpp"

#include "core/base/math/box.hpp"
#include "core/base/math/columns.hpp"
#include "core/scene/lamps/light_importance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lightnet {
namespace {

constexpr std::uint32_t at_once = 8;
using EightNumbers = std::array<float, at_once>;

template <class Vector, class Row>
[[gnu::always_inline]] inline Vector eight_from(const Row& row, std::size_t first) {
    Vector eight;
    std::memcpy(&eight, &row[first], sizeof(eight));
    return eight;
}
[[gnu::always_inline]] inline EightNumbers laid_out(const Eight& eight) {
    EightNumbers all;
    std::memcpy(all.data(), &eight, sizeof(eight));
    return all;
}

// Lights, each number of them by get(row).
template <class All, class Get>
[[gnu::always_inline]] inline EightLights lights_by(const All& all, Get&& get) {
    return {{get(all.middle_x), get(all.middle_y), get(all.middle_z)},
            get(all.radius2),
            get(all.radius),
            {get(all.axis_x), get(all.axis_y), get(all.axis_z)},
            get(all.cos_spread),
            get(all.sin_spread),
            get(all.cos_reach),
            get(all.intensity),
            get(all.two_sided)};
}

// Eight points: point(k).
template <class Point>
[[gnu::always_inline]] inline EightPoints points_by(Point&& point_of) {
    EightPoints eight;
    for (std::uint32_t k = 0; k < at_once; ++k) {
        const LitPoint& point = point_of(k);
        eight.at.x[k] = point.position.x;
        eight.at.y[k] = point.position.y;
        eight.at.z[k] = point.position.z;
        eight.normal.x[k] = point.normal.x;
        eight.normal.y[k] = point.normal.y;
        eight.normal.z[k] = point.normal.z;
    }
    const EightVectors& n = eight.normal;
    eight.any_side = (n.x == 0) & (n.y == 0) & (n.z == 0);
    return eight;
}

}  // namespace

FewLights::FewLights(const std::vector<LightBounds>& lights) : place_of_(lights.size(), most) {
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const LightBounds& light = lights[i];
        if (!(light.intensity > 0)) continue;
        const Box box{light.low, light.high};
        const Vec3 middle = box.center(), half = box.size() * 0.5f;
        const std::uint32_t n = count_++;
        place_of_[i] = n;
        lights_.name[n] = i;
        lights_.middle_x[n] = middle.x;
        lights_.middle_y[n] = middle.y;
        lights_.middle_z[n] = middle.z;
        lights_.radius2[n] = length_squared(half);
        lights_.radius[n] = length(half);
        lights_.axis_x[n] = light.axis.x;
        lights_.axis_y[n] = light.axis.y;
        lights_.axis_z[n] = light.axis.z;
        lights_.cos_spread[n] = light.cos_spread;
        lights_.sin_spread[n] = std::sqrt(std::max(0.0f, 1 - light.cos_spread * light.cos_spread));
        lights_.cos_reach[n] = light.cos_reach;
        lights_.intensity[n] = light.intensity;
        lights_.two_sided[n] = light.two_sided ? -1 : 0;
    }
}

/// Lights for many points: light by light, eight points at a time.
struct FewLights::Choosing {
    const Lights& lights;
    std::uint32_t count;
    std::span<const LitPoint> from;
    std::span<float> places;
    std::span<LightChoice> chosen;

    [[gnu::always_inline]] void work() {
        for (std::size_t first = 0; first < from.size(); first += at_once) work_on_eight(first);
    }
    [[gnu::always_inline]] void work_on_eight(std::size_t first) {
        // The last one stands for those that are not there.
        const EightPoints points =
            points_by([&](std::size_t k) -> const LitPoint& { return from[std::min(first + k, from.size() - 1)]; });
        std::array<EightNumbers, most> own;
        std::array<EightNumbers, most + 1> before;  // sums of all before each light
        Eight sum = all_of(0.0f), place;
        before[0] = laid_out(sum);
        for (std::uint32_t j = 0; j < count; ++j) {
            const Eight one = importance(lights_by(lights, [&](const auto& row) { return all_of(row[j]); }), points);
            own[j] = laid_out(one);
            sum += one;
            before[j + 1] = laid_out(sum);
        }
        for (std::uint32_t k = 0; k < at_once; ++k) place[k] = places[std::min(first + k, from.size() - 1)];
        place *= sum;
        Mask at = all_of(0);
        for (std::uint32_t j = 0; j < count; ++j) at -= eight_from<Eight>(before[j + 1], 0) <= place;
        const EightNumbers all = laid_out(sum), where = laid_out(place);
        for (std::uint32_t k = 0; k < std::min<std::size_t>(at_once, from.size() - first); ++k) {
            if (!(all[k] > 0)) {
                chosen[first + k] = {0, 0};
                continue;
            }
            std::uint32_t j = std::uint32_t(at[k]);
            if (j == count)  // by rounding
                while (!(own[--j][k] > 0)) continue;
            places[first + k] = std::clamp((where[k] - before[j][k]) / own[j][k], 0.0f, 0x1.fffffep-1f);
            chosen[first + k] = {lights.name[j], own[j][k] / all[k]};
        }
    }
};

void FewLights::choose(std::span<const LitPoint> from, std::span<float> places, std::span<LightChoice> chosen) const {
    Choosing choosing{lights_, count_, from, places, chosen};
    work_in_lanes(choosing);
}

/// How likely some lights are: light by light, eight points at a time.
struct FewLights::Looking {
    const Lights& lights;
    std::uint32_t count;
    std::span<const std::uint32_t> place_of;
    std::span<const LampMet> met;
    std::span<float> chances;

    [[gnu::always_inline]] void work() {
        for (std::size_t first = 0; first < met.size(); first += at_once) work_on_eight(first);
    }
    [[gnu::always_inline]] void work_on_eight(std::size_t first) {
        const auto one_of = [&](std::size_t k) -> const LampMet& { return met[std::min(first + k, met.size() - 1)]; };
        const EightPoints points = points_by([&](std::size_t k) -> const LitPoint& { return one_of(k).from; });
        Mask place;
        for (std::uint32_t k = 0; k < at_once; ++k) place[k] = std::int32_t(place_of[one_of(k).lamp]);
        Eight sum = all_of(0.0f), own = all_of(0.0f);
        for (std::uint32_t j = 0; j < count; ++j) {
            const Eight one = importance(lights_by(lights, [&](const auto& row) { return all_of(row[j]); }), points);
            sum += one;
            own = select(place == all_of(std::int32_t(j)), one, own);
        }
        const EightNumbers found = laid_out(select(sum > 0, own / sum, all_of(0.0f)));
        std::copy_n(found.begin(), std::min<std::size_t>(at_once, met.size() - first), chances.begin() + first);
    }
};

void FewLights::chances(std::span<const LampMet> met, std::span<float> chances) const {
    Looking looking{lights_, count_, place_of_, met, chances};
    work_in_lanes(looking);
}

}  // namespace lightnet
