// Sixteen hosts of 64 places, whose operators ask each other: one line between two hosts serves all of them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

constexpr int hosts = 16, places = 64;

std::size_t entries(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(ManyPlaces, OnManyHostsNeedOneLineBetweenTwoOfThem) {
    const Folder folder;
    std::vector<std::unique_ptr<Daemon>> daemons;
    std::ofstream file(folder / "hosts.lua");
    for (int i = 0; i < hosts; ++i) {
        daemons.push_back(std::make_unique<Daemon>(folder, places));
        file << "place \"" << daemons.back()->endpoint << "\" "
             << (i < hosts / 2 ? "{ direct = 64, lighting = 1 }\n" : "{ bounce = 32, image = 64 }\n");
    }
    file.close();
    const std::vector<std::string> small{"--size", "64x64", "--samples", "64", "--progress", "json"};
    auto words = launch_words(graph_file("cornell.lua"), folder / "many.exr", small);
    words.insert(words.end(), {"--hosts", (folder / "hosts.lua").string(), "--wait", "60"});
    Process run(words);
    ASSERT_TRUE(run.wait_for("\"phase\":\"render\",\"done\":1", slowdown * std::chrono::seconds(120))) << run.output();
    std::size_t most = 0;
    for (const auto& daemon : daemons)
        most = std::max(most, entries("/proc/" + std::to_string(daemon->process->id()) + "/fd"));
    EXPECT_LT(most, 5u * places + 6 * hosts) << "descriptors grow with places plus hosts, not with their product";
    ASSERT_EQ(run.wait(slowdown * std::chrono::seconds(300)), 0) << run.output();
    words = launch_words(graph_file("cornell.lua"), folder / "alone.exr", small);
    ASSERT_EQ(Process(words).wait(), 0);
    EXPECT_TRUE(bytes_of(folder / "many.exr") == bytes_of(folder / "alone.exr"));
}

}  // namespace
}  // namespace lightnet::test
