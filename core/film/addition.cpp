#include "core/film/addition.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>

#include "core/base/math/random.hpp"

namespace lightnet {
namespace {

std::uint32_t bits_of(const Rgb& seen) { return std::bit_cast<std::uint32_t>(seen.r); }

// DECISIONS: ids-in-a-fixed-order
bool comes_first(const Rgb& a, const Rgb& b) { return a.g != b.g ? a.g > b.g : bits_of(a) < bits_of(b); }

// Any hue, never grey, black or white.
Rgb colour_of(const Rgb& seen) {
    const auto bits = mix(bits_of(seen));
    const auto part = [&](int byte) { return static_cast<float>(bits >> (8 * byte) & 0xff) / 255; };
    const float hue = 6 * part(0), saturation = 0.5f + 0.45f * part(1), value = 0.25f + 0.7f * part(2);
    const auto channel = [&](float at) {
        const float off = std::abs(std::fmod(hue + at, 6.f) - 3) - 1;  // a hexagon of colours
        return value * (1 - saturation * (1 - std::clamp(off, 0.f, 1.f)));
    };
    return {channel(0), channel(4), channel(2)};
}

}  // namespace

Rgb false_colour(std::span<const Rgb> ids, float samples) {
    Rgb sum;
    for (const Rgb& seen : ids)
        if (seen.g > 0) sum += colour_of(seen) * (seen.g / samples);
    return sum;
}

void add_ids(std::span<Rgb> ids, std::span<const Rgb> more) {
    assert(ids.size() <= most_ids && more.size() <= most_ids);
    std::array<Rgb, 2 * most_ids> all;
    std::size_t count = 0;
    for (const Rgb& id : ids)
        if (id.g > 0) all[count++] = id;
    const std::size_t known = count;
    for (const Rgb& id : more) {
        if (!(id.g > 0)) continue;
        const auto end = all.begin() + std::ptrdiff_t(known);
        const auto same = std::find_if(all.begin(), end, [&](const Rgb& one) { return bits_of(one) == bits_of(id); });
        if (same != end)
            same->g += id.g;
        else
            all[count++] = id;
    }
    std::sort(all.begin(), all.begin() + std::ptrdiff_t(count), comes_first);
    std::fill(all.begin() + std::ptrdiff_t(count), all.end(), Rgb{});
    std::copy_n(all.begin(), ids.size(), ids.begin());
}

void Addition::operator()(std::span<Rgb> sums, std::span<const Rgb> more) const {
    if (ids_.empty()) {
        std::transform(sums.begin(), sums.end(), more.begin(), sums.begin(), std::plus<>());
        return;
    }
    for (std::size_t first = 0; first < sums.size(); first += colours_) {
        std::size_t next = 0;
        const auto add_until = [&](std::size_t end) {
            for (; next < end; ++next) sums[first + next] += more[first + next];
        };
        for (const auto& [id, count] : ids_) {
            add_until(id);
            add_ids(sums.subspan(first + id, count), more.subspan(first + id, count));
            next += count;
        }
        add_until(colours_);
    }
}

}  // namespace lightnet
