// Messages from thread to thread.
#include "transport/lines/frame_queue.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "transport/lines/poll.hpp"

namespace lightnet::frame_queue_test {
namespace {

using namespace std::chrono_literals;

bool push(FrameQueue& queue, const std::string& word) {
    Frames frames;
    frames.emplace_back(word);
    return queue.push(frames);
}

std::string pop(FrameQueue& queue) {
    const auto frames = queue.pop();
    return frames ? text_of(frames->front()) : "";
}

TEST(FrameQueue, KeepsTheirOrder) {
    FrameQueue queue;
    EXPECT_EQ(pop(queue), "");
    EXPECT_TRUE(push(queue, "a"));
    EXPECT_TRUE(push(queue, "b"));
    EXPECT_EQ(pop(queue), "a");
    EXPECT_EQ(pop(queue), "b");
    EXPECT_EQ(pop(queue), "");
}

TEST(FrameQueue, IsReadableForWhoWaitsAsLongAsItHoldsSomething) {
    FrameQueue queue;
    for (int turn = 0; turn < 3; ++turn) {
        Poll before;
        before.add(queue);
        before.wait(0ms);
        EXPECT_FALSE(before.readable(0));
        push(queue, "a");
        for (int look = 0; look < 2; ++look) {
            Poll poll;
            poll.add(queue);
            poll.wait(0ms);
            EXPECT_TRUE(poll.readable(0));
        }
        pop(queue);
    }
}

TEST(FrameQueue, WakesWhoWaits) {
    FrameQueue queue;
    const std::jthread thread([&] {
        for (int i = 0; i < 1000; ++i) push(queue, std::to_string(i));
    });
    for (int next = 0; next < 1000;) {
        Poll poll;
        poll.add(queue);
        poll.wait(60s);  // for ever, where a wake-up is lost
        ASSERT_TRUE(poll.readable(0)) << "after " << next;
        for (auto word = pop(queue); !word.empty(); word = pop(queue)) EXPECT_EQ(word, std::to_string(next++));
    }
}

TEST(FrameQueue, HoldsNoMoreThanCreditAllows) {
    FrameQueue queue;
    for (int i = 0; i < high_water_mark; ++i) ASSERT_TRUE(push(queue, "a"));
    EXPECT_FALSE(push(queue, "b")) << "somebody sends without credit";
    Frames plan;
    plan.emplace_back(std::string("c"));
    EXPECT_TRUE(queue.push_always(plan)) << "of the host itself";
    pop(queue), pop(queue);
    EXPECT_TRUE(push(queue, "b"));
}

TEST(FrameQueue, RefusesWhatNobodyWillTakeAndLeavesItAsItWas) {
    FrameQueue queue;
    push(queue, "a");
    queue.close();
    EXPECT_EQ(pop(queue), "");
    Frames frames;
    frames.emplace_back(std::string("b"));
    EXPECT_FALSE(queue.push(frames));
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(text_of(frames.front()), "b");
}

}  // namespace
}  // namespace lightnet::frame_queue_test
