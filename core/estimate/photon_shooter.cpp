#include "core/estimate/photon_shooter.hpp"

#include "core/base/error.hpp"
#include "core/base/math/samples.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene_media.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t paths_at_once = 1024;   // whose rays are traced together
constexpr std::uint32_t most_surfaces = 512;  // light can go round inside glass without loss
constexpr float far_beyond = 3;               // radii of the scene: what light does farther from its middle is left out
constexpr float piece_of_radius = 1.0f / 16;  // longest piece of a beam: long ones have large boxes

// Veach 1997, equation 5.19: where shading normals lean, light that is followed from its lamp isn't scattered as light
// that is followed from the eye. 1 where they don't.
float lean(const SurfacePoint& point, Vec3 arriving, Vec3 leaving) {
    const float shaded = std::fabs(dot(arriving, point.shading.z) * dot(leaving, point.normal));
    const float plain = std::fabs(dot(leaving, point.shading.z) * dot(arriving, point.normal));
    return plain > 0 ? std::min(shaded / plain, 10.0f) : 0;
}

// One of the instants that photons can tell, so that they lie exactly where they say that they came to.
ShutterTime drawn_time(Key key, std::uint32_t path) {
    return PhotonTime::middle_of(PhotonTime::instant_of(time_in_shutter(Samples(key, path).next())));
}

// W. What an emission carries is nearly all power, whichever lamp it is of, so that a few tell.
double power_of_lamps(const Scene& scene) {
    constexpr std::uint32_t count = 64;
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples numbers(key_of("power"), i);
        const float choice = numbers.next();
        const Vec2 place = numbers.next_2d(), direction = numbers.next_2d();
        if (const auto light = scene.lights().emit(choice, place, direction)) sum += max_component(light->flux) / count;
    }
    return sum;
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
            return "LS+(D|V)";
        case PhotonPaths::diffuse:
            return "L(S|D|V)*(D|V)S*(D|V)";
        case PhotonPaths::indirect:
            return "L(S|D|V)+(D|V)";
        case PhotonPaths::all:
            break;
    }
    return "L(S|D|V)*(D|V)";
}

PhotonShooter::PhotonShooter(const Scene& scene, PhotonPaths paths, Key key) : scene_(scene), paths_(paths), key_(key) {
    if (paths == PhotonPaths::caustic || !scene.has_media() || !(scene.media().power() > 0)) return;
    const double power = scene.media().power(), lamps = power_of_lamps(scene);
    share_of_media_ = lamps > 0 ? float(std::clamp(power / (power + lamps), 0.05, 0.95)) : 1;
}

/// Light that begins a path.
struct PhotonShooter::Start {
    Emission light;
    bool from_medium;
};

std::optional<PhotonShooter::Start> PhotonShooter::start(const EmissionNumbers& numbers, ShutterTime time) const {
    const Vec2 place{numbers[1], numbers[2]}, direction{numbers[3], numbers[4]};
    const float share = share_of_media_;
    const bool of_media = numbers[0] < share;
    const float others = 1 - share, choice = of_media ? numbers[0] / share : (numbers[0] - share) / others;
    auto light = of_media ? scene_.media().emit(choice, place, direction, time)
                          : scene_.lights().emit(share > 0 ? choice : numbers[0], place, direction, time);
    if (!light) return std::nullopt;
    if (share > 0) light->flux *= 1 / (of_media ? share : others);
    if (of_media) light->group = scene_.lights().environment_group();
    return Start{*light, of_media};
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

// Light on its way through media to the end of a ray: false, it does not get there. A collision scatters it; but
// caustic paths have no corner that scatters, so what would collide is taken from their light.
template <class Keep>
bool PhotonShooter::cross(PhotonPath& path, const Ray& way, const Keep& keep, Batch& batch) const {
    if (keeps(path.met_mirror, path.met_rough)) keep.on_way(path, way);
    if (paths_ == PhotonPaths::caustic) {
        path.flux *= scene_.media().transmittance(way, path.samples.next_2d());
        return !is_black(path.flux);
    }
    const Flight flight = scene_.media().fly(way, path.flux, path.samples.next_2d());
    path.flux *= flight.weight;
    if (is_black(path.flux)) return false;
    if (!flight.collision) return true;
    const Vec3 place = way.origin + way.direction * flight.collision->distance;
    const SurfacePoint point = scene_.point_in_space(place, flight.collision->medium, way.time);
    go_on(std::move(path), point, scene_.bsdf(point), -way.direction, batch);
    return false;
}

template <class Keep>
void PhotonShooter::visit(PhotonPath path, const Ray& ray, const Hit& hit, const Keep& keep, Batch& batch) const {
    if (path.inside) path.flux *= left_after(path.inside, hit.distance);
    if (scene_.has_media() && !cross(path, {ray.origin, ray.direction, hit.distance, ray.time}, keep, batch)) return;
    const SurfacePoint point = scene_.surface(hit);
    const Bsdf bsdf = scene_.bsdf(point);
    const Vec3 arriving = -ray.direction;
    if ((bsdf.lobes() & lobe::rough) && keeps(path.met_mirror, path.met_rough))
        keep.at_surface(path, point, arriving, hit);
    go_on(std::move(path), point, bsdf, arriving, batch);
}

// Light that meets nothing passes through what media there are around the scene, as far as a ball around it.
template <class Keep>
void PhotonShooter::leave(PhotonPath path, const Ray& ray, const Keep& keep, Batch& batch) const {
    const Vec3 from = ray.origin - scene_.bounds().center();
    const float radius = far_beyond * scene_.radius(), along = dot(from, ray.direction);
    const float root = along * along - length_squared(from) + radius * radius;
    const float left = root > 0 ? std::sqrt(root) - along : 0;  // metres to the ball's edge
    if (left > 0) cross(path, {ray.origin, ray.direction, left, ray.time}, keep, batch);
}

void PhotonShooter::go_on(PhotonPath path, const SurfacePoint& point, const Bsdf& bsdf, Vec3 arriving,
                          Batch& batch) const {
    const auto lobes = paths_ == PhotonPaths::caustic ? lobe::specular : lobe::all;
    if (!(bsdf.lobes() & lobes)) return;
    const float choice = bsdf.chooses() ? path.samples.next() : path.samples.skip();
    const auto step = bsdf.sample(arriving, choice, path.samples.next_2d(), lobes);
    if (!step) return;
    float gain = step->transmitted ? step->eta * step->eta : 1;  // flux isn't squeezed as radiance is
    if (step->lobe != lobe::specular && !point.is_in_space()) gain *= lean(point, arriving, step->incoming);
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
        const ShutterTime time = moves ? drawn_time(time_key, index) : ShutterTime(0);
        const auto started = start(numbers, time);
        if (!started || !(max_component(started->light.flux) > 0)) continue;
        const Emission& light = started->light;
        batch.paths.push_back({samples, static_cast<std::uint32_t>(i), light.flux * (weight * share), light.group});
        batch.paths.back().met_rough = started->from_medium;
        batch.rays.push_back({light.origin, light.direction, Ray().far, time});
        batch.free.push_back(light.free);
    }
    for (std::uint32_t surface = 0; !batch.paths.empty() && surface < most_surfaces; ++surface) {
        batch.hits.resize(batch.rays.size());
        scene_.intersect(batch.rays, batch.hits);
        batch.before.swap(batch.paths);
        batch.rays_before.swap(batch.rays);
        batch.paths.clear();
        batch.rays.clear();
        for (std::size_t i = 0; i < batch.before.size(); ++i) {
            const auto& hit = batch.hits[i];
            if (hit && (surface > 0 || hit->distance >= batch.free[i]))
                visit(batch.before[i], batch.rays_before[i], *hit, keep, batch);
            else if (!hit && scene_.has_media())
                leave(batch.before[i], batch.rays_before[i], keep, batch);
        }
    }
}

