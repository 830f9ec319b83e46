#include "core/scene/bsdf/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/math/sampling.hpp"

namespace lightnet {
namespace {

/// Between +z and a unit vector; without acos(), which knows little of small angles.
float angle_to_z(Vec3 d) {
    const float gap = std::sqrt(d.x * d.x + d.y * d.y + (d.z - 1) * (d.z - 1));
    return 2 * std::asin(std::min(1.0f, 0.5f * gap));
}

float square_of_angle(float angle) { return std::sqrt(angle * 2 / pi); }
float square_of_turn(float turn) {
    const float whole = turn / (2 * pi) + 0.5f;
    return whole - std::floor(whole);
}

/// The two nodes around a number, and the share of the second one.
struct Nodes {
    std::uint32_t first = 0, second = 0;
    float share = 0;
};
Nodes nodes_around(const std::vector<float>& nodes, float at) {
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), at);
    const auto last = static_cast<std::uint32_t>(nodes.size() - 1);
    if (above == nodes.begin()) return {};
    if (above == nodes.end()) return {last, last, 0};
    const auto second = static_cast<std::uint32_t>(above - nodes.begin());
    return {second - 1, second, (at - nodes[second - 1]) / (nodes[second] - nodes[second - 1])};
}

TableBlend blend_of(const Nodes& azimuth, const Nodes& angle, std::size_t angles) {
    TableBlend blend;
    for (const auto& [a, a_share] : {std::pair(azimuth.first, 1 - azimuth.share), {azimuth.second, azimuth.share}})
        for (const auto& [b, b_share] : {std::pair(angle.first, 1 - angle.share), {angle.second, angle.share}})
            if (a_share * b_share > 0) {
                blend.table[blend.count] = static_cast<std::uint32_t>(a * angles + b);
                blend.share[blend.count++] = a_share * b_share;
            }
    return blend;
}

Hash content_of(const Measurement::Numbers& n) {
    Hasher hasher;
    const auto add = [&](const auto&... lists) {
        const auto one = [&](const auto& list) {
            const std::uint64_t size = list.size();
            hasher.add(std::as_bytes(std::span(&size, 1)));
            hasher.add(std::as_bytes(std::span(list)));
        };
        (one(lists), ...);
    };
    add(n.azimuths, n.angles, n.facets, n.areas, n.seen, n.light, n.colours);
    add(std::vector<std::uint32_t>{n.facet_grid.wide, n.area_grid.wide, n.seen_grid.wide, n.light_grid.wide,
                                   n.times_facets ? 1u : 0u, n.folds});
    return hasher.finish();
}

}  // namespace

/// A viewer in the measurement's own coordinates.
struct Measurement::Seen {
    Vec3 outgoing;
    float flip_x = 1, flip_y = 1;  // from ours to those of the measurement, and back
    float turn = 0;                // from which facets are counted
    float scale = 1;               // of colours, times the density of facets
    TableBlend blend;

    Vec3 folded(Vec3 d) const { return {d.x * flip_x, d.y * flip_y, d.z}; }
};

Measurement::Measurement(Numbers numbers)
    : numbers_(std::move(numbers)),
      seen_(numbers_.seen_grid, numbers_.seen),
      light_(numbers_.light_grid, numbers_.light),
      content_(content_of(numbers_)) {
    numbers_.seen = {}, numbers_.light = {};
}

Measurement::Seen Measurement::seen_from(Vec3 outgoing) const {
    Seen seen;
    if (numbers_.folds == 2 && outgoing.y > 0) seen.flip_x = seen.flip_y = -1;
    if (numbers_.folds == 4) seen.flip_x = outgoing.x > 0 ? -1.0f : 1.0f, seen.flip_y = outgoing.y > 0 ? -1.0f : 1.0f;
    seen.outgoing = seen.folded(outgoing);
    const float angle = angle_to_z(seen.outgoing), azimuth = std::atan2(seen.outgoing.y, seen.outgoing.x);
    if (isotropic()) seen.turn = azimuth;
    seen.blend = blend_of(nodes_around(numbers_.azimuths, azimuth), nodes_around(numbers_.angles, angle),
                          numbers_.angles.size());
    if (numbers_.times_facets) {
        const float area =
            bilinear(numbers_.areas, numbers_.area_grid, {square_of_angle(angle), square_of_turn(azimuth)});
        seen.scale = area > 1e-12f ? 1 / (4 * area) : 0;
    }
    return seen;
}

Rgb Measurement::colour(Vec2 place, const TableBlend& blend) const {
    const GridSize size = numbers_.light_grid;
    const auto [x, y, right, down] = cell_of(size, place);
    Rgb sum;
    for (std::uint32_t i = 0; i < blend.count; ++i) {
        const Rgb* upper = &numbers_.colours[blend.table[i] * size.nodes() + std::size_t{y} * size.wide + x];
        const Rgb* lower = upper + size.wide;
        sum += ((upper[0] * (1 - right) + upper[1] * right) * (1 - down) +
                (lower[0] * (1 - right) + lower[1] * right) * down) *
               blend.share[i];
    }
    return {std::max(0.0f, sum.r), std::max(0.0f, sum.g), std::max(0.0f, sum.b)};
}

BsdfValue Measurement::value(Vec3 outgoing, Vec3 incoming) const {
    const Seen seen = seen_from(outgoing);
    const Vec3 facet = normalize(seen.outgoing + seen.folded(incoming));
    const float cosine = dot(seen.outgoing, facet);
    if (!(cosine > 0)) return {};
    const Vec2 place{square_of_angle(angle_to_z(facet)), square_of_turn(std::atan2(facet.y, facet.x) - seen.turn)};
    const auto [u, density] = seen_.invert(place, seen.blend);

    float scale = seen.scale;
    if (numbers_.times_facets) scale *= bilinear(numbers_.facets, numbers_.facet_grid, place);
    // how much of the sphere a piece of the square stands for, and from facets to directions
    const float sine = std::sqrt(facet.x * facet.x + facet.y * facet.y);
    const float stretch = std::max(2 * pi * pi * place.x * sine, 1e-6f) * 4 * cosine;
    return {colour(u, seen.blend) * scale, density * light_.density(u, seen.blend) / stretch};
}

Vec3 Measurement::sample_facet(Vec3 outgoing, Vec2 u) const {
    const Seen seen = seen_from(outgoing);
    const Vec2 place = seen_.sample(light_.sample(u, seen.blend).place, seen.blend).place;
    const float angle = place.x * place.x * pi / 2, turn = (2 * place.y - 1) * pi + seen.turn;
    const float sine = std::sin(angle);
    return seen.folded({std::cos(turn) * sine, std::sin(turn) * sine, std::cos(angle)});
}

}  // namespace lightnet
