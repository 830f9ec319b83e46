#include "core/scene/media/medium.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace lightnet {
namespace {

bool sound(Rgb colour) { return finite(colour) && colour.r >= 0 && colour.g >= 0 && colour.b >= 0; }

bool sound(const VolumeGrid& grid) {
    if (grid.channels != 1 && grid.channels != 3) return false;
    if (grid.blocks.empty()) {
        if (grid.values.size() != grid.points() * grid.channels) return false;
    } else {
        const auto whole = [](std::uint32_t size) { return size % VolumeGrid::block_side == 0; };
        const std::size_t each = std::size_t{VolumeGrid::block_points} * grid.channels,
                          stored = grid.values.size() / each;
        if (!std::all_of(grid.size.begin(), grid.size.end(), whole) || grid.values.size() % each != 0 ||
            grid.blocks.size() != grid.points() / VolumeGrid::block_points ||
            !std::all_of(grid.blocks.begin(), grid.blocks.end(), [&](std::uint32_t block) { return block < stored; }))
            return false;
    }
    return std::all_of(grid.values.begin(), grid.values.end(), [](float v) { return std::isfinite(v) && v >= 0; });
}

bool sound(const VolumeField& field) {
    if (!sound(field.value)) return false;
    return !field.grid || sound(*field.grid);
}

Rgb mixed(Rgb a, Rgb b, float part) { return a * (1 - part) + b * part; }

// The points on both sides of a place along one axis, and how far it is to the second.
struct BetweenVoxels {
    std::int64_t first;
    float part;
};
BetweenVoxels between(float place, std::uint32_t size) {
    const float at = std::clamp(place, 0.0f, 1.0f) * float(size) - 0.5f, below = std::floor(at);
    return {static_cast<std::int64_t>(below), at - below};
}

}  // namespace

Rgb VolumeGrid::point(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::array<std::int64_t, 3> wanted{x, y, z};
    std::array<std::uint32_t, 3> at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto within = std::clamp<std::int64_t>(wanted[axis], 0, std::int64_t{size[axis]} - 1);
        if (fades && within != wanted[axis]) return {};
        at[axis] = static_cast<std::uint32_t>(within);
    }
    const float* value = values.data() + index_of(at) * channels;
    return channels == 3 ? Rgb{value[0], value[1], value[2]} : Rgb{value[0], value[0], value[0]};
}

std::size_t VolumeGrid::index_of(const std::array<std::uint32_t, 3>& at) const {
    if (blocks.empty()) return (std::size_t{at[2]} * size[1] + at[1]) * size[0] + at[0];
    constexpr std::uint32_t side = block_side;
    const std::uint32_t within = (at[2] % side * side + at[1] % side) * side + at[0] % side;
    return std::size_t{block_of(at)} * block_points + within;
}

Rgb VolumeGrid::at(Vec3 place) const {
    const auto x = between(place.x, size[0]), y = between(place.y, size[1]), z = between(place.z, size[2]);
    const auto corner = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        return point(x.first + i, y.first + j, z.first + k);
    };
    if (nearest) return corner(x.part >= 0.5f, y.part >= 0.5f, z.part >= 0.5f);
    const auto row = [&](std::int64_t j, std::int64_t k) { return mixed(corner(0, j, k), corner(1, j, k), x.part); };
    return mixed(mixed(row(0, 0), row(1, 0), y.part), mixed(row(0, 1), row(1, 1), y.part), z.part);
}

Hash VolumeGrid::content() const {
    Hasher hasher;
    hasher.add(std::as_bytes(std::span(size)));
    const std::array<std::uint32_t, 3> ways{channels, fades, nearest};
    hasher.add(std::as_bytes(std::span(ways)));
    hasher.add(std::as_bytes(std::span(values)));
    hasher.add(std::as_bytes(std::span(blocks)));
    return hasher.finish();
}

std::string Medium::fault() const {
    for (const VolumeField* field : {&extinction, &albedo, &emission})
        if (!sound(*field)) return "a medium's numbers must be finite and not negative";
    return phase.fault();
}

Rgb Medium::albedo_at(Vec3 position) const {
    const Rgb found = albedo.at(position);
    if (!albedo_scatters) return found;
    const Rgb whole = extinction.at(position);
    const auto share = [](float part, float all) { return all > 0 ? std::min(part / all, 1.0f) : 0.0f; };
    return {share(found.r, whole.r), share(found.g, whole.g), share(found.b, whole.b)};
}

}  // namespace lightnet
