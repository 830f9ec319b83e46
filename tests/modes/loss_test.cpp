// Workers that are lost, hang, leave and come in the middle of a run: the bytes stay the same.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/modes/daemons.hpp"
#include "tests/modes/long_enough.hpp"
#include "tests/modes/stranger.hpp"
#include "tests/support/own_loopback.hpp"

namespace lightnet::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

// Long enough that something can happen in the middle, and a host that hangs is noticed before the others are done.
constexpr auto length = seconds(3);
std::vector<std::string> some_seconds{"--size",     "128x128", "--samples", std::to_string(64 / slowdown),
                                      "--progress", "json",    "--tile",    "16"};

// Who held a node at the end, as run.json has it.
std::vector<std::string> holders_of(const std::string& node, const std::string& report) {
    std::vector<std::string> holders;
    const auto all = nlohmann::json::parse(report);
    for (const auto& place : all.at("places"))
        for (const auto& held : place.at("nodes"))
            if (held == node) holders.push_back(place.at("host"));
    return holders;
}

class Loss : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        const auto made = launch_for(length, graph_file("cornell.lua"), some_seconds);
        reference = new std::string(made.picture);
        ASSERT_FALSE(reference->empty());
        rays = counter(made.report, "rays");
    }
    static void TearDownTestSuite() { delete reference; }

    std::string hosts_file(const std::vector<std::string>& places) {
        std::ofstream file(folder / "hosts.lua");
        for (const auto& place : places) file << "place " << place << "\n";
        return folder / "hosts.lua";
    }
    static std::string whole(const std::string& endpoint) { return "\"" + endpoint + "\" { places = 1 }"; }

    std::unique_ptr<Process> start(const std::vector<std::string>& places, std::vector<std::string> more = {}) {
        auto words = some_seconds;
        words.insert(words.end(), {"--hosts", hosts_file(places)});
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), out, words));
    }
    // Some tiles are done, and many are not.
    static ::testing::AssertionResult in_the_middle(Process& run) {
        return run.wait_for("\"event\":\"progress\"") ? ::testing::AssertionSuccess()
                                                      : ::testing::AssertionFailure() << run.output();
    }
    Launch expect_same(Process& run) {
        auto end = finish(run, out);
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == *reference) << "the bytes differ\n" << end.said;
        return end;
    }

    static std::string* reference;
    static inline double rays = 0;  // that it takes
    Folder folder;
    std::filesystem::path out = folder / "picture.exr";
};
std::string* Loss::reference = nullptr;

TEST_F(Loss, OfAKilledDaemonChangesNoByte) {
    const Daemon one(folder), two(folder);
    const auto run = start({whole(one.endpoint), whole(two.endpoint)});
    ASSERT_TRUE(in_the_middle(*run));
    two.process->signal(SIGKILL);
    const auto end = expect_same(*run);
    EXPECT_GT(counter(end.report, "asked_again"), 0) << "it should have had work";
    EXPECT_NE(end.said.find("is lost"), std::string::npos) << end.said;
}

TEST_F(Loss, OfADaemonThatDealsToItsPlacesChangesNoByte) {
    const Daemon one(folder), two(folder);
    const auto run = start({"\"" + one.endpoint + "\" { image = 2, bounce = 2, direct = 1 }",
                            "\"" + two.endpoint + "\" { image = 2, bounce = 2, lighting = 2 }"});
    ASSERT_TRUE(in_the_middle(*run));
    one.process->signal(SIGKILL);
    const auto end = expect_same(*run);
    EXPECT_GT(counter(end.report, "asked_again"), 0) << end.report;
    EXPECT_GT(counter(end.report, "dealt"), 0) << end.report;
}

TEST_F(Loss, OfALocalWorkerIsNoticedAtOnce) {
    auto words = some_seconds;
    words.insert(words.end(), {"--local-workers", "2"});
    Process run(launch_words(graph_file("cornell.lua"), out, words));
    ASSERT_TRUE(in_the_middle(run));
    const auto workers =
        processes_with("lightnetd --listen tcp://127.0.0.1:* --places 1 --parent " + std::to_string(run.id()));
    ASSERT_EQ(workers.size(), 2u);
    ::kill(workers[0], SIGKILL);
    expect_same(run);
}

