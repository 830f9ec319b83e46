// Pictures whose tiles take long, and some of them nothing: whether anything is done twice, and how near the makespan
// comes to the ideal.
// Figures: long.tiles, makespan over the ideal where tiles of ten seconds follow free ones, emulated; long.rays and
// long.rays_busy, rays of a landscape below a sky over those of one thread, with the processors idle and busy.
#include <atomic>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/landscape.hpp"
#include "tests/bench/stage.hpp"
#include "tests/support/folder.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

constexpr std::uint32_t places = 4, free_tiles = 60, long_tiles = 12;
const auto long_time = sized(std::chrono::milliseconds(10000), std::chrono::milliseconds(100));

/// Waits at tiles as if they were dear, but for the first ones.
class Waiting final : public Renderer {
public:
    void render_block(const Tile& tile, std::span<Rgb>) const override {
        if (tile.x >= free_tiles) std::this_thread::sleep_for(long_time);
    }
};

double tiles() {
    constexpr std::uint64_t run_id = 1;
    const Registry kinds(
        {{.name = "Waiting", .role = Role::image, .help = "waits", .make_renderer = [](const NodeContext&) {
              return std::make_unique<Waiting>();
          }}});
    Job job;
    job.isa = usual_isa();
    job.graph.file = "long.lua";
    job.graph.nodes = {{"image", "Waiting", {}, {}, {}}};
    const auto network = build_network(job, kinds, LoadedScene{});
    Plan plan{{}, {{}}};
    for (std::uint32_t place = 0; place < places; ++place) {
        plan.places.push_back({"", place});
        plan.places_of[0].push_back(place);
    }
    ThreadedRun run(network, run_id, plan, job.tuning);
    const double seconds = seconds_of_emulated(*network, run_id, run.carrier(), plan, free_tiles + long_tiles, 2);
    run.stop();
    return seconds / (std::chrono::duration<double>(long_time).count() * long_tiles / places);
}

// A landscape as a file, below a sky that shines.
std::string landscape_file(const test::Folder& folder) {
    const Mesh mesh = landscape(200);
    std::ofstream ply(folder / "land.ply");
    ply << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& at : mesh.positions) ply << at.x << ' ' << at.y << ' ' << at.z << '\n';
    for (const auto& corners : mesh.triangles)
        ply << "3 " << corners[0] << ' ' << corners[1] << ' ' << corners[2] << '\n';
    std::ofstream(folder / "land.pbrt") << "LookAt 0 7 -14  0 4 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
                                           "Film \"rgb\" \"integer xresolution\" 256 \"integer yresolution\" 256\n"
                                           "WorldBegin\nLightSource \"infinite\" \"rgb L\" [.5 .6 .8]\n"
                                           "LightSource \"distant\" \"point3 from\" [3 5 -1] \"rgb L\" [3 3 2]\n"
                                           "Material \"diffuse\" \"rgb reflectance\" [.6 .6 .5]\n"
                                           "Shape \"plymesh\" \"string filename\" \"land.ply\"\n";
    return folder / "land.pbrt";
}

double rays(Stage& stage, bool busy, double serial) {
    std::atomic<bool> over{false};
    std::vector<std::jthread> others;
    for (unsigned i = 0; busy && i < 2 * std::thread::hardware_concurrency(); ++i)
        others.emplace_back([&over] {
            while (!over.load(std::memory_order_relaxed)) {
            }
        });
    const double traced = stage.in_threads(std::thread::hardware_concurrency()).rays;
    over = true;
    return traced / serial;
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    namespace bench = lightnet::bench;
    return bench::run("long", [] {
        bench::figure("long.tiles", {bench::tiles()}, 1.34, false);  // one tile more, in a bundle with free ones
        const lightnet::test::Folder folder;
        const lightnet::Registry registry{lightnet::standard_nodes()};
        bench::Stage stage(registry, "path_all.lua",
                           {{"file", bench::landscape_file(folder)}, {"samples", bench::sized("48", "1")}});
        const double serial = stage.in_threads(1).rays;
        bench::figure("long.rays", {bench::rays(stage, false, serial)}, 1.01, false);
        bench::figure("long.rays_busy", {bench::rays(stage, true, serial)}, 1.01, false);
    });
}
