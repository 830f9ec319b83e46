// Programs take memory from where it comes in large pages. Nothing else tells whether they do, but for their pace.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/modes/daemons.hpp"
#include "tests/support/process.hpp"

namespace lightnet::test {
namespace {

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have allocators of their own
class LargePages : public testing::TestWithParam<const char*> {};

TEST_P(LargePages, AreAskedFor) {
    // The allocator says at the end what it was set to.
    Process run(
        {"/usr/bin/env", "MALLOC_CONF=stats_print:true,stats_print_opts:mdablxeh", program(GetParam()), "--version"});
    EXPECT_EQ(run.wait(), 0);
    EXPECT_THAT(run.output(), testing::HasSubstr("opt.thp: \"always\""));
}

INSTANTIATE_TEST_SUITE_P(Programs, LargePages, testing::Values("lightnet", "lightnetd"),
                         [](const auto& each) { return std::string(each.param); });
#endif

}  // namespace
}  // namespace lightnet::test
