// What `lightnet hosts` tells of daemons and launchers.
#include <gtest/gtest.h>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

std::string told_of(const std::string& whom, int code = 0) {
    Process ask({program("lightnet"), "hosts", whom});
    EXPECT_EQ(ask.wait(), code) << ask.output();
    return ask.output();
}

TEST(Hosts, TellOfTheirMachineAndThatTheyAreFree) {
    const Folder folder;
    const Daemon daemon(folder, 3);
    const auto told = told_of(daemon.endpoint);
    for (const auto* word : {daemon.endpoint.c_str(), "is free", "3 places", " cores", "GiB"})
        EXPECT_NE(told.find(word), std::string::npos) << word << "\n" << told;
}

TEST(Hosts, TellWhomTheyServeAndWithWhat) {
    const Folder folder;
    const Daemon daemon(folder);
    const auto hosts = folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}");
    Process run(launch_words(graph_file("cornell.lua"), folder / "x.exr",
                             {"--size", "128x128", "--samples", "4096", "--progress", "json", "--hosts", hosts,
                              "--listen", "tcp://127.0.0.1:*"}));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    const auto told = told_of(hosts);
    for (const auto* word : {"serves", "run of ", "cornell.lua", "holds ", "bounce", " answered"})
        EXPECT_NE(told.find(word), std::string::npos) << word << "\n" << told;
    EXPECT_NE(told.find("is busy: serves"), std::string::npos) << told;
    const auto of_launcher = told_of(join_endpoint(run));
    EXPECT_NE(of_launcher.find(daemon.endpoint), std::string::npos) << of_launcher;
    EXPECT_NE(of_launcher.find("is ready"), std::string::npos) << of_launcher;
}

TEST(Hosts, ThatAreNotThereAreSaidToBe) {
    EXPECT_NE(told_of("tcp://127.0.0.1:1", 3).find("does not answer"), std::string::npos);
    const Folder folder;
    const Daemon daemon(folder);
    const auto told =
        told_of(folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}\nplace 'tcp://127.0.0.1:1' {}"), 3);
    EXPECT_NE(told.find("is free"), std::string::npos) << told;
    EXPECT_NE(told.find("1 of 2 is not there"), std::string::npos) << told;
}

TEST(Hosts, AreLookedAtByTheDoctor) {
    const Folder folder;
    const Daemon daemon(folder, 2);
    Process fit({program("lightnet"), "doctor", "--hosts",
                 folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}"), "--cache", folder / "cache"});
    fit.wait();  // its code tells of this machine as well
    for (const auto* word : {daemon.endpoint.c_str(), "is free, 2 places", "round trip", "MB/s", "its clock"})
        EXPECT_NE(fit.output().find(word), std::string::npos) << word << "\n" << fit.output();
    EXPECT_EQ(fit.output().find("another build"), std::string::npos) << fit.output();
    Process absent({program("lightnet"), "doctor", "--hosts", "tcp://127.0.0.1:1", "--cache", folder / "cache"});
    EXPECT_EQ(absent.wait(), 3) << absent.output();
    EXPECT_NE(absent.output().find("does not answer"), std::string::npos) << absent.output();
}

TEST(Hosts, StandInTheTableOnceWithTheirEndpoint) {
    const Folder folder;
    const Daemon daemon(folder);
    Process ask({program("lightnet"), "hosts", daemon.endpoint, daemon.endpoint,
                 folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}")});
    EXPECT_EQ(ask.wait(), 0) << ask.output();
    EXPECT_EQ(ask.output().find(daemon.endpoint), 0u) << ask.output();
    EXPECT_EQ(ask.output().find(daemon.endpoint, 1), std::string::npos) << ask.output();
}

}  // namespace
}  // namespace lightnet::test
