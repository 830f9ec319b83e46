// Runs that are watched: the same picture, whoever looks, and what a report shows of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "tests/modes/daemons.hpp"
#include "tests/modes/long_enough.hpp"
#include "tests/watch/visitor.hpp"

namespace lightnet::watched_run_test {
namespace {

using namespace std::chrono_literals;
using test::Folder;
using test::graph_file;
using test::Process;
using test::Visitor;
using testing::AllOf;
using testing::HasSubstr;

// A run on two local daemons, or in threads, that can be watched.
class WatchedRun {
public:
    explicit WatchedRun(const Folder& folder, std::vector<std::string> more) : picture(folder / "watched.exr") {
        more.insert(more.end(), {"--watch", "--cache", folder / "cache"});
        process = std::make_unique<Process>(test::launch_words(graph_file("cornell.lua"), picture, more));
        const std::string before = "watch it at http://127.0.0.1:";
        EXPECT_TRUE(process->wait_for(before) && process->wait_for("\n")) << process->output();
        const auto& said = process->output();
        const auto at = said.find(before) + before.size();
        port = static_cast<std::uint16_t>(std::atoi(said.c_str() + at));
        const auto token_at = said.find('#', at) + 1;
        token = said.substr(token_at, said.find('\n', token_at) - token_at);
    }
    std::string name() const { return "127.0.0.1:" + std::to_string(port); }

    std::filesystem::path picture;
    std::unique_ptr<Process> process;
    std::uint16_t port = 0;
    std::string token;
};

std::string unwatched(const Folder& folder, const std::vector<std::string>& words) {
    const auto launch = test::launch(graph_file("cornell.lua"), folder, words);
    EXPECT_EQ(launch.code, 0) << launch.said;
    return launch.picture;
}

#ifndef LIGHTNET_LARGE

// What a page does until the run ends: looks at all that comes. Returns the last state.
nlohmann::json watched_to_the_end(const WatchedRun& run) {
    Visitor visitor(run.port);
    EXPECT_TRUE(visitor.watch(run.name()));
    nlohmann::json last;
    std::size_t pixels = 0;
    while (const auto frame = visitor.next(test::slowdown * 10s)) {
        if (!frame->text)
            pixels += frame->data.size();
        else if (auto said = nlohmann::json::parse(frame->data); said.contains("state"))
            last = said["state"];
    }
    EXPECT_GT(pixels, 0u);
    return last;
}

class WatchedModes : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WatchedModes, GiveTheSameBytes) {
    const Folder folder;
    auto words = GetParam();
    words.insert(words.end(), {"--size", "96x96", "--samples", "64"});
    const auto plain = unwatched(folder, words);
    const WatchedRun run(folder, words);
    const auto last = watched_to_the_end(run);
    EXPECT_EQ(run.process->wait(), 0) << run.process->output();
    EXPECT_EQ(test::bytes_of(run.picture), plain);
    EXPECT_EQ(last["outcome"], "done");
    EXPECT_EQ(last["done"], 1.0);
}
INSTANTIATE_TEST_SUITE_P(InEveryMode, WatchedModes,
                         testing::Values(std::vector<std::string>{"--threads", "1"},
                                         std::vector<std::string>{"--threads", "2"},
                                         std::vector<std::string>{"--local-workers", "2"}));

TEST(WatchedRun, EndsWhenSomebodyWithTheTokenWantsIt) {
    const Folder folder;
    const WatchedRun run(folder, {"--threads", "2", "--samples", "1000000"});
    Visitor visitor(run.port);
    ASSERT_TRUE(visitor.watch(run.name()));
    visitor.say(R"({"do":"end","token":"no"})");
    ASSERT_TRUE(visitor.next_with(R"("allowed":false)"));
    ASSERT_TRUE(visitor.next_with(R"("phase":"render")"));
    visitor.say(R"({"do":"write","token":")" + run.token + "\"}");
    EXPECT_TRUE(visitor.next_with("shows the picture so far"));
    EXPECT_TRUE(std::filesystem::exists(run.picture));
    visitor.say(R"({"do":"end","token":")" + run.token + "\"}");
    EXPECT_TRUE(visitor.next_with(R"("outcome":"cancelled")"));
    EXPECT_EQ(run.process->wait(), 130) << run.process->output();
}

bool sees_all_hosts_ready(Visitor& visitor) {
    while (const auto text = visitor.next_with(R"("phase":"render")")) {
        const auto hosts = nlohmann::json::parse(*text)["state"]["hosts"];
        if (std::all_of(hosts.begin(), hosts.end(), [](const auto& host) { return host["there"] == true; }))
            return true;
    }
    return false;
}

