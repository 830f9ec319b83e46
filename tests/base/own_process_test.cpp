#include "core/base/own_process.hpp"

#include <gtest/gtest.h>

namespace lightnet {
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
    EXPECT_GT(figures.resident, 0u);
    EXPECT_GT(figures.virtually, figures.resident);
    EXPECT_GT(figures.started, 1.6e9) << "seconds since 1970";
    EXPECT_GE(figures.threads, 1u);
    EXPECT_GT(figures.descriptors, 0u);
    EXPECT_GT(figures.most_descriptors, figures.descriptors);
}

}  // namespace
}  // namespace lightnet
