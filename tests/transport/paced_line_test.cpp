// What two ends of a line make of each other's messages.
#include "transport/lines/paced_line.hpp"

#include <gmock/gmock.h>

#include <deque>
#include <string>
#include <vector>

namespace lightnet::paced_line_test {
namespace {

using packet::Fields;
using packet::Type;
using std::chrono::milliseconds;

class PacedLineTest : public ::testing::Test {
protected:
    // A message that waits its turn, of so many bytes and of this number.
    static Frames plan(std::size_t size, std::uint64_t number = 1) {
        return frames_of(packet::pack(Type::plan, 7, Fields{}.set("plan", std::string(size, 'x')).set("n", number)));
    }
    static Frames ping() { return frames_of(packet::pack(Type::ping, 7, {})); }
    static Frames ask() {
        Message message;
        message.run = 7, message.bundle = 3;
        message.questions = std::make_shared<const std::vector<Query>>(1);
        return frames_of(packet::pack(message, 0));
    }
    void send(Frames frames) { ASSERT_TRUE(here.send(frames, now, to_there)); }
    // Everything that is on the line arrives, and what that causes.
    void carry() {
        while (!there_in.empty() || !here_in.empty()) {
            now += milliseconds(1);
            carry_one(there_in, there, to_here);
            carry_one(here_in, here, to_there);
        }
    }
    void carry_one(std::deque<Frames>& from, PacedLine& to, const PacedLine::Send& back) {
        if (from.empty()) return;
        auto frames = std::move(from.front());
        from.pop_front();
        if (auto message = to.take(std::move(frames), now, back)) arrived.push_back(std::move(*message));
    }
    std::vector<std::uint64_t> numbers() const {
        std::vector<std::uint64_t> all;
        for (const auto& frames : arrived) all.push_back(packet::unpack_fields(bytes_of(frames.back()))->number("n"));
        return all;
    }
    std::size_t on_the_line() const {
        std::size_t size = 0;
        for (const auto& frames : there_in)
            for (const auto& frame : frames) size += frame.size();
        return size;
    }
    static Type type_of(const Frames& frames) { return packet::peek_header(bytes_of(frames[0]))->type; }

    PacedLine::Time now = PacedLine::Time{} + std::chrono::hours(1);
    PacedLine here, there;
    std::deque<Frames> there_in, here_in;
    bool open = true;
    const PacedLine::Send to_there = [this](Frames& frames) {
        if (open) there_in.push_back(std::move(frames));
        return open;
    };
    const PacedLine::Send to_here = [this](Frames& frames) {
        here_in.push_back(std::move(frames));
        return true;
    };
    std::vector<Frames> arrived;
};

TEST_F(PacedLineTest, CarriesWhatIsSmallAsItIs) {
    send(plan(100));
    ASSERT_EQ(there_in.size(), 1u);
    EXPECT_EQ(type_of(there_in[0]), Type::plan);
    EXPECT_EQ(here.counted(), 1u);
}

TEST_F(PacedLineTest, CarriesWhatIsLargeInPartsAndPutsThemTogether) {
    auto frames = plan(3'000'000);
    frames.insert(frames.begin(), MessageFrame(std::string_view("an address")));
    std::vector<std::string> before;
    for (const auto& frame : frames) before.push_back(text_of(frame));
    send(std::move(frames));
    EXPECT_LT(on_the_line(), 50'000u) << "nobody knows yet how fast it is";
    EXPECT_EQ(here.counted(), 0u) << "it is not there as a whole";
    carry();
    ASSERT_EQ(arrived.size(), 1u);
    std::vector<std::string> after;
    for (const auto& frame : arrived[0]) after.push_back(text_of(frame));
    EXPECT_EQ(after, before);
    EXPECT_EQ(here.counted(), 1u);
    EXPECT_FALSE(here.waiting());
}

TEST_F(PacedLineTest, KeepsTheOrderOfMessages) {
    std::uint64_t number = 0;
    for (const std::size_t size : {10, 200'000, 10, 30'000, 10}) send(plan(size, number++));
    carry();
    EXPECT_THAT(numbers(), ::testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(PacedLineTest, LetsHeartbeatsPass) {
    send(plan(1'000'000));
    send(ping());
    EXPECT_EQ(type_of(there_in.back()), Type::ping);
}

TEST_F(PacedLineTest, BeginsAMessageAnewOnANewConnection) {
    send(plan(1'000'000, 1));
    send(plan(10, 2));
    there_in.clear();  // it was cut
    here.restart();
    there.restart();
    here.go_on(now, to_there);
    carry();
    EXPECT_THAT(numbers(), ::testing::ElementsAre(1, 2));
}

TEST_F(PacedLineTest, GoesOnWhenAnswersToItsMarksVanish) {
    send(plan(300'000, 1));
    there_in.clear();
    here_in.clear();
    here.restart();  // what had gone is lost, and so is the answer to what comes now
    here.go_on(now, to_there);
    std::erase_if(there_in, [](const Frames& frames) { return type_of(frames) == Type::mark; });
    carry();
    EXPECT_TRUE(arrived.empty());
    now += std::chrono::seconds(20);
    here.go_on(now, to_there);
    carry();
    EXPECT_THAT(numbers(), ::testing::ElementsAre(1));
}

TEST_F(PacedLineTest, HoldsAnAskThatWaitsOnce) {
    send(plan(1'000'000));
    send(ask());
    send(ask());
    carry();
    EXPECT_EQ(arrived.size(), 2u);
}

TEST_F(PacedLineTest, GivesBackWhatTheSocketRefuses) {
    open = false;
    auto frames = plan(100, 4);
    EXPECT_FALSE(here.send(frames, now, to_there));
    EXPECT_EQ(packet::unpack_fields(bytes_of(frames.back()))->number("n"), 4u);
    EXPECT_TRUE(here.refused());
    EXPECT_EQ(here.counted(), 0u);
}

TEST_F(PacedLineTest, MakesNothingOfPartsThatDoNotFit) {
    const std::vector<std::byte> some(100);
    const auto take = [&](std::uint64_t offset, std::uint32_t whole) {
        return there.take(frames_of(packet::pack(7, packet::Part{offset, whole, some})), now, to_here);
    };
    EXPECT_FALSE(take(50, 150)) << "its beginning never came";
    EXPECT_FALSE(take(0, 60)) << "longer than the whole";
    EXPECT_FALSE(take(0, 0xffffffff)) << "longer than any message";
    EXPECT_EQ(there.incomplete(), 0u);
    EXPECT_FALSE(take(0, 100000));
    EXPECT_EQ(there.incomplete(), 100u) << "no room is taken for what is not there";
    EXPECT_FALSE(take(0, 100)) << "more frames than any message has";
}

}  // namespace
}  // namespace lightnet::paced_line_test
