// Daemons that serve several runs at a time, each in a process of its own.
#include <gmock/gmock.h>

#include <sched.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/modes/keyed.hpp"
#include "tools/daemon/memory_bound.hpp"

namespace lightnet::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

// The children of a process, those that died and that nobody has waited for left out.
std::vector<int> children_of(int process) {
    std::vector<int> children;
    std::ifstream in("/proc/" + std::to_string(process) + "/task/" + std::to_string(process) + "/children");
    for (int child = 0; in >> child;) children.push_back(child);
    return children;
}
bool lives(int process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state;
    return (in >> number >> name >> state) && state != "Z";
}
bool all_end(const std::vector<int>& processes) {
    for (int i = 0; i < 1000 * slowdown; ++i) {
        if (std::none_of(processes.begin(), processes.end(), lives)) return true;
        std::this_thread::sleep_for(milliseconds(10));
    }
    return false;
}

class SeveralRuns : public ::testing::Test {
protected:
    static constexpr const char* any_port = "tcp://127.0.0.1:*";
    static constexpr const char* endless = "1000000";  // samples: of a run that is ended from outside

    std::string hosts_file(const std::string& name, const std::string& text) const { return folder.write(name, text); }
    static std::string whole(const std::string& endpoint) { return "place \"" + endpoint + "\" { places = 1 }\n"; }
    std::unique_ptr<Process> start(const std::string& name, const std::string& hosts, const std::string& samples,
                                   Words more = {}) const {
        Words words{"--size", "64x64", "--tile", "16", "--samples", samples, "--progress", "json"};
        words.insert(words.end(), {"--hosts", hosts_file(name + ".lua", hosts)});
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), folder / (name + ".exr"), words));
    }
    static bool renders(Process& run) { return run.wait_for("\"event\":\"progress\""); }
    std::string serial(const std::string& samples) const {
        const auto alone = launch(graph_file("cornell.lua"), folder,
                                  {"--size", "64x64", "--samples", samples, "--threads", "1", "--progress", "none"});
        EXPECT_EQ(alone.code, 0) << alone.said;
        return alone.picture;
    }
    Launch end_of(Process& run, const std::string& name) const { return finish(run, folder / (name + ".exr")); }

    Folder folder;
};

TEST_F(SeveralRuns, RenderAtTheSameTimeOnOneDaemon) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    const auto long_one = start("one", whole(daemon.endpoint), "400");
    ASSERT_TRUE(renders(*long_one)) << long_one->output();
    const auto short_one = start("two", whole(daemon.endpoint), "4");
    const auto two = end_of(*short_one, "two");
    EXPECT_EQ(two.code, 0) << two.said;
    EXPECT_TRUE(long_one->lives()) << "it was over before the other one came to its turn";
    EXPECT_TRUE(two.picture == serial("4"));
    EXPECT_THAT(two.report, HasSubstr(daemon.endpoint)) << "a host has the name that the hosts file gives it";
    const auto one = end_of(*long_one, "one");
    EXPECT_EQ(one.code, 0) << one.said;
    EXPECT_TRUE(one.picture == serial("400"));
}

TEST_F(SeveralRuns, WaitWhereThereAreMoreThanThat) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    const auto one = start("one", whole(daemon.endpoint), "300"), two = start("two", whole(daemon.endpoint), "300");
    ASSERT_TRUE(renders(*one) && renders(*two)) << one->output() << two->output();
    const auto three = start("three", whole(daemon.endpoint), "4");
    ASSERT_TRUE(three->wait_for("is busy: it serves another run")) << three->output();
    EXPECT_EQ(end_of(*one, "one").code, 0) << one->output();
    const auto last = end_of(*three, "three");
    EXPECT_EQ(last.code, 0) << last.said;
    EXPECT_TRUE(last.picture == serial("4"));
    EXPECT_EQ(end_of(*two, "two").code, 0) << two->output();
}

// Operators of each run are on both, so that daemons ask each other at the ports where they serve this run.
TEST_F(SeveralRuns, AskFromHostToHost) {
    const Daemon one(folder, 1, any_port, {"--runs", "2"}), two(folder, 1, any_port, {"--runs", "2"});
    const auto spread = "place \"" + one.endpoint + "\" { image = 1, direct = 1, lighting = 1 }\n" +  //
                        "place \"" + two.endpoint + "\" { bounce = 1 }\n";
    const auto first = start("first", spread, "200");
    ASSERT_TRUE(renders(*first)) << first->output();
    const auto second = start("second", spread, "8");
    const auto other = end_of(*second, "second");
    EXPECT_EQ(other.code, 0) << other.said;
    EXPECT_TRUE(other.picture == serial("8")) << "the bytes differ";
    EXPECT_GT(counter(other.report, "questions"), 0);
    EXPECT_EQ(counter(other.report, "broken_packets"), 0);
    EXPECT_TRUE(first->lives()) << "it was over before the other ones came to their turn";
    const auto end = end_of(*first, "first");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_TRUE(end.picture == serial("200")) << "the bytes differ";
}

