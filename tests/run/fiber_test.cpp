#include "core/run/fiber/fiber.hpp"

#include <gtest/gtest.h>

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
    fibers.start("node", [&] {
        waiting = fibers.current();
        before = fibers.running_time(waiting);
        fibers.park();
        after = fibers.running_time(waiting);
    });
    const auto begun = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(20)) {
    }
    fibers.resume(waiting);
    EXPECT_LT(after - before, std::chrono::milliseconds(15));
}

TEST(Fibers, EndAStintByWhatTheyRunAndNotByWhatPassesMeanwhile) {
    Fibers fibers;
    const auto pass = [](std::chrono::milliseconds time) {
        const auto begun = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() - begun < time) {
        }
    };
    pass(std::chrono::milliseconds(2));
    fibers.begin_stint(std::chrono::milliseconds(10));
    fibers.start("node", [] {});
    pass(std::chrono::milliseconds(20));
    EXPECT_FALSE(fibers.stint_over());
    fibers.start("node", [&] { pass(std::chrono::milliseconds(20)); });
    EXPECT_TRUE(fibers.stint_over());
    fibers.begin_stint(std::chrono::milliseconds(10));
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
