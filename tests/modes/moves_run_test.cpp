// Three daemons, one of which becomes slow in mid-run: a node goes elsewhere, and the picture has the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/modes/daemons.hpp"
#include "transport/start/child.hpp"
#include "transport/start/cpu_throttle.hpp"

namespace lightnet::moves_run_test {
namespace {

using namespace test;
using Json = nlohmann::json;

// Two maps of photons, and what they keep is all that counts in memory.
std::string graph_of_two_maps() {
    return "scene = Scene { '" + graph_file("glass_ball.pbrt") +
           "' }\n"
           "caustics = PhotonMap { paths = 'caustic', photons = 20000, gather = 400 }\n"
           "indirect = PhotonMap { paths = 'diffuse', photons = 20000, gather = 400 }\n"
           "direct = DirectLighting {}\n"
           "light = Combine { direct, caustics, indirect }\n"
           "image = RayTracer { light, scene = scene, samples = 256, film = { 96, 96 } }\n";
}

std::string text_of_file(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// Bytes that both maps have together, as layouts reckon with them.
double memory_of_maps(const Json& report) {
    double bytes = 0;
    for (const auto& node : report["nodes"])
        if (node.contains("preparing")) bytes += 3 * node["preparing"]["bytes"].get<double>();
    return bytes;
}

// The only host of a node, by a hosts file that --layout-out has written: the line of its place.
std::size_t only_holder(const std::string& hosts, const std::vector<Daemon>& daemons) {
    for (const char* map : {"caustics = ", "indirect = "}) {
        std::vector<std::size_t> holders;
        std::istringstream lines(hosts);
        for (std::string line; std::getline(lines, line);)
            for (std::size_t i = 0; i < daemons.size(); ++i)
                if (line.starts_with("place") && line.find(daemons[i].endpoint) != std::string::npos &&
                    line.find(map) != std::string::npos)
                    holders.push_back(i);
        if (holders.size() == 1) return holders.front();
    }
    return 0;
}

TEST(MovesRun, GoesOnElsewhereWhereAHostBecomesSlow) {
    const Folder folder;
    const auto graph = folder.write("maps.lua", graph_of_two_maps());
    const auto alone = launch(graph, folder, {"--threads", "2", "--progress", "none", "--cache", "none"});
    ASSERT_EQ(alone.code, 0) << alone.said;
    const auto report = folder.write("alone.run.json", alone.report);
    const auto memory = std::to_string(std::uint64_t(0.9 * memory_of_maps(Json::parse(alone.report))));

    std::vector<Daemon> daemons;
    const Folder own[3];
    for (const auto& one : own) daemons.emplace_back(one);
    const auto out = folder / "moved.exr", layout = folder / "layout.lua", trace = folder / "trace.json",
               page = folder / "moved.html";
    Process run(launch_words(graph, out,
                             {"--hosts", daemons[0].endpoint + "," + daemons[1].endpoint + "," + daemons[2].endpoint,
                              "--layout", "auto=" + report, "--layout-memory", memory, "--layout-out", layout,
                              "--trace", trace, "--report", page, "--progress", "plain"}));
    const auto end = std::chrono::steady_clock::now() + slowdown * std::chrono::seconds(30);
    while (!std::filesystem::exists(layout) && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const auto slow = only_holder(text_of_file(layout), daemons);
    const CpuThrottle throttle(daemons[slow].process->id(), 8);
    const auto moved = finish(run, out, slowdown * std::chrono::seconds(120));
    ASSERT_EQ(moved.code, 0) << moved.said;
    EXPECT_TRUE(moved.picture == alone.picture) << moved.said;
    const auto told = Json::parse(moved.report);
    ASSERT_TRUE(told.contains("moves")) << moved.said << text_of_file(layout) << daemons[slow].endpoint;
    for (const auto& node : told["moves"][0]["nodes"])
        EXPECT_THAT(moved.said, testing::HasSubstr(node.get<std::string>()));
    EXPECT_GE(told["moves"][0]["gain"], 0.2);
    EXPECT_THAT(text_of_file(trace), testing::HasSubstr("\"cat\":\"move\""));
    EXPECT_THAT(text_of_file(page), testing::HasSubstr("\"moves\":[{\"gain\":"));
    const auto drawn =
        run_program({program("lightnet"), "dot", graph, "--moves", folder.write("moved.run.json", moved.report)}, "",
                    slowdown * std::chrono::seconds(60));
    EXPECT_EQ(drawn.code, 0) << drawn.text;
    EXPECT_THAT(drawn.text, testing::HasSubstr("style=dotted"));
}

}  // namespace
}  // namespace lightnet::moves_run_test
