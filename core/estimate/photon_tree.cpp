#include "core/estimate/photon_tree.hpp"

#include "core/base/math/columns.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/unwanted.hpp"
#include "core/estimate/photon_order.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t width = Nearest::width;  // photons of a leaf
constexpr std::size_t fan = 8;                 // boxes in a box
constexpr std::size_t least_shared = 1 << 15;  // photons that are worth a second builder
constexpr std::size_t leaves_at_once = 128;    // whose photons stay in the nearest caches
constexpr float grazing = 0.02f;               // cosine below which light is taken to arrive at this one
constexpr float out_of_reach = std::numeric_limits<float>::infinity(), visited = out_of_reach;

// How many of the leaves come first: so many that the leaves of every box follow one another.
std::size_t first_half(std::size_t leaves) {
    std::size_t of_box = 1;  // leaves of the boxes in the smallest box that has all these
    while (of_box * fan < leaves) of_box *= fan;
    return ((leaves + of_box - 1) / of_box + 1) / 2 * of_box;
}

void sort_proxies(std::span<PhotonProxy> proxies, std::size_t leaves, const Photon* photons) {
    if (leaves == 1) return sort_few(proxies, ByProxy{0, photons});
    const std::size_t left = first_half(leaves);
    halve(proxies, left * width, ByProxy{longest_axis(std::span<const PhotonProxy>(proxies)), photons});
    sort_proxies(proxies.first(left * width), left, photons);
    sort_proxies(proxies.subspan(left * width), leaves - left, photons);
}

}  // namespace

/// What a photon brings.
struct PhotonTree::Light {
    Rgb flux;
    std::uint32_t incoming;
};

/// Photons: by what they are found, coordinate by coordinate, before what they bring.
struct PhotonTree::Leaf {
    using Floats = std::array<float, width>;
    Floats x, y, z;
    std::array<std::uint32_t, width> surface;
    std::array<Light, width> light;
};

/// Boxes side by side in a greater one.
struct PhotonTree::Boxes {
    using Floats = std::array<float, fan>;
    std::array<Floats, 3> least, most;
};

PhotonTree::PhotonTree(Photons photons, Builders& builders) : size_(photons.size()), photons_(std::move(photons)) {
    static_assert(sizeof(Leaf) == width * sizeof(Photon) && alignof(Leaf) == alignof(Photon) && width == room);
    Photon none;
    none.position = Vec3{1, 1, 1} * std::numeric_limits<float>::quiet_NaN();
    photons_.resize((size_ + width - 1) / width * width, none);
    if (size_ == 0) return;
    sort(builders);
    put_in_boxes();
}

PhotonTree::~PhotonTree() = default;
PhotonTree::PhotonTree(PhotonTree&&) noexcept = default;

const PhotonTree::Leaf& PhotonTree::leaf(std::size_t i) const {
    return *std::launder(reinterpret_cast<const Leaf*>(photons_.data() + i * width));
}

const PhotonTree::Light& PhotonTree::light_of(std::size_t i) const { return leaf(i / width).light[i % width]; }

Photon PhotonTree::operator[](std::size_t i) const {
    const Leaf& leaf = this->leaf(i / width);
    const std::size_t k = i % width;
    Photon photon;
    photon.position = {leaf.x[k], leaf.y[k], leaf.z[k]};
    photon.flux = leaf.light[k].flux;
    photon.incoming = leaf.light[k].incoming;
    photon.surface = leaf.surface[k];
    return photon;
}

// What happens in one part changes nothing in the others: so builders share the halves of what is large, level by
// level, and then all the rest.
void PhotonTree::sort(Builders& builders) {
    std::vector<Part> large, small;
    const auto add = [&](Part part) { (part.leaves * width > least_shared ? large : small).push_back(part); };
    add({0, photons_.size() / width});
    while (!large.empty()) {
        std::vector<std::array<Part, 2>> halves(large.size());
        builders.each(large.size(), [&](std::size_t i) { halves[i] = halved(large[i]); });
        large.clear();
        for (const auto& both : halves) std::ranges::for_each(both, add);
    }
    builders.each(small.size(), [&](std::size_t i) { sort(small[i]); });
}

