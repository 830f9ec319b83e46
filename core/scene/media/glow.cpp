#include "core/scene/media/glow.hpp"

#include <cmath>

#include "core/base/math/prefix_cdf.hpp"
#include "core/base/math/sampling.hpp"

namespace lightnet {
namespace {

constexpr double all_directions = 4 * double(pi);

Vec3 row(const Matrix& matrix, int which) {
    const auto& [a, b, c, d] = matrix.m[std::size_t(which)];
    return {float(a), float(b), float(c)};
}

/// What is a unit cube to a field's grid. Volume 0: nothing sound.
struct Cube {
    explicit Cube(const Matrix& to_grid) {
        const Vec3 a = row(to_grid, 0), b = row(to_grid, 1), c = row(to_grid, 2);
        const float det = dot(a, cross(b, c));
        if (det == 0 || !std::isfinite(1 / det)) return;
        x = cross(b, c) / det, y = cross(c, a) / det, z = cross(a, b) / det;
        const Vec3 shift = transform_point(to_grid, {0, 0, 0});
        corner = -(x * shift.x + y * shift.y + z * shift.z);
        volume = 1 / std::fabs(double(det));
    }
    Vec3 corner, x, y, z;
    double volume = 0;
};

}  // namespace

Glow::Glow(std::span<const Medium> media, std::span<const Box> boxes) : media_(media) {
    std::vector<double> powers;
    for (std::size_t m = 0; m < media.size(); ++m) {
        const Medium& medium = media[m];
        if (is_black(medium.emission.value)) continue;
        Source source{std::uint16_t(m), {}, {}, {}, {}, {1, 1, 1}, 0};
        if (medium.extinction.grid) {
            const Cube cube((medium.emission.grid ? medium.emission : medium.extinction).to_grid);
            source.corner = cube.corner, source.x = cube.x, source.y = cube.y, source.z = cube.z;
            source.volume = cube.volume;
        } else if (!boxes[m].empty()) {
            const Vec3 sides = boxes[m].size();
            source.corner = boxes[m].low;
            source.x = {sides.x, 0, 0}, source.y = {0, sides.y, 0}, source.z = {0, 0, sides.z};
            source.volume = double{sides.x} * sides.y * sides.z;
        }
        if (source.volume > 0) add(source, medium.emission, powers);
    }
    power_ = prefix_cdf(powers, ends_);
}

void Glow::add(const Source& source, const VolumeField& emission, std::vector<double>& powers) {
    const auto number = std::uint32_t(sources_.size());
    Source& added = sources_.emplace_back(source);
    // without a grid of its extinction a medium is the same everywhere
    const bool uneven = emission.grid && media_[source.medium].extinction.grid;
    const CollisionBounds bounds = uneven ? CollisionBounds(emission) : CollisionBounds();
    if (uneven) added.cells = bounds.cells();
    const std::uint32_t count = added.cells[0] * added.cells[1] * added.cells[2];
    added.volume /= count;
    for (std::uint32_t cell = 0; cell < count; ++cell) {
        const float most = uneven ? bounds.most(cell) : max_component(emission.value);
        if (!(most > 0)) continue;
        cells_.push_back({number, cell});
        powers.push_back(all_directions * most * added.volume);
    }
}

std::optional<Glow::Spark> Glow::spark(float choice, Vec2 place) const {
    if (cells_.empty()) return std::nullopt;
    const std::size_t which = pick(ends_, choice);  // what is left of the choice is the place's third number
    const float chance = share_of(ends_, which);
    const auto [number, index] = cells_[which];
    const Source& source = sources_[number];
    const std::uint32_t wide = source.cells[0], high = source.cells[1];
    const auto part = [](std::uint32_t cell, float u, std::uint32_t cells) { return (float(cell) + u) / float(cells); };
    const Vec3 position = source.corner + source.x * part(index % wide, place.x, wide) +
                          source.y * part(index / wide % high, place.y, high) +
                          source.z * part(index / wide / high, choice, source.cells[2]);
    const Medium& medium = media_[source.medium];
    const Rgb emission = medium.extinction.grid ? medium.emission.at(position) : medium.emission.value;
    if (is_black(emission)) return std::nullopt;
    return Spark{position, source.medium, emission * float(all_directions * source.volume / chance)};
}

}  // namespace lightnet
