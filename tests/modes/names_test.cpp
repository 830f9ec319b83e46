// Runs on hosts that have names and addresses of all sorts. Names are what the test says
// (tests/support/told_names.cpp).
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class NamesOfHosts : public ::testing::Test {
protected:
    NamesOfHosts() {
        names("");
        ::setenv("LIGHTNET_TOLD_NAMES", folder.file("names").c_str(), 1);
        ::setenv("LD_PRELOAD", LIGHTNET_NAMES, 1);
        const char* before = std::getenv("ASAN_OPTIONS");  // which wants to be the first that is loaded
        ::setenv("ASAN_OPTIONS", (std::string(before ? before : "") + ":verify_asan_link_order=0").c_str(), 1);
    }
    ~NamesOfHosts() override {
        ::unsetenv("LD_PRELOAD");
        ::unsetenv("LIGHTNET_TOLD_NAMES");
    }
    void names(const std::string& lines) const { folder.write("names", lines); }
    std::unique_ptr<Process> start(const std::string& hosts, std::vector<std::string> more = {}) {
        std::vector<std::string> words{"--size", "32x32", "--samples", "16", "--progress", "plain"};
        if (!hosts.empty()) words.insert(words.end(), {"--hosts", folder.write("hosts.lua", hosts)});
        for (std::size_t i = 0; i + 1 < more.size(); i += 2)
            if (const auto found = std::find(words.begin(), words.end(), more[i]); found != words.end())
                words.erase(found, found + 2);
        words.insert(words.end(), more.begin(), more.end());
        words.push_back("--insecure");
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), folder / "picture.exr", words));
    }
    Launch run(const std::string& hosts, const std::vector<std::string>& more = {}) {
        return finish(*start(hosts, more), folder / "picture.exr");
    }
    static std::string place(const std::string& endpoint) { return "place '" + endpoint + "' {}\n"; }

    Folder folder;
};

TEST_F(NamesOfHosts, OfWhichNoServerTellsTakeNoOtherHostAway) {
    const Daemon well(folder);
    names("render9.farm silent\n");
    const auto launch = run(place(well.endpoint) + place("tcp://render9.farm:7777"));
    EXPECT_EQ(launch.code, 0) << launch.said;
    EXPECT_THAT(launch.said, HasSubstr("no name server says where 'render9.farm' is"));
}

TEST_F(NamesOfHosts, ThatNobodyHasAreHostsThatNeverCame) {
    const Daemon well(folder);
    const auto launch = run(place(well.endpoint) + place("tcp://render9.farm:7777"));
    EXPECT_EQ(launch.code, 0) << launch.said;
    EXPECT_THAT(launch.said, HasSubstr("tcp://render9.farm:7777: does not answer: no host is called 'render9.farm'; it "
                                       "was to hold the whole network"));
    EXPECT_THAT(launch.said, HasSubstr("never came"));
    const auto alone = run(place("tcp://render9.farm:7777"));
    EXPECT_EQ(alone.code, 3) << alone.said;
    EXPECT_THAT(alone.said, HasSubstr("no host is called 'render9.farm'"));
}

TEST_F(NamesOfHosts, OfLaunchersThatNobodyHasAreToldInTheLogOfWhoJoins) {
    const auto daemon = joining_daemon(folder, "tcp://front.farm:7777", "inside", {"--insecure"});
    EXPECT_TRUE(
        daemon->wait_for("the launcher at tcp://front.farm:7777 does not answer: no host is called 'front.farm'"))
        << daemon->output();
}

TEST_F(NamesOfHosts, AreTriedAtAllTheirAddresses) {
    names("two.lab 127.0.0.1 127.0.0.3\n");
    const Daemon second(folder, 1, "tcp://127.0.0.3:*", {"--insecure"});
    const auto port = second.endpoint.substr(second.endpoint.rfind(':'));
    const auto launch = run(place("tcp://two.lab" + port));
    EXPECT_EQ(launch.code, 0) << launch.said;
    EXPECT_THAT(launch.said, HasSubstr("tcp://two.lab" + port + " is ready"));
}

TEST_F(NamesOfHosts, ThatMoveInMidRunAreFound) {
    names("moving.lab 127.0.0.2\n");
    auto first = std::make_unique<Daemon>(folder, 1, "tcp://127.0.0.2:*");
    const auto port = first->endpoint.substr(first->endpoint.rfind(':'));
    const auto launch = start(place("tcp://moving.lab" + port), {"--samples", "512", "--tile", "8"});
    ASSERT_TRUE(launch->wait_for("is ready")) << launch->output();
    first->process->signal(SIGKILL);
    first->process->wait();
    names("moving.lab 127.0.0.4\n");
    const Daemon next(folder, 1, "tcp://127.0.0.4" + port);
    const auto end = finish(*launch, folder / "picture.exr");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr("is lost"));
}