// Halves photons until there is a leaf of them.
void PhotonTree::sort(Part part) {
    if (part.leaves <= leaves_at_once) return put_in_leaves(part);
    for (const Part half : halved(part)) sort(half);
}

// Puts the photons that lie lower along the longest side before the others.
std::array<PhotonTree::Part, 2> PhotonTree::halved(Part part) {
    end_if_unwanted();
    const auto [first, leaves] = part;
    const std::size_t low = first * width, high = std::min(low + leaves * width, size_);
    const auto photons = std::span(photons_).subspan(low, high - low);
    const std::size_t left = first_half(leaves);
    halve(photons, left * width, ByPhoton{longest_axis(std::span<const Photon>(photons))});
    return {Part{first, left}, Part{first + left, leaves - left}};
}

// The same for so few that they stay in the cache: where they are is moved, and they follow in the end.
void PhotonTree::put_in_leaves(Part part) {
    end_if_unwanted();
    const auto [first, leaves] = part;
    const std::size_t low = first * width, high = std::min(low + leaves * width, size_);
    const std::vector<Photon> photons(photons_.begin() + std::ptrdiff_t(low), photons_.begin() + std::ptrdiff_t(high));
    std::vector<PhotonProxy> proxies;
    proxies.reserve(photons.size());
    for (const Photon& photon : photons) proxies.push_back({photon.position, std::uint32_t(proxies.size())});
    sort_proxies(proxies, leaves, photons.data());
    for (std::size_t i = 0; i < proxies.size(); ++i) photons_[low + i] = photons[proxies[i].photon];
    for (std::size_t leaf = first; leaf < first + leaves; ++leaf) put_in_columns(leaf);
}

void PhotonTree::put_in_columns(std::size_t leaf) {
    Leaf columns;
    for (std::size_t k = 0; k < width; ++k) {
        const Photon& photon = photons_[leaf * width + k];
        columns.x[k] = photon.position.x;
        columns.y[k] = photon.position.y;
        columns.z[k] = photon.position.z;
        columns.surface[k] = photon.surface;
        columns.light[k] = {photon.flux, photon.incoming};
    }
    std::memcpy(static_cast<void*>(photons_.data() + leaf * width), &columns, sizeof columns);
}

// How many boxes or leaves are in one, which may be the last of its level.
std::size_t PhotonTree::children(std::size_t level, std::size_t at) const {
    const std::size_t inside = level == 0 ? photons_.size() / width : levels_[level - 1].size();
    return std::min(fan, inside - at * fan);
}

void PhotonTree::put_in_boxes() {
    const auto groups = [](std::size_t count) { return (count + fan - 1) / fan; };
    const std::size_t leaves = photons_.size() / width;
    levels_.emplace_back(groups(leaves));
    for (std::size_t i = 0; i < leaves; ++i) {
        if (i % leaves_at_once == 0) end_if_unwanted();
        const Leaf& inside = leaf(i);
        Boxes& boxes = levels_[0][i / fan];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& values = axis == 0 ? inside.x : axis == 1 ? inside.y : inside.z;
            float least = values[0], most = least;
            for (const float value : values) {  // also those that are no numbers, as no photons are there
                least = value < least ? value : least;
                most = value > most ? value : most;
            }
            boxes.least[axis][i % fan] = least;
            boxes.most[axis][i % fan] = most;
        }
    }
    for (std::size_t count = levels_[0].size(); count > 1; count = groups(count)) {
        const auto& inside = levels_.back();
        Level level(groups(count));
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto all = std::ptrdiff_t(children(levels_.size() - 1, i));
                const auto &least = inside[i].least[axis], &most = inside[i].most[axis];
                level[i / fan].least[axis][i % fan] = *std::min_element(least.begin(), least.begin() + all);
                level[i / fan].most[axis][i % fan] = *std::max_element(most.begin(), most.begin() + all);
            }
        levels_.push_back(std::move(level));
    }
}

