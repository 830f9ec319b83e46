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
constexpr float narrow = 0.25f;      // of the radius: from below such a ceiling nobody sees how far a surface goes
constexpr float rounding = 1.001f;   // of squares of distances
constexpr float just_above = 0.02f;  // of the radius: lower than what stands on the surface
constexpr float wide_open = 4;       // radii: what is free as far as that somebody may look at

// As densely as Epanechnikov's kernel is high, in the unit disc.
Vec2 point_of_kernel(Vec2 u) {
    const Vec2 even = disk(u);
    const float square = even.x * even.x + even.y * even.y;
    if (!(square > 0)) return even;
    const float part = std::sqrt((1 - std::sqrt(std::max(0.0f, 1 - square))) / square);
    return {even.x * part, even.y * part};
}

// Photons don't keep of what shape their surface is, and their normals are rounded: further off than a ray needs to be
// that starts from a surface point.
Vec3 off_photon(Vec3 position, Vec3 normal) {
    return position + normal * (16 * rounding_step * largest_coordinate(position));
}

}  // namespace

/// Where a photon is spread.
struct PhotonSpread::Disc {
    Vec3 position, normal;  // of the side that the light came from
    float radius;
    Vec3 eye;          // above it, in the free
    ShutterTime time;  // at which the photon came

    Vec3 at(Vec2 point) const {
        const Frame frame = Frame::around(normal);
        return position + (frame.x * point.x + frame.y * point.y) * radius;
    }
    Ray ray_to(Vec2 point) const {
        const Vec3 way = at(point) - eye;
        const float distance = length(way);
        return {eye, way / distance, 2 * distance, time};
    }
    Ray down_at(Vec2 point) const {
        return {at(point) + normal * (just_above * radius), -normal, (just_above + PhotonTree::flatness) * radius,
                time};
    }
};

/// Of a point of its disc.
struct PhotonSpread::Try {
    std::size_t photon;
    Vec2 point, way_out;
    bool landed;
};

PhotonSpread::PhotonSpread(const Scene& scene, std::shared_ptr<const PhotonTree> pilot, std::size_t gather,
                           double times, float most)
    : scene_(scene),
      pilot_(std::move(pilot)),
      scale_(float(double(gather) / (double(pilot_photons) * times))),
      most_(most) {}

float PhotonSpread::radius_of(const Photon& photon, Nearest& scratch) const {
    if (!(scale_ > 0)) return most_;
    const PhotonWindow when = scene_.moves() ? window_of(photon.time(), photon_window) : PhotonWindow{};
    const auto found =
        pilot_->find({photon.position, photon.normal(), most_ / std::sqrt(scale_), pilot_photons, when}, scratch);
    return found.size() < pilot_photons ? most_ : std::sqrt(found.back().distance2 * scale_);
}

std::vector<PhotonSpread::Disc> PhotonSpread::discs_of(std::span<const Photon> photons) const {
    std::vector<Disc> discs;
    std::vector<Ray> rays;
    Nearest scratch;
    const bool moves = scene_.moves();
    for (const Photon& photon : photons) {
        Vec3 normal = photon.normal();
        if (dot(normal, photon.towards_light()) < 0) normal = -normal;
        const float radius = radius_of(photon, scratch);
        const ShutterTime time = moves ? photon.time().time() : ShutterTime(0);
        rays.push_back({off_photon(photon.position, normal), normal, radius, time});
        discs.push_back({photon.position, normal, radius, {}, time});
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

// Light also leaks behind what hides the surface, and is looked at there where it is open.
void PhotonSpread::look_behind(std::span<const Disc> discs, std::span<Try> tries) const {
    std::vector<Ray> rays;
    std::vector<Try*> missed;
    for (Try& one : tries)
        if (!one.landed) {
            missed.push_back(&one);
            rays.push_back(discs[one.photon].down_at(one.point));
        }
    std::vector<std::optional<Hit>> hits(rays.size());
    scene_.intersect(rays, hits);
    std::vector<Ray> ways_out;
    std::size_t left = 0;
    for (std::size_t k = 0; k < missed.size(); ++k) {
        const Disc& disc = discs[missed[k]->photon];
        if (!lands(disc, hits[k])) continue;
        const Vec3 out = Frame::around(disc.normal).to_world(cosine_hemisphere(missed[k]->way_out));
        const Vec3 position = scene_.surface(*hits[k]).position;
        ways_out.push_back({off_photon(position, disc.normal), out, wide_open * disc.radius, disc.time});
        missed[left++] = missed[k];
    }
    hits.resize(ways_out.size());
    scene_.intersect(ways_out, hits);
    for (std::size_t k = 0; k < left; ++k) missed[k]->landed = !hits[k];
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
    std::vector<Try> all;
    std::vector<Ray> rays;
    std::vector<std::optional<Hit>> hits;
    for (std::uint32_t done = 1; done <= tries && !waiting.empty(); ++done) {
        all.clear();
        rays.clear();
        for (const std::size_t i : waiting) {  // each with a key of its own, as points of one sequence avoid each other
            Samples samples(child(key, i, done), 0);
            const Vec2 point = point_of_kernel(samples.next_2d());
            all.push_back({i, point, samples.next_2d(), false});
            rays.push_back(discs[i].ray_to(point));
        }
        hits.resize(rays.size());
        scene_.intersect(rays, hits);
        for (std::size_t k = 0; k < all.size(); ++k) all[k].landed = lands(discs[all[k].photon], hits[k]);
        look_behind(discs, all);
        waiting.clear();
        for (const Try& one : all)
            if (one.landed)
                landed(one.photon, done);
            else
                waiting.push_back(one.photon);
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
