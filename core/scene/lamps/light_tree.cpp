#include "core/scene/lamps/light_tree.hpp"

#include "core/scene/lamps/light_tree_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace lightnet {
namespace {

constexpr std::uint32_t width = LightTree::width;
// Of light that arrives, as what counts it by: where the shading normal leans over, the true normal's cosine may be 0.
constexpr float least_cosine = 0.05f;
using Node = LightTree::Node;
using Importances = Node::Each<float>;

// Four numbers at once. The compiler's own vectors: it would not make any of loops with so many conditions.
using Four = float __attribute__((vector_size(16)));
using Mask = std::int32_t __attribute__((vector_size(16)));

inline Four all_of(float x) { return Four{x, x, x, x}; }
inline Four select(Mask mask, Four a, Four b) {
    return std::bit_cast<Four>((mask & std::bit_cast<Mask>(a)) | (~mask & std::bit_cast<Mask>(b)));
}
inline Four greater_of(Four a, Four b) { return select(a > b, a, b); }
inline Four magnitude(Four a) { return std::bit_cast<Four>(std::bit_cast<Mask>(a) & 0x7fffffff); }
inline Four root(Four a) { return Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }

/// The cosine and the sine of an angle, times a distance.
struct Turn {
    Four cosine, sine;
};
// The angle less another one: at least 0.
inline Turn less(const Turn& angle, Four distance, Four cosine, Four sine) {
    const Mask none_left = angle.cosine > distance * cosine;
    return {select(none_left, distance, angle.cosine * cosine + angle.sine * sine),
            select(none_left, all_of(0), angle.sine * cosine - angle.cosine * sine)};
}

inline Four numbers(const Node::Each<float>& each, std::uint32_t i) {
    Four four;
    std::memcpy(&four, &each[i], sizeof(four));
    return four;
}
template <class Whole>
inline Four numbers(const Node::Each<Whole>& each, std::uint32_t i) {
    Whole __attribute__((vector_size(4 * sizeof(Whole)))) whole;
    std::memcpy(&whole, &each[i], sizeof(whole));
    return __builtin_convertvector(__builtin_convertvector(whole, Mask), Four);
}
/// Middles and half sizes of boxes, along an axis.
struct Reach {
    Four middle, half;
    Reach(const Node::Each<std::uint16_t>& lows, const Node::Each<std::uint16_t>& highs, float low, float step,
          std::uint32_t i) {
        const Four first = numbers(lows, i), last = numbers(highs, i);
        middle = low + (0.5f * step) * (first + last);
        half = (0.5f * step) * (last - first);
    }
};

// DECISIONS: tree-of-lamps
// Section 4.1: intensity × cosines / distance², the cosines as large as any light in the box could have them. Of four
// children from the i-th on.
[[gnu::always_inline]] inline Four importances_of_four(const Node& node, const LitPoint& from, std::uint32_t i) {
    constexpr float roundings = 3e-4f, unit = 1.0f / 32767;
    const Vec3 at = from.position, n = from.normal;
    const Reach x(node.lows.x, node.highs.x, node.low.x, node.step.x, i);
    const Reach y(node.lows.y, node.highs.y, node.low.y, node.step.y, i);
    const Reach z(node.lows.z, node.highs.z, node.low.z, node.step.z, i);
    const Four way_x = at.x - x.middle, way_y = at.y - y.middle, way_z = at.z - z.middle;
    const Four distance2 = way_x * way_x + way_y * way_y + way_z * way_z;
    const Four radius2 = x.half * x.half + y.half * y.half + z.half * z.half;
    // As near as the size of the box the distance says nothing.
    const Four square = greater_of(distance2, greater_of(radius2, all_of(1e-30f))), per_square = 1 / square;
    const Four distance = root(square), radius = root(radius2), rim = root(square - radius2);
    const Four falloff = numbers(node.intensity, i) * per_square;

    // Angles are worked out times the distance, and their difference to that which the box fills times its square, so
    // that no root waits for another, nor for the quotient.
    const auto cosine_beyond_box = [&](const Turn& angle) {
        return select(angle.cosine > rim, square, angle.cosine * rim + angle.sine * radius) * per_square;
    };
    const Four along =
        (way_x * numbers(node.axis.x, i) + way_y * numbers(node.axis.y, i) + way_z * numbers(node.axis.z, i)) * unit;
    const std::int32_t bits = node.two_sided >> i;
    const Mask two_sided = (Mask{bits, bits, bits, bits} & Mask{1, 2, 4, 8}) != 0;
    const Turn to_axis{select(two_sided, magnitude(along), along), root(magnitude(square - along * along))};
    const Four cos_leaving = cosine_beyond_box(
        less(to_axis, distance, numbers(node.cos_spread, i) * unit, numbers(node.sin_spread, i) * unit));
    const Four lit = select(cos_leaving < numbers(node.cos_reach, i) * unit - roundings, all_of(0),
                            greater_of(cos_leaving, all_of(roundings)));
    const Four inside = all_of(1);  // the box is all around: any direction is possible
    if (n == Vec3{}) return falloff * select(distance2 <= radius2, inside, lit);

    const Four up = way_x * -n.x + way_y * -n.y + way_z * -n.z;
    const Four cos_arriving = cosine_beyond_box({up, root(magnitude(square - up * up))});
    const Four above = select(cos_arriving < -roundings, all_of(0), greater_of(cos_arriving, all_of(least_cosine)));
    return falloff * select(distance2 <= radius2, inside, lit * above);
}

inline Importances importances(const Node& node, const LitPoint& from) {
    const Four first = importances_of_four(node, from, 0);
    const bool more = node.intensity[4] > 0;  // children stand in front
    const Four second = more ? importances_of_four(node, from, 4) : Four{};
    Importances found;
    std::memcpy(found.data(), &first, sizeof(first));
    std::memcpy(found.data() + 4, &second, sizeof(second));
    return found;
}

/// Sums of all before each child, and of all: they never fall.
struct Sums {
    std::array<float, width + 1> before;
    explicit Sums(const Importances& a) {
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

// Which child a place within all is in: never one of no importance. Without a branch, as it can't be foretold.
inline std::uint32_t child_at(float place, const Importances& all, const Sums& sums) {
    std::uint32_t child = 0;
    for (std::uint32_t i = 0; i < width; ++i) child += sums.before[i + 1] <= place;
    if (child < width) return child;
    while (!(all[--child] > 0)) continue;  // by rounding
    return child;
}

}  // namespace

std::optional<LightTree::Choice> LightTree::choose(const LitPoint& from, float& u) const {
    if (nodes_.empty()) return {};
    float chance = 1;
    for (std::uint32_t at = 0;;) {
        const Node& node = nodes_[at];
        const Importances all = importances(node, from);
        const Sums sums(all);
        if (!(sums.all() > 0)) return {};
        const float place = u * sums.all();
        const std::uint32_t i = child_at(place, all, sums);
        u = std::clamp((place - sums.before[i]) / all[i], 0.0f, 0x1.fffffep-1f);
        chance *= all[i] / sums.all();
        at = node.child[i];
        if (node.leaves >> i & 1) return Choice{at, chance};
    }
}

float LightTree::chance(const LitPoint& from, std::uint32_t light) const {
    std::uint32_t place = place_of_[light];
    if (place == none) return 0;
    for (float chance = 1;;) {
        const Node& node = nodes_[place / width];
        const Importances all = importances(node, from);
        const float own = all[place % width];
        if (!(own > 0)) return 0;
        chance *= own / Sums(all).all();
        if (place < width) return chance;  // a child of the first node
        place = node.parent;
    }
}

LightTree::LightTree(const std::vector<LightBounds>& lights) : place_of_(lights.size(), none) {
    nodes_ = LightTreeBuilder(lights).build();
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
        for (std::uint32_t i = 0; i < width; ++i)
            if (nodes_[n].leaves >> i & 1) place_of_[nodes_[n].child[i]] = n * width + i;
}

}  // namespace lightnet
