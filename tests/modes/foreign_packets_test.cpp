// What somebody says who is not of the run changes nothing in it.
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "core/base/build_info.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/plan.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/modes/stranger.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Type;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

class ForeignPackets : public ::testing::Test {
protected:
    std::vector<std::string> words(const std::string& name) {
        std::ofstream(folder / "hosts.lua") << "place \"" << daemon.endpoint << "\" {}\n";
        return launch_words(
            graph_file("cornell.lua"), folder / name,
            {"--size", "64x64", "--samples", "64", "--progress", "json", "--hosts", (folder / "hosts.lua").string()});
    }
    Folder folder;
    Daemon daemon{folder, 2};
};

TEST_F(ForeignPackets, DoNotPlanEndFeedOrQuestionARun) {
    Process undisturbed(words("undisturbed.exr"));
    ASSERT_EQ(undisturbed.wait(), 0) << undisturbed.output();

    Process run(words("picture.exr"));
    ASSERT_TRUE(run.wait_for("\"phase\":\"render\"")) << run.output();
    Stranger stranger(daemon.endpoint);
    stranger.send(packet::pack(Type::ping, 0, {}));
    const auto [type, pong] = stranger.receive();
    ASSERT_EQ(type, Type::pong);
    EXPECT_EQ(pong.number("run"), 0u) << "a stranger is told no number of a run";
    stranger.send(packet::pack(Type::status, 0, {}));
    EXPECT_EQ(stranger.receive().first, Type::state);
    EXPECT_EQ(stranger.run(), 0u);

    // A plan by which lights would be asked of somebody else, and whatever else only members may say.
    const Plan elsewhere{{{daemon.endpoint, 0}, {"tcp://127.0.0.1:9", 0}}, {{}, {1}, {1}, {1}, {0}}};
    std::mt19937_64 random(7);
    for (int i = 0; i < 300; ++i) {
        const auto guess = i % 3 == 0 ? 0 : random();
        stranger.send(packet::pack(Type::plan, guess, Fields{}.set("plan", to_json(elsewhere))));
        stranger.send(packet::pack(Type::end, guess, {}));
        stranger.send(packet::pack(Type::expect, guess, Fields{}.set("hash", to_hex(Hash{})).set("size", 100)));
        stranger.send(packet::pack(guess, packet::Piece{Hash{}, 0, std::as_bytes(std::span("false", 5))}));
        Message message;
        message.run = guess;
        message.questions = std::make_shared<const std::vector<Query>>(4);
        stranger.send(packet::pack(message, 0));
    }
    stranger.send(packet::pack(Type::begin, 5, Fields{}.set("job", "{}").set("plan", "{}").set("you", "x")));
    ASSERT_EQ(run.wait(), 0) << run.output();
    EXPECT_TRUE(bytes_of(folder / "picture.exr") == bytes_of(folder / "undisturbed.exr"));
    EXPECT_THAT(run.output(), Not(HasSubstr("is lost")));
}

TEST_F(ForeignPackets, ThatBeginRunsAreReadBesideTheServing) {
    // Many small objects: whoever reads such a text must not keep others waiting.
    std::string job = R"({"graph":{"nodes":[)";
    for (int i = 0; i < 200'000; ++i) job += R"({"a":{"b":1}},)";
    job += "0]}}";
    Stranger stranger(daemon.endpoint), other(daemon.endpoint);
    stranger.send(packet::pack(Type::begin, 5, Fields{}.set("job", job).set("plan", "{}").set("you", "x")));
    const auto begun = std::chrono::steady_clock::now();
    other.send(packet::pack(Type::status, 0, {}));
    EXPECT_EQ(other.receive().first, Type::state);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, slowdown * seconds(1));
    EXPECT_EQ(stranger.receive().first, Type::broken);
    EXPECT_EQ(Process(words("picture.exr")).wait(), 0) << "and the next run is served";
}

TEST_F(ForeignPackets, AreToldOfInSoManyLinesAndNoMore) {
    Stranger stranger(daemon.endpoint);
    for (int i = 0; i < 300; ++i) {
        stranger.send(packet::pack(Type::begin, 5, Fields{}.set("job", "{}").set("plan", "{}").set("you", "x")));
        ASSERT_EQ(stranger.receive().first, Type::broken);
    }
    daemon.process->signal(SIGTERM);
    ASSERT_EQ(daemon.process->wait(), 0);
    const auto& said = daemon.process->output();
    const auto lines = static_cast<int>(std::count(said.begin(), said.end(), '\n'));
    EXPECT_LT(lines, 60) << said;
    EXPECT_THAT(said, HasSubstr("more lines like 'refuses a …'"));
}

TEST_F(ForeignPackets, AreNoJobWhenTheyAreTooLong) {
    Stranger stranger(daemon.endpoint);
    stranger.send(packet::pack(Type::begin, 5, Fields{}.set("job", std::string(40 << 20, ' ')).set("plan", "{}")));
    const auto [type, fields] = stranger.receive();
    EXPECT_EQ(type, Type::broken);
    EXPECT_THAT(fields.text("text"), HasSubstr("larger than any that is taken"));
}

TEST(Joining, BeyondThisMachineTakesInsecure) {
    Process daemon({program("lightnetd"), "--join", "tcp://10.99.0.1:7000"});
    EXPECT_EQ(daemon.wait(), 2);
    EXPECT_THAT(daemon.output(), HasSubstr("--insecure"));
    const Folder folder;
    std::ofstream(folder / "hosts.lua") << "place \"tcp://10.99.0.1:7000\" {}\nplace \"tcp://10.99.0.2:7000\" {}\n";
    Process run(
        launch_words(graph_file("cornell.lua"), folder / "x.exr", {"--hosts", (folder / "hosts.lua").string()}));
    EXPECT_EQ(run.wait(), 2);
    EXPECT_THAT(run.output(), HasSubstr("hosts.lua:1: 'tcp://10.99.0.1:7000' goes beyond this machine"));
    EXPECT_THAT(run.output(), HasSubstr("hosts.lua:2: ")) << "all at once";
}

TEST(Joining, TakesThePassOfTheRunsUser) {
    const Folder folder, home, strange;
    const auto out = folder / "picture.exr";
    Process run(launch_words(graph_file("cornell.lua"), out,
                             {"--size", "32x32", "--samples", "4", "--progress", "json", "--listen",
                              "tcp://127.0.0.1:*", "--pass", home.file("pass")}));
    const auto endpoint = join_endpoint(run);
    auto stranger = joining_daemon(folder, endpoint, "stranger", {"--pass", strange.file("pass")});
    EXPECT_TRUE(stranger->wait_for("does not let this host in")) << stranger->output();
    EXPECT_TRUE(run.wait_for("does not know the pass of this run's user")) << run.output();
    auto friendly = joining_daemon(strange, endpoint, "friendly", {"--pass", home.file("pass")});
    EXPECT_EQ(run.wait(), 0) << run.output();
    EXPECT_THAT(run.output(), HasSubstr("friendly is ready"));
    EXPECT_THAT(run.output(), Not(HasSubstr("stranger is")));
    for (const auto& file : std::filesystem::directory_iterator(folder / "cache"))
        EXPECT_EQ(file.path().filename(), "CACHEDIR.TAG") << "it was sent none of the job's files";
}

}  // namespace
}  // namespace lightnet::test
