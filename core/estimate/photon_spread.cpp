#include "core/estimate/photon_spread.hpp"

#include "core/base/math/frame.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t pilot_photons = 8;  // that a disc of the pilot has
// What is less than an eighth of its disc, such as a wire, stays too dark: its few photons would be so bright that each
// makes a spot of its own. Who misses as often counts as many as make corners right on average, a quarter of a disc.
constexpr std::uint32_t most_tries = 8, when_all_miss = 12;
constexpr float narrow = 0.25f;           // of the radius: from below such a ceiling nobody sees how far a surface goes
constexpr float rounding = 1.001f;        // of squares of distances

// As densely as Epanechnikov's kernel is high, in the unit disc.
Vec2 point_of_kernel(Vec2 u) {
    const Vec2 even = disk(u);
    const float square = even.x * even.x + even.y * even.y;
    if (!(square > 0)) return even;
    const float part = std::sqrt((1 - std::sqrt(std::max(0.0f, 1 - square))) / square);
    return {even.x * part, even.y * part};
}

}  // namespace

/// Where a photon is spread.
struct PhotonSpread::Disc {
    Vec3 position, normal;  // of the side that the light came from
    float radius;
    Vec3 eye;  // above it, in the free

    Ray ray_to(Vec2 point) const {
        const Frame frame = Frame::around(normal);
        const Vec3 way = position + (frame.x * point.x + frame.y * point.y) * radius - eye;
        const float distance = length(way);
        return {eye, way / distance, 2 * distance};
    }
};

PhotonSpread::PhotonSpread(const Scene& scene, std::shared_ptr<const PhotonTree> pilot, std::size_t gather,
                           double times, float most)
    : scene_(scene),
      pilot_(std::move(pilot)),
      scale_(float(double(gather) / (double(pilot_photons) * times))),
      most_(most) {}

float PhotonSpread::radius_of(const Photon& photon, Nearest& scratch) const {
    if (!(scale_ > 0)) return most_;
    const auto found =
        pilot_->find({photon.position, photon.normal(), most_ / std::sqrt(scale_), pilot_photons}, scratch);
    return found.size() < pilot_photons ? most_ : std::sqrt(found.back().distance2 * scale_);
}

std::vector<PhotonSpread::Disc> PhotonSpread::discs_of(std::span<const Photon> photons) const {
    std::vector<Disc> discs;
    std::vector<Ray> rays;
    Nearest scratch;
    for (const Photon& photon : photons) {
        Vec3 normal = photon.normal();
        if (dot(normal, photon.towards_light()) < 0) normal = -normal;
        const float radius = radius_of(photon, scratch);
        rays.push_back({photon.position + normal * offset_at(photon.position, 0), normal, radius});
        discs.push_back({photon.position, normal, radius, {}});
    }
    std::vector<std::optional<Hit>> ceilings(rays.size());
    scene_.intersect(rays, ceilings);
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const float free = ceilings[i] ? ceilings[i]->distance : discs[i].radius;
        if (free < narrow * discs[i].radius) discs[i].radius = 0;
        discs[i].eye = rays[i].origin + discs[i].normal * (free / 2);
    }
    return discs;
}

// On a surface from which the photon is found: as PhotonTree::find() has it.
bool PhotonSpread::lands(const Disc& disc, const std::optional<Hit>& hit) const {
    if (!hit) return false;
    const SurfacePoint point = scene_.surface(*hit);
    return PhotonTree::distance2(disc.position - point.position, point.normal) <=
               rounding * disc.radius * disc.radius &&
           PhotonTree::turned_alike(dot(disc.normal, point.normal));
}

/// landed(photon, how many tries it took) of each that landed within so many tries.
template <class Landed>
void PhotonSpread::try_all(std::span<const Photon> photons, Key key, std::uint32_t tries, const Landed& landed) const {
    const auto discs = discs_of(photons);
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < discs.size(); ++i)
        if (discs[i].radius > 0)
            waiting.push_back(i);
        else
            landed(i, 1u);
    std::vector<Ray> rays;
    std::vector<std::optional<Hit>> hits;
    for (std::uint32_t done = 1; done <= tries && !waiting.empty(); ++done) {
        rays.clear();
        for (const std::size_t i : waiting)  // each with a key of its own, as points of one sequence avoid each other
            rays.push_back(discs[i].ray_to(point_of_kernel(Samples(child(key, i, done), 0).next_2d())));
        hits.resize(rays.size());
        scene_.intersect(rays, hits);
        std::size_t left = 0;
        for (std::size_t k = 0; k < waiting.size(); ++k) {
            const std::size_t i = waiting[k];
            if (lands(discs[i], hits[k]))
                landed(i, done);
            else
                waiting[left++] = i;
        }
        waiting.resize(left);
    }
}

void PhotonSpread::spread(std::span<Photon> photons, Key key) const {
    std::vector<std::uint32_t> tries(photons.size(), when_all_miss);
    try_all(photons, key, most_tries, [&](std::size_t i, std::uint32_t took) { tries[i] = took; });
    for (std::size_t i = 0; i < photons.size(); ++i) photons[i].flux *= float(tries[i]);
}

PhotonSpread::Missed PhotonSpread::missed(std::span<const Photon> photons, Key key) const {
    Missed sums;
    for (const Photon& photon : photons) sums.all += luminance(photon.flux);
    sums.missed = sums.all;
    try_all(photons, key, 1, [&](std::size_t i, std::uint32_t) { sums.missed -= luminance(photons[i].flux); });
    return sums;
}

}  // namespace lightnet