TEST_F(SeveralRuns, DoNotFeelThatTheProcessOfAnotherDies) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    const auto processes = children_of(daemon.process->id());
    ASSERT_EQ(processes.size(), 2u);
    const auto one = start("one", whole(daemon.endpoint), "200");
    ASSERT_TRUE(renders(*one)) << one->output();
    const auto two = start("two", whole(daemon.endpoint), "200");
    ASSERT_TRUE(renders(*two)) << two->output();
    kill(processes[0], SIGKILL);  // serves the first one
    ASSERT_TRUE(one->wait_for("is lost")) << one->output();
    const auto second = end_of(*two, "two"), first = end_of(*one, "one");
    EXPECT_EQ(second.code, 0) << second.said;
    EXPECT_THAT(second.said, testing::Not(HasSubstr("is lost")));
    EXPECT_EQ(first.code, 0) << first.said;
    EXPECT_TRUE(first.picture == serial("200") && second.picture == first.picture);
    EXPECT_TRUE(daemon.process->wait_for("was ended by signal 9; it is started anew")) << daemon.process->output();
}

TEST_F(SeveralRuns, EndWithTheirDaemonHoweverThatEnds) {
    for (const int signal : {SIGTERM, SIGKILL}) {
        const Daemon daemon(folder, 1, any_port, {"--runs", "3"});
        const auto processes = children_of(daemon.process->id());
        ASSERT_EQ(processes.size(), 3u);
        daemon.process->signal(signal);
        daemon.process->wait();
        EXPECT_TRUE(all_end(processes));
    }
}

// As many hold as one that is at work and one that is not, and not quite so much.
TEST_F(SeveralRuns, GoOnWithoutADaemonThatHoldsTooMuch) {
    std::uint64_t idle = 0, at_work = 0;
    {
        const Daemon unbounded(folder, 1, any_port, {"--runs", "2"});
        const auto processes = children_of(unbounded.process->id());
        const auto run = start("measured", whole(unbounded.endpoint), endless);
        ASSERT_TRUE(renders(*run)) << run->output();
        at_work = use_of(processes.at(0)).value().memory, idle = use_of(processes.at(1)).value().memory;
        run->signal(SIGINT), run->wait();
    }
    ASSERT_GT(at_work, idle);
    const Daemon bounded(folder, 1, any_port, {"--runs", "2", "--memory", std::to_string(idle + (idle + at_work) / 2)});
    const Daemon beside(folder);
    const auto run = start("one", whole(bounded.endpoint) + whole(beside.endpoint), "800");
    EXPECT_TRUE(run->wait_for(bounded.endpoint + " was told to stop, as other runs of its daemon need its memory"))
        << run->output();
    EXPECT_TRUE(bounded.process->wait_for("is told to end")) << bounded.process->output();
    const auto end = end_of(*run, "one");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_TRUE(end.picture == serial("800")) << "the bytes differ";
}

// As a service manager tells them.
TEST_F(SeveralRuns, FinishWhatTheyHaveWhereEachProcessIsToldToStop) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"}), beside(folder);
    const auto processes = children_of(daemon.process->id());
    const auto run = start("one", whole(daemon.endpoint) + whole(beside.endpoint), "200");
    ASSERT_TRUE(renders(*run) && run->wait_for(daemon.endpoint + " is ready")) << run->output();
    for (const int process : processes) kill(process, SIGTERM);
    daemon.process->signal(SIGTERM);
    EXPECT_EQ(daemon.process->wait(), 0) << daemon.process->output();
    const auto end = end_of(*run, "one");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(daemon.endpoint + " was told to stop"));
    EXPECT_THAT(end.said, testing::Not(HasSubstr("does not answer"))) << "or it ended in the middle of its work";
}

