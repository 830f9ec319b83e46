#include "core/run/fiber/fiber.hpp"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/endless.hpp"

namespace lightnet::fiber_test {
namespace {

TEST(Fibers, RunUntilTheyParkAndGoOnWhereTheyStood) {
    Fibers fibers;
    std::string story;
    Fibers::Fiber* waiting = nullptr;
    fibers.start("node", [&] {
        story += "a";
        waiting = fibers.current();
        fibers.park();
        story += "c";
    });
    story += "b";
    EXPECT_EQ(fibers.alive(), 1u);
    fibers.resume(waiting);
    EXPECT_EQ(story, "abc");
    EXPECT_EQ(fibers.alive(), 0u);
}

TEST(Fibers, MayParkInsideACatchBlockWithoutMixingUpTheirExceptions) {
    Fibers fibers;
    std::vector<Fibers::Fiber*> waiting;
    std::vector<std::string> caught;
    for (const std::string name : {"first", "second"})
        fibers.start("node", [&, name] {
            try {
                throw std::runtime_error(name);
            } catch (...) {
                waiting.push_back(fibers.current());
                fibers.park();
                try {
                    throw;  // must be our own exception, whoever threw meanwhile
                } catch (const std::exception& error) {
                    caught.push_back(name + " caught " + error.what());
                }
            }
        });
    fibers.resume(waiting[0]);
    fibers.resume(waiting[1]);
    EXPECT_EQ(caught, (std::vector<std::string>{"first caught first", "second caught second"}));
}

TEST(Fibers, ThrowWhatTheirWorkThrowsWhereTheyWereResumed) {
    Fibers fibers;
    EXPECT_THROW(fibers.start("node", [] { throw std::bad_alloc(); }), std::bad_alloc);
    Fibers::Fiber* waiting = nullptr;
    fibers.start("node", [&] {
        waiting = fibers.current();
        fibers.park();
        throw std::runtime_error("late");
    });
    EXPECT_THROW(fibers.resume(waiting), std::runtime_error);
    EXPECT_EQ(fibers.alive(), 0u);
    bool runs = false;
    fibers.start("node", [&] { runs = true; });
    EXPECT_TRUE(runs);
}

TEST(Fibers, UnwindWhenTheyAreCancelled) {
    struct Tracer {
        int& count;
        ~Tracer() { ++count; }
    };
    int unwound = 0;
    {
        Fibers fibers;
        for (int i = 0; i < 10; ++i)
            fibers.start("node", [&] {
                const Tracer tracer{unwound};
                fibers.park();
                ADD_FAILURE() << "a cancelled wait must not return";
            });
    }
    EXPECT_EQ(unwound, 10);
}

TEST(Fibers, ThatAreCancelledMayEvenWaitAgainWhileUnwinding) {
    Fibers fibers;
    int refused = 0;
    fibers.start("node", [&] {
        try {
            fibers.park();
        } catch (const Cancelled&) {
            try {
                fibers.park();
            } catch (const Cancelled&) {
                ++refused;
            }
            throw;
        }
    });
    fibers.cancel_all();
    EXPECT_EQ(refused, 1);
}

TEST(Fibers, UseTheirStacksAgain) {
    Fibers fibers;
    const void* first = nullptr;
    for (int i = 0; i < 1000; ++i)
        fibers.start("node", [&] {
            // Not the address of a local variable: AddressSanitizer puts those elsewhere.
            const void* here = __builtin_frame_address(0);
            if (!first) first = here;
            EXPECT_EQ(first, here);
        });
}

TEST(Fibers, MeasureTimeThatTheyRunAndNotTimeThatTheyWait) {
    Fibers fibers;
    Fibers::Fiber* waiting = nullptr;
    std::chrono::nanoseconds before{}, after{};
    const auto begun = std::chrono::steady_clock::now();
    fibers.start("node", [&] {
        waiting = fibers.current();
        before = fibers.running_time(waiting);
        fibers.park();
        after = fibers.running_time(waiting);
    });
    constexpr auto waited = std::chrono::milliseconds(20);
    for (const auto parked = std::chrono::steady_clock::now(); std::chrono::steady_clock::now() - parked < waited;) {
    }
    fibers.resume(waiting);
    // However long this thread was kept from running meanwhile.
    EXPECT_LT(after - before, std::chrono::steady_clock::now() - begun - waited * 3 / 4);
}

TEST(Fibers, EndAStintByWhatTheyRunAndNotByWhatPassesMeanwhile) {
    Fibers fibers;
    using Clock = std::chrono::steady_clock;
    const auto pass = [](std::chrono::milliseconds time) {
        for (const auto begun = Clock::now(); Clock::now() - begun < time;) {
        }
    };
    constexpr auto stint = std::chrono::milliseconds(10);
    pass(std::chrono::milliseconds(2));
    // A fiber that does nothing may be kept from running for a whole stint, on a machine that has much to do.
    Clock::duration ran{};
    for (int time = 0; time == 0 || (ran > stint / 2 && time < 100); ++time) {
        fibers.begin_stint(stint);
        const auto begun = Clock::now();
        fibers.start("node", [] {});
        ran = Clock::now() - begun;
    }
    pass(2 * stint);
    EXPECT_FALSE(fibers.stint_over());
    fibers.start("node", [&] { pass(2 * stint); });
    EXPECT_TRUE(fibers.stint_over());
    fibers.begin_stint(stint);
    EXPECT_FALSE(fibers.stint_over());
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(FibersDeathTest, NameTheNodeWhoseStackRanOut) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(
        {
            Fibers fibers(64 * 1024);
            fibers.start("caustics", [] { (void)test::recurse(nullptr); });
        },
        "stack of node 'caustics' ran out");
}
#endif

}  // namespace
}  // namespace lightnet::fiber_test
