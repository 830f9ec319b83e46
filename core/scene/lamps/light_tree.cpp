#include "core/scene/lamps/light_tree.hpp"

#include "core/base/math/columns.hpp"
#include "core/base/thread_pool.hpp"
#include "core/scene/lamps/light_importance.hpp"
#include "core/scene/lamps/light_tree_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lightnet {
namespace {

constexpr std::uint32_t width = LightTree::width;
constexpr std::size_t line_of_cache = 64;  // bytes
using Node = LightTree::Node;
using Importances = Node::Each<float>;
static_assert(width == 8);

// A number of each child, all at once.
[[gnu::always_inline]] inline Eight numbers(const Node::Each<float>& each) {
    Eight eight;
    std::memcpy(&eight, each.data(), sizeof(eight));
    return eight;
}
template <class Whole>
[[gnu::always_inline]] inline Eight numbers(const Node::Each<Whole>& each) {
    Whole __attribute__((vector_size(width * sizeof(Whole)))) whole;
    std::memcpy(&whole, each.data(), sizeof(whole));
    return __builtin_convertvector(__builtin_convertvector(whole, Mask), Eight);
}
/// Middles and half sizes of boxes, along an axis.
struct Reach {
    Eight middle, half;
    [[gnu::always_inline]] Reach(const Node::Each<std::uint16_t>& lows, const Node::Each<std::uint16_t>& highs,
                                 float low, float step) {
        const Eight first = numbers(lows), last = numbers(highs);
        middle = low + (0.5f * step) * (first + last);
        half = (0.5f * step) * (last - first);
    }
};

/// Its children.
[[gnu::always_inline]] inline EightLights lights_of(const Node& node) {
    constexpr float unit = 1.0f / 32767;
    const Reach x(node.lows.x, node.highs.x, node.low.x, node.step.x);
    const Reach y(node.lows.y, node.highs.y, node.low.y, node.step.y);
    const Reach z(node.lows.z, node.highs.z, node.low.z, node.step.z);
    const Eight radius2 = x.half * x.half + y.half * y.half + z.half * z.half;
    const Mask two_sided = (all_of(std::int32_t{node.two_sided}) & Mask{1, 2, 4, 8, 16, 32, 64, 128}) != 0;
    return {{x.middle, y.middle, z.middle},
            radius2,
            root(radius2),
            {numbers(node.axis.x) * unit, numbers(node.axis.y) * unit, numbers(node.axis.z) * unit},
            numbers(node.cos_spread) * unit,
            numbers(node.sin_spread) * unit,
            numbers(node.cos_reach) * unit,
            numbers(node.intensity),
            two_sided};
}

[[gnu::always_inline]] inline Importances importances(const Node& node, const LitPoint& from) {
    const Vec3 at = from.position, n = from.normal;
    const EightPoints eight_times{{all_of(at.x), all_of(at.y), all_of(at.z)},
                                  {all_of(n.x), all_of(n.y), all_of(n.z)},
                                  all_of(std::int32_t{n == Vec3{} ? -1 : 0})};
    const Eight found = importance(lights_of(node), eight_times);
    Importances each;
    std::memcpy(each.data(), &found, sizeof(found));
    return each;
}

/// Sums of all before each child, and of all: they never fall.
struct Sums {
    std::array<float, width + 1> before;
    [[gnu::always_inline]] explicit Sums(const Importances& a) {
        const float first = a[0] + a[1], second = a[2] + a[3], third = a[4] + a[5], half = first + second;
        before = {0,
                  a[0],
                  first,
                  first + a[2],
                  half,
                  half + a[4],
                  half + third,
                  half + (third + a[6]),
                  half + (third + (a[6] + a[7]))};
    }
    float all() const { return before[width]; }
};

// Where a node lies in memory. Who wants it fetched does so himself: compilers leave out calls of a function that does
// nothing else.
[[gnu::always_inline]] inline const std::byte* bytes_of(const Node& node) {
    return reinterpret_cast<const std::byte*>(&node);
}

// Which child a place within all is in: never one of no importance. Without a branch, as it can't be foretold.
[[gnu::always_inline]] inline std::uint32_t child_at(float place, const Importances& all, const Sums& sums) {
    std::uint32_t child = 0;
    for (std::uint32_t i = 0; i < width; ++i) child += sums.before[i + 1] <= place;
    if (child < width) return child;
    while (!(all[--child] > 0)) continue;  // by rounding
    return child;
}

// Takes `count` of `open` from level to level, goes_on(each), until none does. Not one after the other: one step of a
// point waits for the one before it, but not for other points; and nodes that some go to are fetched meanwhile.
template <class GoesOn>
[[gnu::always_inline]] inline void level_by_level(std::array<std::size_t, lanes>& open, std::size_t count,
                                                  GoesOn&& goes_on) {
    while (count > 0) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = open[k];
            open[kept] = i;
            kept += goes_on(i);
        }
        count = kept;
    }
}

}  // namespace

/// Lights for many points.
struct LightTree::Choosing {
    std::span<const Node> nodes;
    std::span<const LitPoint> from;
    std::span<float> places;
    std::span<LightChoice> chosen;

