// Sixteen hosts of 64 places, whose operators ask each other: one line between two hosts serves all of them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "tests/modes/daemons.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::test {
namespace {

constexpr int hosts = 16, places = 64;

std::size_t entries(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

void expect_one_line_between_two(bool with_keys) {
    const Folder folder;
    const auto key_in = [&](const std::string& name) {
        return load_or_make_key(folder.file(name + ".key")).open.text();
    };
    const auto list = folder.write("launchers", key_in("user") + " user\n");
    std::vector<std::unique_ptr<Daemon>> daemons;
    std::ofstream file(folder / "hosts.lua");
    for (int i = 0; i < hosts; ++i) {
        const auto name = "host " + std::to_string(i);
        std::vector<std::string> keyed;
        if (with_keys) keyed = {"--key", folder.file(name + ".key"), "--allow", list};
        daemons.push_back(std::make_unique<Daemon>(folder, places, "tcp://127.0.0.1:*", keyed));
        file << "place \"" << daemons.back()->endpoint << "\" { "
             << (i < hosts / 2 ? "direct = 64, lighting = 1" : "bounce = 32, image = 64");
        if (with_keys) file << ", key = \"" << key_in(name) << "\"";
        file << " }\n";
    }
    file.close();
    const std::vector<std::string> small{"--size", "64x64", "--samples", "64", "--progress", "json"};
    auto words = launch_words(graph_file("cornell.lua"), folder / "many.exr", small);
    words.insert(words.end(), {"--hosts", (folder / "hosts.lua").string(), "--wait", "60"});
    if (with_keys) words.insert(words.end(), {"--key", folder.file("user.key")});
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

TEST(ManyPlaces, OnManyHostsNeedOneLineBetweenTwoOfThem) { expect_one_line_between_two(false); }

TEST(ManyPlaces, OnManyHostsThatHaveKeysNeedNoMoreLines) { expect_one_line_between_two(true); }

}  // namespace
}  // namespace lightnet::test
