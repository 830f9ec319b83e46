// Records that one run keeps and another goes on from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/modes/daemons.hpp"
#include "tests/support/pixels_in.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;

const std::vector<std::string> small{"--size", "32x32",   "--samples",  "4",     "-D",      "photons=5000",
                                     "-D",     "rays=32", "--progress", "plain", "--cache", "none"};

std::vector<std::string> with(std::vector<std::string> words) {
    words.insert(words.begin(), small.begin(), small.end());
    return words;
}

struct Records {
    int all = 0, older = 0;
};

// What the cache says of itself: "soft: 312 records, 280 of them from an earlier run".
Records records(const std::string& said) {
    Records found;
    const auto at = said.rfind("soft: ", said.find(" records"));
    EXPECT_GE(std::sscanf(said.c_str() + at, "soft: %d records, %d of them", &found.all, &found.older), 1) << said;
    return found;
}

class Keep : public testing::Test {
protected:
    // figure5.lua in a folder of its own, with more parameters for its cache, and another camera.
    std::string graph(const std::string& name, const std::string& more, const std::string& camera = "") {
        for (const char* scene : {"glass_ball.pbrt", "cornell_box.pbrt"})
            std::ofstream(folder / scene) << bytes_of(graph_file(scene));
        auto text = bytes_of(graph_file("paper/figure5.lua"));
        const auto put = [&](const std::string& before, const std::string& what) {
            const auto at = text.find(before);
            ASSERT_NE(at, std::string::npos) << before;
            text.insert(at + before.size(), what);
        };
        text.replace(text.find("../glass"), 3, "");  // the scene lies beside it
        put("rays = rays", more);
        put("Scene           { file", camera);
        std::ofstream(folder / name) << text;
        return folder / name;
    }

    static constexpr const char* aside = ", camera = { from = { 300, 200, -700 }, to = { 278, 273, 0 } }";
    Folder folder;
};

TEST_F(Keep, LetsAnotherViewOfASceneGoOnFromTheRecordsOfOne) {
    const auto first = launch(graph("first.lua", ", keep = 'room.records'"), folder, with({}));
    ASSERT_EQ(first.code, 0) << first.said;
    EXPECT_THAT(first.said, HasSubstr("soft: kept in"));
    EXPECT_TRUE(bytes_of(folder / "room.records").starts_with("lightnet kept 1\nwhat irradiance records\n"));

    const auto alone = launch(graph("alone.lua", "", aside), folder, with({}));
    const auto second_graph = graph("second.lua", ", extend = 'room.records'", aside);
    const auto second = launch(second_graph, folder, with({"--threads", "1"}));
    ASSERT_EQ(second.code, 0) << second.said;
    EXPECT_FALSE(pixels_in(second.picture) == pixels_in(alone.picture)) << "the older records should count";
    const auto found = records(first.said);
    EXPECT_GT(found.all, 20);
    EXPECT_EQ(records(second.said).older, found.all);
    EXPECT_GT(records(second.said).all, found.all) << "another view sees more";

    const auto again = launch(graph("again.lua", ", extend = 'room.records'"), folder, with({}));
    EXPECT_EQ(records(again.said).older, found.all);
    EXPECT_LT(records(again.said).all, 1.2 * found.all) << "the same view has most of what it needs";
    for (const auto& mode : {std::vector<std::string>{"--threads", "2"}, {"--local-workers", "2"}}) {
        const auto other = launch(second_graph, folder, with(mode));
        ASSERT_EQ(other.code, 0) << other.said;
        EXPECT_TRUE(other.picture == second.picture) << mode[0];
    }
}

TEST_F(Keep, KeepsTheSameInEveryMode) {
    const auto keeping = graph("keep.lua", ", keep = 'a.records'");
    ASSERT_EQ(launch(keeping, folder, with({"--threads", "1"})).code, 0);
    const auto kept = bytes_of(folder / "a.records");
    for (const auto& mode : {std::vector<std::string>{"--threads", "2"}, {"--local-workers", "2"}}) {
        std::filesystem::remove(folder / "a.records");
        ASSERT_EQ(launch(keeping, folder, with(mode)).code, 0);
        EXPECT_TRUE(bytes_of(folder / "a.records") == kept) << mode[0];
    }
}

// The graph guided.lua in a folder of its own, with more parameters for its guide.
TEST_F(Keep, LetsAGuideGoOnFromWhatAnotherRunHasLearnt) {
    std::ofstream(folder / "cornell_box.pbrt") << bytes_of(graph_file("cornell_box.pbrt"));
    const auto guided = [&](const std::string& name, const std::string& more) {
        auto text = bytes_of(graph_file("guided.lua"));
        text.replace(text.find("when = when"), 11, "when = 'always', " + more);
        std::ofstream(folder / name) << text;
        return folder / name;
    };
    const std::vector<std::string> few{"--size",     "32x32", "--samples", "4",    "-D",        "lessons=7000",
                                       "--progress", "plain", "--cache",   "none", "--threads", "1"};
    const auto keeping = guided("first.lua", "keep = 'room.directions'");
    ASSERT_EQ(launch(keeping, folder, few).code, 0);
    const auto kept = bytes_of(folder / "room.directions");
    EXPECT_TRUE(kept.starts_with("lightnet kept 1\nwhat light directions\n"));
    std::filesystem::remove(folder / "room.directions");
    auto daemons = few;
    daemons[10] = "--local-workers", daemons[11] = "2";
    ASSERT_EQ(launch(keeping, folder, daemons).code, 0);
    EXPECT_TRUE(bytes_of(folder / "room.directions") == kept) << "on daemons";

    const auto extending = guided("second.lua", "extend = 'room.directions'");
    const auto alone = launch(guided("alone.lua", ""), folder, few), second = launch(extending, folder, few);
    ASSERT_EQ(second.code, 0) << second.said;
    EXPECT_FALSE(pixels_in(second.picture) == pixels_in(alone.picture)) << "what was kept should count";
    EXPECT_TRUE(launch(extending, folder, daemons).picture == second.picture);

    auto damaged = kept;
    damaged.back() ^= 1;
    std::ofstream(folder / "room.directions") << damaged;
    EXPECT_THAT(launch(extending, folder, few).said, HasSubstr("room.directions' is damaged"));
}

TEST_F(Keep, IsRefusedForAnotherSceneAndForOtherFiles) {
    ASSERT_EQ(launch(graph("first.lua", ", keep = 'room.records'"), folder, with({})).code, 0);
    const auto extending = graph("second.lua", ", extend = 'room.records'");
    const auto other = launch(extending, folder, with({"-D", "file=cornell_box.pbrt"}));
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.said, HasSubstr("IrradianceCache 'soft': 'extend': "));
    EXPECT_THAT(other.said, HasSubstr("room.records' belongs to another scene"));

    auto damaged = bytes_of(folder / "room.records");
    damaged.back() ^= 1;
    std::ofstream(folder / "room.records") << damaged;
    EXPECT_THAT(launch(extending, folder, with({})).said, HasSubstr("room.records' is damaged"));
    std::ofstream(folder / "room.records") << "no records";
    EXPECT_THAT(launch(extending, folder, with({})).said, HasSubstr("is no file that a run has kept"));
    std::filesystem::remove(folder / "room.records");
    const auto missing = launch(extending, folder, with({}));
    EXPECT_EQ(missing.code, 2);
    EXPECT_THAT(missing.said, HasSubstr("room.records"));
}

}  // namespace
}  // namespace lightnet::test
