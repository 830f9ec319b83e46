#include "core/estimate/photon_shooter.hpp"

#include "core/base/error.hpp"
#include "core/scene/direct_light.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t ways_at_once = 1024;    // whose rays are traced together
constexpr std::uint32_t most_surfaces = 512;  // light can go round inside glass without loss

// Veach 1997, equation 5.19: where shading normals lean, light that is followed from its lamp isn't scattered as light
// that is followed from the eye. 1 where they don't.
float lean(const SurfacePoint& point, Vec3 arriving, Vec3 leaving) {
    const float shaded = std::fabs(dot(arriving, point.shading.z) * dot(leaving, point.normal));
    const float plain = std::fabs(dot(leaving, point.shading.z) * dot(arriving, point.normal));
    return plain > 0 ? std::min(shaded / plain, 10.0f) : 0;
}

}  // namespace

PhotonPaths photon_paths(const std::string& name) {
    if (name == "caustic") return PhotonPaths::caustic;
    if (name == "diffuse") return PhotonPaths::diffuse;
    if (name == "indirect") return PhotonPaths::indirect;
    if (name == "all") return PhotonPaths::all;
    throw Error("photons", "no light paths are called '" + name + "'");
}

std::string expression_of(PhotonPaths paths) {
    switch (paths) {
        case PhotonPaths::caustic:
            return "LS+D";
        case PhotonPaths::diffuse:
            return "L(S|D)*DS*D";
        case PhotonPaths::indirect:
            return "L(S|D)+D";
        case PhotonPaths::all:
            break;
    }
    return "L(S|D)*D";
}

struct PhotonShooter::Walk {
    Samples samples;
    std::uint32_t way;  // counted from the first
    Rgb flux;
    const Rgb* inside = nullptr;  // what it leads through
    bool met_mirror = false, met_rough = false;
};

struct PhotonShooter::Flock {
    std::vector<Walk> walks, before;
    std::vector<Ray> rays, rays_before;
    std::vector<std::optional<Hit>> hits;
};

bool PhotonShooter::keeps(bool met_mirror, bool met_rough) const {
    switch (paths_) {
        case PhotonPaths::caustic:
            return met_mirror && !met_rough;
        case PhotonPaths::diffuse:
            return met_rough;
        case PhotonPaths::indirect:
            return met_mirror || met_rough;
        case PhotonPaths::all:
            break;
    }
    return true;
}

template <class Keep>
void PhotonShooter::visit(Walk walk, const Ray& ray, const Hit& hit, const Keep& keep, Flock& flock) const {
    if (walk.inside) walk.flux *= left_after(walk.inside, hit.distance);
    const SurfacePoint point = scene_.surface(hit);
    const Bsdf bsdf = scene_.bsdf(point);
    const Vec3 arriving = -ray.direction;
    if ((bsdf.lobes() & lobe::rough) && keeps(walk.met_mirror, walk.met_rough)) keep(walk, point, arriving);
    const auto lobes = paths_ == PhotonPaths::caustic ? lobe::specular : lobe::all;
    if (!(bsdf.lobes() & lobes)) return;
    const float choice = bsdf.chooses() ? walk.samples.next() : walk.samples.skip();
    const auto step = bsdf.sample(arriving, choice, walk.samples.next_2d(), lobes);
    if (!step) return;
    float gain = step->transmitted ? step->eta * step->eta : 1;  // flux isn't squeezed as radiance is
    if (step->lobe != lobe::specular) gain *= lean(point, arriving, step->incoming);
    const Rgb flux = walk.flux * step->weight * gain;
    // Ways end by chance, so that what is left carries about as much as before. Jensen 2001, section 5.2.
    const float before = max_component(walk.flux), after = max_component(flux);
    const float chance = std::min(1.0f, after / before);
    if (!(walk.samples.next() < chance)) return;
    walk.flux = flux / chance;
    walk.inside = filling(bsdf, point, arriving, step->incoming, walk.inside);
    (step->lobe == lobe::specular ? walk.met_mirror : walk.met_rough) = true;
    flock.walks.push_back(walk);
    flock.rays.push_back({point.origin_towards(step->incoming), step->incoming});
}

template <class Keep>
void PhotonShooter::follow(std::uint64_t first, std::size_t count, float share, const Aim& aim, const Keep& keep,
                           std::vector<Aim::Choice>* chosen) const {
    Flock flock;
    for (std::size_t i = 0; i < count; ++i) {
        Samples samples(key_, static_cast<std::uint32_t>(first + i));
        const auto choice = aim.choose(samples);
        const auto& [numbers, weight] = choice;
        if (chosen) chosen->push_back(choice);
        const auto light = scene_.emit(numbers[0], {numbers[1], numbers[2]}, {numbers[3], numbers[4]});
        if (!light || !(max_component(light->flux) > 0)) continue;
        flock.walks.push_back({samples, static_cast<std::uint32_t>(i), light->flux * (weight * share)});
        flock.rays.push_back({light->origin, light->direction});
    }
    for (std::uint32_t surface = 0; !flock.walks.empty() && surface < most_surfaces; ++surface) {
        flock.hits.resize(flock.rays.size());
        scene_.intersect(flock.rays, flock.hits);
        flock.before.swap(flock.walks);
        flock.rays_before.swap(flock.rays);
        flock.walks.clear();
        flock.rays.clear();
        for (std::size_t i = 0; i < flock.before.size(); ++i)
            if (flock.hits[i]) visit(flock.before[i], flock.rays_before[i], *flock.hits[i], keep, flock);
    }
}

void PhotonShooter::shoot(std::uint64_t first, std::size_t count, double share, const Aim& aim,
                          std::vector<Photon>& out) const {
    const auto keep = [&](const Walk& walk, const SurfacePoint& point, Vec3 arriving) {
        out.emplace_back(point.position, walk.flux, arriving, point.normal);
    };
    for (std::size_t done = 0; done < count; done += ways_at_once)
        follow(first + done, std::min(ways_at_once, count - done), float(share), aim, keep, nullptr);
}

void PhotonShooter::attempt(std::uint64_t first, std::size_t count, const Aim& aim, std::vector<Trial>& out) const {
    for (std::size_t done = 0; done < count; done += ways_at_once) {
        std::vector<Aim::Choice> chosen;
        std::vector<float> gains(ways_at_once);
        // What the choice itself added to the flux is none of the gain.
        const auto keep = [&](const Walk& walk, const SurfacePoint&, Vec3) {
            gains[walk.way] += luminance(walk.flux) / chosen[walk.way].weight;
        };
        follow(first + done, std::min(ways_at_once, count - done), 1, aim, keep, &chosen);
        for (std::size_t way = 0; way < chosen.size(); ++way)
            if (gains[way] > 0) out.emplace_back(chosen[way].numbers, chosen[way].weight, gains[way]);
    }
}

}  // namespace lightnet
