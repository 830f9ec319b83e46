#include "core/run/fiber/rounds.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <stdexcept>
#include <string>

#include "tests/support/endless.hpp"

namespace lightnet::rounds_test {
namespace {

// Fibers whose pieces of work wait until the test lets them go on.
class RoundsTest : public ::testing::Test {
protected:
    ~RoundsTest() override { fibers.cancel_all(); }

    // A piece that waits once.
    void wait() {
        waiting.push_back(fibers.current());
        most_waiting = std::max(most_waiting, waiting.size());
        fibers.park();
    }
    void start(std::size_t count, std::size_t at_once, const Concurrent::Work& work) {
        fibers.start("caller", [&, count, at_once] {
            try {
                rounds.each("node", count, at_once, work);
                ended = true;
            } catch (const std::exception& error) {
                what = error.what();
            }
        });
    }
    // Like a place: what is ready, then more of what is done side by side; then all that waits is answered.
    void run() {
        while (true) {
            if (!ready.empty()) {
                auto* const fiber = ready.front();
                ready.pop_front();
                fibers.resume(fiber);
            } else if (!rounds.start_one()) {
                if (waiting.empty()) return;
                std::swap(ready, waiting);
            }
        }
    }

    Fibers fibers;
    std::deque<Fibers::Fiber*> ready, waiting;
    Rounds rounds{fibers, 5, [this](Fibers::Fiber* fiber) { ready.push_back(fiber); }};
    std::size_t most_waiting = 0;
    bool ended = false;
    std::string what;
};

TEST_F(RoundsTest, DoEachPieceOnce) {
    std::vector<int> done(100);
    const Concurrent::Work work = [&](std::size_t i) {
        if (i % 3) wait();
        ++done[i];
    };
    start(done.size(), 100, work);
    run();
    EXPECT_TRUE(ended);
    EXPECT_EQ(done, std::vector<int>(100, 1));
    EXPECT_EQ(most_waiting, 6u) << "five fibers, and the one that calls";
    EXPECT_EQ(fibers.alive(), 0u);
}

TEST_F(RoundsTest, StartNoFiberForWhatNeverWaits) {
    const Concurrent::Work work = [](std::size_t) {};
    start(100, 100, work);
    EXPECT_TRUE(ended) << "before anybody could start another";
}

TEST_F(RoundsTest, HaveNoMoreAtWorkThanTheyAreAllowed) {
    const Concurrent::Work work = [&](std::size_t) { wait(); };
    start(100, 2, work);
    run();
    EXPECT_TRUE(ended);
    EXPECT_EQ(most_waiting, 2u);
}

TEST_F(RoundsTest, GoOnWithTheCallerAlone) {
    Rounds alone(fibers, 0, [this](Fibers::Fiber* fiber) { ready.push_back(fiber); });
    fibers.start("caller", [&] {
        alone.each("node", 10, 10, [&](std::size_t) { wait(); });
        ended = true;
    });
    run();
    EXPECT_TRUE(ended);
    EXPECT_EQ(most_waiting, 1u);
}

TEST_F(RoundsTest, ThrowWhatTheFirstPieceThrewWhenAllThatWereBegunHaveEnded) {
    int done = 0;
    const Concurrent::Work work = [&](std::size_t i) {
        wait();
        if (i == 2 || i == 4) throw std::runtime_error("piece " + std::to_string(i));
        ++done;
    };
    start(100, 100, work);
    run();
    EXPECT_EQ(what, "piece 2");
    EXPECT_LT(done, 20) << "few were begun, and then no more";
    EXPECT_EQ(fibers.alive(), 0u);
}

TEST_F(RoundsTest, RunSeveralAtATimeAndInsideEachOther) {
    int done = 0;
    const Concurrent::Work inner = [&](std::size_t) { wait(), ++done; };
    const Concurrent::Work outer = [&](std::size_t) { rounds.each("inner", 4, 4, inner); };
    start(3, 3, outer);
    start(3, 3, outer);
    run();
    EXPECT_EQ(done, 24);
    EXPECT_EQ(fibers.alive(), 0u);
}

// The caller's stack holds what all work on: it must be the last to unwind.
TEST_F(RoundsTest, UnwindTheCallerAfterItsHelpers) {
    std::vector<std::string> order;
    struct Leaving {
        std::vector<std::string>& order;
        std::string name;
        ~Leaving() { order.push_back(name); }
    };
    const Concurrent::Work work = [&](std::size_t i) {
        const Leaving leaving{order, "piece " + std::to_string(i)};
        wait();
    };
    fibers.start("caller", [&] {
        const Leaving leaving{order, "caller"};
        rounds.each("node", 3, 3, work);
    });
    while (rounds.start_one()) {
    }
    ASSERT_EQ(waiting.size(), 3u);
    fibers.cancel_all();
    EXPECT_EQ(order, (std::vector<std::string>{"piece 0", "piece 1", "piece 2", "caller"}));
}

TEST_F(RoundsTest, CountTheTimeOfHelpersAsTheCallers) {
    const auto until = [](std::chrono::steady_clock::time_point end) {
        while (std::chrono::steady_clock::now() < end) {
        }
    };
    std::chrono::nanoseconds ran{0};
    const Concurrent::Work work = [&](std::size_t) {
        wait();
        until(std::chrono::steady_clock::now() + std::chrono::milliseconds(2));
    };
    fibers.start("caller", [&] {
        rounds.each("node", 4, 4, work);
        ran = fibers.running_time(fibers.current());
    });
    run();
    EXPECT_GE(ran, std::chrono::microseconds(7900));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(RoundsTest, AreNamedWhenAStackRunsOutWhoeverHasCalledThem) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Concurrent::Work work = [](std::size_t) { (void)test::recurse(nullptr); };
    EXPECT_DEATH(start(1, 1, work), "stack of node 'node' ran out");
}
#endif

}  // namespace
}  // namespace lightnet::rounds_test
