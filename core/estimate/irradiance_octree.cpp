#include "core/estimate/irradiance_octree.hpp"

#include "core/base/unwanted.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightnet {
namespace {

constexpr float in_front = 0.02f;  // of its reach: how far a point may lie behind what a record sees
constexpr int most_levels = 20;

float change_of(const IrradianceRecord& record) {
    const float r = length(record.moved[0]), g = length(record.moved[1]), b = length(record.moved[2]);
    return std::max({r, g, b});
}

IrradianceRecord sum_of(std::span<const IrradianceRecord> groups) {
    IrradianceRecord sum = groups.front();
    for (const auto& other : groups.subspan(1)) {
        sum.irradiance += other.irradiance;
        for (std::size_t colour = 0; colour < 3; ++colour) {
            sum.moved[colour] += other.moved[colour];
            sum.turned[colour] += other.turned[colour];
        }
    }
    return sum;
}

// Where a record has to reach farther than its gradient lets it, the gradient is made less: next to an edge it is
// mostly noise.
float steepest(const IrradianceRecord& record, const Spacing& spacing, float& reach) {
    const float brightest = max_component(record.irradiance), change = change_of(record);
    reach = record.distance;
    if (change > 0) reach = std::min(reach, brightest / change);
    reach = std::clamp(spacing.accuracy * reach, spacing.least, spacing.most);
    const float most = spacing.accuracy * brightest / reach;
    return change > most ? most / change : 1;
}

}  // namespace

void IrradianceOctree::add(std::span<const IrradianceRecord> groups) {
    Entry entry{sum_of(groups), 0};
    const float less = steepest(entry.record, spacing_, entry.reach);
    const auto flatten = [&](IrradianceRecord& record) {
        for (Vec3& moved : record.moved)
            if (less != 1) moved = moved * less;
    };
    flatten(entry.record);
    records_.push_back(entry);
    if (groups_ == 1) return;
    for (IrradianceRecord one : groups) {
        flatten(one);
        apart_.push_back(one);
    }
}

IrradianceOctree::IrradianceOctree(std::span<const IrradianceRecord> records, const Spacing& spacing, const Box& bounds,
                                   std::size_t groups)
    : groups_(groups), low_(bounds.low), spacing_(spacing) {
    const Vec3 extent = bounds.high - bounds.low;
    size_ = std::max({extent.x, extent.y, extent.z}) * 1.001f;
    records_.reserve(records.size() / groups_);
    for (std::size_t first = 0; first < records.size(); first += groups_) add(records.subspan(first, groups_));
    cells_.emplace_back();
    clamp_to_neighbours();
    cells_.assign(1, {});
    for (std::uint32_t i = 0; i < records_.size(); ++i) insert(i);
}

// Of two records, the one sees within its own distance and that between them all that the other sees within its own.
// Longest reach first, so that each limit is handed on.
void IrradianceOctree::clamp_to_neighbours() {
    std::vector<std::uint32_t> order(records_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) {
        return records_[a].reach < records_[b].reach || (records_[a].reach == records_[b].reach && a < b);
    });
    for (const auto i : order) {
        end_if_unwanted();
        Entry& entry = records_[i];
        for_all_near(entry.record.position, [&](const Reach& other) {
            const float between = length(entry.record.position - other.position);
            if (between < other.reach && dot(entry.record.normal, other.normal) > 0.5f)
                entry.reach = std::min(entry.reach, other.reach + spacing_.accuracy * between);
        });
        entry.reach = std::max(entry.reach, spacing_.least);
        insert(i);
    }
}

void IrradianceOctree::insert(std::uint32_t entry) { insert(0, low_, size_, entry); }

void IrradianceOctree::insert(std::uint32_t cell, Vec3 low, float size, std::uint32_t entry) {
    const Entry& inserted = records_[entry];
    const float reach = most_stretch * inserted.reach;
    int level = 0;
    for (float s = size_; s > size * 1.5f; s /= 2) ++level;
    if (size < 2 * reach || level >= most_levels) {
        const IrradianceRecord& record = inserted.record;
        cells_[cell].entries.push_back({record.position, record.normal, inserted.reach, entry});
        return;
    }
    const float half = size / 2;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        Vec3 corner = low;
        bool meets = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner[axis] += (octant >> axis & 1) ? half : 0;
            const float at = inserted.record.position[axis];
            meets = meets && at + reach >= corner[axis] && at - reach <= corner[axis] + half;
        }
        if (!meets) continue;
        if (!cells_[cell].children[octant]) {
            cells_[cell].children[octant] = std::uint32_t(cells_.size());
            cells_.emplace_back();
        }
        insert(cells_[cell].children[octant], corner, half, entry);
    }
}

template <class Function>
void IrradianceOctree::for_all_near(Vec3 position, Function function) const {
    Vec3 low = low_;
    float size = size_;
    std::uint32_t cell = 0;
    while (true) {
        for (const Reach& entry : cells_[cell].entries) function(entry);
        size /= 2;
        std::uint32_t octant = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (position[axis] >= low[axis] + size) {
                octant |= 1u << axis;
                low[axis] += size;
            }
        cell = cells_[cell].children[octant];
        if (cell == 0) return;
    }
}

float IrradianceOctree::weight(const Reach& entry, Vec3 position, Vec3 normal, float stretch) const {
    const Vec3 offset = position - entry.position;
    const float reach = entry.reach * stretch, distance2 = length_squared(offset);
    if (distance2 >= reach * reach) return 0;
    const float cosine = dot(normal, entry.normal);
    const float turn = std::sqrt(std::max(0.0f, 1 - cosine)) / (spacing_.accuracy * stretch);
    const float error = std::sqrt(distance2) / reach + turn;
    if (error >= 1) return 0;
    // What lies behind the record's horizon, it did not see.
    if (dot(offset, normal + entry.normal) * 0.5f < -in_front * reach) return 0;
    return 1 - error;
}

std::optional<Rgb> IrradianceOctree::irradiance(Vec3 position, Vec3 normal, float stretch) const {
    std::vector<Rgb> groups(groups_);
    if (!irradiance(position, normal, stretch, groups)) return {};
    return std::accumulate(groups.begin(), groups.end(), Rgb{});
}

bool IrradianceOctree::irradiance(Vec3 position, Vec3 normal, float stretch, std::span<Rgb> groups) const {
    std::fill(groups.begin(), groups.end(), Rgb{});
    float weights = 0;
    for_all_near(position, [&](const Reach& entry) {
        const float w = weight(entry, position, normal, stretch);
        if (!(w > 0)) return;
        for (std::size_t g = 0; g < groups_; ++g) groups[g] += record(entry.entry, g).at(position, normal) * w;
        weights += w;
    });
    if (!(weights > 0)) return false;
    for (Rgb& sum : groups) sum = sum / weights;
    return true;
}

const IrradianceRecord* IrradianceOctree::nearest(Vec3 position, Vec3 normal, float within) const {
    const Reach* best = nullptr;
    float least = within * within;
    for_all_near(position, [&](const Reach& entry) {
        const float distance2 = length_squared(position - entry.position);
        const bool nearer = distance2 < least || (best && distance2 == least && entry.entry < best->entry);
        if (!nearer || std::fabs(dot(normal, entry.normal)) < 0.7f) return;
        best = &entry;
        least = distance2;
    });
    return best ? &records_[best->entry].record : nullptr;
}

bool IrradianceOctree::covers(Vec3 position, Vec3 normal) const {
    bool covered = false;
    for_all_near(position, [&](const Reach& entry) { covered = covered || weight(entry, position, normal, 1) > 0; });
    return covered;
}

}  // namespace lightnet
