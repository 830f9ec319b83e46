#include "core/readers/pbrt/glow.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.hpp"
#include "core/readers/common/inverse.hpp"
#include "core/readers/pbrt/older_light.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float coldest = 100, hottest = 1e5f;  // K

/// Light by temperature, linear between those that are multiples of ten.
class BlackBodies {
public:
    Rgb at(float kelvin) {
        if (!(kelvin > coldest)) return {};
        const float steps = std::min(kelvin, hottest) / step, below = std::floor(steps), part = steps - below;
        return known(below) * (1 - part) + known(below + 1) * part;
    }

private:
    static constexpr float step = 10;

    const Rgb& known(float steps) {
        const auto [entry, fresh] = known_.try_emplace(steps);
        if (fresh) entry->second = peaked_blackbody(steps * step).rgb;
        return entry->second;
    }

    std::map<float, Rgb> known_;
};

/// Fills in the colours of a cube of points.
class Glow {
public:
    Glow(const VolumeField& density, const Heat& heat)
        : density_(*density.grid),
          heat_(heat),
          to_heat_(heat.grid.to_grid * inverse(density.to_grid).value_or(Matrix())) {}

    /// Of one point.
    Rgb at(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const float density = density_.point(x, y, z).r;
        if (!(density > 0)) return {};
        const auto along = [](std::uint32_t i, std::uint32_t size) { return (float(i) + 0.5f) / float(size); };
        const auto& size = density_.size;
        const Vec3 place{along(x, size[0]), along(y, size[1]), along(z, size[2])};
        const Vec3 there = transform_point(to_heat_, place);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!(there[axis] >= 0 && there[axis] <= 1)) return {};
        const float kelvin = (heat_.grid.grid->at(there).r - heat_.offset) * heat_.scale;
        return bodies_.at(kelvin) * density;
    }

private:
    const VolumeGrid& density_;
    const Heat& heat_;
    Matrix to_heat_;
    BlackBodies bodies_;
};

void put(std::vector<float>& values, Rgb colour) { values.insert(values.end(), {colour.r, colour.g, colour.b}); }

VolumeGrid as_large_as(const VolumeGrid& grid) {
    VolumeGrid made;
    made.size = grid.size, made.channels = 3, made.fades = grid.fades, made.nearest = grid.nearest;
    return made;
}

VolumeGrid glow_of_points(const VolumeGrid& density, Glow& glow) {
    VolumeGrid made = as_large_as(density);
    for (std::uint32_t z = 0; z < density.size[2]; ++z)
        for (std::uint32_t y = 0; y < density.size[1]; ++y)
            for (std::uint32_t x = 0; x < density.size[0]; ++x) put(made.values, glow.at(x, y, z));
    return made;
}

/// Which blocks of a grid are not 0 everywhere.
std::vector<bool> filled_blocks(const VolumeGrid& grid) {
    std::vector<bool> filled;
    for (std::size_t first = 0; first < grid.values.size(); first += VolumeGrid::block_points) {
        const auto begin = grid.values.begin() + std::ptrdiff_t(first);
        filled.push_back(std::any_of(begin, begin + VolumeGrid::block_points, [](float value) { return value > 0; }));
    }
    return filled;
}

// What is dark everywhere is the first block.
VolumeGrid glow_of_blocks(const VolumeGrid& density, const VolumeGrid& heat, Glow& glow) {
    constexpr std::uint32_t side = VolumeGrid::block_side;
    constexpr std::size_t each = std::size_t{VolumeGrid::block_points} * 3;
    const auto filled = filled_blocks(density);
    const std::size_t most = 4096 + 4 * (density.values.size() + heat.values.size()) / VolumeGrid::block_points;
    const auto wanted = std::count_if(density.blocks.begin(), density.blocks.end(), [&](auto b) { return filled[b]; });
    if (std::size_t(wanted) > most) throw Error("what it emits would take much more memory than its grids");
    VolumeGrid made = as_large_as(density);
    made.values.assign(each, 0);
    for (std::uint32_t z = 0; z < density.size[2]; z += side)
        for (std::uint32_t y = 0; y < density.size[1]; y += side)
            for (std::uint32_t x = 0; x < density.size[0]; x += side) {
                const std::size_t first = made.values.size();
                for (std::uint32_t i = 0; i < VolumeGrid::block_points && filled[density.block_of({x, y, z})]; ++i)
                    put(made.values, glow.at(x + i % side, y + i / side % side, z + i / side / side));
                const bool dark = std::none_of(made.values.begin() + std::ptrdiff_t(first), made.values.end(),
                                               [](float value) { return value > 0; });
                if (dark) made.values.resize(first);
                made.blocks.push_back(dark ? 0 : static_cast<std::uint32_t>(first / each));
            }
    return made;
}

}  // namespace

std::shared_ptr<const VolumeGrid> glowing(const VolumeField& density, const Heat& heat) {
    Glow glow(density, heat);
    VolumeGrid made = density.grid->blocks.empty() ? glow_of_points(*density.grid, glow)
                                                   : glow_of_blocks(*density.grid, *heat.grid.grid, glow);
    const bool dark = std::all_of(made.values.begin(), made.values.end(), [](float value) { return value == 0; });
    return dark ? nullptr : std::make_shared<const VolumeGrid>(std::move(made));
}

std::shared_ptr<const VolumeGrid> product_of(const VolumeGrid& a, const VolumeGrid& b) {
    VolumeGrid made = a.channels >= b.channels ? a : b;
    const VolumeGrid& other = a.channels >= b.channels ? b : a;
    const std::size_t each = made.channels / other.channels;
    for (std::size_t i = 0; i < made.values.size(); ++i) made.values[i] *= other.values[i / each];
    return std::make_shared<const VolumeGrid>(std::move(made));
}

}  // namespace lightnet::pbrt