    [[gnu::always_inline]] void work() {
        for (std::size_t first = 0; first < from.size(); first += lanes) {
            std::array<std::size_t, lanes> open;
            std::size_t count = 0;
            for (std::size_t i = first; i < std::min(first + lanes, from.size()); ++i) {
                chosen[i] = {0, 1};
                open[count++] = i;
            }
            level_by_level(
                open, count, [&](std::size_t i) __attribute__((always_inline)) {
                    return goes_down(from[i], places[i], chosen[i]);
                });
        }
    }
    /// From a node to one of its children: is that a node again?
    [[gnu::always_inline]] bool goes_down(const LitPoint& point, float& u, LightChoice& choice) const {
        const Node& node = nodes[choice.light];
        const Importances all = importances(node, point);
        const Sums sums(all);
        if (!(sums.all() > 0)) {
            choice = {0, 0};
            return false;
        }
        const float place = u * sums.all();
        const std::uint32_t i = child_at(place, all, sums);
        u = std::clamp((place - sums.before[i]) / all[i], 0.0f, 0x1.fffffep-1f);
        choice = {node.child[i], choice.chance * (all[i] / sums.all())};
        const bool more = !(node.leaves >> i & 1);
        const std::byte* next = bytes_of(nodes[more ? choice.light : 0]);
        for (std::size_t line = 0; line < sizeof(Node); line += line_of_cache) __builtin_prefetch(next + line);
        return more;
    }
};

void LightTree::choose(std::span<const LitPoint> from, std::span<float> places, std::span<LightChoice> chosen) const {
    if (!few_.empty()) return few_.choose(from, places, chosen);
    if (nodes_.empty()) {
        std::ranges::fill(chosen, LightChoice{0, 0});
        return;
    }
    Choosing choosing{nodes_, from, places, chosen};
    work_in_lanes(choosing);
}

std::optional<LightChoice> LightTree::choose(const LitPoint& from, float& u) const {
    LightChoice choice{};
    choose({&from, 1}, {&u, 1}, {&choice, 1});
    return choice.chance > 0 ? std::optional(choice) : std::nullopt;
}

/// How likely some lights are.
struct LightTree::Looking {
    std::span<const Node> nodes;
    std::span<const std::uint32_t> place_of;
    std::span<const LampMet> met;
    std::span<float> chances;

    [[gnu::always_inline]] void work() {
        for (std::size_t first = 0; first < met.size(); first += lanes) {
            std::array<std::size_t, lanes> open;
            std::array<std::uint32_t, lanes> place;
            std::size_t count = 0;
            for (std::size_t i = first; i < std::min(first + lanes, met.size()); ++i) {
                place[i - first] = place_of[met[i].lamp];
                chances[i] = place[i - first] == none ? 0 : 1;
                if (place[i - first] == none) continue;
                const std::byte* own = bytes_of(nodes[place[i - first] / width]);
                for (std::size_t line = 0; line < sizeof(Node); line += line_of_cache) __builtin_prefetch(own + line);
                open[count++] = i;
            }
            level_by_level(
                open, count, [&](std::size_t i) __attribute__((always_inline)) {
                    return goes_up(met[i].from, place[i - first], chances[i]);
                });
        }
    }
    /// From a child to its node's own place: is there one?
    [[gnu::always_inline]] bool goes_up(const LitPoint& from, std::uint32_t& place, float& chance) const {
        const Node& node = nodes[place / width];
        const Importances all = importances(node, from);
        const float own = all[place % width];
        chance = own > 0 ? chance * (own / Sums(all).all()) : 0;
        if (!(own > 0) || place < width) return false;  // a child of the first node
        place = node.parent;
        const std::byte* next = bytes_of(nodes[place / width]);
        for (std::size_t line = 0; line < sizeof(Node); line += line_of_cache) __builtin_prefetch(next + line);
        return true;
    }
};

float LightTree::chance(const LitPoint& from, std::uint32_t light) const {
    const LampMet one{from, light, 1};
    float chance = 0;
    chances({&one, 1}, {&chance, 1});
    return chance;
}

void LightTree::chances(std::span<const LampMet> met, std::span<float> chances) const {
    if (!few_.empty()) return few_.chances(met, chances);
    Looking looking{nodes_, place_of_, met, chances};
    work_in_lanes(looking);
}

LightTree::LightTree(const std::vector<LightBounds>& lights) {
    const auto shining = std::ranges::count_if(lights, [](const LightBounds& one) { return one.intensity > 0; });
    if (shining <= FewLights::most) {
        few_ = FewLights(lights);
        return;
    }
    place_of_.assign(lights.size(), none);
    nodes_ = LightTreeBuilder(lights).build();
    parallel_for(nodes_.size(), [&](std::size_t first, std::size_t last) {
        for (auto n = std::uint32_t(first); n < last; ++n)
            for (std::uint32_t i = 0; i < width; ++i)
                if (nodes_[n].leaves >> i & 1) place_of_[nodes_[n].child[i]] = n * width + i;
    });
}

}  // namespace lightnet