class PhotonTree::Search {
public:
    Search(const PhotonTree& tree, const Wanted& wanted, Nearest& found) : tree_(tree), wanted_(wanted), found_(found) {
        found_.begin(wanted.most, std::min(wanted.radius * wanted.radius, std::numeric_limits<float>::max()));
    }

    void visit(std::size_t level, std::size_t at) {
        const std::size_t count = tree_.children(level, at), first = at * fan;
        Bounds bounds{tree_.levels_[level][at], wanted_, {}};
        work_in_lanes(bounds);
        if (level == 0)
            for (std::size_t i = 0; i < count; ++i)
                if (bounds.distance2[i] <= found_.limit()) fetch(tree_.leaf(first + i));
        for (std::size_t visits = 0; visits < count; ++visits) {
            std::size_t next = 0;
            for (std::size_t i = 1; i < count; ++i) next = bounds.distance2[i] < bounds.distance2[next] ? i : next;
            if (!(bounds.distance2[next] <= found_.limit())) return;
            bounds.distance2[next] = visited;
            level == 0 ? visit_leaf(first + next) : visit(level - 1, first + next);
        }
    }

private:
    // Distances of a leaf's photons as they are counted; infinite for those on surfaces that are turned elsewhere.
    struct Distances {
        const Leaf& leaf;
        Vec3 at, normal;
        Leaf::Floats distance2;

        [[gnu::always_inline]] void work() {
            for (std::size_t i = 0; i < width; ++i) {
                const Vec3 offset = Vec3{leaf.x[i], leaf.y[i], leaf.z[i]} - at;
                const bool alike = turned_alike(Photon::cosine_between(leaf.surface[i], normal));
                distance2[i] = PhotonTree::distance2(offset, normal) + (alike ? 0 : out_of_reach);
            }
        }
    };

    // Ahead of time what a leaf is judged by, as a map does not fit into the nearest caches.
    static void fetch(const Leaf& leaf) {
        for (const void* part : {leaf.x.data(), leaf.y.data(), leaf.z.data()}) __builtin_prefetch(part);
        __builtin_prefetch(leaf.surface.data());
    }

    void visit_leaf(std::size_t leaf) {
        Distances distances{tree_.leaf(leaf), wanted_.position, wanted_.normal, {}};
        work_in_lanes(distances);
        if (!wanted_.when.whole()) leave_out_other_times(distances);
        found_.offer(distances.distance2, std::uint32_t(leaf * width));
    }

    void leave_out_other_times(Distances& distances) const {
        for (std::size_t i = 0; i < width; ++i)
            if (!wanted_.when.has(Photon::time_in(distances.leaf.light[i].incoming).instant))
                distances.distance2[i] = out_of_reach;
    }

    // No photon in a box is nearer, as it is counted: each step rounds a greater number to no smaller one, and is the
    // same for photons.
    struct Bounds {
        const Boxes& boxes;
        const Wanted& wanted;
        Boxes::Floats distance2;

        [[gnu::always_inline]] void work() {
            const Vec3 at = wanted.position, normal = wanted.normal;
            for (std::size_t i = 0; i < fan; ++i) {
                const Vec3 low = Vec3{boxes.least[0][i], boxes.least[1][i], boxes.least[2][i]} - at;
                const Vec3 high = Vec3{boxes.most[0][i], boxes.most[1][i], boxes.most[2][i]} - at;
                const Vec3 out{outside(low.x, high.x), outside(low.y, high.y), outside(low.z, high.z)};
                const Vec3 a{low.x * normal.x, low.y * normal.y, low.z * normal.z};
                const Vec3 b{high.x * normal.x, high.y * normal.y, high.z * normal.z};
                const float least = lesser(a.x, b.x) + lesser(a.y, b.y) + lesser(a.z, b.z);
                const float most = greater(a.x, b.x) + greater(a.y, b.y) + greater(a.z, b.z);
                const float height = outside(least, most);
                distance2[i] = length_squared(out) + height_counts * height * height;
            }
        }
        // How far a range is from zero.
        static float outside(float low, float high) { return greater(greater(low, -high), 0); }
        static float lesser(float a, float b) { return a < b ? a : b; }
        static float greater(float a, float b) { return a > b ? a : b; }
    };

