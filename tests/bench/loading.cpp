// How long a scene takes from its files to where rays can be asked, beside the bare build of the same triangles' tree
// by Embree. A landscape of a million triangles is written to the disk first; other scenes are those that lie beside
// the project. What Embree doesn't do, above all to read pictures, counts as well. Besides: how much memory a scene
// takes per triangle, at most on the way there and afterwards. Arguments: scene files, instead of all these, and
// `triangles=5e6`, a landscape of so many.
#include <embree/rtcore.h>
#include <jemalloc/jemalloc.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "core/scene/scene.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/landscape.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/references.hpp"

namespace lightnet {
namespace {

const int rounds = bench::repeated(3);

template <class T>
void put(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// A figure of this process's memory, bytes.
double memory(const std::string& figure) {
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(figure + ":")) return 1024 * std::atof(line.c_str() + figure.size() + 1);
    return 0;
}
void forget_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

void give_back_what_is_free() { mallctl("arena.4096.purge", nullptr, nullptr, nullptr, 0); }  // 4096: of all

constexpr std::uint32_t usual_side = 722;  // of the landscape: 2 for each of its square

/// A scene file, and beside it its mesh, as modellers write them: PLY, binary.
std::string written_to(const test::Folder& folder, std::uint32_t side) {
    const Mesh mesh = bench::landscape(side);
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& position : mesh.positions) put(ply, position);
    for (const auto& triangle : mesh.triangles) {
        put(ply, std::uint8_t{3});
        put(ply, triangle);
    }
    folder.write("landscape.ply", ply);
    return folder.write("landscape.pbrt",
                        "LookAt 7.5 5.5 -7.5  0 1.8 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n"
                        "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n"
                        "Material \"diffuse\" \"rgb reflectance\" [.6 .6 .6]\n"
                        "Shape \"plymesh\" \"string filename\" \"landscape.ply\"\n");
}

/// The tree that the scene has, and nothing else; objects that stand in a scene many times are built once.
double bare_seconds(const SceneData& scene) {
    RTCDevice device = rtcNewDevice("start_threads=0,isa=avx2");
    RTCScene tree = rtcNewScene(device);
    std::vector<std::vector<Vec3>> padded;  // Embree reads 16 bytes of the last vertex
    for (const Shape& shape : scene.shapes) {
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        if (!mesh) continue;
        auto& positions = padded.emplace_back(mesh->positions);
        positions.emplace_back();
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                   sizeof(Vec3), mesh->positions.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles.data(), 0,
                                   3 * sizeof(std::uint32_t), mesh->triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);
    const double seconds = bench::seconds_of([&] { rtcCommitScene(tree); });
    rtcReleaseScene(tree);
    rtcReleaseDevice(device);
    return seconds;
}

void compare(const std::string& name, const std::string& file) {
    std::vector<double> ratios, most, held;
    for (int round = 0; round < rounds; ++round) {
        give_back_what_is_free();
        const double before = memory("VmRSS");
        forget_peak();
        SceneData data;
        const double reading = bench::seconds_of([&] {
            DiskFiles files;
            data = read_scene(files, file);
        });
        std::optional<Scene> scene;
        const double building = bench::seconds_of([&] { scene.emplace(std::move(data)); });
        const auto triangles = double(std::max<std::size_t>(1, scene->size().triangles));
        most.push_back((memory("VmHWM") - before) / triangles);
        give_back_what_is_free();
        held.push_back((memory("VmRSS") - before) / triangles);
        const double bare = bare_seconds(scene->data());
        ratios.push_back((reading + building) / bare);
        std::printf("  %s: %.0f triangles: read in %.3f s, built in %.3f s, by Embree alone in %.3f s\n", name.c_str(),
                    triangles, reading, building, bare);
    }
    bench::quantity("loading." + name, ratios, "times Embree's build", 2, false);
    bench::show("bytes per triangle at most, pictures included", most);
    bench::show("bytes per triangle afterwards", held);
}

void compare_landscape(double triangles) {
    const test::Folder folder;
    const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / 2)));
    compare("landscape", written_to(folder, side));
}

void compare_all() {
    compare_landscape(bench::sized(2.0 * usual_side * usual_side, 20'000.0));
    const std::pair<const char*, const char*> others[]{{"terrain", "reference/terrain.pbrt"},
                                                       {"living-room", "scenes/living-room-pbrt/living-room.pbrt"},
                                                       {"staircase2", "scenes/staircase2-pbrt/staircase2.pbrt"},
                                                       {"veach-ajar", "scenes/veach-ajar-pbrt/veach-ajar.pbrt"},
                                                       {"bmw-m6", "scenes/bmw-m6-pbrt/bmw-m6.pbrt"}};
    for (const auto& [name, path] : others)
        if (const auto file = test::shared_file(path))
            compare(name, file->string());
        else
            bench::not_run(std::string("loading.") + name, test::is_not_here(path));
}

}  // namespace
}  // namespace lightnet

int main(int argc, char** argv) {
    return lightnet::bench::run("loading", [&] {
        if (argc == 1) lightnet::compare_all();
        for (const std::string argument : std::span(argv, std::size_t(argc)).subspan(1))
            if (argument.starts_with("triangles="))
                lightnet::compare_landscape(std::stod(argument.substr(argument.find('=') + 1)));
            else
                lightnet::compare(std::filesystem::path(argument).stem(), argument);
    });
}
