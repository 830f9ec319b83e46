// A daemon and its port: who is served, who is refused, what stays behind.
#include <gtest/gtest.h>

#include <csignal>
#include <random>

#include "core/base/build_info.hpp"
#include "core/network/graph/plan.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/modes/stranger.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Packet;
using packet::Type;
using std::chrono::seconds;

const std::vector<std::string> tiny{"--size", "16x16", "--samples", "1", "--progress", "plain"};

Packet hello(const std::string& build) {
    return packet::pack(Type::hello, 0, Fields{}.set("build", build).set("isa", "sse4.2"));
}

class DaemonTest : public ::testing::Test {
protected:
    std::string hosts_file() {
        std::ofstream(folder / "hosts.lua") << "place \"" << daemon.endpoint << "\" {}\n";
        return folder / "hosts.lua";
    }
    Launch launch_there() {
        auto words = tiny;
        words.insert(words.end(), {"--hosts", hosts_file()});
        return launch(graph_file("cornell.lua"), folder, words);
    }
    Folder folder;
    Daemon daemon{folder};
};

TEST_F(DaemonTest, WelcomesALauncherOfItsOwnBuild) {
    Stranger launcher(daemon.endpoint);
    launcher.send(hello(build_id()));
    const auto [type, fields] = launcher.receive();
    EXPECT_EQ(type, Type::welcome);
    EXPECT_EQ(fields.number("places"), 1u);
    EXPECT_NE(fields.number("fingerprint"), 0u);
}

TEST_F(DaemonTest, KeepsASignalIgnoredThatWasSoAndEndsInOrderWhenSlurmWarnsIt) {
    Process one({"/bin/sh", "-c", "trap '' INT; exec \"$@\"", "sh", program("lightnetd"), "--listen",
                 "tcp://127.0.0.1:*", "--places", "1", "--cache", folder / "other"});
    ASSERT_TRUE(one.wait_for("listening on ") && one.wait_for("\n")) << one.output();
    const auto from = one.output().find("tcp://");
    const auto endpoint = one.output().substr(from, one.output().find('\n', from) - from);
    one.signal(SIGINT);
    auto words = tiny;
    words.insert(words.end(), {"--hosts", folder.write("one.lua", "place '" + endpoint + "' {}")});
    EXPECT_EQ(launch(graph_file("cornell.lua"), folder, words).code, 0);
    one.signal(SIGUSR1);
    EXPECT_EQ(one.wait(), 0) << one.output();
}

TEST_F(DaemonTest, RefusesAnotherBuildAndNamesBoth) {
    Stranger launcher(daemon.endpoint);
    launcher.send(hello("9.9.9 (somewhere else)"));
    const auto [type, fields] = launcher.receive();
    EXPECT_EQ(type, Type::refuse);
    EXPECT_NE(fields.text("text").find("9.9.9 (somewhere else)"), std::string::npos);
    EXPECT_NE(fields.text("text").find(build_id()), std::string::npos);
}

TEST_F(DaemonTest, RefusesAnInstructionSetThatItDoesNotHave) {
    Stranger launcher(daemon.endpoint);
    launcher.send(packet::pack(Type::hello, 0, Fields{}.set("build", build_id()).set("isa", "avx9000")));
    const auto [type, fields] = launcher.receive();
    EXPECT_EQ(type, Type::refuse);
    EXPECT_NE(fields.text("text").find("avx9000"), std::string::npos) << fields.text("text");
}

TEST_F(DaemonTest, RefusesAnotherProtocolVersionAndNamesBoth) {
    auto packet = hello(build_id());
    packet.header[4] = std::byte{9};
    Stranger launcher(daemon.endpoint);
    launcher.send(packet);
    const auto [type, fields] = launcher.receive();
    EXPECT_EQ(type, Type::refuse);
    EXPECT_NE(fields.text("text").find("version " + std::to_string(packet::version) + " is spoken here, not 9"),
              std::string::npos)
        << fields.text("text");
}

TEST_F(DaemonTest, RefusesAJobThatIsNone) {
    Stranger launcher(daemon.endpoint);
    launcher.send(packet::pack(Type::begin, 5, Fields{}.set("job", "{}").set("plan", "[1").set("you", "x")));
    EXPECT_EQ(launcher.receive().first, Type::broken);
    // Well-formed, but the graph has a kind that is none, or the plan has no row for its nodes.
    const std::string rest =
        R"("scene":"","files":[],"seed":0,"isa":"sse4.2","width":8,"height":8,"tuning":{"bundle":1,
        "oldest_us":1,"eager":1,"credit":1,"credit_questions":1,"credit_bytes":1,"spare_fibers":0,
        "side_fibers":1,"check_answers":false,"call_own_nodes":true}})";
    Graph strange;
    strange.nodes = {{"a", "NoSuchKind", {}, {}, {}}};
    launcher.send(packet::pack(Type::begin, 6,
                               Fields{}
                                   .set("job", "{\"graph\":" + to_json(strange) + "," + rest)
                                   .set("plan", to_json(Plan{}))
                                   .set("you", "x")));
    EXPECT_EQ(launcher.receive().first, Type::broken);
    EXPECT_EQ(launch_there().code, 0) << "and serves the next run";
}