TEST_F(SeveralRuns, AreServedByAnotherProcessWhileTheFirstStops) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    const auto processes = children_of(daemon.process->id());
    const auto one = start("one", whole(daemon.endpoint), endless);
    ASSERT_TRUE(renders(*one)) << one->output();
    one->signal(SIGSTOP);  // so that its host waits
    kill(processes[0], SIGUSR1);
    ASSERT_TRUE(daemon.process->wait_for("finishes what it has, then stops")) << daemon.process->output();
    const auto two = start("two", whole(daemon.endpoint), "4");
    const auto end = end_of(*two, "two");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_TRUE(lives(processes[0])) << "or its successor has served the run";
    EXPECT_TRUE(end.picture == serial("4"));
    one->signal(SIGKILL);
}

// Of a thread of a process by its name: its niceness, field 19 of its figures.
std::vector<int> nicenesses_of(int process, const std::string& thread) {
    std::vector<int> all;
    std::error_code gone;
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task", gone)) {
        const auto stat = bytes_of(task.path() / "stat");
        const auto open = stat.find('('), close = stat.rfind(')');
        if (close == stat.npos || stat.substr(open + 1, close - open - 1) != thread) continue;
        std::istringstream in(stat.substr(close + 2));
        std::string field;
        for (int i = 3; i <= 19; ++i) in >> field;
        all.push_back(std::stoi(field));
    }
    return all;
}

// What niceness does is the system's business.
TEST_F(SeveralRuns, TakeASmallerShareWhereTheyWantNoMore) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    const auto processes = children_of(daemon.process->id());
    const auto one = start("one", whole(daemon.endpoint), endless, {"--share", "26"});
    ASSERT_TRUE(renders(*one)) << one->output();
    const auto two = start("two", whole(daemon.endpoint), endless);
    ASSERT_TRUE(renders(*two)) << two->output();
    const int usual = getpriority(PRIO_PROCESS, 0);
    EXPECT_THAT(nicenesses_of(processes[0], "place 0"), testing::ElementsAre(std::min(19, usual + 6)));
    EXPECT_THAT(nicenesses_of(processes[1], "place 0"), testing::ElementsAre(usual));
    for (auto* run : {&*one, &*two}) run->signal(SIGINT), run->wait();
    const auto three = start("three", whole(daemon.endpoint), endless);
    ASSERT_TRUE(renders(*three)) << three->output();
    EXPECT_THAT(nicenesses_of(processes[0], "place 0"), testing::ElementsAre(usual)) << "of the run that it serves";
    three->signal(SIGINT), three->wait();
}

// Bound to one processor while it lives, as is whoever is started meanwhile.
class OnOneProcessor {
public:
    OnOneProcessor() {
        sched_getaffinity(0, sizeof before_, &before_);
        cpu_set_t one;
        CPU_ZERO(&one);
        for (int number = 0; number < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++number)
            if (CPU_ISSET(number, &before_)) CPU_SET(number, &one);
        sched_setaffinity(0, sizeof one, &one);
    }
    ~OnOneProcessor() { sched_setaffinity(0, sizeof before_, &before_); }
    OnOneProcessor(const OnOneProcessor&) = delete;
    OnOneProcessor& operator=(const OnOneProcessor&) = delete;

private:
    cpu_set_t before_{};
};

// Six steps of niceness are a ratio of 1.25^6 = 3.8 under the scheduler of Linux.
TEST_F(SeveralRuns, HaveTheirPartsOfAProcessorThatBothWant) {
    std::optional<OnOneProcessor> bound(std::in_place);
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    bound.reset();
    const auto processes = children_of(daemon.process->id());
    const auto polite = start("one", whole(daemon.endpoint), endless, {"--share", "26"});
    ASSERT_TRUE(renders(*polite)) << polite->output();
    const auto usual = start("two", whole(daemon.endpoint), endless);
    ASSERT_TRUE(renders(*usual)) << usual->output();
    const auto computed = [](int process) { return use_of(process).value().computed; };
    const auto before_polite = computed(processes[0]), before_usual = computed(processes[1]);
    milliseconds by_polite{}, by_usual{};
    const auto end = std::chrono::steady_clock::now() + slowdown * seconds(60);
    while (by_polite + by_usual < seconds(4) && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(milliseconds(20));
        by_polite = computed(processes[0]) - before_polite, by_usual = computed(processes[1]) - before_usual;
    }
    EXPECT_GT(by_usual, by_polite * 5 / 2) << by_usual.count() << " and " << by_polite.count() << " ms";
    EXPECT_LT(by_usual, by_polite * 7) << by_usual.count() << " and " << by_polite.count() << " ms";
    for (auto* run : {&*polite, &*usual}) run->signal(SIGINT), run->wait();
}

