// How much of the machine a process may use.
#include "core/base/allowance.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "core/base/this_machine.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::allowance_test {
namespace {

/// A machine whose control groups say what a test wants.
struct Machine {
    test::Folder folder;
    SystemFiles files{folder.file("proc"), folder.file("groups")};

    explicit Machine(const std::string& groups) { folder.write("proc/self/cgroup", groups); }
    Machine& say(const std::string& file, const std::string& text) {
        folder.write("groups/" + file, text + "\n");
        return *this;
    }
    std::optional<double> quota() const { return core_allowance(files).quota; }
};

/// A variable of the environment, until the end of a test.
class Variable {
public:
    Variable(std::string name, const std::string& value) : name_(std::move(name)) {
        ::setenv(name_.c_str(), value.c_str(), 1);
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    ~Variable() { ::unsetenv(name_.c_str()); }

private:
    std::string name_;
};

TEST(Allowance, CountsPartsOfACoreAsWhole) {
    CoreAllowance allowance{.machine = 8, .bound = 8, .quota = {}, .asked = {}};
    EXPECT_EQ(allowance.cores(), 8u);
    allowance.quota = 2.5;
    EXPECT_EQ(allowance.cores(), 3u);
    allowance.quota = 0.1;
    EXPECT_EQ(allowance.cores(), 1u);
    allowance.quota = 2;
    EXPECT_EQ(allowance.cores(), 2u);
    allowance.quota = 100;
    EXPECT_EQ(allowance.cores(), 8u);
}

TEST(Allowance, TakesTheLeastOfAllThatIsSaid) {
    EXPECT_EQ((CoreAllowance{.machine = 8, .bound = 3, .quota = 5, .asked = 4}.cores()), 3u);
    EXPECT_EQ((CoreAllowance{.machine = 8, .bound = 6, .quota = 5, .asked = 4}.cores()), 4u);
}

TEST(Allowance, ReadsTheQuotaOfAGroup) {
    Machine machine("0::/farm/job\n");
    EXPECT_EQ(machine.quota(), std::nullopt) << "there are no files";
    machine.say("farm/job/cpu.max", "max 100000");
    EXPECT_EQ(machine.quota(), std::nullopt) << "there is no limit";
    machine.say("farm/job/cpu.max", "150000 100000");
    EXPECT_EQ(machine.quota(), 1.5);
}

TEST(Allowance, TakesTheLeastOfGroupsWithinGroups) {
    Machine machine("0::/farm/job/step\n");
    machine.say("farm/job/step/cpu.max", "400000 100000").say("farm/job/cpu.max", "max 100000");
    machine.say("farm/cpu.max", "100000 100000");
    EXPECT_EQ(machine.quota(), 1.0);
    machine.say("cpu.max", "50000 100000");
    EXPECT_EQ(machine.quota(), 0.5) << "of a container, whose own group is the root that it sees";
}

TEST(Allowance, FindsTheGroupOfAContainerThatTheOutsideNamed) {
    Machine machine("0::/../../docker/abcdef\n");
    machine.say("cpu.max", "100000 100000");
    EXPECT_EQ(machine.quota(), 1.0);
}

TEST(Allowance, ReadsTheFirstVersionOfGroups) {
    Machine machine("3:cpuset:/\n2:cpu,cpuacct:/docker/abc\n0::/\n");
    machine.say("cpu,cpuacct/docker/abc/cpu.cfs_quota_us", "-1");
    machine.say("cpu,cpuacct/docker/abc/cpu.cfs_period_us", "100000");
    EXPECT_EQ(machine.quota(), std::nullopt);
    machine.say("cpu,cpuacct/docker/abc/cpu.cfs_quota_us", "300000");
    EXPECT_EQ(machine.quota(), 3.0);
    machine.say("cpu/cpu.cfs_quota_us", "200000").say("cpu/cpu.cfs_period_us", "100000");
    EXPECT_EQ(machine.quota(), 2.0) << "the root, under the other name of the controller";
}

TEST(Allowance, ReadsTheSecondVersionWhereBothAreInUse) {
    Machine machine("1:cpu:/\n0::/job\n");
    machine.say("unified/job/cpu.max", "100000 100000");
    EXPECT_EQ(machine.quota(), 1.0);
}

TEST(Allowance, IsNotConfusedByNonsense) {
    Machine machine("nonsense\n0::/\n");
    for (const char* text : {"", "x y", "100000", "0 0", "-5 100000", "100000 0"})
        EXPECT_EQ(machine.say("cpu.max", text).quota(), std::nullopt) << text;
}

TEST(Allowance, FollowsWhatTheProcessIsBoundTo) {
    cpu_set_t before{}, one{};
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    int first = 0;
    while (!CPU_ISSET(first, &before)) ++first;
    CPU_SET(first, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    const auto allowance = core_allowance();
    sched_setaffinity(0, sizeof before, &before);
    EXPECT_EQ(allowance.bound, 1u);
    EXPECT_EQ(allowance.cores(), 1u);
    EXPECT_EQ(core_allowance().bound, static_cast<unsigned>(CPU_COUNT(&before)));
}

TEST(Allowance, FollowsVariablesForThreads) {
    for (const char* name : {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT"}) ::unsetenv(name);
    EXPECT_EQ(core_allowance().asked, std::nullopt);
    const Variable threads("OMP_NUM_THREADS", "4,2");
    EXPECT_EQ(core_allowance().asked, 4u);
    const Variable limit("OMP_THREAD_LIMIT", "3");
    EXPECT_EQ(core_allowance().asked, 3u);
    for (const char* text : {"", "0", "-1", "many", "4x"}) {
        const Variable nonsense("OMP_NUM_THREADS", text);
        EXPECT_EQ(core_allowance().asked, 3u) << text;
    }
}

TEST(Allowance, ReadsTheMemoryOfAGroup) {
    Machine machine("4:memory:/job\n0::/job\n");
    EXPECT_EQ(memory_of_group(machine.files), std::nullopt);
    EXPECT_EQ(usable_memory(machine.files), machine_memory());
    machine.say("memory/job/memory.limit_in_bytes", "9223372036854771712");
    EXPECT_EQ(memory_of_group(machine.files), std::nullopt) << "it says so where there is no limit";
    machine.say("job/memory.max", "max");
    EXPECT_EQ(memory_of_group(machine.files), std::nullopt);
    machine.say("memory/job/memory.limit_in_bytes", "1048576");
    EXPECT_EQ(usable_memory(machine.files), 1048576u);
    machine.say("memory.max", "65536");
    EXPECT_EQ(usable_memory(machine.files), 65536u);
}

TEST(Allowance, ReadsHowManyThreadsAGroupMayHave) {
    Machine machine("5:pids:/a/b\n");
    EXPECT_EQ(threads_of_group(machine.files), std::nullopt);
    machine.say("pids/a/b/pids.max", "max").say("pids/a/pids.max", "512");
    EXPECT_EQ(threads_of_group(machine.files), 512u);
}

}  // namespace
}  // namespace lightnet::allowance_test
