#include "core/scene/lamps/light_tree.hpp"

#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace lightnet {
namespace {

Vec3 least(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 most(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

float angle_of(float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); }

// DECISIONS: tree-of-lamps
// The smallest cone around two cones. Conty Estévez & Kulla 2018, algorithm 1.
struct Cone {
    Vec3 axis;
    float cos_spread;
};
Cone around(Cone a, Cone b) {
    if (b.cos_spread < a.cos_spread) std::swap(a, b);  // a is the wider one
    const float wide = angle_of(a.cos_spread), narrow = angle_of(b.cos_spread), between = angle_of(dot(a.axis, b.axis));
    if (std::min(between + narrow, pi) <= wide) return a;
    const float spread = (wide + between + narrow) / 2;
    const Vec3 turn = cross(a.axis, b.axis);
    const float size = length(turn);
    if (spread >= pi || !(size > 1e-6f)) return {a.axis, -1};
    // Turns a's axis towards b's.
    const Vec3 side = normalize(cross(turn / size, a.axis));
    const float by = spread - wide;
    return {normalize(a.axis * std::cos(by) + side * std::sin(by)), std::cos(spread)};
}

LightBounds both(const LightBounds& a, const LightBounds& b) {
    if (!(a.intensity > 0)) return b;
    if (!(b.intensity > 0)) return a;
    const Cone cone = around({a.axis, a.cos_spread}, {b.axis, b.cos_spread});
    return {least(a.low, b.low),
            most(a.high, b.high),
            cone.axis,
            cone.cos_spread,
            std::min(a.cos_reach, b.cos_reach),
            a.intensity + b.intensity,
            a.two_sided || b.two_sided};
}

// Of the solid angle into which the lights shine, weighted by a cosine at its rim: section 4.3.
float measure(const LightBounds& lights) {
    const float spread = angle_of(lights.cos_spread), reach = angle_of(lights.cos_reach);
    const float widest = std::min(spread + reach, pi), sine = std::sin(spread);
    const float angle =
        2 * pi * (1 - lights.cos_spread) +
        pi / 2 * (2 * widest * sine - std::cos(spread - 2 * widest) - 2 * spread * sine + lights.cos_spread);
    const Vec3 d = lights.high - lights.low;
    const float area = 2 * (d.x * d.y + d.y * d.z + d.z * d.x) + length_squared(d) * 1e-3f;  // lines have none
    return lights.intensity * angle * area;
}

// cos(max(0, a - b)) and sin of the same, from cosines and sines.
float cos_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
    return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
float sin_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
    return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
}
float sine_for(float cosine) { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); }

}  // namespace

LightTree::Node LightTree::node_of(const LightBounds& bounds) {
    Node node;
    node.center = (bounds.low + bounds.high) * 0.5f;
    node.half = (bounds.high - bounds.low) * 0.5f;
    node.axis = bounds.axis;
    node.radius2 = length_squared(node.half);
    node.cos_spread = bounds.cos_spread;
    node.sin_spread = sine_for(bounds.cos_spread);
    node.cos_reach = bounds.cos_reach;
    node.intensity = bounds.intensity;
    node.two_sided = bounds.two_sided;
    return node;
}

// Section 4.1: intensity × cosine / distance², the cosine as large as any light in the box could have it.
float LightTree::importance(const Node& node, Vec3 from) {
    const Vec3 way = from - node.center;
    const float distance2 = length_squared(way);
    // As near as the size of the box the distance says nothing.
    const float falloff = node.intensity / std::max({distance2, node.radius2, 1e-30f});
    if (distance2 <= node.radius2) return falloff;  // the box is all around: any direction is possible
    float cosine = dot(node.axis, way) / std::sqrt(distance2);
    if (node.two_sided) cosine = std::fabs(cosine);
    const float sine = sine_for(cosine);
    const float sin2_box = node.radius2 / distance2, cos_box = std::sqrt(1 - sin2_box), sin_box = std::sqrt(sin2_box);
    const float cos_x = cos_of_difference(cosine, sine, node.cos_spread, node.sin_spread);
    const float sin_x = sin_of_difference(cosine, sine, node.cos_spread, node.sin_spread);
    const float cos_least = cos_of_difference(cos_x, sin_x, cos_box, sin_box);
    constexpr float roundings = 1e-4f;
    if (cos_least < node.cos_reach - roundings) return 0;
    return falloff * std::max(cos_least, roundings);
}

/// Splits lights in two where it parts them best, in space and in direction.
struct LightTree::Builder {
    const std::vector<LightBounds>& lights;
    std::vector<Node>& nodes;
    std::vector<std::uint32_t>& leaf_of;

    static constexpr std::size_t buckets = 12;

    LightBounds bounds_of(std::span<const std::uint32_t> some) const {
        LightBounds all = lights[some[0]];
        for (const auto light : some.subspan(1)) all = both(all, lights[light]);
        return all;
    }
    Vec3 middle(std::uint32_t light) const { return (lights[light].low + lights[light].high) * 0.5f; }