TEST(WatchedRun, GoesOnWithoutAHostThatIsTakenOut) {
    const Folder folder;
    const test::Daemon one(folder), two(folder);
    const auto hosts = folder.write("lab.lua", "place '" + one.endpoint + "' {}\nplace '" + two.endpoint + "' {}\n");
    std::vector<std::string> words{"--samples", "64", "--size", "160x160"};
    const auto alone = test::launch_for(5s, graph_file("cornell.lua"), words).picture;
    words.insert(words.end(), {"--hosts", hosts});
    const WatchedRun run(folder, words);
    Visitor visitor(run.port);
    ASSERT_TRUE(visitor.watch(run.name()));
    ASSERT_TRUE(sees_all_hosts_ready(visitor)) << run.process->output();
    visitor.say(R"({"do":"drain","host":")" + one.endpoint + R"(","token":")" + run.token + "\"}");
    EXPECT_TRUE(visitor.next_with("is taken out: somebody who watched the run wanted it so")) << run.process->output();
    visitor.say(R"({"do":"drain","host":")" + two.endpoint + R"(","token":")" + run.token + "\"}");
    EXPECT_TRUE(visitor.next_with("can't be taken out")) << run.process->output();
    const auto code = run.process->wait();
    EXPECT_EQ(code, 0) << run.process->output();
    EXPECT_EQ(test::bytes_of(run.picture), alone);
    EXPECT_EQ(unwatched(folder, words), alone) << "and the daemon that was taken out serves another run";
}

TEST(WatchedRun, TellsWhatPlacesAndEdgesDid) {
    const Folder folder;
    const WatchedRun run(folder, {"--local-workers", "2", "--samples", "256", "--size", "128x128"});
    const auto last = watched_to_the_end(run);
    ASSERT_EQ(last["hosts"].size(), 2u);
    for (const auto& host : last["hosts"]) EXPECT_FALSE(host["looks"].empty()) << host;
    std::uint64_t busy = 0;
    for (const auto& host : last["hosts"])
        for (const auto& place : host["looks"]) busy += place[0].get<std::uint64_t>();
    EXPECT_GT(busy, 0u);
    for (const auto& edge : last["edges"]) EXPECT_GT(edge[0].get<std::uint64_t>(), 0u);
}

// What is said of a pixel to who clicks on it.
nlohmann::json explained(Visitor& visitor, const WatchedRun& run, const std::string& more) {
    visitor.say(R"({"do":"explain","token":")" + run.token + "\"," + more + "}");
    const auto said = visitor.next_with("\"explained\"");
    return said ? nlohmann::json::parse(*said)["explained"] : nlohmann::json::object();
}

class ExplainedModes : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(ExplainedModes, TellHowAPixelComesAbout) {
    const Folder folder;
    auto words = GetParam();
    words.insert(words.end(), {"--size", "96x96", "--samples", "1000000"});
    const WatchedRun run(folder, words);
    Visitor visitor(run.port);
    ASSERT_TRUE(visitor.watch(run.name()));
    ASSERT_TRUE(visitor.next_with(R"("phase":"render")"));
    const auto told = explained(visitor, run, R"("x":40,"y":50)");
    EXPECT_EQ(told["samples"], 64) << told;
    EXPECT_EQ(told["of"], 1000000);
    EXPECT_THAT(told["text"].get<std::string>(),
                AllOf(HasSubstr("pixel 40,50"), HasSubstr("bounce"), HasSubstr("sample ")));
    bool from_the_eye = false;
    for (const auto& ray : told["rays"]) {
        ASSERT_EQ(ray.size(), 6u) << ray;
        const double x = ray[2], y = ray[3];
        from_the_eye |= ray[4] == "" && 40 <= x && x <= 41 && 50 <= y && y <= 51;
    }
    EXPECT_TRUE(from_the_eye) << told["rays"];
    EXPECT_EQ(explained(visitor, run, R"("x":40,"y":50,"samples":16)")["samples"], 16);
    EXPECT_THAT(explained(visitor, run, R"("x":96,"y":50)")["error"].get<std::string>(), HasSubstr("no such pixel"));
    visitor.say(R"({"do":"explain","x":1,"y":1})");
    EXPECT_THAT(visitor.next_with("\"done\":\"explain\"").value_or(""), HasSubstr(R"("allowed":false)"))
        << "it costs time";
    visitor.say(R"({"do":"end","token":")" + run.token + "\"}");
    EXPECT_EQ(run.process->wait(), 130) << run.process->output();
}