TEST_F(DaemonTest, OutlivesGarbageAndServesOn) {
    std::mt19937 random(3);
    {
        Stranger stranger(daemon.endpoint);
        for (int i = 0; i < 500; ++i) {
            std::string junk(random() % 200, '\0');
            for (auto& c : junk) c = static_cast<char>(random());
            stranger.send(junk);
            auto packet = hello(build_id());
            packet.header[random() % packet.header.size()] ^= static_cast<std::byte>(1 + random() % 255);
            stranger.send(packet);
            packet = hello(build_id());
            packet.body.resize(random() % packet.body.size());
            stranger.send(packet);
        }
        stranger.send(hello(build_id()));
        while (stranger.receive().first != Type::welcome) {
        }
    }
    EXPECT_EQ(launch_there().code, 0);
}

TEST_F(DaemonTest, ServesRunAfterRunAndIsSentFilesOnce) {
    const auto first = launch_there(), second = launch_there();
    ASSERT_EQ(first.code, 0) << first.said;
    ASSERT_EQ(second.code, 0) << second.said;
    EXPECT_TRUE(first.picture == second.picture);
    EXPECT_GT(counter(first.report, "file_bytes"), 0);
    EXPECT_EQ(counter(second.report, "file_bytes"), 0) << "the second run sends hashes only";
}

// A file goes over the wire in many pieces, and more of them than are under way at once.
TEST_F(DaemonTest, WithNothingYetIsSentLargeFilesPieceByPiece) {
    {
        std::ofstream scene(folder / "large.pbrt");
        scene << "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nTranslate 0 0 4\n";
        for (int i = 0; i < 120'000; ++i) scene << "# " << i << " is a remark that makes this file large\n";
        scene << "Shape \"sphere\"\n";
    }
    const auto graph = folder / "large.lua";
    std::ofstream(graph) << "scene = Scene { 'large.pbrt' }\ndirect = DirectLighting {}\n"
                            "image = RayTracer { direct, scene = scene, film = { 16, 16 }, samples = 1 }\n";
    const auto here = launch(graph, folder, {"--progress", "none", "--threads", "1"});
    const auto there = launch(graph, folder, {"--progress", "none", "--hosts", hosts_file()});
    ASSERT_EQ(here.code, 0) << here.said;
    ASSERT_EQ(there.code, 0) << there.said;
    EXPECT_TRUE(here.picture == there.picture);
    EXPECT_GE(counter(there.report, "file_bytes"), double(std::filesystem::file_size(folder / "large.pbrt")));
}

TEST_F(DaemonTest, ServesOneRunAtATimeAndTellsTheOtherToWait) {
    auto words = launch_words(graph_file("cornell.lua"), folder / "long.exr",
                              {"--size", "128x128", "--samples", "256", "--progress", "json", "--hosts", hosts_file()});
    Process first(words);
    ASSERT_TRUE(first.wait_for("\"done\"")) << first.output();
    const auto second = launch_there();
    EXPECT_EQ(second.code, 0);
    EXPECT_NE(second.said.find("serves another run"), std::string::npos) << second.said;
    EXPECT_EQ(first.wait(), 0) << first.output();
}

TEST_F(DaemonTest, LeavesNothingBehindWhenItStops) {
    ASSERT_EQ(launch_there().code, 0);
    daemon.process->signal(SIGTERM);
    EXPECT_EQ(daemon.process->wait(), 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "cache"))
        if (entry.path().filename() != "CACHEDIR.TAG") {
            EXPECT_EQ(entry.path().filename().string().size(), 64u) << entry.path() << " is no blob";
        }
}

TEST(Daemon, ThatIsNotThereEndsTheRunWithCode3) {
    const Folder folder;
    std::ofstream(folder / "hosts.lua") << "place \"tcp://127.0.0.1:1\" {}\n";
    auto words = tiny;
    words.insert(words.end(), {"--hosts", (folder / "hosts.lua").string()});
    const auto run = launch(graph_file("cornell.lua"), folder, words);
    EXPECT_EQ(run.code, 3);
    EXPECT_NE(run.said.find("tcp://127.0.0.1:1: does not answer"), std::string::npos) << run.said;
}

TEST(Daemon, ListensBeyondItsMachineOnlyWhenToldThatThisIsInsecure) {
    Process daemon({program("lightnetd"), "--listen", "tcp://0.0.0.0:*"});
    EXPECT_EQ(daemon.wait(), 2);
    EXPECT_NE(daemon.output().find("--insecure"), std::string::npos);
}

}  // namespace
}  // namespace lightnet::test
