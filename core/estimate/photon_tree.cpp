#include "core/estimate/photon_tree.hpp"

#include "core/math/sampling.hpp"

#include <algorithm>
#include <thread>
#include <tuple>
#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t leaf = 8;                // photons that are looked at one by one
constexpr std::size_t least_shared = 1 << 15;  // photons that are worth a thread
constexpr float height_counts = 15;            // of a height squared, beside its part of the distance: a flat ellipsoid
constexpr float least_cosine = 0.7f;           // between normals of a surface that is taken for the same one
constexpr float grazing = 0.02f;               // cosine below which light is taken to arrive at this one

// By all that a photon is, so that the order can't depend on how the library sorts.
bool comes_before(const Photon& a, const Photon& b, std::size_t axis) {
    const float x = a.position[axis], y = b.position[axis];
    if (x != y) return x < y;
    const auto rank = [](const Photon& p) {
        return std::tuple(p.position.x, p.position.y, p.position.z, p.incoming, p.flux.r, p.flux.g, p.flux.b);
    };
    return rank(a) < rank(b);
}

}  // namespace

PhotonTree::PhotonTree(std::vector<Photon> photons, std::size_t threads)
    : photons_(std::move(photons)), axes_(photons_.size()) {
    build(0, photons_.size(), std::clamp<std::size_t>(threads, 1, std::max(1u, std::thread::hardware_concurrency())));
}

// Indices would differ between the trees of all photons and of some.
bool PhotonTree::comes_first(const Near& a, const Near& b) const {
    if (a.distance2 != b.distance2) return a.distance2 < b.distance2;
    return comes_before(photons_[a.index], photons_[b.index], 0);
}

// A subtree is a range, its root in the middle; what others do with other ranges changes nothing in it.
void PhotonTree::build(std::size_t low, std::size_t high, std::size_t threads) {
    const auto at = [&](std::size_t i) { return photons_.begin() + std::ptrdiff_t(i); };
    if (high - low <= leaf) {
        std::sort(at(low), at(high), [](const Photon& a, const Photon& b) { return comes_before(a, b, 0); });
        return;
    }
    Vec3 least = photons_[low].position, most = least;
    for (std::size_t i = low; i < high; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            least[axis] = std::min(least[axis], photons_[i].position[axis]);
            most[axis] = std::max(most[axis], photons_[i].position[axis]);
        }
    const Vec3 size = most - least;
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = low + (high - low) / 2;
    std::nth_element(at(low), at(middle), at(high),
                     [axis](const Photon& a, const Photon& b) { return comes_before(a, b, axis); });
    axes_[middle] = std::uint8_t(axis);
    if (threads < 2 || high - low < least_shared) {
        build(low, middle, 1);
        build(middle + 1, high, 1);
    } else {
        const std::jthread other([=, this] { build(low, middle, threads / 2); });
        build(middle + 1, high, threads - threads / 2);
    }
}

class PhotonTree::Search {
public:
    Search(const PhotonTree& tree, const Wanted& wanted, std::vector<Near>& found)
        : tree_(tree), wanted_(wanted), found_(found), limit_(wanted.radius * wanted.radius) {}

    void look(std::size_t low, std::size_t high) {
        if (high - low <= leaf) {
            for (std::size_t i = low; i < high; ++i) consider(i);
            return;
        }
        const std::size_t middle = low + (high - low) / 2, axis = tree_.axes_[middle];
        const float beyond = wanted_.position[axis] - tree_.photons_[middle].position[axis];
        if (beyond < 0) {
            look(low, middle);
            if (beyond * beyond > limit_) return;
            consider(middle);
            look(middle + 1, high);
        } else {
            look(middle + 1, high);
            if (beyond * beyond > limit_) return;
            consider(middle);
            look(low, middle);
        }
    }

private:
    void consider(std::size_t i) {
        const Photon& photon = tree_.photons_[i];
        const Vec3 way = photon.position - wanted_.position;
        const float height = dot(way, wanted_.normal);
        const Near near{length_squared(way) + height_counts * height * height, std::uint32_t(i)};
        if (!(near.distance2 <= limit_) || std::fabs(photon.cosine_to(wanted_.normal)) < least_cosine) return;
        if (!wanted_.most) {
            found_.push_back(near);
            return;
        }
        if (found_.size() == wanted_.most) {
            if (!tree_.comes_first(near, found_.front())) return;
            std::pop_heap(found_.begin(), found_.end(), order_);
            found_.back() = near;
            std::push_heap(found_.begin(), found_.end(), order_);
        } else {
            found_.push_back(near);
            std::push_heap(found_.begin(), found_.end(), order_);
        }
        if (found_.size() == wanted_.most) limit_ = found_.front().distance2;
    }

    struct Order {
        const PhotonTree& tree;
        bool operator()(const Near& a, const Near& b) const { return tree.comes_first(a, b); }
    };

    const PhotonTree& tree_;
    Order order_{tree_};
    const Wanted& wanted_;
    std::vector<Near>& found_;  // a heap while there is a `most`
    float limit_;
};

void PhotonTree::find(const Wanted& wanted, std::vector<Near>& found) const {
    found.clear();
    Search(*this, wanted, found).look(0, photons_.size());
    std::sort(found.begin(), found.end(), [this](const Near& a, const Near& b) { return comes_first(a, b); });
}

Rgb PhotonTree::radiance(const Lookup& at, float radius, std::size_t most, std::vector<Near>& scratch) const {
    const Vec3 normal = at.point.normal;
    find({at.point.position, normal, radius, most}, scratch);
    const float r2 = most && scratch.size() == most ? scratch.back().distance2 : radius * radius;
    if (scratch.empty() || !(r2 > 0)) return {};
    Rgb sum;
    for (const Near& near : scratch) {
        const Photon& photon = photons_[near.index];
        const Vec3 incoming = photon.towards_light();
        const Rgb scattered = at.bsdf.evaluate(at.outgoing, incoming, at.lobes);
        // flux arrived per area of the surface as it is, not as it is shaded
        const float cosine = std::max(std::fabs(dot(incoming, normal)), grazing);
        sum += scattered * photon.flux * ((1 - near.distance2 / r2) / cosine);
    }
    return sum * (2 / (pi * r2));
}

}  // namespace lightnet