TEST_F(Loss, OfAHostThatHangsAndComesBackChangesNoByte) {
    const Daemon one(folder), two(folder);
    const auto run = start({whole(one.endpoint), whole(two.endpoint)});
    ASSERT_TRUE(in_the_middle(*run));
    two.process->signal(SIGSTOP);
    ASSERT_TRUE(run->wait_for("is lost")) << run->output();
    two.process->signal(SIGCONT);
    expect_same(*run);
}

TEST_F(Loss, OfALauncherThatSleepsLosesNoCount) {
    const Daemon one(folder);
    const auto run = start({whole(one.endpoint)});
    ASSERT_TRUE(in_the_middle(*run));
    run->signal(SIGSTOP);
    ASSERT_TRUE(one.process->wait_for("is given up")) << one.process->output();
    run->signal(SIGCONT);
    const auto end = expect_same(*run);
    EXPECT_GE(counter(end.report, "rays"), rays) << "what was done before it slept counts as well";
}

TEST_F(Loss, OfTheOnlyHostOfAnOperatorMovesItElsewhere) {
    const Daemon one(folder), two(folder);
    const auto run = start({"\"" + one.endpoint + "\" { image = 1, lighting = 1, direct = 1 }",
                            "\"" + two.endpoint + "\" { bounce = 1 }"});
    ASSERT_TRUE(in_the_middle(*run));
    two.process->signal(SIGKILL);
    const auto end = expect_same(*run);
    EXPECT_NE(end.said.find(two.endpoint + " is lost"), std::string::npos) << end.said;
    EXPECT_EQ(holders_of("bounce", end.report), std::vector{one.endpoint}) << end.report;
    EXPECT_GT(counter(end.report, "asked_again"), 0) << "it should have had work";
}

TEST_F(Loss, OfAllHostsEndsTheRunWithTheNameOfWhatHasNoPlace) {
    const Daemon one(folder);
    const auto run = start({whole(one.endpoint)}, {"--wait", "1"});
    ASSERT_TRUE(in_the_middle(*run));
    one.process->signal(SIGKILL);
    EXPECT_EQ(run->wait(slowdown * seconds(30)), 1);
    EXPECT_NE(run->output().find("node 'image' has no place"), std::string::npos) << run->output();
}

TEST_F(Loss, IsMadeGoodByADaemonThatStartsInTheMiddle) {
    const Daemon one(folder);
    auto two = std::make_unique<Daemon>(folder, 1, own_loopback());
    const auto endpoint = two->endpoint;
    two.reset();  // its port is free again, as nobody else is at this address
    const auto run = start({whole(one.endpoint), whole(endpoint)});
    ASSERT_TRUE(in_the_middle(*run));
    const Daemon late(folder, 1, endpoint);
    ASSERT_TRUE(run->wait_for(endpoint + " is ready")) << run->output();
    one.process->signal(SIGKILL);  // so the late one has to finish the picture
    expect_same(*run);
}

TEST_F(Loss, IsMadeGoodByADaemonThatDialsIn) {
    const Daemon one(folder);
    const auto run = start({whole(one.endpoint)}, {"--listen", "tcp://127.0.0.1:*"});
    const std::string before = "hosts may join at ";
    ASSERT_TRUE(run->wait_for(before) && in_the_middle(*run)) << run->output();
    const auto at = run->output().find(before) + before.size();
    const auto launcher = run->output().substr(at, run->output().find_first_of("\"\n", at) - at);
    const Daemon joined(folder, 1, "tcp://127.0.0.1:*", {"--join", launcher});
    ASSERT_TRUE(run->wait_for(joined.endpoint + " is ready")) << run->output();
    expect_same(*run);
}

