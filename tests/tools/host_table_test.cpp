// What `lightnet hosts` prints, and what is said while a run waits for busy hosts.
#include "tools/hosts/host_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/hosts/host_json.hpp"

namespace lightnet::host_table_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

HostAnswer daemon_at(const std::string& endpoint, const std::string& state, const std::string& who = "") {
    HostAnswer host;
    host.asked = endpoint, host.name = "vm", host.state = state, host.who = who;
    host.machine.name = "vm", host.machine.cores = 8, host.places = 4;
    return host;
}

HostAnswer told_by_launcher(const std::string& name, const std::string& state) {
    HostAnswer host = daemon_at("tcp://launcher:7000", state);
    host.of_launcher = true, host.name = name;
    return host;
}

TEST(HostTable, NamesEachDaemonByItsEndpoint) {
    const auto table = host_table({daemon_at("tcp://a:7777", "is free"), daemon_at("tcp://a:7778", "is free")});
    EXPECT_THAT(table, HasSubstr("tcp://a:7777  is free  4 places  vm: 8 cores"));
    EXPECT_THAT(table, HasSubstr("\ntcp://a:7778  is free  4 places  vm: 8 cores")) << "on one machine, but not one";
}

TEST(HostTable, MarksAnotherBuild) {
    auto old = daemon_at("tcp://b:7777", "is free");
    old.machine.version = "0.1.0 (GNU 12.2.0, x86-64-v2, Release, Embree 3.13.5, flags aa, sources cc)";
    const std::string ours = "0.2.0 (GNU 12.2.0, x86-64-v2, Release, Embree 3.13.5, flags aa, sources bb)";
    EXPECT_TRUE(is_other_build(old, ours));
    EXPECT_FALSE(is_other_build(old, old.machine.version));
    EXPECT_FALSE(is_other_build(daemon_at("tcp://a:1", "does not answer"), ours)) << "who says nothing is no other";
    const auto table = host_table({old}, ours);
    EXPECT_THAT(table, HasSubstr("tcp://b:7777  is free, ANOTHER BUILD"));
    EXPECT_THAT(table, HasSubstr("would be refused: version 0.1.0, here 0.2.0; sources cc, here bb\n"));
    EXPECT_THAT(host_json({old}, {"onyx"}, ours), HasSubstr("\"same_build\": false"));
}

TEST(HostTable, CallsABusyDaemonBusyAndSaysWithWhoseRun) {
    const auto table = host_table({daemon_at("tcp://a:7777", "serves", "anna@vm (lab.lua)")});
    EXPECT_THAT(table, HasSubstr("tcp://a:7777  is busy: serves"));
    EXPECT_THAT(table, HasSubstr("  run of anna@vm (lab.lua)\n"));
}

TEST(HostTable, HasEachHostOnceAlthoughALauncherTellsOfItToo) {
    const auto table = host_table({daemon_at("tcp://a:7777", "serves", "anna@vm"), told_by_launcher("", "is ready"),
                                   told_by_launcher("tcp://a:7777", "is ready"), told_by_launcher("onyx1", "builds")});
    EXPECT_EQ(table.find("tcp://a:7777"), table.rfind("tcp://a:7777")) << table;
    EXPECT_THAT(table, HasSubstr("tcp://launcher:7000 (the launcher)  is ready"));
    EXPECT_THAT(table, HasSubstr("\nonyx1 "));
}

TEST(HostTable, TellsWhoIsThere) {
    for (const char* state : {"is free", "serves", "builds", "is ready", "leaves", "is busy: it serves another run"})
        EXPECT_TRUE(is_there(daemon_at("tcp://a:1", state))) << state;
    for (const char* state : {"does not answer", "is lost: it does not answer"})
        EXPECT_FALSE(is_there(daemon_at("tcp://a:1", state))) << state;
}

}  // namespace
}  // namespace lightnet::host_table_test
