#include "core/base/own_process.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lightnet::own_process_test {
namespace {

TEST(OwnProcess, HasTakenProcessorTimeFromItsFirstInstruction) {
    const double before = process_figures().processor_seconds;
    EXPECT_GT(before, 0);
    volatile unsigned work = 0;
    for (unsigned i = 0; i < 10'000; ++i) work = work + i;
    const double after = process_figures().processor_seconds;
    EXPECT_GT(after, before) << "less than a tick counts as well";
}

TEST(OwnProcess, KnowsWhatItTakes) {
    const auto figures = process_figures();
    EXPECT_GT(figures.resident, 1u << 20);
    EXPECT_GT(figures.virtually, figures.resident);
    EXPECT_GE(figures.threads, 1u);
    EXPECT_GE(figures.descriptors, 3u);
    EXPECT_GT(figures.started, 1.6e9);
    EXPECT_GE(peak_memory(), figures.resident / 2);
}

TEST(OwnProcess, CountsThePeakAnew) {
    {
        const std::string much(std::size_t{64} << 20, 'x');
        EXPECT_GE(peak_memory(), much.size());
    }
    const auto before = peak_memory();
    if (!forget_peak_memory()) GTEST_SKIP() << "the system doesn't do that";
    EXPECT_LE(peak_memory(), before);
}

}  // namespace
}  // namespace lightnet::own_process_test
