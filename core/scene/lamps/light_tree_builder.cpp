#include "core/scene/lamps/light_tree_builder.hpp"

#include "core/base/thread_pool.hpp"
#include "core/base/unwanted.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lightnet {
namespace {

constexpr std::uint32_t children = LightTree::width;
constexpr std::size_t buckets = 12;
constexpr std::uint32_t many_at_once = 1 << 14;  // so many are sorted by one thread
constexpr std::uint32_t many = 256;  // so many are split along their longest side: there it's space that counts
constexpr std::uint32_t looked_at = 1 << 12;  // of more, so many tell where to split

Vec3 least(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 most(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

float sine_of(float cosine) { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); }

// Of both signs of the axis of a light that shines on both sides, the one that all such lights agree on.
Vec3 upwards(Vec3 axis) {
    const float x = std::fabs(axis.x), y = std::fabs(axis.y), z = std::fabs(axis.z);
    const float greatest = x >= y && x >= z ? axis.x : y >= z ? axis.y : axis.z;
    return greatest < 0 ? -axis : axis;
}

// Compilers compare the numbers of a Box one by one.
using Four = float __attribute__((vector_size(16)));

Four four(Vec3 v, float last = 0) { return Four{v.x, v.y, v.z, last}; }
Vec3 three(Four v) { return {v[0], v[1], v[2]}; }
constexpr Four infinite{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                        std::numeric_limits<float>::infinity(), 0};

/// Around boxes, or points.
struct FourBox {
    Four low = infinite, high = -infinite;
    void add(Four from, Four to) {
        low = from < low ? from : low;
        high = to > high ? to : high;
    }
    Vec3 extent() const { return three(high - low); }
};

// Some lights: a box, and sums.
struct Heap {
    FourBox box;
    Four sums{};  // axis × intensity, intensity

    void add(const Heap& other) {
        box.add(other.box.low, other.box.high);
        sums += other.sums;
    }
    float intensity() const { return sums[3]; }
};

// Section 4.3: what lights cost that are in one node. The solid angle into which they shine, weighted by a cosine at
// its rim, is that of a cap whose mean direction is as long as theirs: a bound, as nodes have, would follow the
// outermost. Over π it is 1 for one direction, 4 for all, and within a tenth of a parabola by the cap's cosine in
// between.
float cost_of(const Heap& lights) {
    const float cosine = std::clamp(2 * length(three(lights.sums)) / lights.intensity() - 1, -1.0f, 1.0f);
    const float angle = 3.571f - (1.5f + 1.071f * cosine) * cosine;
    const Vec3 d = lights.box.extent();
    const float area = 2 * (d.x * d.y + d.y * d.z + d.z * d.x) + length_squared(d) * 1e-3f;  // lines have none
    return lights.intensity() * angle * area;
}

// Whole steps from `low`, so that they hold what they are to hold in spite of rounding.
std::uint16_t steps_down(float value, float low, float step) {
    if (!(step > 0)) return 0;
    auto steps = std::int32_t(std::clamp(std::floor((value - low) / step), 0.0f, 65535.0f));
    while (steps > 0 && low + step * float(steps) > value) --steps;
    return std::uint16_t(steps);
}
std::uint16_t steps_up(float value, float low, float step) {
    if (!(step > 0)) return 0;
    auto steps = std::int32_t(std::clamp(std::ceil((value - low) / step), 0.0f, 65535.0f));
    while (steps < 65535 && low + step * float(steps) < value) ++steps;
    return std::uint16_t(steps);
}
std::int16_t rounded(float unit) { return std::int16_t(std::lround(std::clamp(unit, -1.0f, 1.0f) * 32767)); }
std::int16_t rounded_down(float unit) { return std::int16_t(std::floor(std::clamp(unit, -1.0f, 1.0f) * 32767)); }

// The cosine of the sum of two angles; -1 if that is more than half a turn.
float cos_of_sum(float cos_a, float cos_b) {
    return cos_a + cos_b <= 0 ? -1 : cos_a * cos_b - sine_of(cos_a) * sine_of(cos_b);
}

// Around some lights: their cone is about the mean of their directions.
LightBounds around(std::span<const LightBounds> all) {
    LightBounds sum = all[0];
    Vec3 axis;
    sum.intensity = 0;
    sum.two_sided = std::any_of(all.begin(), all.end(), [](const LightBounds& one) { return one.two_sided; });
    for (const LightBounds& one : all) {
        sum.low = least(sum.low, one.low);
        sum.high = most(sum.high, one.high);
        sum.cos_reach = std::min(sum.cos_reach, one.cos_reach);
        sum.intensity += one.intensity;
        axis += (sum.two_sided ? upwards(one.axis) : one.axis) * one.intensity;
    }
    const float size = length(axis);
    sum.axis = size > 1e-6f * sum.intensity ? axis / size : Vec3{0, 0, 1};
    sum.cos_spread = 1;
    for (const LightBounds& one : all) {
        const float between = std::clamp(dot(sum.axis, one.axis), -1.0f, 1.0f);
        const float cosine = sum.two_sided ? std::fabs(between) : between;
        sum.cos_spread = std::min(sum.cos_spread, cos_of_sum(one.cos_spread, cosine));
    }
    return sum;
}

}  // namespace

LightTreeBuilder::LightTreeBuilder(const std::vector<LightBounds>& lights) {
    items_.reserve(lights.size());
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        if (!(lights[i].intensity > 0)) continue;
        LightBounds& bounds = items_.emplace_back(Item{lights[i], i}).bounds;
        if (bounds.two_sided) bounds.axis = upwards(bounds.axis);
    }
}

