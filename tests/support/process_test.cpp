#include "tests/support/process.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

namespace lightnet::test {
namespace {

TEST(Process, FailsTheTestWhenASanitizerHasFoundSomethingInAProcessThatItStarted) {
    const std::string report_from_below = "sh -c 'echo data race > ${TSAN_OPTIONS##*log_path=}.1'";
    EXPECT_NONFATAL_FAILURE(
        {
            Process process({"/bin/sh", "-c", report_from_below + "; exit 0"});
            process.wait();
        },
        "data race");
}

TEST(Process, KeepsTheOptionsThatSanitizersHave) {
    ASSERT_EQ(setenv("LSAN_OPTIONS", "verbosity=0", 1), 0);
    Process process({"/bin/sh", "-c", "echo $LSAN_OPTIONS"});
    EXPECT_EQ(process.wait(), 0);
    EXPECT_EQ(process.output().find("verbosity=0:log_path="), 0u) << process.output();
}

}  // namespace
}  // namespace lightnet::test
