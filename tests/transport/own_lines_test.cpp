// Lines of a place's own to other hosts.
#include "transport/zmq/own_lines.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "transport/lines/poll.hpp"

namespace lightnet::own_lines_test {
namespace {

using namespace std::chrono_literals;
using packet::Type;

constexpr std::size_t room = 1000;
const std::string host = "tcp://somewhere:7777";  // as plans call it

struct OwnLinesTest : ::testing::Test {
    SocketContext context;
    std::shared_ptr<LineBook> book = std::make_shared<LineBook>();
    OwnLines lines{context, book};
    std::vector<Frames> came;  // to the door, but for wishes about the line
    std::set<std::string> routes;
    bool unpaced = false;

    static Socket new_door(const SocketContext& context) {
        auto door = door_socket(context);
        door.bind("tcp://127.0.0.1:*");
        return door;
    }
    Socket door = new_door(context);

    LineBook::Entry entry(std::uint64_t line = 1) const { return {door.endpoint(), std::nullopt, line, room}; }
    void read_book(bool waiting = false) {
        lines.look_into_book([&](const std::string&) { return waiting; });
    }
    // A packet that asks: header and body.
    static Frames ask() {
        Message message;
        message.questions = std::make_shared<const std::vector<Query>>(1);
        return frames_of(packet::pack(message, 0));
    }
    bool send(std::size_t bytes = room) {
        auto frames = ask();
        return lines.send(host, frames, bytes);
    }
    void look_at_door() {
        while (auto frames = door.receive()) {
            routes.insert(text_of(frames->front()));
            const auto header = frames->size() == 3 ? packet::peek_header(bytes_of((*frames)[1])) : std::nullopt;
            if (header && header->type == Type::unpaced)
                unpaced = true;
            else if (header)
                came.push_back(std::move(*frames));
        }
    }
    // What both ends have to do is done until `enough`, for as long as a busy machine may need.
    bool until(const std::function<bool()>& enough) {
        for (int turn = 0; turn < 3000; ++turn) {
            look_at_door();
            lines.receive();
            if (enough()) return true;
            Poll poll;
            poll.add(door);
            for (auto* source : lines.sources()) poll.add(source->socket), source->dry = false;
            poll.wait(10ms);
        }
        return false;
    }
    bool greeted() {
        return until([&] { return unpaced; });
    }
};

TEST_F(OwnLinesTest, AreForHostsOfTheBookAlone) {
    read_book();
    EXPECT_TRUE(lines.sources().empty());
    EXPECT_FALSE(send());
    book->use({{host, entry()}});
    read_book();
    EXPECT_EQ(lines.sources().size(), 1u);
}

TEST_F(OwnLinesTest, CarryPacketsOnceTheyAreGreetedAndSayThatTheyWantNoMarks) {
    book->use({{host, entry()}});
    read_book();
    EXPECT_FALSE(send()) << "nobody is there yet, as far as is known";
    ASSERT_TRUE(greeted());
    EXPECT_TRUE(send());
    EXPECT_TRUE(until([&] { return came.size() == 1; }));
    EXPECT_TRUE(lines.cut().empty()) << "the first greeting is expected";
}

TEST_F(OwnLinesTest, BringRepliesBack) {
    book->use({{host, entry()}});
    read_book();
    ASSERT_TRUE(greeted());
    ASSERT_TRUE(send());
    ASSERT_TRUE(until([&] { return !came.empty(); }));
    ASSERT_TRUE(door.send(came.front()));
    for (int turn = 0; turn < 3000; ++turn) {
        for (auto* source : lines.sources()) source->dry = false;
        if (const auto reply = lines.receive()) {
            EXPECT_EQ(reply->first, host);
            EXPECT_EQ(reply->second.size(), 2u);
            return;
        }
        Poll poll;
        for (auto* source : lines.sources()) poll.add(source->socket);
        poll.wait(10ms);
    }
    FAIL() << "it did not come";
}

TEST_F(OwnLinesTest, HaveNoMoreUnderWayThanTheBookHasRoomFor) {
    book->use({{host, entry()}});
    read_book();
    ASSERT_TRUE(greeted());
    EXPECT_TRUE(send(2 * room)) << "one always may";
    EXPECT_FALSE(send(1));
    lines.settled(host, 2 * room);
    EXPECT_TRUE(send(room / 2));
    EXPECT_TRUE(send(room / 2));
    EXPECT_FALSE(send(1));
}

TEST_F(OwnLinesTest, AreRenewedWithThatOfTheHostAndTellWhatMayBeLost) {
    book->use({{host, entry()}});
    read_book();
    ASSERT_TRUE(greeted());
    ASSERT_TRUE(send());
    unpaced = false;
    book->use({{host, entry(2)}});
    read_book();
    EXPECT_EQ(lines.cut(), std::vector{host});
    EXPECT_TRUE(lines.cut().empty()) << "it is told once";
    ASSERT_TRUE(greeted());
    EXPECT_TRUE(send()) << "nothing is under way on the new one";
    EXPECT_TRUE(until([&] { return routes.size() == 2; })) << "it is another connection";
}

TEST_F(OwnLinesTest, AreKeptForRepliesOnly) {
    book->use({{host, entry()}});
    read_book();
    ASSERT_TRUE(greeted());
    ASSERT_TRUE(send(1));
    book->use({});
    read_book(true);
    EXPECT_EQ(lines.sources().size(), 1u) << "somebody waits for it";
    EXPECT_FALSE(send(1)) << "and nothing new goes that way";
    book->use({{"tcp://elsewhere:1", entry()}});
    read_book(false);
    EXPECT_EQ(lines.sources().size(), 1u) << "that to elsewhere";
}

TEST_F(OwnLinesTest, TellWhenTheirConnectionWasMadeAnew) {
    book->use({{host, entry()}});
    read_book();
    ASSERT_TRUE(greeted());
    const auto endpoint = door.endpoint();
    door.unbind(endpoint);
    { const Socket gone = std::move(door); }
    door = door_socket(context);
    for (int turn = 0; turn < 500; ++turn) try {
            door.bind(endpoint);
            break;
        } catch (const SocketError&) {  // the one before takes a moment to end
            Poll().wait(10ms);
        }
    EXPECT_TRUE(until([&] { return lines.cut() == std::vector{host}; }));
}

}  // namespace
}  // namespace lightnet::own_lines_test