std::uint32_t LightTreeBuilder::Part::stride() const { return std::max(1u, size() / looked_at); }

struct LightTreeBuilder::Split {
    std::size_t axis = 0, bucket = 0;
    float low = 0, per_metre = 0;
    std::size_t bucket_of(Vec3 p) const {
        const float at = (p[axis] - low) * per_metre;
        return at < float(buckets - 1) ? std::size_t(std::max(0.0f, at)) : buckets - 1;
    }
};

// What both halves of each split along an axis cost: eq. 2.
void LightTreeBuilder::try_axis(Part part, Split split, Vec3 extent, Split& best, float& least_cost) const {
    std::array<Heap, buckets> heaps, above;
    for (std::uint32_t i = part.first; i < part.last; i += part.stride()) {
        const auto& [low, high, axis, cos_spread, cos_reach, intensity, two_sided] = items_[i].bounds;
        const Vec3 mean = axis * (intensity * (1 + cos_spread) / 2);
        heaps[split.bucket_of(items_[i].center())].add({{four(low), four(high)}, four(mean, intensity)});
    }
    const float stretch = std::max({extent.x, extent.y, extent.z}) / extent[split.axis];  // splits long sides first
    Heap below, rest;
    for (std::size_t i = buckets - 1; i > 0; --i) {
        rest.add(heaps[i]);
        above[i] = rest;
    }
    for (std::size_t i = 0; i + 1 < buckets; ++i) {
        below.add(heaps[i]);
        if (!(below.intensity() > 0) || !(above[i + 1].intensity() > 0)) continue;
        const float cost = stretch * (cost_of(below) + cost_of(above[i + 1]));
        if (!(cost < least_cost)) continue;
        least_cost = cost;
        best = split;
        best.bucket = i;
    }
}

/// Puts the lights of both halves side by side; returns where the second begins.
std::uint32_t LightTreeBuilder::halve(Part part) {
    FourBox centers;
    for (std::uint32_t i = part.first; i < part.last; i += part.stride()) {
        const Four center = four(items_[i].center());
        centers.add(center, center);
    }
    const Vec3 low = three(centers.low), extent = centers.extent();
    const float longest = std::max({extent.x, extent.y, extent.z});
    Split best;
    float least_cost = std::numeric_limits<float>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (extent[axis] > 0 && (part.size() <= many || extent[axis] == longest))
            try_axis(part, {axis, 0, low[axis], float(buckets) / extent[axis]}, extent, best, least_cost);
    if (std::isinf(least_cost)) return part.first + part.size() / 2;  // all in one place
    const auto begin = items_.begin();
    const auto end = std::partition(begin + part.first, begin + part.last,
                                    [&](const Item& item) { return best.bucket_of(item.center()) <= best.bucket; });
    return std::uint32_t(end - begin);
}

/// Up to eight parts, at the front of `parts`. None has more than eight lights, if there is room for that: nodes at the
/// ends are full then.
std::uint32_t LightTreeBuilder::cut(Part whole, std::array<Part, children>& parts) {
    if (whole.size() <= children) {
        for (std::uint32_t i = 0; i < whole.size(); ++i) parts[i] = {whole.first + i, whole.first + i + 1};
        return whole.size();
    }
    parts[0] = whole;
    std::uint32_t count = 1;
    while (count < children) {
        const auto largest =
            std::max_element(parts.begin(), parts.begin() + count, [](Part a, Part b) { return a.size() < b.size(); });
        if (largest->size() <= children) break;
        const std::uint32_t middle = halve(*largest);
        parts[count++] = {middle, largest->last};
        largest->last = middle;
    }
    return count;
}

