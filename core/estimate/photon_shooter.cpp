#include "core/estimate/photon_shooter.hpp"

#include "core/base/error.hpp"
#include "core/base/math/samples.hpp"
#include "core/scene/direct_light.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t paths_at_once = 1024;   // whose rays are traced together
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

struct PhotonShooter::PhotonPath {
    Samples samples;
    std::uint32_t index;  // counted from the first
    Rgb flux;
    std::uint32_t group;          // of its lamp
    const Rgb* inside = nullptr;  // what fills the space that it crosses
    bool met_mirror = false, met_rough = false;
};

struct PhotonShooter::Batch {
    std::vector<PhotonPath> paths, before;
    std::vector<Ray> rays, rays_before;
    std::vector<std::optional<Hit>> hits;
    std::vector<float> free;  // of each path that begins: Emission::free
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
void PhotonShooter::visit(PhotonPath path, const Ray& ray, const Hit& hit, const Keep& keep, Batch& batch) const {
    if (path.inside) path.flux *= left_after(path.inside, hit.distance);
    if (scene_.has_media()) {  // what is scattered on the way is left out
        const Ray way{ray.origin, ray.direction, hit.distance, ray.time};
        path.flux *= scene_.transmittance(way, path.samples.next_2d());
        if (is_black(path.flux)) return;
    }
    const SurfacePoint point = scene_.surface(hit);
    const Bsdf bsdf = scene_.bsdf(point);
    const Vec3 arriving = -ray.direction;
    if ((bsdf.lobes() & lobe::rough) && keeps(path.met_mirror, path.met_rough)) keep(path, point, arriving);
    const auto lobes = paths_ == PhotonPaths::caustic ? lobe::specular : lobe::all;
    if (!(bsdf.lobes() & lobes)) return;
    const float choice = bsdf.chooses() ? path.samples.next() : path.samples.skip();
    const auto step = bsdf.sample(arriving, choice, path.samples.next_2d(), lobes);
    if (!step) return;
    float gain = step->transmitted ? step->eta * step->eta : 1;  // flux isn't squeezed as radiance is
    if (step->lobe != lobe::specular) gain *= lean(point, arriving, step->incoming);
    const Rgb flux = path.flux * step->weight * gain;
    // Russian roulette, so that what is left carries about as much as before. Jensen 2001, section 5.2.
    const float before = max_component(path.flux), after = max_component(flux);
    const float chance = std::min(1.0f, after / before);
    if (!(path.samples.next() < chance)) return;
    path.flux = flux / chance;
    path.inside = filling(bsdf, point, arriving, step->incoming, path.inside);
    (step->lobe == lobe::specular ? path.met_mirror : path.met_rough) = true;
    batch.paths.push_back(path);
    batch.rays.push_back(point.ray_towards(step->incoming));
}

template <class Keep>
void PhotonShooter::follow(std::uint64_t first, std::size_t count, float share, const Aim& aim, const Keep& keep,
                           std::vector<Aim::Choice>* chosen) const {
    Batch batch;
    const bool moves = scene_.moves();
    const Key time_key = child(key_, key_of("shutter"));
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(first + i);
        Samples samples(key_, index);
        const auto choice = aim.choose(samples);
        const auto& [numbers, weight] = choice;
        if (chosen) chosen->push_back(choice);
        const ShutterTime time = moves ? time_in_shutter(Samples(time_key, index).next()) : ShutterTime(0);
        const auto light = scene_.emit(numbers[0], {numbers[1], numbers[2]}, {numbers[3], numbers[4]}, time);
        if (!light || !(max_component(light->flux) > 0)) continue;
        batch.paths.push_back({samples, static_cast<std::uint32_t>(i), light->flux * (weight * share), light->group});
        batch.rays.push_back({light->origin, light->direction, Ray().far, time});
        batch.free.push_back(light->free);
    }
    for (std::uint32_t surface = 0; !batch.paths.empty() && surface < most_surfaces; ++surface) {
        batch.hits.resize(batch.rays.size());
        scene_.intersect(batch.rays, batch.hits);
        batch.before.swap(batch.paths);
        batch.rays_before.swap(batch.rays);
        batch.paths.clear();
        batch.rays.clear();
        for (std::size_t i = 0; i < batch.before.size(); ++i)
            if (batch.hits[i] && (surface > 0 || batch.hits[i]->distance >= batch.free[i]))
                visit(batch.before[i], batch.rays_before[i], *batch.hits[i], keep, batch);
    }
}

void PhotonShooter::shoot(std::uint64_t first, std::size_t count, double share, const Aim& aim,
                          std::vector<Photon>& out) const {
    const auto keep = [&](const PhotonPath& path, const SurfacePoint& point, Vec3 arriving) {
        out.emplace_back(point.position, path.flux, arriving, point.normal, path.group);
    };
    for (std::size_t done = 0; done < count; done += paths_at_once)
        follow(first + done, std::min(paths_at_once, count - done), float(share), aim, keep, nullptr);
}

void PhotonShooter::attempt(std::uint64_t first, std::size_t count, const Aim& aim, std::vector<Trial>& out) const {
    for (std::size_t done = 0; done < count; done += paths_at_once) {
        std::vector<Aim::Choice> chosen;
        std::vector<float> gains(paths_at_once);
        // What the choice itself added to the flux is none of the gain.
        const auto keep = [&](const PhotonPath& path, const SurfacePoint&, Vec3) {
            gains[path.index] += luminance(path.flux) / chosen[path.index].weight;
        };
        follow(first + done, std::min(paths_at_once, count - done), 1, aim, keep, &chosen);
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (gains[i] > 0) out.emplace_back(chosen[i].numbers, chosen[i].weight, gains[i]);
    }
}

}  // namespace lightnet
