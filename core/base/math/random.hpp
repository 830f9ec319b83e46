// Keys, from which every random number of a run comes. Nothing else ever seeds anything, so a number
// depends on what is computed, never on the thread, host, bundle or attempt that computes it.
#pragma once

#include <cstdint>
#include <string_view>

namespace lightnet {

/// Names one stream of random numbers.
using Key = std::uint64_t;

/// A bijective finaliser with good avalanche (Stafford's variant 13, as in SplitMix64).
constexpr std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// The key of the i-th stream that `who` derives from `parent`.
constexpr Key child(Key parent, Key who, std::uint64_t i = 0) {
    return mix(mix(parent ^ mix(who)) + 0x9e3779b97f4a7c15ull * (i + 1));
}

/// FNV-1a: a node's name as a key.
constexpr Key key_of(std::string_view name) {
    Key hash = 0xcbf29ce484222325ull;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return mix(hash);
}

/// The root of everything that is computed for one pixel.
constexpr Key pixel_key(std::uint64_t seed, std::uint32_t x, std::uint32_t y) {
    // added, so that seed and pixel can't change places
    return child(mix(seed + 0x9e3779b97f4a7c15ull), (std::uint64_t{y} << 32) | x);
}

}  // namespace lightnet
