// Work on the side.
#include "core/base/thread_pool.hpp"

#include <gtest/gtest.h>

#include "core/base/unwanted.hpp"

#include <atomic>
#include <numeric>
#include <vector>

namespace lightnet::thread_pool_test {
namespace {

TEST(ThreadPool, DoesAllPiecesOnce) {
    for (const unsigned threads : {1u, 2u, 4u}) {
        ThreadPool thread_pool(threads);
        std::vector<int> done(1000);
        for (auto& one : done) thread_pool.add([&one] { ++one; });
        thread_pool.finish();
        EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 1000);
        thread_pool.add([&done] { done[0] = 7; });  // and goes on afterwards
        thread_pool.finish();
        EXPECT_EQ(done[0], 7);
    }
}

TEST(Pieces, AreAllThereOnce) {
    for (const std::size_t count : {0u, 1u, 9u, 10u, 11u, 1000u}) {
        std::vector<int> done(count);
        const auto work = [&](std::size_t first, std::size_t last) {
            EXPECT_LE(last - first, 10u);
            for (std::size_t i = first; i < last; ++i) ++done[i];
        };
        parallel_for(count, work, 10);
        EXPECT_EQ(done, std::vector<int>(count, 1));
    }
}

// Whoever has given a task and does not want it any more is told that it was not done, by whatever thread.
TEST(ThreadPool, EndsWhatIsUnwanted) {
    for (const unsigned threads : {1u, 2u, 4u}) {
        std::atomic<bool> unwanted = false;
        std::atomic<int> done = 0;
        const LookingAt looking(&unwanted);
        ThreadPool thread_pool(threads);
        const auto all = [&] {
            for (int i = 0; i < 1000; ++i)
                thread_pool.add([&] {
                    if (++done == 10) unwanted = true;
                    end_if_unwanted();
                });
            thread_pool.finish();
        };
        EXPECT_THROW(all(), Cancelled);
        EXPECT_LE(done, 9 + int(threads)) << "one each may have begun";
        if (threads == 1) continue;  // it was done in add()
        EXPECT_THROW(thread_pool.finish(), Cancelled) << "nobody takes it for done, however often they ask";
    }
}

TEST(Pieces, OfWhatIsUnwantedEndTheirCaller) {
    std::atomic<bool> unwanted = false;
    std::atomic<int> done = 0;
    const LookingAt looking(&unwanted);
    const auto work = [&](std::size_t, std::size_t) {
        if (++done == 3) unwanted = true;
        end_if_unwanted();
    };
    EXPECT_THROW(parallel_for(1000, work, 1), Cancelled);
    EXPECT_LT(done, 100);
}

TEST(ThreadPool, MayBeGivenUp) {
    std::atomic<int> done = 0;
    {
        ThreadPool thread_pool(2);
        for (int i = 0; i < 100; ++i) thread_pool.add([&done] { ++done; });
    }
    EXPECT_LE(done, 100);
}

}  // namespace
}  // namespace lightnet::thread_pool_test
