// Values that places of a process share and make together.
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/run/assembly/shared_values.hpp"

namespace lightnet::shared_values_test {
namespace {

TEST(SharedValues, AreMadeOnce) {
    SharedValues values;
    int made = 0;
    const auto make = [&](Builders&) { return std::make_shared<const int>(++made); };
    EXPECT_EQ(*std::static_pointer_cast<const int>(values.get(3, 0, {}, make)), 1);
    EXPECT_EQ(*std::static_pointer_cast<const int>(values.get(3, 0, {}, make)), 1);
    EXPECT_EQ(*std::static_pointer_cast<const int>(values.get(3, 1, {}, make)), 2);
}

TEST(SharedValues, OfPassesThatAreOverAreLetGo) {
    SharedValues values;
    int made = 0;
    const auto make = [&](Builders&) { return std::make_shared<const int>(++made); };
    values.get(2, 0, {}, make);
    for (std::uint32_t pass = 0; pass < 20; ++pass)
        for (const std::uint32_t index : {0, 1}) values.get(3, index, {}, make, pass);
    EXPECT_EQ(made, 41);
    EXPECT_EQ(values.size(), 3u) << "two of the last pass, and one of another node";
}

TEST(SharedValues, AreBuiltByAllWhoWaitForThem) {
    SharedValues values;
    std::vector<std::thread::id> builders(3);
    std::latch all_are_here(3);
    const auto make = [&](Builders& here) {
        // None of the three pieces ends before three threads have begun one.
        here.each(3, [&](std::size_t i) {
            builders[i] = std::this_thread::get_id();
            all_are_here.arrive_and_wait();
        });
        return std::make_shared<const int>(7);
    };
    {
        std::vector<std::jthread> places;
        for (int i = 0; i < 3; ++i)
            places.emplace_back(
                [&] { EXPECT_EQ(*std::static_pointer_cast<const int>(values.get(0, 0, {}, make)), 7); });
    }
    EXPECT_EQ(std::set(builders.begin(), builders.end()).size(), 3u);
}

TEST(SharedValues, HaveEachPieceDoneOnceHoweverManyHelp) {
    SharedValues values;
    std::vector<std::atomic<int>> done(500);
    const auto make = [&](Builders& here) {
        for (std::size_t round = 0; round < 5; ++round) here.each(100, [&](std::size_t i) { ++done[round * 100 + i]; });
        return std::make_shared<const int>(0);
    };
    {
        std::vector<std::jthread> places;
        for (int i = 0; i < 4; ++i) places.emplace_back([&] { values.get(0, 0, {}, make); });
    }
    for (const auto& times : done) EXPECT_EQ(times, 1);
}

TEST(SharedValues, ThrowWhatAPieceThrowsToAllWhoAsk) {
    SharedValues values;
    std::size_t begun = 0;
    const auto make = [&](Builders& here) -> SharedValues::Value {
        here.each(10, [&](std::size_t) {
            ++begun;
            throw std::runtime_error("no room");
        });
        return nullptr;
    };
    for (int i = 0; i < 2; ++i) EXPECT_THROW(values.get(0, 0, {}, make), std::runtime_error);
    EXPECT_EQ(begun, 1u) << "and no more is begun";
}

}  // namespace
}  // namespace lightnet::shared_values_test
