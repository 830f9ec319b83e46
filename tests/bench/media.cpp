// What fog costs. Mitsuba's tests of participating media by path tracing, with as many scatterings as they say, beside
// the pictures that lie with them: seconds to a stated error are printed, the figure is how far the mean is off. And
// the beam of light behind a glass ball in fog, which paths find as the lamp is large: how many times longer they take
// than a map of photon beams for the error that this has, by processor time. Nobody knows that picture, so the
// reference is a map of many more beams and of other random numbers, with a smaller radius.
//
// Arguments: names of rows; without any, all of them. LIGHTNET_BENCH_SAMPLES changes the samples per pixel of scenes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/stage.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/references.hpp"

namespace lightnet::bench {
namespace {

constexpr std::uint32_t places = 2;
constexpr double wanted_error = 1e-2, most_off = 0.01, times_quicker = 5;
const std::uint64_t seeds = sized<std::uint64_t>(3, 1);

const std::vector<std::string>& scenes() {
    static const std::vector<std::string> all{
        "homo_null_envmap",       "hetero_sigmat_albedo", "hetero_spectral_sigmat_no_scattering",
        "homo_obj_inside_medium", "homo_area_light",      "surf_area_light"};
    return all;
}

// Six rays of a path, as they say, are four surfaces or collisions behind the one asked about.
std::string scene_graph(const std::string& file, const lightnet::Picture& size) {
    const char* given = std::getenv("LIGHTNET_BENCH_SAMPLES");
    const std::string samples = smoke() ? "1" : given ? given : "256";
    return "scene = Scene { '" + file + "' }\n" +
           "direct = DirectLighting {}\nbounce = PathTracing { max_depth = 4 }\nlight = Combine { direct, bounce }\n" +
           "image = RayTracer { light, scene = scene, samples = " + samples + ", film = { " +
           std::to_string(size.width) + ", " + std::to_string(size.height) + " } }\n";
}

void measure(const std::string& name, const Registry& registry) {
    const std::string folder = "scenes/mitsuba-media/tests/scenes/participating_media/";
    const auto file = test::shared_file(folder + "test_" + name + "_volpath.xml"),
               reference_file = test::shared_file(folder + "refs/test_" + name + "_ref_rgb.exr");
    if (!file || !reference_file) return not_run("media." + name, test::is_not_here(folder));
    const lightnet::Picture reference = read_exr(reference_file->string());
    const test::Folder own;
    Stage stage(registry, parse_graph(scene_graph(file->string(), reference), own.file("media.lua")));
    std::vector<double> errors, off, to_target;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        stage.use_seed(seed);
        const Rendered made = stage.in_threads(places);
        const Difference found = compare(reference, made.picture);
        errors.push_back(found.relative_square);
        const Rgb mean = found.mean_ratio;
        off.push_back(double(std::max({std::fabs(mean.r - 1), std::fabs(mean.g - 1), std::fabs(mean.b - 1)})));
        to_target.push_back(made.seconds * errors.back() / wanted_error);
    }
    show(("media." + name + ", relative square error").c_str(), errors);
    show(("media." + name + ", seconds to an error of 0.01").c_str(), to_target);
    figure("media." + name, off, most_off, false);
}

const char* const beam_scene = R"(LookAt 0 -1 3  0 -1 0  0 1 0
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .049 .049 .049 ] "rgb sigma_s" [ .001 .001 .001 ]
MediumInterface "" "fog"
Camera "perspective" "float fov" 12
WorldBegin
MediumInterface "" ""
AttributeBegin
Material "dielectric"
Shape "sphere" "float radius" .5
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -3 -1.6 -3  3 -1.6 -3  3 -1.6 3  -3 -1.6 3 ]
AreaLightSource "diffuse" "rgb L" [ 3000 3000 3000 ] "bool twosided" true
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -.7 2 -.7  .7 2 -.7  .7 2 .7  -.7 2 .7 ]
)";

void measure_beam(const Registry& registry) {
    const test::Folder folder;
    folder.write("beam.pbrt", beam_scene);
    const auto stage = [&](const std::string& light, std::uint32_t samples) {
        const std::string size = std::to_string(sized(64, 8));
        return Stage(registry,
                     parse_graph("scene = Scene { 'beam.pbrt' }\nlight = " + light +
                                     "\nimage = RayTracer { light, scene = scene, samples = " +
                                     std::to_string(sized(samples, 1u)) + ", film = { " + size + ", " + size + " } }\n",
                                 folder.file("beam.lua")));
    };
    const auto map = [&](int beams, const char* radius) {
        return "PhotonMap { photons = 1000, beams = " + std::to_string(sized(beams, 1000)) + ", radius = " + radius +
               " }";
    };
    Stage known = stage(map(400000, "0.02"), 128), paths = stage("PathTracing {}", 512),
          beams = stage(map(50000, "0.05"), 64);
    known.use_seed(100);
    const Rendered reference = known.in_threads(places);
    std::vector<double> times, of_paths, of_beams;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const auto cost = [&](Stage& by, std::vector<double>& errors) {
            by.use_seed(seed);
            const Rendered made = by.in_threads(places);
            errors.push_back(compare(reference.picture, made.picture).relative_square);
            return made.cpu_seconds * errors.back();
        };
        const double slow = cost(paths, of_paths), quick = cost(beams, of_beams);
        times.push_back(quick > 0 ? slow / quick : 0);
    }
    show("media.beam, error of paths", of_paths);
    show("media.beam, error of beams", of_beams);
    quantity("media.beam", times, "times quicker", times_quicker, true);
}

template <class Work>
void row(const std::string& name, const std::vector<std::string>& names, Work&& work) {
    if (!names.empty() && std::find(names.begin(), names.end(), name) == names.end()) return;
    try {
        work();
    } catch (const std::exception& error) {
        broken("media." + name, error.what());
    }
}

void measure_all(const std::vector<std::string>& names) {
    const Registry registry{standard_nodes()};
    for (const std::string& one : scenes()) row(one, names, [&] { measure(one, registry); });
    row("beam", names, [&] { measure_beam(registry); });
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("media", [&] { lightnet::bench::measure_all({argv + 1, argv + argc}); });
}
