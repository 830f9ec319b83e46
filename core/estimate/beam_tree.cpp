#include "core/estimate/beam_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/math/sampling.hpp"

namespace lightnet {
namespace {

auto rank(const PhotonBeam& beam) {
    return std::tuple(beam.from.x, beam.from.y, beam.from.z, beam.along.x, beam.along.y, beam.along.z, beam.length,
                      beam.flux.r, beam.flux.g, beam.flux.b, beam.group);
}

Vec3 middle(const PhotonBeam& beam) { return beam.from + beam.along * (0.5f * beam.length); }

float distance2(const Box& box, Vec3 position) {
    float sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float off = std::max(std::max(box.low[axis] - position[axis], position[axis] - box.high[axis]), 0.0f);
        sum += off * off;
    }
    return sum;
}

}  // namespace

BeamTree::BeamTree(std::vector<PhotonBeam> beams) : beams_(std::move(beams)) {
    if (beams_.empty()) return;
    build(0, static_cast<std::uint32_t>(beams_.size()));
    put_in_columns();
}

void BeamTree::build(std::uint32_t first, std::uint32_t count) {
    Box box, middles;
    for (std::uint32_t i = first; i < first + count; ++i) {
        box.add(beams_[i].from), box.add(beams_[i].to());
        middles.add(middle(beams_[i]));
    }
    const std::size_t at = nodes_.size();
    nodes_.push_back({box, first, 0});
    if (count <= leaf_beams) return;
    const std::size_t axis = middles.longest_axis();
    // All leaves but one are full.
    const std::uint32_t leaves = (count + leaf_beams - 1) / leaf_beams;
    const std::uint32_t half = leaves / 2 * static_cast<std::uint32_t>(leaf_beams);
    const auto begin = beams_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [axis](const PhotonBeam& a, const PhotonBeam& b) {
        const float x = middle(a)[axis], y = middle(b)[axis];
        return x != y ? x < y : rank(a) < rank(b);
    });
    build(first, half);
    nodes_[at].beyond = static_cast<std::uint32_t>(nodes_.size());
    build(first + half, count - half);
}

void BeamTree::put_in_columns() {
    leaves_.resize((beams_.size() + leaf_beams - 1) / leaf_beams);
    for (std::size_t i = 0; i < beams_.size(); ++i) {
        Columns& leaf = leaves_[i / leaf_beams];
        const std::size_t k = i % leaf_beams;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            leaf.from[axis][k] = beams_[i].from[axis];
            leaf.along[axis][k] = beams_[i].along[axis];
        }
        leaf.length[k] = beams_[i].length;
    }
}

// Squared distances from a point to the lines of beams; infinite where it lies before their beginning or beyond their
// end.
void BeamTree::offer_leaf(std::size_t leaf, Vec3 position, Nearest& scratch) const {
    constexpr float beyond = std::numeric_limits<float>::infinity();
    const Columns& beams = leaves_[leaf];
    std::array<float, leaf_beams> distances2;
    for (std::size_t i = 0; i < leaf_beams; ++i) {
        const float x = position.x - beams.from[0][i], y = position.y - beams.from[1][i],
                    z = position.z - beams.from[2][i];
        const float passed = x * beams.along[0][i] + y * beams.along[1][i] + z * beams.along[2][i];
        const float off_x = x - beams.along[0][i] * passed, off_y = y - beams.along[1][i] * passed,
                    off_z = z - beams.along[2][i] * passed;
        const float off = off_x * off_x + off_y * off_y + off_z * off_z;
        distances2[i] = (passed >= 0) & (passed < beams.length[i]) ? off : beyond;
    }
    scratch.offer(distances2, static_cast<std::uint32_t>(leaf * leaf_beams));
}

std::span<const Nearest::Item> BeamTree::find(Vec3 position, float radius, std::size_t most, Nearest& scratch) const {
    scratch.begin(most, radius * radius);
    if (nodes_.empty()) return {};
    struct Waiting {
        float distance2;
        std::uint32_t node;
    };
    std::array<Waiting, 64> waiting;  // by halves, so less deep than that
    std::size_t count = 0;
    waiting[count++] = {0, 0};
    while (count > 0) {
        const auto [least, at] = waiting[--count];
        if (least > scratch.limit()) continue;
        const Node& node = nodes_[at];
        if (node.beyond == 0) {
            offer_leaf(node.first / leaf_beams, position, scratch);
            continue;
        }
        const Waiting one{distance2(nodes_[at + 1].box, position), at + 1},
            other{distance2(nodes_[node.beyond].box, position), node.beyond};
        const bool one_first = one.distance2 <= other.distance2;
        waiting[count++] = one_first ? other : one;
        waiting[count++] = one_first ? one : other;
    }
    return scratch.sorted([this](std::uint32_t a, std::uint32_t b) { return rank(beams_[a]) < rank(beams_[b]); });
}

void BeamTree::radiance(const Gathering& at, float radius, std::size_t most, Nearest& scratch,
                        std::span<Rgb> to) const {
    if (!(at.bsdf.lobes() & at.lobes)) return;
    const auto found = find(at.point.position, radius, most, scratch);
    const float r2 = most && found.size() == most ? found.back().distance2 : radius * radius;
    if (found.empty() || !(r2 > 0)) return;
    for (const auto& item : found) {
        const PhotonBeam& beam = beams_[item.index];
        const Rgb left = left_after(&beam.extinction, dot(at.point.position - beam.from, beam.along));
        const Rgb scattered = at.bsdf.evaluate(at.outgoing, -beam.along, at.lobes);
        to[to.size() == 1 ? 0 : beam.group] += beam.flux * left * scattered * (1 - item.distance2 / r2);
    }
    for (Rgb& sum : to) sum = sum * (2 / (pi * r2));
}

}  // namespace lightnet
