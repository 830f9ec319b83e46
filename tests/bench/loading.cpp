// How long a scene takes from its files to where rays can be asked, beside the bare build of the same triangles' tree
// by Embree. Argument: a scene file; without one, a mesh of a million triangles, which has no files to read.
#include <embree/rtcore.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "core/scene/scene.hpp"
#include "tests/bench/figure.hpp"

namespace lightnet {
namespace {

constexpr int rounds = 3;

SceneData waves() {
    constexpr std::uint32_t side = 708;
    Mesh mesh;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x)
            mesh.positions.push_back({float(x), std::sin(float(x) * 0.1f) * std::cos(float(y) * 0.07f), float(y)});
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t corner = y * (side + 1) + x;
            mesh.triangles.push_back({corner, corner + 1, corner + side + 1});
            mesh.triangles.push_back({corner + 1, corner + side + 2, corner + side + 1});
        }
    SceneData scene;
    scene.textures.emplace_back();
    scene.materials.emplace_back();
    scene.shapes.push_back({std::move(mesh), 0, std::nullopt, {}});
    return scene;
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

void compare(const std::string& file) {
    std::vector<double> reading, building, bare, ratios;
    for (int round = 0; round < rounds; ++round) {
        SceneData data;
        reading.push_back(bench::seconds_of([&] {
            DiskFiles files;
            data = file.empty() ? waves() : read_scene(files, file);
        }));
        bare.push_back(bare_seconds(data));
        std::size_t triangles = 0;
        building.push_back(bench::seconds_of([&] { triangles = Scene(std::move(data)).size().triangles; }));
        if (file.empty()) reading.back() = 0;  // there was nothing to read
        ratios.push_back((reading.back() + building.back()) / bare.back());
        std::printf("  %zu triangles: read in %.3f s, built in %.3f s, by Embree alone in %.3f s\n", triangles,
                    reading.back(), building.back(), bare.back());
    }
    bench::show("reading and building, over building alone", ratios);
    bench::quantity("loading", bench::median(ratios), "times Embree's build", 2, false);
}

}  // namespace
}  // namespace lightnet

int main(int argc, char** argv) {
    return lightnet::bench::run("loading", [&] { lightnet::compare(argc > 1 ? argv[1] : ""); });
}