TEST_F(NamesOfHosts, OfWhichNoServerTellsInMidRunTakeNoOtherHostAway) {
    names("named.lab 127.0.0.2\n");
    const Daemon well(folder), named(folder, 1, "tcp://127.0.0.2:*");
    const auto port = named.endpoint.substr(named.endpoint.rfind(':'));
    const auto launch =
        start(place(well.endpoint) + place("tcp://named.lab" + port), {"--samples", "2048", "--tile", "8"});
    ASSERT_TRUE(launch->wait_for("named.lab" + port + " is ready")) << launch->output();
    ASSERT_TRUE(launch->wait_for(well.endpoint + " is ready")) << launch->output();
    names("named.lab silent\n");
    named.process->signal(SIGKILL);
    const auto end = finish(*launch, folder / "picture.exr");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said,
                AllOf(HasSubstr("named.lab" + port + " is lost"), Not(HasSubstr(well.endpoint + " is lost"))));
}

// Machines without IPv6 say so, where they are asked for it.
class Families : public NamesOfHosts {
protected:
    bool without_six() const {
        if (std::ifstream("/proc/net/if_inet6").peek() != std::ifstream::traits_type::eof()) return false;
        Process six({program("lightnetd"), "--listen", "tcp://[::1]:*", "--cache", folder / "c"});
        EXPECT_EQ(six.wait(), 1);
        EXPECT_THAT(six.output(), HasSubstr("tcp://[::1]:*: can't listen there"));
        return true;
    }
};

TEST_F(Families, AreBothListenedAtAndCalled) {
    if (without_six()) return;
    const Daemon six(folder, 1, "tcp://[::1]:*"), both(folder, 1, "tcp://[::]:*", {"--insecure"});
    EXPECT_THAT(six.endpoint, HasSubstr("tcp://[::1]:"));
    const auto port = both.endpoint.substr(both.endpoint.rfind(':'));
    const auto launch = run(place(six.endpoint) + place("tcp://127.0.0.1" + port));
    EXPECT_EQ(launch.code, 0) << launch.said;
    for (const auto& endpoint : {six.endpoint, "tcp://127.0.0.1" + port})
        EXPECT_THAT(launch.said, HasSubstr(endpoint + " is ready"));
    Process ask({program("lightnet"), "hosts", six.endpoint, "tcp://[::1]" + port});
    EXPECT_EQ(ask.wait(), 0) << ask.output();
}

TEST_F(Families, AreBothJoinedBy) {
    if (without_six()) return;
    for (const auto* listen : {"tcp://[::1]:*", "tcp://localhost:*"}) {
        const auto launch = start("place 'six' {}\n", {"--listen", listen, "--wait", "30"});
        const auto daemon = joining_daemon(folder, join_endpoint(*launch), "six");
        const auto end = finish(*launch, folder / "picture.exr");
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_THAT(end.said, HasSubstr("six is ready"));
    }
}

TEST_F(Families, OfWhoJoinsAndListensAreBothCalled) {
    if (without_six()) return;
    const auto launch = start("", {"--listen", "tcp://[::1]:*", "--wait", "30"});
    const Daemon daemon(folder, 1, "tcp://[::]:*", {"--insecure", "--join", join_endpoint(*launch)});
    const auto port = daemon.endpoint.substr(daemon.endpoint.rfind(':'));
    const auto end = finish(*launch, folder / "picture.exr");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr("tcp://[::1]" + port + " is ready")) << "where it came from";
}

TEST_F(NamesOfHosts, CanBeListenedAt) {
    names("here.lab 127.0.0.5\n");
    const Daemon own(folder, 1, "tcp://localhost:*"), named(folder, 1, "tcp://here.lab:*", {"--insecure"});
    const auto port = [](const Daemon& daemon) { return daemon.endpoint.substr(daemon.endpoint.rfind(':')); };
    const auto launch = run(place("tcp://localhost" + port(own)) + place("tcp://here.lab" + port(named)));
    EXPECT_EQ(launch.code, 0) << launch.said;
    Process nobody({program("lightnetd"), "--listen", "tcp://nobody.lab:7777", "--insecure", "--cache", folder / "c"});
    EXPECT_EQ(nobody.wait(), 1);
    EXPECT_THAT(nobody.output(), HasSubstr("no host is called 'nobody.lab', and no network card"));
}

}  // namespace
}  // namespace lightnet::test
