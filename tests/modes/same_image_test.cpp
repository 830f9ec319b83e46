// The flagship: each graph in graphs/ runs serial, threaded and networked, and gives the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

#if defined(LIGHTNET_LARGE)
const std::vector<std::string> small_pictures{"--size", "96x80",      "--samples", "136",     "--seed",
                                              "7",      "--progress", "none",      "--cache", "none"};
const std::set<std::string> left_out;
const std::vector<std::string> threads_tried{"2", "3", "4", "8"}, tiles_tried{"64", "32", "11", "3"};
const std::vector<std::string> daemons_tried{"1", "2", "3", "4"}, bundles_tried{"4096", "512", "61", "37", "8"};
constexpr std::chrono::seconds narrowest_takes(600);  // 136 samples, eight questions at a time
#else
const std::vector<std::string> small_pictures{"--size",     "64x64", "--samples", "4",
                                              "--progress", "none",  "--cache",   "none"};
const std::vector<std::string> threads_tried{"2", "3"}, tiles_tried{"32", "11"};
const std::set<std::string> left_out{"linking.lua", "studio.lua"};  // studio_maps.lua has all that they have
const std::vector<std::string> daemons_tried{"1", "2", "3"}, bundles_tried{"512", "37", "1"};
constexpr std::chrono::seconds narrowest_takes(60);
#endif

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::vector<std::string> graph_files() {
    std::vector<std::string> files;
    for (const std::string folder : {"", "paper/"})
        for (const auto& entry : std::filesystem::directory_iterator(graph_file(folder)))
            if (entry.path().extension() == ".lua" && !left_out.contains(entry.path().filename().string()))
                files.push_back(folder + entry.path().filename().string());
    std::sort(files.begin(), files.end());
    return files;
}

// The names of the nodes that may be placed: what stands left of "Kind {", but for scenes.
std::vector<std::string> nodes_of(const std::string& graph) {
    std::vector<std::string> names;
    std::istringstream lines(bytes_of(graph));
    for (std::string line; std::getline(lines, line);) {
        const auto equals = line.find(" = "), brace = line.find('{');
        if (line.starts_with("--") || equals == std::string::npos || brace == std::string::npos || equals + 3 >= brace)
            continue;
        if (!std::isupper(static_cast<unsigned char>(line[equals + 3]))) continue;  // keys { … }, say
        const auto name = line.substr(0, line.find_first_of(" ="));
        if (line.find("Scene", equals) == std::string::npos) names.push_back(name);
    }
    return names;
}

// Graphs that learn much ask far more than their pixels do.
std::vector<std::string> words_for(const std::string& graph) {
    if (graph == "paper/figure5.lua" || graph == "paper/figure8.lua")
        return with(small_pictures, {"-D", "photons=20000", "-D", "rays=32", "-D", "wanted_error=0.0625"});
    if (graph == "guided.lua") return with(small_pictures, {"-D", "lessons=7000", "-D", "when=always"});
    if (graph == "irradiance_cache.lua") return with(small_pictures, {"-D", "rays=32", "-D", "wanted_error=0.0625"});
    if (graph == "paper/figure3.lua") return with(small_pictures, {"-D", "rays=32"});
    if (graph == "studio_maps.lua") {
        auto words = with(small_pictures, {"-D", "photons=5000", "-D", "rays=32", "-D", "wanted_error=0.0625"});
        words[1] = "32x24";  // a layer for each group of each operator
        return words;
    }
    if (graph == "compositing.lua" || graph == "expressions.lua") {
        auto words = small_pictures;
        words[1] = "32x24";  // twenty layers and more
        return words;
    }
    if (graph == "progressive.lua") return with(small_pictures, {"-D", "photons=1000"});
    return small_pictures;
}

class SameImage : public ::testing::TestWithParam<std::string> {
protected:
    SameImage()
        : graph(graph_file(GetParam())),
          small(words_for(GetParam())),
          serial(launch(graph, folder, with(small, {"--threads", "1"}))) {}

    void expect_same(const Launch& other, const std::string& how) {
        EXPECT_EQ(other.code, 0) << how << "\n" << other.said;
        EXPECT_TRUE(other.picture == serial.picture) << how << ": the bytes differ";
        EXPECT_EQ(counter(other.report, "refused_sends"), 0) << how << ": a line was full, in spite of credit";
    }
    // Each node on one or two of the daemons (or places of this process, called "here"), so that every question travels
    // somewhere.
    std::string spread(const std::vector<std::string>& endpoints) {
        const auto file = folder / "spread.lua";
        std::ofstream out(file);
        std::vector<std::string> tables(endpoints.size());
        std::size_t turn = 0;
        for (const auto& node : nodes_of(graph)) {
            tables[turn % tables.size()] += node + " = 1, ";
            if (turn % 3 != 1) tables[(turn + 1) % tables.size()] += node + " = 1, ";
            turn += 1;
        }
        for (std::size_t i = 0; i < endpoints.size(); ++i)
            out << "place \"" << endpoints[i] << "\" { " << tables[i] << (endpoints[i] == "here" ? "places = 1 " : "")
                << "}\n";
        return file;
    }

    Folder folder;
    std::string graph;
    std::vector<std::string> small;
    Launch serial;
};

TEST_P(SameImage, InThreadsOfAnyNumber) {
    ASSERT_EQ(serial.code, 0) << serial.said;
    for (const auto& threads : threads_tried)
        for (const auto& tile : tiles_tried)
            expect_same(launch(graph, folder, with(small, {"--threads", threads, "--tile", tile})),
                        threads + " threads, tiles of " + tile);
}

