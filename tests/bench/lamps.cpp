// Many lamps: what it costs to choose one and a point on it, how good the choice is, what a million take.
//
// Lamps are the triangles of one mesh, scattered over a floor; they are turned anyhow, and their radiances differ by
// three orders of magnitude. Points on the floor ask for light. The variance is that of the irradiance at a point
// without anything in between, relative to its square, by one sample; it is compared with that of lamps chosen by their
// power alone, worked out here from the triangles. Processor time of samples is measured in turns. One sample is
// choosing a lamp and a point on it, for a column of points at once, and asking whether anything is in the way. Paths
// are whole ones from points on the floor, by path tracing, all surfaces grey; all triangles are there in both scenes,
// and in one of them ten shine.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/columns.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/query.hpp"
#include "core/estimate/path_walk.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surfaces/triangle.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::bench {
namespace {

constexpr float side = 100;         // of the floor, m
constexpr std::size_t asked = 512;  // points on it

/// Triangles, each as radiant as its shape.
struct Lamps {
    std::vector<Mesh> meshes;  // of the same radiance
    std::vector<float> radiances;
};

// Eight meshes; the area of all together does not depend on how many they are.
Lamps lamps(std::uint32_t count) {
    Lamps all;
    constexpr std::uint32_t kinds = 8;
    all.meshes.resize(kinds);
    for (std::uint32_t k = 0; k < kinds; ++k) all.radiances.push_back(std::pow(10.0f, 3 * float(k) / kinds));
    const float size = std::min(1.0f, 30 / std::sqrt(float(count)));
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(11, i);
        const Vec2 at = samples.next_2d();
        const Vec3 place{side * at.x, 1 + 4 * samples.next(), side * at.y};
        const Frame turned = Frame::around(sphere(samples.next_2d()));
        Mesh& mesh = all.meshes[std::size_t(samples.next() * kinds)];
        const auto first = std::uint32_t(mesh.positions.size());
        for (const Vec3 corner : {place, place + turned.x * size, place + turned.y * size})
            mesh.positions.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return all;
}

SceneData over_a_floor(const Lamps& lamps, float albedo_of_lamps = 0) {
    SceneData data;
    test::add(data, test::quad({0, 0, 0}, {0, 0, side}, {side, 0, 0}), test::diffuse(data, 0.5f));
    const auto material = test::diffuse(data, albedo_of_lamps);
    for (std::size_t k = 0; k < lamps.meshes.size(); ++k)
        if (const float l = lamps.radiances[k]; !lamps.meshes[k].triangles.empty())
            test::add(data, lamps.meshes[k], material).emission = AreaEmission{{l, l, l}};
    return data;
}

/// The same triangles, of which but a few shine.
SceneData of_which_few_shine(const Lamps& lamps, std::size_t few) {
    SceneData data = over_a_floor(lamps, 0.5f);
    const std::size_t shapes = data.shapes.size();
    for (std::size_t s = 1; s < shapes; ++s) {
        Mesh dark = std::get<Mesh>(data.shapes[s].geometry);
        auto& shining = std::get<Mesh>(data.shapes[s].geometry).triangles;
        const std::size_t own = few * s / (shapes - 1) - few * (s - 1) / (shapes - 1);
        dark.triangles.erase(dark.triangles.begin(), dark.triangles.begin() + std::ptrdiff_t(own));
        shining.resize(own);
        test::add(data, std::move(dark), data.shapes[s].material);
    }
    return data;
}

std::vector<SurfacePoint> points(const Scene& scene) {
    std::vector<SurfacePoint> all;
    for (std::uint32_t i = 0; i < asked; ++i) {
        const Vec2 at = triangle(Samples(12, i).next_2d());
        all.push_back(scene.surface(Query{.geometry = 0, .primitive = i % 2, .u = at.x, .v = at.y}));
    }
    return all;
}

std::optional<LightSample> look(const Scene& scene, const SurfacePoint& from, Samples samples) {
    const float choice = samples.next();
    return scene.lights().sample({from.position, from.normal}, choice, samples.next_2d());
}

double irradiance(const SurfacePoint& at, const LightSample& lamp) {
    return lamp.radiance.g * std::max(0.0f, dot(at.normal, lamp.direction)) / lamp.pdf;
}

/// Mean and mean square.
struct Moments {
    double sum = 0, squares = 0;
    std::size_t count = 0;
    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    double mean() const { return sum / double(count); }
};

/// Of lamps chosen by power.
class ByPower {
public:
    explicit ByPower(const Lamps& lamps) {
        double total = 0;
        for (std::size_t k = 0; k < lamps.meshes.size(); ++k)
            for (std::uint32_t t = 0; t < lamps.meshes[k].triangles.size(); ++t) {
                const Corners at = corners(lamps.meshes[k], t);
                const Vec3 across = cross(at.b - at.a, at.c - at.a);
                ends_.push_back(total += 0.5 * length(across) * lamps.radiances[k]);
                lamps_.push_back({at, normalize(across)});
            }
    }
    double irradiance(const SurfacePoint& at, Samples samples) const {
        const double choice = double(samples.next()) * ends_.back();
        const auto lamp = std::size_t(std::upper_bound(ends_.begin(), ends_.end() - 1, choice) - ends_.begin());
        const Vec2 u = triangle(samples.next_2d());
        const Vec3 way = on_triangle(lamps_[lamp].first, u.x, u.y) - at.position;
        const double d2 = length_squared(way), here = dot(at.normal, way), there = -dot(lamps_[lamp].second, way);
        return std::max(0.0, here) * std::max(0.0, there) / (d2 * d2) * ends_.back();  // radiance × area / chance
    }

private:
    std::vector<double> ends_;
    std::vector<std::pair<Corners, Vec3>> lamps_;
};

struct Quality {
    double variance = 0, by_power = 0, ratio_of_means = 0;
};

Quality quality(const Scene& scene, const Lamps& lamps) {
    const ByPower other(lamps);
    const std::uint32_t by_tree = sized(1u << 12, 1u << 6), by_power = sized(1u << 14, 1u << 6);
    Quality found;
    double tree_means = 0, power_means = 0;
    const auto places = points(scene);
    for (std::size_t p = 0; p < places.size(); p += 8) {
        Moments tree, power;
        for (std::uint32_t i = 0; i < by_tree; ++i) {
            const auto lamp = look(scene, places[p], Samples(13 + p, i));
            tree.add(lamp ? irradiance(places[p], *lamp) : 0);
        }
        for (std::uint32_t i = 0; i < by_power; ++i) power.add(other.irradiance(places[p], Samples(14 + p, i)));
        const double mean2 = tree.mean() * tree.mean();
        if (!(mean2 > 0)) continue;
        found.variance += tree.squares / by_tree / mean2 - 1;
        found.by_power += power.squares / by_power / mean2 - 1;
        tree_means += tree.mean();
        power_means += power.mean();
    }
    found.variance /= double(asked) / 8;
    found.by_power /= double(asked) / 8;
    found.ratio_of_means = tree_means / power_means;
    return found;
}

/// Processor time of a sample, ns.
struct Cost {
    double choice = 0, sample = 0;
};

Cost cost(const Scene& scene) {
    const std::uint32_t rounds = sized(400u, 4u);
    const auto places = points(scene);
    std::vector<Ray> rays;
    std::array<LitPoint, lanes> from;
    std::array<float, lanes> choices;
    std::array<Vec2, lanes> u;
    LightSamples found;
    const double begun = thread_seconds();
    for (std::uint32_t i = 0; i < rounds; ++i)
        for (std::uint32_t first = 0; first < asked; first += lanes) {
            for (std::uint32_t k = 0; k < lanes; ++k) {
                const auto& place = places[first + k];
                Samples samples(15, i * asked + first + k);
                from[k] = {place.position, place.normal};
                choices[k] = samples.next();
                u[k] = samples.next_2d();
            }
            scene.lights().sample(from, choices, u, found);
            for (std::uint32_t k = 0; k < lanes; ++k)
                if (found.found[k]) rays.push_back(scene.ray_to(places[first + k], found[k]));
        }
    const double chosen = thread_seconds();
    std::vector<std::uint8_t> hidden(rays.size());
    scene.occluded(rays, hidden);
    const double done = thread_seconds();
    const double per_sample = 1e9 / (rounds * double(asked));
    return {(chosen - begun) * per_sample, (done - begun) * per_sample};
}

/// Processor time of a path, ns.
double cost_of_paths(const Scene& scene) {
    const std::uint32_t samples = sized(64u, 4u);
    const PathWalk paths(scene, {.samples = samples, .all = true});
    std::vector<Query> questions;
    for (std::uint32_t i = 0; i < asked; ++i) {
        const Vec2 at = triangle(Samples(12, i).next_2d());
        questions.push_back({.stream = key_of("paths") + i,
                             .geometry = 0,
                             .primitive = i % 2,
                             .u = at.x,
                             .v = at.y,
                             .outgoing = {0, 1, 0}});
    }
    std::vector<Rgb> answers(questions.size());
    SharedFirstRays first;
    const double begun = thread_seconds();
    paths.light(questions, 1, first, answers);
    return (thread_seconds() - begun) * 1e9 / (double(asked) * samples);
}

void measure_paths() {
    const Lamps lamps_there = lamps(100'000);
    const Scene all(over_a_floor(lamps_there, 0.5f)), few(of_which_few_shine(lamps_there, 10));
    std::vector<double> among_all, among_few, ratios;
    for (int round = 0; round < repeated(9); ++round) {
        among_all.push_back(cost_of_paths(all));
        among_few.push_back(cost_of_paths(few));
        ratios.push_back(among_all.back() / among_few.back());
    }
    show("a path below 100000 lamps, ns", among_all);
    show("below ten of them, ns", among_few);
    quantity("lamps.paths", ratios, "times that of ten", 2, false);
}

void measure_all() {
    measure_paths();
    constexpr std::array<std::uint32_t, 4> counts{10, 1000, 100'000, 1'000'000};
    std::vector<std::unique_ptr<Scene>> scenes;
    for (const auto count : counts) {
        const Lamps all = lamps(count);
        auto& scene = scenes.emplace_back(std::make_unique<Scene>(over_a_floor(all)));
        const auto [variance, by_power, means] = quality(*scene, all);
        std::printf("  %u lamps: relative variance %.3f, by power %.3f, their means %.4f : 1\n", count, variance,
                    by_power, means);
        if (count == 100'000) quantity("lamps.variance", {variance / by_power}, "of that by power", 1.0 / 3, false);
    }
    std::array<std::vector<double>, counts.size()> choices, samples;
    std::vector<double> choice_ratios, ratios;
    for (int round = 0; round < repeated(9); ++round) {
        for (std::size_t s = 0; s < scenes.size(); ++s) {
            const auto [choice, sample] = cost(*scenes[s]);
            choices[s].push_back(choice);
            samples[s].push_back(sample);
        }
        choice_ratios.push_back(choices[2].back() / choices[0].back());
        ratios.push_back(samples[2].back() / samples[0].back());
    }
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        show(("choice among " + std::to_string(counts[s]) + ", ns").c_str(), choices[s]);
        show(("with its shadow ray, ns"), samples[s]);
    }
    quantity("lamps.choice", choice_ratios, "times that of ten", 2, false);
    quantity("lamps.sample", ratios, "times that of ten", 2, false);

    const auto size = scenes.back()->size();
    quantity("lamps.bytes", {double(size.light_bytes) / double(counts.back())}, "bytes", 100, false);
    std::vector<double> building;
    for (int round = 0; round < repeated(3); ++round)  // the view of all lamps makes them anew, and nothing else
        building.push_back(seconds_of([&] { const Scene again(*scenes.back(), SceneView{.apart = true}); }));
    quantity("lamps.building", building, "s", 0.5, false);
}

}  // namespace
}  // namespace lightnet::bench

int main() { return lightnet::bench::run("lamps", lightnet::bench::measure_all); }