TEST_F(SeveralRuns, GiveTwoSessionsAndARunEqualPartsOfAProcessor) {
    std::optional<OnOneProcessor> bound(std::in_place);
    const Daemon daemon(folder, 1, any_port, {"--runs", "3"});
    bound.reset();
    const auto processes = children_of(daemon.process->id());
    ASSERT_EQ(processes.size(), 3u);
    std::vector<std::unique_ptr<Process>> all;
    for (const std::string name : {"one", "two"}) {
        all.push_back(std::make_unique<Process>(Words{
            program("lightnet"), "session", graph_file("cornell.lua"), "-o", folder / (name + ".exr"), "--json",
            "--size", "128x128", "--samples", endless, "--hosts", hosts_file(name + ".lua", whole(daemon.endpoint))}));
        ASSERT_TRUE(all.back()->wait_for("\"coarse\":false")) << all.back()->output();
    }
    all.push_back(start("three", whole(daemon.endpoint), endless));
    ASSERT_TRUE(renders(*all.back())) << all.back()->output();
    std::vector<milliseconds> before, took(3);
    for (const int process : processes) before.push_back(use_of(process).value().computed);
    milliseconds together{};
    const auto end = std::chrono::steady_clock::now() + slowdown * seconds(90);
    while (together < seconds(6) && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(milliseconds(20));
        together = {};
        for (std::size_t i = 0; i < took.size(); ++i)
            together += took[i] = use_of(processes[i]).value().computed - before[i];
    }
    for (const auto& one : took)
        EXPECT_NEAR(double(one.count()), double(together.count()) / 3, double(together.count()) / 30)
            << took[0].count() << ", " << took[1].count() << " and " << took[2].count() << " ms";
    for (const auto& run : all) run->signal(SIGINT), run->wait();
}

TEST_F(SeveralRuns, AreToldOfByLightnetHosts) {
    const Daemon daemon(folder, 1, any_port, {"--runs", "2"});
    const auto run = start("one", whole(daemon.endpoint), "300");
    ASSERT_TRUE(renders(*run)) << run->output();
    Process hosts({program("lightnet"), "hosts", daemon.endpoint});
    EXPECT_EQ(hosts.wait(), 0) << hosts.output();
    EXPECT_THAT(hosts.output(), HasSubstr("is busy: serves"));
    EXPECT_THAT(hosts.output(), HasSubstr("is free"));
    run->signal(SIGINT);
    run->wait();
}

TEST_F(SeveralRuns, AreRefusedWhereTheyMeanNothing) {
    for (const auto& [words, why] : std::vector<std::pair<Words, std::string>>{
             {{"--join", "tcp://127.0.0.1:7000"}, "leave --join out"},
             {{"--leave-after", "5"}, "serves one run at a time"},
             {{"--runs", "1", "--memory", "4G"}, "say --runs"},
             {{"--metrics", "127.0.0.1"}, "--metrics needs a port"},
             {{"--listen", "tcp://127.0.0.1:65535"}, "no 2 ports from 65535 on"}}) {
        Words all{program("lightnetd"), "--runs", "2"};
        all.insert(all.end(), words.begin(), words.end());
        Process daemon(all);
        EXPECT_EQ(daemon.wait(), 2) << daemon.output();
        EXPECT_THAT(daemon.output(), HasSubstr(why));
    }
}

class SeveralKeyedRuns : public Keys {};

TEST_F(SeveralKeyedRuns, RenderAtTheSameTime) {
    folder.write("launchers", user.open.text() + " user\n");
    const Daemon daemon(folder, 1, "tcp://127.0.0.1:*",
                        {"--runs", "2", "--key", folder.file("host.key"), "--allow", folder.file("launchers")});
    const auto one = start(place(daemon.endpoint, "host"), long_words("1000000"));  // ended from outside
    ASSERT_TRUE(one->wait_for("\"event\":\"progress\"")) << one->output();
    const Folder other;
    const auto two = launch(graph_file("cornell.lua"), other,
                            join(size, {"--key", folder.file("user.key"), "--hosts",
                                        folder.write("two.lua", place(daemon.endpoint, "host"))}));
    EXPECT_EQ(two.code, 0) << two.said;
    EXPECT_TRUE(two.picture == *reference);
    EXPECT_TRUE(one->lives());
    one->signal(SIGINT);
    one->wait();
}

}  // namespace
}  // namespace lightnet::test
