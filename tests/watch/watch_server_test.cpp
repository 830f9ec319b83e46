// What browsers, and others, get from the server of a run.
#include "tools/watch/watch_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "core/base/error.hpp"
#include "tests/watch/visitor.hpp"

namespace lightnet::watch_server_test {
namespace {

using namespace std::chrono_literals;
using test::get;
using test::status_of;
using test::Visitor;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class WatchServerTest : public ::testing::Test {
protected:
    static constexpr std::size_t side = 512;

    WatchServer::Options options() { return {{}, "right", "<p>the page</p>"}; }
    WatchStage stage() {
        return {R"({"hello":{"graph":"box.lua"}})", shown, [this](WatchCommand command) {
                    const std::lock_guard lock(mutex);
                    commands.push_back(std::move(command));
                }};
    }
    void show(float value) {
        const Tile whole{0, 0, side, side};
        const std::vector<Rgb> pixels(whole.pixels(), Rgb{value, value, value});
        while (!board.show(whole, pixels)) std::this_thread::sleep_for(1ms);
    }
    // A page that looks at the board just now has it refuse.
    void tell(const std::string& state) {
        while (!board.tell(state)) std::this_thread::sleep_for(1ms);
    }
    std::string own() { return "127.0.0.1:" + std::to_string(server.port()); }
    // So many bytes of pixels, as far as they come.
    static std::size_t pixels_of(Visitor& visitor, std::size_t wanted) {
        std::size_t bytes = 0;
        while (bytes < wanted)
            if (const auto frame = visitor.next(); !frame)
                break;
            else if (!frame->text)
                bytes += frame->data.size();
        return bytes;
    }

    std::mutex mutex;
    std::vector<WatchCommand> commands;
    std::shared_ptr<WatchBoard> shown = std::make_shared<WatchBoard>(Window{0, 0, side, side}, 1);
    WatchBoard& board = *shown;
    WatchServer server{options(), stage()};
};

TEST_F(WatchServerTest, ServesThePageAndTheState) {
    tell(R"({"t":1})");
    EXPECT_THAT(get(server.port(), "/"), HasSubstr("<p>the page</p>"));
    EXPECT_THAT(get(server.port(), "/state"), HasSubstr(R"({"hello":{"graph":"box.lua"},"state":{"t":1}})"));
    EXPECT_THAT(server.url(), HasSubstr("http://" + own() + "/#right"));
    EXPECT_THAT(get(server.port(), "/"), HasSubstr("default-src 'none'"));
}

TEST_F(WatchServerTest, RefusesWhatIsCalledByAnotherNameOrByAnothersPage) {
    EXPECT_EQ(status_of(get(server.port(), "/", "", "evil.example")), 421);
    EXPECT_EQ(status_of(get(server.port(), "/state", "", "evil.example:" + std::to_string(server.port()))), 421);
    EXPECT_EQ(status_of(get(server.port(), "/state", "Origin: http://evil.example\r\n")), 403);
    EXPECT_EQ(status_of(get(server.port(), "/state", "Origin: null\r\n")), 403);
    Visitor stranger(server.port()), own_page(server.port());
    EXPECT_FALSE(stranger.watch(own(), "http://evil.example"));
    EXPECT_TRUE(own_page.watch(own(), "http://" + own()));
}

TEST_F(WatchServerTest, AnswersBadRequestsByWhatIsWrong) {
    const auto status = [&](const std::string& request) {
        Visitor visitor(server.port());
        visitor.send(request);
        visitor.end();
        return status_of(visitor.all());
    };
    const auto host = "Host: " + own() + "\r\n";
    EXPECT_EQ(status("nonsense\r\n\r\n"), 400);
    EXPECT_EQ(status("GET / HTTP/1.1\r\n\r\n"), 400);
    EXPECT_EQ(status("POST / HTTP/1.1\r\n" + host + "\r\n"), 405);
    EXPECT_EQ(status("POST / HTTP/1.1\r\n" + host + "Content-Length: 3\r\n\r\nabc"), 413);
    EXPECT_EQ(status("GET /etc/passwd HTTP/1.1\r\n" + host + "\r\n"), 404);
    EXPECT_EQ(status("GET /../state HTTP/1.1\r\n" + host + "\r\n"), 404);
    EXPECT_EQ(status("GET /live HTTP/1.1\r\n" + host + "\r\n"), 426);
    EXPECT_EQ(status("GET / HTTP/1.1\r\n" + host + "X: " + std::string(20000, 'x') + "\r\n\r\n"), 431);
    EXPECT_EQ(status("HEAD / HTTP/1.1\r\n" + host + "\r\n"), 200);
    EXPECT_EQ(status_of(get(server.port(), "/")), 200) << "and goes on";
}

TEST_F(WatchServerTest, ClosesOnWhoDoesNotFinishARequest) {
    Visitor visitor(server.port());
    visitor.send("GET / HT");
    EXPECT_THAT(visitor.all(test::slowdown * 8s), IsEmpty());
}

TEST_F(WatchServerTest, SaysHelloThenStateLogAndPixels) {
    board.say("a line");
    tell(R"({"t":7})");
    show(0.5f);
    Visitor visitor(server.port());
    ASSERT_TRUE(visitor.watch(own()));
    EXPECT_TRUE(board.wanted());
    EXPECT_TRUE(visitor.next_with("hello"));
    EXPECT_TRUE(visitor.next_with("a line"));
    EXPECT_TRUE(visitor.next_with(R"({"state":{"t":7}})"));
    EXPECT_GT(pixels_of(visitor, side * side * sizeof(Rgb)), side * side * sizeof(Rgb));
}

TEST_F(WatchServerTest, DoesWhatIsAskedForByWhoHasTheTokenAlone) {
    Visitor visitor(server.port());
    ASSERT_TRUE(visitor.watch(own()));
    visitor.say(R"({"do":"end"})");
    EXPECT_THAT(visitor.next_with("done").value_or(""), HasSubstr(R"("allowed":false)"));
    visitor.say(R"({"do":"end","token":"wrong"})");
    EXPECT_THAT(visitor.next_with("done").value_or(""), HasSubstr(R"("allowed":false)"));
    visitor.say(R"({"do":"check","token":"right"})");
    EXPECT_THAT(visitor.next_with("done").value_or(""), HasSubstr(R"("allowed":true)"));
    EXPECT_THAT(commands, IsEmpty());
    visitor.say(R"({"do":"drain","host":"onyx","token":"right"})");
    EXPECT_THAT(visitor.next_with("done").value_or(""), HasSubstr(R"("allowed":true)"));
    const std::lock_guard lock(mutex);
    EXPECT_THAT(commands, ElementsAre(WatchCommand{WatchCommand::What::drain, "onyx"}));
}

TEST_F(WatchServerTest, TellsWhatBecameOfAWish) {
    Visitor visitor(server.port());
    ASSERT_TRUE(visitor.watch(own()));
    visitor.say(R"({"do":"drain","host":"onyx","token":"right"})");
    EXPECT_TRUE(visitor.next_with("allowed"));
    {
        const std::lock_guard lock(mutex);
        ASSERT_EQ(commands.size(), 1u);
        commands[0].answer("nobody is called so");
    }
    EXPECT_THAT(visitor.next_with("obeyed").value_or(""),
                AllOf(HasSubstr(R"("obeyed":"drain")"), HasSubstr(R"("why_not":"nobody is called so")")));
}

TEST_F(WatchServerTest, DropsWhoSaysWhatHasNoSense) {
    for (const std::string said : {"", "{", "[]", R"({"do":7})", R"({"do":"dance","token":"right"})"}) {
        Visitor visitor(server.port());
        ASSERT_TRUE(visitor.watch(own()));
        visitor.say(said);
        EXPECT_FALSE(visitor.next_with("done")) << said;
    }
    Visitor long_winded(server.port());
    ASSERT_TRUE(long_winded.watch(own()));
    long_winded.say(R"({"do":"check","host":")" + std::string(5000, 'x') + "\"}");
    EXPECT_FALSE(long_winded.next_with("done"));
    EXPECT_EQ(status_of(get(server.port(), "/")), 200);
}

TEST_F(WatchServerTest, GivesWhoComesAgainAllOfThePicture) {
    show(1);
    for (int i = 0; i < 2; ++i) {
        Visitor visitor(server.port());
        ASSERT_TRUE(visitor.watch(own()));
        EXPECT_GT(pixels_of(visitor, side * side * sizeof(Rgb)), side * side * sizeof(Rgb)) << i;
    }
}

TEST_F(WatchServerTest, TakesNoMoreThanSoMany) {
    auto few = options();
    few.most_watchers = 1;
    WatchServer small(few, stage());
    const auto name = "127.0.0.1:" + std::to_string(small.port());
    Visitor first(small.port()), second(small.port());
    EXPECT_TRUE(first.watch(name));
    EXPECT_FALSE(second.watch(name));
}

TEST_F(WatchServerTest, DropsWhoIsTooSlowAndServesTheOthers) {
    auto hasty = options();
    hasty.slow_seconds = 1;
    hasty.send_buffer = 4096;
    WatchServer quick(hasty, stage());
    const auto name = "127.0.0.1:" + std::to_string(quick.port());
    Visitor slow(quick.port(), 4096), other(quick.port());
    ASSERT_TRUE(slow.watch(name));  // and takes nothing of what follows
    ASSERT_TRUE(other.watch(name));
    show(1);
    EXPECT_GT(pixels_of(other, side * side * sizeof(Rgb)), side * side * sizeof(Rgb));
    for (const auto end = std::chrono::steady_clock::now() + test::slowdown * 10s;
         quick.dropped() == 0 && std::chrono::steady_clock::now() < end;)
        std::this_thread::sleep_for(20ms);
    EXPECT_EQ(quick.dropped(), 1u);
}

TEST_F(WatchServerTest, SaysWhyItCannotListen) {
    auto taken = options();
    taken.address.port = server.port();
    EXPECT_THROW(WatchServer(taken, stage()), Error);
}

TEST_F(WatchServerTest, ShowsOneRunAfterTheOtherToThoseWhoStay) {
    Visitor visitor(server.port());
    ASSERT_TRUE(visitor.watch(own()));
    tell(R"({"t":1})");
    ASSERT_TRUE(visitor.next_with("\"t\":1"));
    const auto next = std::make_shared<WatchBoard>(Window{0, 0, 8, 8}, 1);
    next->tell(R"({"t":2})");
    std::atomic<int> asked{0};
    server.show({R"({"hello":{"graph":"next.lua"}})", next, [&](const WatchCommand& command) {
                     ++asked;
                     command.answer("");
                 }});
    EXPECT_TRUE(visitor.next_with("next.lua"));
    EXPECT_TRUE(visitor.next_with("\"t\":2"));
    EXPECT_TRUE(next->wanted());
    visitor.say(R"({"do":"write","token":"right"})");
    EXPECT_TRUE(visitor.next_with("obeyed"));
    EXPECT_EQ(asked, 1);
    EXPECT_THAT(commands, IsEmpty());
    server.tell(R"({"edited":{"event":"error"}})");
    EXPECT_TRUE(visitor.next_with("edited"));
}

TEST_F(WatchServerTest, PassesEditsOnFromThoseWhoMay) {
    auto editing = options();
    std::mutex lines_mutex;
    std::vector<std::string> lines;
    editing.edit = [&](std::string line) {
        const std::lock_guard lock(lines_mutex);
        lines.push_back(std::move(line));
    };
    WatchServer session(editing, stage());
    Visitor visitor(session.port());
    ASSERT_TRUE(visitor.watch("127.0.0.1:" + std::to_string(session.port())));
    visitor.say(R"({"do":"edit","edit":{"set":{"light.samples":3}},"token":"wrong"})");
    EXPECT_TRUE(visitor.next_with("\"allowed\":false"));
    visitor.say(R"({"do":"edit","edit":{"set":{"light.samples":3}},"token":"right"})");
    EXPECT_TRUE(visitor.next_with("\"allowed\":true"));
    const std::lock_guard lock(lines_mutex);
    EXPECT_THAT(lines, ElementsAre(R"({"set":{"light.samples":3}})"));
}

TEST_F(WatchServerTest, EndsWhatGoesOnBeyondRunsAlsoBetweenThem) {
    auto lasting = options();
    std::atomic<int> ended{0};
    lasting.end = [&] { ++ended; };
    WatchServer session(lasting, stage_before_runs());
    Visitor visitor(session.port());
    ASSERT_TRUE(visitor.watch("127.0.0.1:" + std::to_string(session.port())));
    visitor.say(R"({"do":"end","token":"wrong"})");
    EXPECT_TRUE(visitor.next_with("\"allowed\":false"));
    EXPECT_EQ(ended, 0);
    visitor.say(R"({"do":"end","token":"right"})");
    EXPECT_TRUE(visitor.next_with("obeyed"));
    EXPECT_EQ(ended, 1);
}

TEST_F(WatchServerTest, HasNobodyWaitForItsEnd) {
    auto ending = std::make_unique<WatchServer>(options(), stage());
    Visitor visitor(ending->port());
    ASSERT_TRUE(visitor.watch("127.0.0.1:" + std::to_string(ending->port())));
    tell(R"({"outcome":"done"})");
    const auto begun = std::chrono::steady_clock::now();
    ending.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, test::slowdown * 2s);
    EXPECT_TRUE(visitor.next_with("done")) << "its last words were said";
}

}  // namespace
}  // namespace lightnet::watch_server_test