void PhotonShooter::shoot(std::uint64_t first, std::size_t count, double share, const Aim& aim,
                          std::vector<Photon>& out) const {
    struct Keep {
        const Scene& scene;
        bool moves;
        std::vector<Photon>& out;
        void at_surface(const PhotonPath& path, const SurfacePoint& point, Vec3 arriving, const Hit& hit) const {
            out.emplace_back(point.position, path.flux, arriving, point.normal, path.group);
            if (moves) out.back().put_time({PhotonTime::instant_of(hit.time), scene.moves(hit)});
        }
        void on_way(const PhotonPath&, const Ray&) const {}
    };
    for (std::size_t done = 0; done < count; done += paths_at_once)
        follow(first + done, std::min(paths_at_once, count - done), float(share), aim,
               Keep{scene_, scene_.moves(), out}, nullptr);
}

void PhotonShooter::shoot_beams(std::uint64_t first, std::size_t count, double share, const Aim& aim,
                                std::vector<PhotonBeam>& out) const {
    struct Keep {
        const Scene& scene;
        std::vector<PhotonBeam>& out;
        std::vector<MediumPiece>& pieces;
        void at_surface(const PhotonPath&, const SurfacePoint&, Vec3, const Hit&) const {}
        void on_way(const PhotonPath& path, const Ray& way) const {
            if (path.inside) return;  // what fills glass only absorbs
            pieces.clear();
            Samples numbers = path.samples;
            scene.media().cut(way, piece_of_radius * scene.radius(), numbers.next_2d(), pieces);
            Rgb flux = path.flux;
            for (const MediumPiece& piece : pieces) {
                const float length = piece.end - piece.begin;
                if (piece.scatters)
                    out.push_back({way.origin + way.direction * piece.begin, way.direction, length, flux,
                                   piece.extinction, path.group});
                flux *= left_after(&piece.extinction, length);
                if (is_black(flux)) return;
            }
        }
    };
    std::vector<MediumPiece> pieces;
    for (std::size_t done = 0; done < count; done += paths_at_once)
        follow(first + done, std::min(paths_at_once, count - done), float(share), aim, Keep{scene_, out, pieces},
               nullptr);
}

void PhotonShooter::attempt(std::uint64_t first, std::size_t count, const Aim& aim, std::vector<Trial>& out,
                            Kept what) const {
    for (std::size_t done = 0; done < count; done += paths_at_once) {
        std::vector<Aim::Choice> chosen;
        std::vector<float> gains(paths_at_once);
        struct Keep {
            bool beams;
            std::span<float> gains;
            const std::vector<Aim::Choice>& chosen;
            // What the choice itself added to the flux is none of the gain.
            float gain(const PhotonPath& path) const { return luminance(path.flux) / chosen[path.index].weight; }
            void at_surface(const PhotonPath& path, const SurfacePoint&, Vec3, const Hit&) const {
                if (!beams) gains[path.index] += gain(path);
            }
            void on_way(const PhotonPath& path, const Ray&) const {
                if (beams) gains[path.index] += gain(path);
            }
        };
        const Keep keep{what == Kept::beams, gains, chosen};
        follow(first + done, std::min(paths_at_once, count - done), 1, aim, keep, &chosen);
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (gains[i] > 0) out.emplace_back(chosen[i].numbers, chosen[i].weight, gains[i]);
    }
}

}  // namespace lightnet