TEST_F(Loss, IsNoneWhenTheLauncherWaitsForTheFirstThatDialsIn) {
    Process run(launch_words(graph_file("direct.lua"), out, {"--size", "32x32", "--listen", "tcp://127.0.0.1:*"}));
    const std::string before = "hosts may join at ";
    ASSERT_TRUE(run.wait_for(before) && run.wait_for("\n")) << run.output();
    const auto at = run.output().find(before) + before.size();
    // It listens on all its addresses; the launcher calls it at the one from which it dialled in.
    const Daemon joined(folder, 1, "tcp://0.0.0.0:*",
                        {"--insecure", "--join", run.output().substr(at, run.output().find('\n', at) - at)});
    EXPECT_EQ(run.wait(), 0) << run.output();
}

TEST_F(Loss, OfSenseInAJoinersWordsIsIgnored) {
    const Daemon one(folder);
    const auto run = start({whole(one.endpoint)}, {"--listen", "tcp://127.0.0.1:*"});
    const std::string before = "hosts may join at ";
    ASSERT_TRUE(run->wait_for(before) && in_the_middle(*run)) << run->output();
    const auto at = run->output().find(before) + before.size();
    Stranger stranger(run->output().substr(at, run->output().find_first_of("\"\n", at) - at));
    for (const std::string endpoint : {"", "nonsense", "tcp://", "tcp://*:*", "http://example"})
        stranger.send(packet::pack(packet::Type::join, 0, packet::Fields{}.set("endpoint", endpoint)));
    stranger.send("junk");
    expect_same(*run);
}

TEST_F(Loss, OfADaemonThatIsToldToStopIsOrderly) {
    const Daemon one(folder), two(folder);
    const auto run = start({whole(one.endpoint), whole(two.endpoint)});
    ASSERT_TRUE(in_the_middle(*run));
    two.process->signal(SIGTERM);
    EXPECT_EQ(two.process->wait(), 0);
    expect_same(*run);
}

TEST_F(Loss, OfPatienceEndsEverything) {
    auto words = some_seconds;
    words.insert(words.end(), {"--local-workers", "2"});
    Process run(launch_words(graph_file("cornell.lua"), out, words));
    ASSERT_TRUE(in_the_middle(run));
    const auto mark = "--parent " + std::to_string(run.id());
    EXPECT_EQ(processes_with(mark).size(), 2u);
    run.signal(SIGINT);
    EXPECT_EQ(run.wait(), 130) << run.output();
    EXPECT_TRUE(processes_with(mark).empty()) << "no process may stay behind";
    EXPECT_TRUE(std::filesystem::exists(out)) << "what there is";
    EXPECT_NE(bytes_of(folder / "picture.run.json").find("\"outcome\": \"cancelled\""), std::string::npos);
}

TEST_F(Loss, OfTimeDrainsTheRunWithinItsDeadline) {
    const Daemon one(folder), two(folder);
    const auto run = start({whole(one.endpoint), whole(two.endpoint)});
    ASSERT_TRUE(in_the_middle(*run));
    run->signal(SIGTERM);
    EXPECT_EQ(run->wait(), 130) << run->output();
    EXPECT_TRUE(std::filesystem::exists(out)) << "the picture that there is is left";
    EXPECT_NE(bytes_of(folder / "picture.run.json").find("\"late_replies\": 0"), std::string::npos)
        << "all that was out came in";
    EXPECT_EQ(
        launch(graph_file("direct.lua"), folder, {"--size", "8x8", "--hosts", hosts_file({whole(one.endpoint)})}).code,
        0)
        << "the daemons serve the next run";
}

TEST_F(Loss, OfTheLauncherEndsItsDaemons) {
    auto words = some_seconds;
    words.insert(words.end(), {"--local-workers", "2"});
    Process run(launch_words(graph_file("cornell.lua"), out, words));
    ASSERT_TRUE(in_the_middle(run));
    const auto mark = "--parent " + std::to_string(run.id());
    run.signal(SIGKILL);
    run.wait();
    const auto end = Clock::now() + slowdown * seconds(20);
    while (!processes_with(mark).empty() && Clock::now() < end) {
    }
    EXPECT_TRUE(processes_with(mark).empty());
}

}  // namespace
}  // namespace lightnet::test
