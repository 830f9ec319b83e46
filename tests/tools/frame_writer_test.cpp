#include "tools/session/frame_writer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>

namespace lightnet::frame_writer_test {
namespace {

TEST(FrameWriter, WritesBesideOneFrameAtATime) {
    FrameWriter writer;
    std::promise<void> disk;
    std::atomic<bool> first_done{false};
    writer.begin([&] {
        disk.get_future().wait();  // would be for ever, if beginning waited for it
        first_done = true;
        return 0;
    });
    disk.set_value();
    bool before = false;
    writer.begin([&] {
        before = first_done;
        return 0;
    });
    EXPECT_EQ(writer.code(), 0);
    EXPECT_TRUE(before) << "memory has room for one";
}

TEST(FrameWriter, LetsGoOfAFrameAsSoonAsThatIsWritten) {
    FrameWriter writer;
    auto film = std::make_shared<int>(0);
    const std::weak_ptr<int> seen = film;
    writer.begin([film = std::move(film)] { return *film; });
    writer.wait();
    EXPECT_TRUE(seen.expired());
}

TEST(FrameWriter, TellsOfTheFirstFrameThatCouldNotBeWritten) {
    FrameWriter codes;
    for (const int code : {0, 3, 1, 0}) codes.begin([code] { return code; });
    EXPECT_EQ(codes.code(), 3);
    FrameWriter errors;
    errors.begin([]() -> int { throw std::runtime_error("the disk is full"); });
    errors.begin([] { return 0; });
    EXPECT_TRUE(errors.failed());
    EXPECT_THROW(errors.code(), std::runtime_error);
}

}  // namespace
}  // namespace lightnet::frame_writer_test
