// What the doctor makes of what it sees.
#include "tools/hosts/doctor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/build_info.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::doctor_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Grade = Finding::Grade;

HostProbe well_host() {
    HostProbe probe;
    probe.answer = {"tcp://a:1", false, "a", "is free", {}, {}, {}};
    probe.answer.machine.version = build_id();
    probe.round_trip = 200us;
    probe.bandwidth = 1e9;
    probe.clock_ahead = 3ms;
    return probe;
}

TEST(Doctor, FindsThisMachineFit) {
    test::Folder folder;
    const auto findings = look_at_this_machine(folder / "cache");
    EXPECT_GE(findings.size(), 8u);
    EXPECT_TRUE(all_good_enough(findings)) << findings_table(findings);
}

TEST(Doctor, SaysWhatToDoAboutACacheThatIsNone) {
    test::Folder folder;
    const auto findings = look_at_this_machine("/proc/nothing");
    const auto cache = std::ranges::find(findings, std::string("cache"), &Finding::about);
    ASSERT_NE(cache, findings.end());
    EXPECT_EQ(cache->grade, Grade::bad);
    EXPECT_THAT(findings_table({*cache}), HasSubstr("-> choose another folder: --cache FOLDER"));
}

TEST(Doctor, FindsAHostFit) {
    const auto finding = look_at_hosts({well_host()}, build_id()).at(0);
    EXPECT_EQ(finding.grade, Grade::good);
    EXPECT_THAT(finding.what, HasSubstr("round trip 0.20 ms, 1000 MB/s, its clock +0.003 s"));
}

TEST(Doctor, NamesThePartInWhichBuildsDiffer) {
    const std::string ours = "0.2.0 (GNU 12.2.0, x86-64-v2, Release, Embree 3.13.5, flags aa, sources bb)";
    EXPECT_EQ(difference_of_builds(ours, ours), "");
    EXPECT_EQ(difference_of_builds("0.2.0 (GNU 13.1.0, x86-64-v2, Release, Embree 4.3.3, flags aa, sources bb)", ours),
              "compiler GNU 13.1.0, here GNU 12.2.0; Embree 4.3.3, here 3.13.5");
    auto other = well_host();
    other.answer.machine.version = "0.1.0 (GNU 12.2.0, x86-64-v2, Release, Embree 3.13.5, flags aa, sources bb)";
    const auto finding = look_at_hosts({other}, ours).at(0);
    EXPECT_EQ(finding.grade, Grade::bad);
    EXPECT_THAT(finding.advice, HasSubstr("version 0.1.0, here 0.2.0"));
}

TEST(Doctor, DoubtsAClockThatIsFarOff) {
    auto probe = well_host();
    probe.clock_ahead = -90s;
    EXPECT_EQ(look_at_hosts({probe}, build_id()).at(0).grade, Grade::doubtful);
}

TEST(Doctor, MissesAHostThatDoesNotAnswer) {
    const auto probes = probe_hosts({{"tcp://127.0.0.1:1"}}, 50ms);
    const auto finding = look_at_hosts(probes, build_id()).at(0);
    EXPECT_EQ(finding.grade, Grade::bad);
    EXPECT_THAT(finding.what, HasSubstr("does not answer"));
}

}  // namespace
}  // namespace lightnet::doctor_test