    struct Split {
        std::size_t axis = 0, bucket = 0;
        float low = 0, per_metre = 0;
        std::size_t bucket_of(Vec3 p) const {
            const float at = (p[axis] - low) * per_metre;
            return at < float(buckets - 1) ? std::size_t(std::max(0.0f, at)) : buckets - 1;
        }
    };

    // What both halves of each split along an axis cost. Section 4.3, eq. 2.
    void try_axis(std::span<const std::uint32_t> some, Split split, Vec3 extent, Split& best, float& least_cost) const {
        std::array<LightBounds, buckets> parts{};
        for (const auto light : some) {
            LightBounds& part = parts[split.bucket_of(middle(light))];
            part = both(part, lights[light]);
        }
        const float stretch = std::max({extent.x, extent.y, extent.z}) / extent[split.axis];  // splits long sides first
        std::array<LightBounds, buckets> above{};
        LightBounds below, rest;
        for (std::size_t i = buckets - 1; i > 0; --i) above[i] = rest = both(rest, parts[i]);
        for (std::size_t i = 0; i + 1 < buckets; ++i) {
            below = both(below, parts[i]);
            if (!(below.intensity > 0) || !(above[i + 1].intensity > 0)) continue;
            const float cost = stretch * (measure(below) + measure(above[i + 1]));
            if (!(cost < least_cost)) continue;
            least_cost = cost;
            best = split;
            best.bucket = i;
        }
    }

    std::size_t halve(std::span<std::uint32_t> some) const {
        Vec3 low = middle(some[0]), high = low;
        for (const auto light : some) {
            low = least(low, middle(light));
            high = most(high, middle(light));
        }
        const Vec3 extent = high - low;
        Split best;
        float least_cost = std::numeric_limits<float>::infinity();
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (extent[axis] > 0)
                try_axis(some, {axis, 0, low[axis], float(buckets) / extent[axis]}, extent, best, least_cost);
        if (std::isinf(least_cost)) return some.size() / 2;  // all in one place
        const auto end = std::stable_partition(some.begin(), some.end(), [&](std::uint32_t light) {
            return best.bucket_of(middle(light)) <= best.bucket;
        });
        return std::size_t(end - some.begin());
    }

    /// Depth first, without recursion: a tree may be as deep as there are lights.
    void build(std::vector<std::uint32_t>& order) {
        struct Task {
            std::size_t first, last;
            std::uint32_t parent;
            bool second;
        };
        std::vector<Task> tasks{{0, order.size(), 0, false}};
        while (!tasks.empty()) {
            const Task task = tasks.back();
            tasks.pop_back();
            const auto here = std::uint32_t(nodes.size());
            const auto some = std::span(order).subspan(task.first, task.last - task.first);
            nodes.push_back(node_of(bounds_of(some)));
            nodes[here].parent = task.parent;
            if (task.second) nodes[task.parent].second = here;
            if (some.size() == 1) {
                nodes[here].light = some[0];
                leaf_of[some[0]] = here;
                continue;
            }
            const std::size_t middle_of = task.first + halve(some);
            tasks.push_back({middle_of, task.last, here, true});
            tasks.push_back({task.first, middle_of, here, false});  // next: it stands behind its parent
        }
    }
};

LightTree::LightTree(const std::vector<LightBounds>& lights) : leaf_of_(lights.size(), none) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < lights.size(); ++i)
        if (lights[i].intensity > 0) order.push_back(i);
    if (order.empty()) return;
    nodes_.reserve(2 * order.size());
    Builder{lights, nodes_, leaf_of_}.build(order);
}

std::optional<LightTree::Choice> LightTree::choose(Vec3 from, float& u) const {
    if (nodes_.empty()) return {};
    std::uint32_t at = 0;
    float chance = 1;
    while (nodes_[at].second != 0) {
        const std::uint32_t first = at + 1, second = nodes_[at].second;
        const float a = importance(nodes_[first], from), b = importance(nodes_[second], from);
        if (!(a + b > 0)) return {};
        const float share = a / (a + b);
        if (u < share) {
            u = std::min(u / share, 0x1.fffffep-1f);
            chance *= share;
            at = first;
        } else {
            u = std::min((u - share) / (1 - share), 0x1.fffffep-1f);
            chance *= 1 - share;
            at = second;
        }
    }
    return Choice{nodes_[at].light, chance};
}

float LightTree::chance(Vec3 from, std::uint32_t light) const {
    std::uint32_t at = leaf_of_[light];
    if (at == none) return 0;
    float chance = 1;
    while (at != 0) {
        const std::uint32_t parent = nodes_[at].parent, first = parent + 1, second = nodes_[parent].second;
        const float a = importance(nodes_[first], from), b = importance(nodes_[second], from);
        if (!(a + b > 0)) return 0;
        const float share = a / (a + b);
        chance *= at == first ? share : 1 - share;
        at = parent;
    }
    return chance;
}

}  // namespace lightnet