TEST_P(SameImage, InVectorsOfAnyWidth) {
    ASSERT_EQ(serial.code, 0) << serial.said;
    for (const std::string width : {"narrow", "avx2"}) {
        const auto out = folder / "picture.exr";
        const auto words = launch_words(graph, out, with(small, {"--threads", "1"}));
        Process process(with({"/usr/bin/env", "LIGHTNET_VECTORS=" + width}, words));
        expect_same(finish(process, out), "vectors: " + width);
    }
}

TEST_P(SameImage, OnDaemonsOfAnyNumber) {
    ASSERT_EQ(serial.code, 0) << serial.said;
    for (const auto& workers : daemons_tried)
        expect_same(launch(graph, folder, with(small, {"--local-workers", workers})), workers + " daemons");
}

TEST_P(SameImage, WithOperatorsSpreadOverHosts) {
    ASSERT_EQ(serial.code, 0) << serial.said;
    const Daemon one(folder, 2), two(folder), three(folder);
    for (const auto& endpoints :
         {std::vector{one.endpoint, two.endpoint}, std::vector{one.endpoint, two.endpoint, three.endpoint}}) {
        const auto hosts = spread(endpoints);
        for (const auto& bundle : bundles_tried) {
            // The smallest bundles, one under way, and one fiber per node: the narrowest way there is.
            const std::string credit = bundle == bundles_tried.back() ? "1" : "8",
                              fibers = bundle == bundles_tried.back() ? "0" : "16";
            const auto far = launch(graph, folder,
                                    with(small, {"--hosts", hosts, "--bundle", bundle, "--credit", credit,
                                                 "--spare-fibers", fibers, "--tile", "16"}),
                                    slowdown * narrowest_takes);
            expect_same(far, std::to_string(endpoints.size()) + " hosts, bundles of " + bundle);
            EXPECT_GT(counter(far.report, "questions"), 0) << "questions should have travelled";
            EXPECT_EQ(counter(far.report, "broken_packets"), 0);
        }
    }
}

TEST_P(SameImage, WithOperatorsSpreadOverThreads) {
    ASSERT_EQ(serial.code, 0) << serial.said;
    for (const auto& threads : threads_tried) {
        const auto hosts = spread(std::vector<std::string>(std::stoul(threads), "here"));
        for (const auto& bundle : bundles_tried) {
            const auto spread_out =
                launch(graph, folder, with(small, {"--hosts", hosts, "--bundle", bundle, "--tile", "16"}));
            expect_same(spread_out, threads + " threads, bundles of " + bundle);
            EXPECT_GT(counter(spread_out.report, "questions"), 0) << "questions should have crossed sockets";
            EXPECT_EQ(counter(spread_out.report, "bytes"), 0) << "but no line between hosts";
            EXPECT_NE(spread_out.report.find("\"mode\": \"threads\""), std::string::npos);
        }
    }
}

TEST_P(SameImage, WithOperatorsSpreadOverThreadsAndDaemons) {
    ASSERT_EQ(serial.code, 0) << serial.said;
    const Daemon daemon(folder, 2);
    const auto mixed = launch(graph, folder, with(small, {"--hosts", spread({"here", daemon.endpoint, "here"})}));
    expect_same(mixed, "two places of this process and a daemon");
    EXPECT_GT(counter(mixed.report, "questions"), 0);
    EXPECT_NE(mixed.report.find("\"host\": \"here\""), std::string::npos) << mixed.report;
    const auto helped =
        launch(graph, folder, with(small, {"--hosts", spread({"here", "here"}), "--local-workers", "1"}));
    expect_same(helped, "two places of this process and a local worker");
}

// Nanoseconds that all threads but the first have run.
std::uint64_t time_of_others(int process) {
    std::uint64_t time = 0;
    for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task"))
        if (thread.path().filename() != std::to_string(process))
            time += std::stoull(bytes_of(thread.path() / "schedstat"));
    return time;
}

// Threads that have helped to load the scene may still be there, but do nothing.
TEST(Serial, OpensNoSocketAndRendersInOneThread) {
    const Folder folder;
    Process run(launch_words(graph_file("cornell.lua"), folder / "picture.exr",
                             {"--size", "128x128", "--samples", "64", "--progress", "json", "--threads", "1"}));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    const auto process = std::filesystem::path("/proc") / std::to_string(run.id());
    for (const auto& file : std::filesystem::directory_iterator(process / "fd")) {
        std::error_code ignored;
        EXPECT_EQ(std::filesystem::read_symlink(file.path(), ignored).string().find("socket:"), std::string::npos);
    }
    const auto before = time_of_others(run.id());
    const auto said = run.output().size();
    for (int turn = 0; turn < 500 && run.output().size() == said; ++turn)
        run.wait_for("never said", std::chrono::milliseconds(20));
    ASSERT_GT(run.output().size(), said) << "it should say how far it is again and again";
    EXPECT_LT(time_of_others(run.id()) - before, 5'000'000u) << "they sleep, or nearly so";
    EXPECT_EQ(run.wait(), 0);
}

INSTANTIATE_TEST_SUITE_P(EveryGraph, SameImage, ::testing::ValuesIn(graph_files()),
                         [](const auto& graph) { return std::filesystem::path(graph.param).stem().string(); });

}  // namespace
}  // namespace lightnet::test