TEST_P(ExplainedModes, GiveTheSameBytesWhilePixelsAreExplained) {
    const Folder folder;
    auto words = GetParam();
    words.insert(words.end(), {"--size", "96x96", "--samples", "64"});
    const auto plain = unwatched(folder, words);
    const WatchedRun run(folder, words);
    Visitor visitor(run.port);
    ASSERT_TRUE(visitor.watch(run.name()));
    for (int pixel = 0; run.process->wait(50ms) == -1; ++pixel) {
        visitor.say(R"({"do":"explain","token":")" + run.token + R"(","y":40,"x":)" + std::to_string(pixel % 96) + "}");
        while (visitor.next(10ms)) {
        }
    }
    EXPECT_EQ(run.process->wait(), 0) << run.process->output();
    EXPECT_EQ(test::bytes_of(run.picture), plain);
}
INSTANTIATE_TEST_SUITE_P(InEveryMode, ExplainedModes,
                         testing::Values(std::vector<std::string>{"--threads", "1"},
                                         std::vector<std::string>{"--threads", "2"},
                                         std::vector<std::string>{"--local-workers", "2"}));

TEST(WatchedRun, ExplainsWhatTheCommandWouldExplain) {
    const Folder folder;
    const WatchedRun run(folder, {"--threads", "2", "--size", "64x64", "--samples", "1000000"});
    Visitor visitor(run.port);
    ASSERT_TRUE(visitor.watch(run.name()));
    ASSERT_TRUE(visitor.next_with(R"("phase":"render")"));
    const auto live = explained(visitor, run, R"("x":20,"y":30)")["text"].get<std::string>();
    const auto picture = unwatched(folder, {"--threads", "2", "--size", "64x64", "--samples", "64"});
    test::Process command({test::program("lightnet"), "explain", folder / "picture.exr", "20,30", "--most", "3"});
    EXPECT_EQ(command.wait(), 0) << command.output();
    const auto story = [](const std::string& text) {
        return text.substr(std::min(text.size(), text.find("\nsample ")));
    };
    EXPECT_EQ(story(live), story(command.output()));
}

TEST(RunReport, IsOnePageWithAllThatTheRunDid) {
    const Folder folder;
    const auto html = folder / "run.html";
    const auto launch = test::launch(graph_file("cornell.lua"), folder,
                                     {"--threads", "2", "--size", "64x64", "--samples", "16", "--report", html});
    ASSERT_EQ(launch.code, 0) << launch.said;
    const auto page = test::bytes_of(html);
    EXPECT_LT(page.size(), 5'000'000u);
    const std::string mark = "<script type=\"application/json\" id=\"frozen\">";
    const auto at = page.find(mark);
    ASSERT_NE(at, std::string::npos);
    const auto frozen =
        nlohmann::json::parse(page.substr(at + mark.size(), page.find("</script>", at) - at - mark.size()));
    EXPECT_EQ(frozen["state"]["outcome"], "done");
    EXPECT_EQ(frozen["hello"]["colours"].size(), 3u);
    EXPECT_EQ(frozen["picture"]["width"], 64);
    EXPECT_EQ(frozen["picture"]["step"], 1);
    EXPECT_EQ(frozen["state"]["hosts"][0]["looks"].size(), 2u);
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(RunReport, TakesNoPlaceOfAnotherPage) {
    const Folder folder;
    const auto html = folder.write("index.html", "<!doctype html>\n<p>somebody's</p>");
    const auto launch =
        test::launch(graph_file("cornell.lua"), folder, {"--threads", "2", "--samples", "1", "--report", html});
    EXPECT_EQ(launch.code, 2) << launch.said;
    EXPECT_THAT(test::bytes_of(html), HasSubstr("somebody's"));
}

#else

// They come, look, and vanish in the middle of what they were told.
TEST(WatchedRun, GivesTheSameBytesWhileAHundredComeAndVanish) {
    const Folder folder;
    const std::vector<std::string> words{"--threads", "2", "--size", "256x256", "--samples", "512"};
    const auto plain = unwatched(folder, words);
    const WatchedRun run(folder, words);
    std::atomic<int> visits{0};
    std::vector<std::jthread> crowd;
    for (int i = 0; i < 100; ++i)
        crowd.emplace_back([&, i](const std::stop_token& stop) {
            while (!stop.stop_requested()) {
                Visitor visitor(run.port);
                if (!visitor.connected()) return;
                if (visitor.watch(run.name()))
                    for (int k = 0; k < i % 7; ++k) visitor.next(200ms);
                ++visits;
                std::this_thread::sleep_for(std::chrono::milliseconds(10 * (i % 20)));
            }
        });
    EXPECT_EQ(run.process->wait(test::slowdown * 300s), 0) << run.process->output();
    crowd.clear();
    EXPECT_GT(visits, 100);
    EXPECT_EQ(test::bytes_of(run.picture), plain);
}

#endif

}  // namespace
}  // namespace lightnet::watched_run_test