/// Depth first, without recursion: a tree may be as deep as there are lights. Children of up to `apart` lights are
/// left out.
LightTreeBuilder::Branch LightTreeBuilder::grow(Part whole, std::uint32_t apart, std::vector<Below>& left) {
    Branch forks;
    std::vector<Below> tasks{{whole, 0}};
    while (!tasks.empty()) {
        end_if_unwanted();
        const auto [part, place] = tasks.back();
        tasks.pop_back();
        const auto here = std::uint32_t(forks.size());
        Fork& fork = forks.emplace_back();
        fork.parent = place;
        if (here > 0) forks[place / children].child[place % children] = here;
        fork.count = cut(part, fork.parts);
        for (std::uint32_t i = 0; i < fork.count; ++i)
            if (const auto size = fork.parts[i].size(); size > 1)
                (size > apart ? tasks : left).push_back({fork.parts[i], here * children + i});
    }
    return forks;
}

std::vector<LightTree::Node> LightTreeBuilder::build() {
    if (items_.empty()) return {};
    const auto count = std::uint32_t(items_.size());
    std::vector<Below> left;
    Branch top = grow({0, count}, count > many_at_once ? many_at_once : 0, left);
    std::vector<Branch> branches(left.size());
    const auto each = [&](const auto& work) {
        const auto some = [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) work(i);
        };
        parallel_for(left.size(), some, 1);
    };
    each([&](std::size_t i) {
        std::vector<Below> none;
        branches[i] = grow(left[i].part, 0, none);
    });
    auto size = std::uint32_t(top.size());
    std::vector<std::uint32_t> starts;
    for (std::size_t i = 0; i < left.size(); ++i) {
        top[left[i].place / children].child[left[i].place % children] = size;
        starts.push_back(size);
        size += std::uint32_t(branches[i].size());
    }
    nodes_.resize(size);
    around_.resize(size);
    each([&](std::size_t i) { write(branches[i], starts[i], left[i].place); });
    write(top, 0, 0);
    return std::move(nodes_);
}

/// Its nodes, from `start` on; its first is a child at `place`.
void LightTreeBuilder::write(const Branch& branch, std::uint32_t start, std::uint32_t place) {
    for (std::size_t n = branch.size(); n-- > 0;) {  // children stand behind their parents
        LightTree::Node& node = nodes_[start + n];
        const Fork& fork = branch[n];
        node.parent = n == 0 ? place : fork.parent + start * children;
        for (std::uint32_t i = 0; i < fork.count; ++i) {
            const bool leaf = fork.parts[i].size() == 1;
            node.child[i] = leaf ? items_[fork.parts[i].first].light : fork.child[i] + start;
            if (leaf) node.leaves |= std::uint8_t(1u << i);
        }
        close(fork, start + n);
    }
}

/// Writes what is known of a node's children, whose own children are closed.
void LightTreeBuilder::close(const Fork& fork, std::size_t n) {
    LightTree::Node& node = nodes_[n];
    std::array<LightBounds, children> all;
    const std::uint32_t count = fork.count;
    for (std::uint32_t i = 0; i < count; ++i)
        all[i] = (node.leaves >> i & 1) ? items_[fork.parts[i].first].bounds : around_[node.child[i]];
    const LightBounds& whole = around_[n] = around(std::span(all).first(count));
    node.low = whole.low;
    // A little more than needed, so that the last step is beyond the box.
    node.step = (whole.high - node.low) * (1.00001f / 65535);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto& [low, high, axis, cos_spread, cos_reach, intensity, two_sided] = all[i];
        node.lows.x[i] = steps_down(low.x, node.low.x, node.step.x);
        node.lows.y[i] = steps_down(low.y, node.low.y, node.step.y);
        node.lows.z[i] = steps_down(low.z, node.low.z, node.step.z);
        node.highs.x[i] = steps_up(high.x, node.low.x, node.step.x);
        node.highs.y[i] = steps_up(high.y, node.low.y, node.step.y);
        node.highs.z[i] = steps_up(high.z, node.low.z, node.step.z);
        node.axis.x[i] = rounded(axis.x);
        node.axis.y[i] = rounded(axis.y);
        node.axis.z[i] = rounded(axis.z);
        node.cos_spread[i] = rounded_down(cos_spread);
        node.sin_spread[i] = rounded(sine_of(float(node.cos_spread[i]) / 32767));
        node.cos_reach[i] = rounded_down(cos_reach);
        node.intensity[i] = intensity;
        if (two_sided) node.two_sided |= std::uint8_t(1u << i);
    }
}

}  // namespace lightnet
