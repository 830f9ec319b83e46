// Whether threads can be had.
#include "core/base/spare_threads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/own_process.hpp"
#include "core/base/thread_pool.hpp"

namespace lightnet::spare_threads_test {
namespace {

using testing::HasSubstr;

// In a process whose memory has room for the stacks of a few threads more, as for root nothing else limits them. True:
// `holds` did.
bool with_few_threads(const std::function<bool()>& holds) {
    const auto child = ::fork();
    if (child == 0) {
        constexpr rlim_t room = rlim_t{40} << 20;
        const rlimit limit{process_figures().virtually + room, process_figures().virtually + room};
        ::setrlimit(RLIMIT_AS, &limit);
        ::_exit(holds() ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(SpareThreads, AreFreeAgainWhenTheyHaveBeenTried) {
    const auto before = own_threads();
    EXPECT_EQ(try_threads(8), 8u);
    EXPECT_EQ(own_threads(), before);
    EXPECT_EQ(try_threads(0), 0u);
}

TEST(SpareThreads, AreCountedWhereThereAreFew) {
    EXPECT_TRUE(with_few_threads([] {
        const auto made = try_threads(100);
        return made < 100 && try_threads(made) == made;
    }));
}

TEST(SpareThreads, AreWantedInWords) {
    EXPECT_TRUE(with_few_threads([] {
        try {
            want_threads(100, "a crowd");
            return false;
        } catch (const Error& error) {
            const std::string what = error.what();
            return what.starts_with("a crowd: needs 101 threads more, and the system gives ") &&
                   what.find("ulimit -u") != std::string::npos;
        }
    }));
}

TEST(SpareThreads, AreNotNeededByAWorkshop) {
    EXPECT_TRUE(with_few_threads([] {
        ThreadPool thread_pool(200);
        std::atomic<int> done{0};
        for (int i = 0; i < 1000; ++i) thread_pool.add([&done] { ++done; });
        thread_pool.finish();
        return done == 1000;
    }));
}

TEST(SpareThreads, AreNotNeededForWorkInTheBackground) {
    EXPECT_TRUE(with_few_threads([] {
        std::vector<std::future<int>> all;
        for (int i = 0; i < 100; ++i)
            all.push_back(in_background([i] {
                usleep(1000);
                return i;
            }));
        int sum = 0;
        for (auto& one : all) sum += one.get();
        return sum == 99 * 100 / 2;
    }));
}

}  // namespace
}  // namespace lightnet::spare_threads_test
