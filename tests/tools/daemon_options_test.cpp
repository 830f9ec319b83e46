#include "tools/daemon/daemon_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tools/support/log_line.hpp"

namespace lightnet::daemon_options_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using Words = std::vector<std::string>;

DaemonOptions daemon_options_of(const Words& words) {
    const auto parsed = parse_daemon_options(words);
    if (const auto* finished = std::get_if<Finished>(&parsed)) ADD_FAILURE() << finished->out << finished->err;
    const auto* options = std::get_if<DaemonOptions>(&parsed);
    return options ? *options : DaemonOptions{};
}

std::string daemon_mistake(const Words& words) {
    const auto parsed = parse_daemon_options(words);
    const auto* finished = std::get_if<Finished>(&parsed);
    if (!finished) return "the command line was taken";
    EXPECT_EQ(finished->code, 2);
    EXPECT_THAT(finished->out, IsEmpty());
    return finished->err;
}

TEST(DaemonOptions, AreUsualWhereNothingIsSaid) {
    const auto options = daemon_options_of({});
    EXPECT_EQ(options.host.listen, "tcp://127.0.0.1:*");
    EXPECT_EQ(options.host.places, 0u);
    EXPECT_EQ(options.host.drain, 20s);
    EXPECT_FALSE(options.host.patience);
}

TEST(DaemonOptions, AreTaken) {
    const auto options = daemon_options_of({"--join", "tcp://onyx1:7000", "--name", "a", "--places", "3", "--drain",
                                            "5", "--leave-after", "9", "--single", "one", "--quiet", "--insecure",
                                            "--pass", "its.pass", "--cache-size", "500M"});
    EXPECT_EQ(options.host.join, "tcp://onyx1:7000");
    EXPECT_EQ(options.host.listen, "") << "who dials out lets nobody in";
    EXPECT_EQ(options.host.name, "a");
    EXPECT_EQ(options.host.places, 3u);
    EXPECT_EQ(options.host.drain, 5s);
    EXPECT_EQ(options.host.patience, 9s);
    EXPECT_EQ(options.single, "one");
    EXPECT_TRUE(options.quiet);
    EXPECT_EQ(options.host.pass, "its.pass");
    EXPECT_EQ(options.host.cache_size, 500u << 20);
}

TEST(DaemonOptions, TellLoopbackFromTheRestInBothFamilies) {
    for (const auto* own : {"tcp://[::1]:7777", "tcp://localhost:7777", "tcp://[::ffff:127.0.0.1]:*"})
        EXPECT_EQ(daemon_options_of({"--listen", own}).host.listen, own);
    EXPECT_EQ(daemon_options_of({"--join", "tcp://[::1]:7000"}).host.join, "tcp://[::1]:7000");
    EXPECT_EQ(daemon_options_of({"--metrics", "[::1]:9100"}).metrics, "[::1]:9100");
    for (const auto* other : {"tcp://[::]:7777", "tcp://*:7777", "tcp://[fe80::1%eth0]:7777", "tcp://[fd00::1]:7777"})
        EXPECT_THAT(daemon_mistake({"--listen", other}), HasSubstr("goes beyond this machine")) << other;
    EXPECT_THAT(daemon_mistake({"--metrics", "[::]:9100"}), HasSubstr("goes beyond this machine"));
    EXPECT_THAT(daemon_mistake({"--metrics", "farm:9100"}), HasSubstr("127.0.0.1:9100 or [::1]:9100"));
    EXPECT_THAT(daemon_mistake({"--listen", "tcp://::1:7777"}), HasSubstr("tcp://[::1]:7777"));
}

TEST(DaemonOptions, NameNoHostAsHostsFilesCallTheLaunchersProcess) {
    EXPECT_THAT(daemon_mistake({"--join", "tcp://127.0.0.1:7000", "--name", "here"}),
                HasSubstr("'here' is what hosts files call the launcher's own process"));
}

TEST(DaemonOptions, SuggestTheFlagYouMeant) {
    EXPECT_EQ(daemon_mistake({"--lisen", "x"}),
              "lightnetd: there is no option '--lisen' (did you mean '--listen'?)\ntry: lightnetd --help\n");
    EXPECT_THAT(daemon_mistake({"onyx1"}), HasSubstr("what is 'onyx1' for?"));
}

TEST(DaemonOptions, ExplainWhatAnEndpointIs) {
    for (const char* wrong : {"foo", "127.0.0.1:7777", "tcp://127.0.0.1", "tcp://:7777", "tcp://a:99999"}) {
        EXPECT_THAT(daemon_mistake({"--listen", wrong}), HasSubstr("--listen: must be like tcp://127.0.0.1:7777"))
            << wrong;
        EXPECT_THAT(daemon_mistake({"--join", wrong}), HasSubstr("--join: must be like tcp://10.0.0.11:7777")) << wrong;
    }
    for (const char* right : {"tcp://127.0.0.1:*", "tcp://127.0.0.1:0", "tcp://localhost:7777", "tcp://[::1]:7777"})
        EXPECT_EQ(daemon_options_of({"--listen", right}).host.listen, right);
    EXPECT_EQ(daemon_options_of({"--listen", "tcp://*:7777", "--insecure"}).host.listen, "tcp://*:7777");
    EXPECT_THAT(daemon_mistake({"--listen", "tcp://*:7777"}), HasSubstr("goes beyond this machine"));
}

TEST(DaemonOptions, AreBounded) {
    EXPECT_THAT(daemon_mistake({"--places", "99999"}),
                HasSubstr("--places: must be a whole number from 0 to 1024, not '99999'"));
    EXPECT_THAT(daemon_mistake({"--drain", "-1"}), HasSubstr("from 0 to 86400"));
}

TEST(DaemonOptions, ShowExamplesThatWork) {
    const auto parsed = parse_daemon_options({"--help"});
    const auto& help = std::get<Finished>(parsed).out;
    std::istringstream lines(help.substr(help.rfind("Example")));
    std::string line;
    std::getline(lines, line);
    int examples = 0;
    while (std::getline(lines, line)) {
        std::istringstream in(line);
        Words words{std::istream_iterator<std::string>(in), {}};
        ASSERT_EQ(words.at(0), "lightnetd");
        daemon_options_of({words.begin() + 1, words.end()});
        ++examples;
    }
    EXPECT_EQ(examples, 4);
}

TEST(LogLine, SaysWhen) {
    const auto line = log_line("lightnetd", "it is ready", std::chrono::system_clock::now());
    EXPECT_TRUE(std::regex_match(
        line, std::regex("20\\d\\d-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\d[+-]\\d{4} lightnetd: it is ready")))
        << line;
}

}  // namespace
}  // namespace lightnet::daemon_options_test
