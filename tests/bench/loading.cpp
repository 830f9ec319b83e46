// How long a scene takes from its files to where rays can be asked, beside the bare build of the same triangles' tree
// by Embree. A landscape of a million triangles is written to the disk first; other scenes are those that lie beside
// the project. What Embree doesn't do, above all to read pictures, counts as well. Arguments: scene files, instead of
// all these.
#include <embree/rtcore.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "core/scene/scene.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/landscape.hpp"
#include "tests/bench/references.hpp"
#include "tests/support/folder.hpp"

namespace lightnet {
namespace {

constexpr int rounds = 3;

template <class T>
void put(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A scene file, and beside it its mesh, as modellers write them: PLY, binary.
std::string written_to(const test::Folder& folder) {
    const Mesh mesh = bench::landscape();
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
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        SceneData data;
        const double reading = bench::seconds_of([&] {
            DiskFiles files;
            data = read_scene(files, file);
        });
        const double bare = bare_seconds(data);
        std::size_t triangles = 0;
        const double building = bench::seconds_of([&] { triangles = Scene(std::move(data)).size().triangles; });
        ratios.push_back((reading + building) / bare);
        std::printf("  %s: %zu triangles: read in %.3f s, built in %.3f s, by Embree alone in %.3f s\n", name.c_str(),
                    triangles, reading, building, bare);
    }
    bench::quantity("loading." + name, ratios, "times Embree's build", 2, false);
}

void compare_all() {
    const test::Folder folder;
    compare("landscape", written_to(folder));
    const std::pair<const char*, const char*> others[]{{"terrain", "reference/terrain.pbrt"},
                                                       {"living-room", "scenes/living-room-pbrt/living-room.pbrt"},
                                                       {"staircase2", "scenes/staircase2-pbrt/staircase2.pbrt"},
                                                       {"veach-ajar", "scenes/veach-ajar-pbrt/veach-ajar.pbrt"},
                                                       {"bmw-m6", "scenes/bmw-m6-pbrt/bmw-m6.pbrt"}};
    for (const auto& [name, path] : others)
        if (const auto file = bench::shared_file(path))
            compare(name, file->string());
        else
            bench::not_run(std::string("loading.") + name, bench::is_not_here(path));
}

}  // namespace
}  // namespace lightnet

int main(int argc, char** argv) {
    return lightnet::bench::run("loading", [&] {
        if (argc == 1) lightnet::compare_all();
        for (int i = 1; i < argc; ++i) lightnet::compare(std::filesystem::path(argv[i]).stem(), argv[i]);
    });
}