    const PhotonTree& tree_;
    const Wanted& wanted_;
    Nearest& found_;
};

std::span<const Nearest::Item> PhotonTree::find(const Wanted& wanted, Nearest& scratch) const {
    Search search(*this, wanted, scratch);
    if (size_ > 0) search.visit(levels_.size() - 1, 0);
    // Indices would differ between the trees of all photons and of some.
    return scratch.sorted([this](auto a, auto b) { return comes_before((*this)[a], (*this)[b]); });
}

namespace {

// What a surface makes of light that arrives, of many photons at once.
struct Arrivals {
    Arrivals(const PhotonTree::Lookup& lookup, float square) : at(lookup), r2(square) {}

    const PhotonTree::Lookup& at;
    float r2;  // m², of the disc
    std::size_t count = 0;
    std::array<std::uint32_t, lanes> packed;
    Column distance2;

    Columns3 incoming;
    Column share;  // of the kernel's height, for an area of the surface as it is, not as it is shaded
    Column pdf;    // of a diffuse surface

    [[gnu::always_inline]] void work() {
        const Vec3 normal = at.point.normal, shading = at.bsdf.shading().z, outgoing = at.outgoing;
        const bool one_sided = at.bsdf.one_sided();
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 towards_light = Photon::unpacked_direction(packed[i]);
            const float cosine = std::fabs(dot(towards_light, normal));
            incoming.set(i, towards_light);
            share[i] = (1 - distance2[i] / r2) / (cosine > grazing ? cosine : grazing);
            pdf[i] = diffuse_pdf(shading, normal, one_sided, outgoing, towards_light);
        }
    }
};

}  // namespace

Rgb PhotonTree::radiance(const Lookup& at, float radius, std::size_t most, Nearest& scratch) const {
    Rgb all;
    radiance(at, radius, most, scratch, {&all, 1});
    return all;
}

void PhotonTree::radiance(const Lookup& at, float radius, std::size_t most, Nearest& scratch, std::span<Rgb> to) const {
    if (!(at.bsdf.lobes() & at.lobes)) return;
    const auto found = find({at.point.position, at.point.normal, radius, most, at.when}, scratch);
    const float r2 = most && found.size() == most ? found.back().distance2 : radius * radius;
    if (found.empty() || !(r2 > 0)) return;
    const Rgb* albedo = at.bsdf.diffuse_albedo();
    Arrivals many(at, r2);
    for (std::size_t first = 0; first < found.size(); first += lanes) {
        many.count = std::min(lanes, found.size() - first);
        for (std::size_t i = 0; i < many.count; ++i) {
            many.packed[i] = light_of(found[first + i].index).incoming;
            many.distance2[i] = found[first + i].distance2;
        }
        work_in_lanes(many);
        for (std::size_t i = 0; i < many.count; ++i) {
            const auto index = found[first + i].index;
            const Rgb flux = light_of(index).flux * many.share[i];
            Rgb& sum = to.size() == 1 ? to[0] : to[Photon::group_in(leaf(index / width).surface[index % width])];
            if (albedo)
                sum += flux * many.pdf[i];
            else
                sum += flux * at.bsdf.evaluate(at.outgoing, many.incoming[i], at.lobes);
        }
    }
    for (Rgb& sum : to) sum = sum * (albedo ? *albedo : Rgb{1, 1, 1}) * (2 / (pi * r2) / at.when.part());
}

}  // namespace lightnet
