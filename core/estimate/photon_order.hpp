// Photons in order along an axis, for those who build trees of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <tuple>

#include "core/base/math/box.hpp"
#include "core/estimate/photon.hpp"
#include "core/estimate/ranks.hpp"

namespace lightnet {

/// By all that a photon is, so that the order can't depend on how the library sorts.
inline bool comes_before(const Photon& a, const Photon& b) {
    const auto rank = [](const Photon& p) {
        return std::tuple(p.position.x, p.position.y, p.position.z, p.incoming, p.flux.r, p.flux.g, p.flux.b,
                          p.surface);
    };
    return rank(a) < rank(b);
}

/// A photon that stays where it is while others are put before and behind it.
struct PhotonProxy {
    Vec3 position;
    std::uint32_t photon;
};

/// The order of photons along an axis.
struct ByPhoton {
    std::size_t axis;
    bool operator()(const Photon& a, const Photon& b) const {
        const float x = a.position[axis], y = b.position[axis];
        return x != y ? x < y : comes_before(a, b);
    }
};
/// The order of proxies along an axis: that of their photons.
struct ByProxy {
    std::size_t axis;
    const Photon* photons;
    bool operator()(const PhotonProxy& a, const PhotonProxy& b) const {
        const float x = a.position[axis], y = b.position[axis];
        return x != y ? x < y : comes_before(photons[a.photon], photons[b.photon]);
    }
};

/// In parts as wide as they are read again: a processor waits where it reads at once what was written in smaller ones.
template <class T>
void swap_whole(T& a, T& b) {
    using Piece [[gnu::vector_size(16)]] = float;
    std::array<Piece, sizeof(T) / sizeof(Piece)> of_a, of_b;
    std::memcpy(&of_a, &a, sizeof a);
    std::memcpy(&of_b, &b, sizeof b);
    std::memcpy(static_cast<void*>(&a), &of_b, sizeof a);
    std::memcpy(static_cast<void*>(&b), &of_a, sizeof b);
}

/// As many as are sorted by their ranks.
inline constexpr std::size_t ranked_at_once = 32;

/// Sorts up to `ranked_at_once` of them.
template <class T, class Before>
void sort_few(std::span<T> all, const Before& before) {
    constexpr float beyond = std::numeric_limits<float>::infinity();
    alignas(64) std::array<float, ranked_at_once> values;
    const std::size_t padded = all.size() <= ranked_at_once / 2 ? ranked_at_once / 2 : ranked_at_once;
    for (std::size_t i = 0; i < padded; ++i) values[i] = i < all.size() ? all[i].position[before.axis] : beyond;
    const Ranks<ranked_at_once> ranks(values.data(), all.size(), padded);
    if (!ranks.all_differ()) return std::sort(all.begin(), all.end(), before);
    std::array<T, ranked_at_once> sorted;
    for (std::size_t i = 0; i < all.size(); ++i) sorted[ranks[i]] = all[i];
    std::copy_n(sorted.begin(), all.size(), all.begin());
}

/// As nth_element: it puts those before the one in place `middle` before it. Where that guesses at each photon, this
/// moves all alike.
template <class T, class Before>
void halve(std::span<T> all, std::size_t middle, const Before& before) {
    constexpr std::size_t tries = ranked_at_once / 2;
    std::array<T, tries> some;
    while (all.size() > ranked_at_once) {
        for (std::size_t i = 0; i < tries; ++i) some[i] = all[(2 * i + 1) * all.size() / (2 * tries)];
        sort_few(std::span<T>(some), before);
        const T border = some[std::clamp<std::size_t>(middle * tries / all.size(), 1, tries - 1)];
        std::size_t low = 0;
        for (T& one : all) {
            const bool is_low = before(one, border);
            swap_whole(one, all[low]);
            low += is_low;
        }
        if (low == 0) break;  // as many are the same
        all = middle < low ? all.first(low) : all.subspan(low);
        middle -= middle < low ? 0 : low;
    }
    if (all.size() <= ranked_at_once) return sort_few(all, before);
    std::nth_element(all.begin(), all.begin() + std::ptrdiff_t(middle), all.end(), before);
}

/// The axis along which they reach farthest.
template <class T>
std::size_t longest_axis(std::span<const T> all) {
    Box box;
    for (const T& one : all) box.add(one.position);
    return box.longest_axis();
}

}  // namespace lightnet
