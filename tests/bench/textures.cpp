// What textures cost in samples: the part of the noise of a picture that comes from textures, seen through its pixels,
// and not from light. Pictures of textures at several resolutions (mip maps) could take no more than that away.
//
// Light that a surface sends out is its albedo times what falls on it. Both vary within a pixel, and relative variances
// of factors that are independent add up. So the variance of a pixel that only its albedo had is measured (the fact
// that compositing shows, from the same rays) and divided by that of the picture, summed over all pixels. Those where
// depth varies are left out: there edges are seen, which no texture smooths. What remains of them counts as textures,
// so the true part is smaller. Four seeds; scenes that lie beside the project, and a floor with squares up to the
// horizon under an even sky, where there is hardly anything but textures to be seen.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/film/exr.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/references.hpp"
#include "transport/start/child.hpp"

namespace lightnet::bench {
namespace {

constexpr int seeds = 4;
const int rounds = repeated(3);
constexpr double most_of_noise = 0.1;  // less is not worth a footprint in every question

std::string graph_of(const std::string& scene) {
    return "scene = Scene { '" + scene +
           "' }\nlighting = PathTracing { paths = 'all' }\nalbedo = SurfaceFact { of = 'albedo' }\n"
           "depth = SurfaceFact { of = 'depth' }\nimage = RayTracer { lighting, show = { albedo, depth }, "
           "scene = scene, " +
           sized<std::string>("samples = 8, film = { 480, 270, file = 'x.exr' }",
                              "samples = 1, film = { 32, 18, file = 'x.exr' }") +
           " }\n";
}

/// A layer that is shown beside the sum.
const std::vector<Rgb>& shown(const Picture& picture, const std::string& name) {
    for (const auto& layer : picture.shown)
        if (layer.name == name) return layer.pixels;
    throw std::runtime_error("the picture has no " + name);
}

std::vector<Picture> pictures_of(const test::Folder& folder, const std::string& graph, int round) {
    std::vector<Picture> pictures;
    for (int seed = 0; seed < seeds; ++seed) {
        const auto out = folder / "x.exr";
        const auto output = run_program({LIGHTNET_STARTS_LIGHTNET, "run", graph, "--seed",
                                         std::to_string(1 + seed + seeds * round), "--progress", "none", "-o", out},
                                        "", std::chrono::minutes(5));
        if (output.code != 0) throw std::runtime_error("lightnet ended badly: " + output.text);
        pictures.push_back(read_exr(out));
    }
    return pictures;
}

struct Moments {
    double mean = 0, variance = 0;
};

Moments moments_of(const std::array<double, seeds>& values) {
    Moments moments;
    for (const double value : values) moments.mean += value / seeds;
    for (const double value : values) {
        const double off = value - moments.mean;
        moments.variance += off * off / (seeds - 1);
    }
    return moments;
}

/// The variance of pictures that their albedo had alone, by all of it.
double part_of_textures(const std::vector<Picture>& pictures) {
    constexpr double even = 0.02;  // depths of one surface in one pixel
    constexpr double dark = 1e-3;
    double of_textures = 0, of_all = 0;
    struct Views {
        const std::vector<Rgb>&light, &albedo, &depth;
    };
    std::vector<Views> views;
    for (const auto& picture : pictures)
        views.push_back({picture.beauty, shown(picture, "albedo"), shown(picture, "depth")});
    const auto over_seeds = [&](const auto& value) {
        std::array<double, seeds> values{};
        for (std::size_t seed = 0; seed < seeds; ++seed) values[seed] = value(views[seed]);
        return values;
    };
    for (std::size_t pixel = 0; pixel < pictures[0].beauty.size(); ++pixel) {
        const auto depths = over_seeds([&](const Views& one) { return double(one.depth[pixel].r); });
        const auto [near, far] = std::minmax_element(depths.begin(), depths.end());
        if (*far - *near > even * *far) continue;
        for (const auto channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
            const auto albedo =
                moments_of(over_seeds([&](const Views& one) { return double(one.albedo[pixel].*channel); }));
            const auto light =
                moments_of(over_seeds([&](const Views& one) { return double(one.light[pixel].*channel); }));
            if (albedo.mean < dark || light.mean < dark) continue;
            of_textures += albedo.variance * std::pow(light.mean / albedo.mean, 2);
            of_all += light.variance;
        }
    }
    return of_textures / of_all;
}

std::vector<double> parts_of(const test::Folder& folder, const std::string& name, const std::string& scene) {
    const auto graph = folder.write(name + ".lua", graph_of(scene));
    std::vector<double> parts;
    for (int round = 0; round < rounds; ++round) parts.push_back(part_of_textures(pictures_of(folder, graph, round)));
    return parts;
}

std::string floor_under_an_even_sky(const test::Folder& folder) {
    return folder.write("floor.pbrt",
                        "LookAt 0 2 0  0 1.6 10  0 1 0\nCamera \"perspective\" \"float fov\" 45\nWorldBegin\n"
                        "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
                        "Texture \"squares\" \"spectrum\" \"checkerboard\" \"float uscale\" 2000 \"float vscale\" 2000 "
                        "\"rgb tex1\" [.1 .1 .1] \"rgb tex2\" [.8 .8 .8]\n"
                        "Material \"diffuse\" \"texture reflectance\" \"squares\"\n"
                        "Shape \"bilinearmesh\" \"point3 P\" [-1000 0 -1000 1000 0 -1000 -1000 0 1000 1000 0 1000]\n");
}

void measure_all() {
    const test::Folder folder;
    for (const auto& [name, file] : {std::pair{"living-room", "scenes/living-room-pbrt/living-room.pbrt"},
                                     {"staircase2", "scenes/staircase2-pbrt/staircase2.pbrt"},
                                     {"veach-ajar", "scenes/veach-ajar-pbrt/veach-ajar.pbrt"},
                                     {"bmw-m6", "scenes/bmw-m6-pbrt/bmw-m6.pbrt"}})
        if (const auto scene = test::shared_file(file))
            figure(std::string("textures.") + name, parts_of(folder, name, scene->string()), most_of_noise, false);
        else
            not_run(std::string("textures.") + name, test::is_not_here(file));
    // What textures can do at the most: no figure, as nothing is known of how many scenes are like that.
    show("textures of a far floor", parts_of(folder, "far_floor", floor_under_an_even_sky(folder)));
}

}  // namespace
}  // namespace lightnet::bench

int main() { return lightnet::bench::run("textures", lightnet::bench::measure_all); }
