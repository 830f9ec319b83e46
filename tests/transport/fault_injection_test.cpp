// Lines that delay, and processes in slow motion.
#include <arpa/inet.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <thread>

#include "transport/start/child.hpp"
#include "transport/start/cpu_throttle.hpp"
#include "transport/start/latency_proxy.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A socket of this machine, closed at the end.
class Plug {
public:
    Plug() : file_(socket(AF_INET, SOCK_STREAM, 0)) {}
    explicit Plug(int file) : file_(file) {}
    ~Plug() { close(file_); }
    Plug(const Plug&) = delete;

    /// Listens; gives the port.
    int listen_anywhere() const {
        sockaddr_in address = of(0);
        bind(file_, reinterpret_cast<sockaddr*>(&address), sizeof address);
        ::listen(file_, 4);
        socklen_t size = sizeof address;
        getsockname(file_, reinterpret_cast<sockaddr*>(&address), &size);
        return ntohs(address.sin_port);
    }
    int take_caller() const { return accept(file_, nullptr, nullptr); }
    bool call(const std::string& endpoint) const {
        const sockaddr_in address = of(std::stoi(endpoint.substr(endpoint.rfind(':') + 1)));
        return connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    void say(const std::string& text) const { EXPECT_EQ(write(file_, text.data(), text.size()), long(text.size())); }
    /// So many bytes, or fewer when the line has ended.
    std::string hear(std::size_t size) const {
        std::string text(size, ' ');
        std::size_t there = 0;
        for (ssize_t n = 1; there < size && n > 0; there += std::max<ssize_t>(n, 0))
            n = read(file_, text.data() + there, size - there);
        return text.substr(0, there);
    }

private:
    static sockaddr_in of(int port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        return address;
    }
    int file_;
};

struct Line {
    Plug door, caller;
    std::string behind = "tcp://127.0.0.1:" + std::to_string(door.listen_anywhere());
};

TEST(DelayLineTest, BringsAllBytesInOrderAndNoneTooEarly) {
    Line line;
    const LatencyProxy delayed(line.behind, 30ms);
    ASSERT_TRUE(line.caller.call(delayed.endpoint()));
    const Plug called(line.door.take_caller());
    const auto begun = Clock::now();
    line.caller.say("there");
    EXPECT_EQ(called.hear(5), "there");
    EXPECT_GE(Clock::now() - begun, 30ms);
    called.say("and back");
    EXPECT_EQ(line.caller.hear(8), "and back");
    EXPECT_GE(Clock::now() - begun, 60ms);
    std::string much;
    for (int i = 0; i < 300'000; ++i) much += std::to_string(i);
    std::thread sender([&] { line.caller.say(much); });
    EXPECT_TRUE(called.hear(much.size()) == much);
    sender.join();
}

TEST(DelayLineTest, TellsTheEndBehindTheLastByte) {
    Line line;
    const LatencyProxy delayed(line.behind, 10ms);
    std::optional<Plug> caller(std::in_place);
    ASSERT_TRUE(caller->call(delayed.endpoint()));
    const Plug called(line.door.take_caller());
    caller->say("last");
    caller.reset();
    EXPECT_EQ(called.hear(100), "last");
}

TEST(DelayLineTest, HangsUpWhereNobodyAnswers) {
    std::string nowhere;
    {
        const Line gone;
        nowhere = gone.behind;
    }
    const LatencyProxy delayed(nowhere, 1ms);
    const Plug caller;
    ASSERT_TRUE(caller.call(delayed.endpoint()));
    EXPECT_EQ(caller.hear(1), "");
}

TEST(SlowMotionTest, MakesAllThatAProcessDoesTakeLonger) {
    int out = -1;
    const int process = spawn({"sh", "-c", "i=0; while [ $i -lt 150000 ]; do i=$((i+1)); done"}, &out);
    const auto begun = Clock::now();
    {
        const CpuThrottle slow(process, 6);
        rusage used{};
        int status = -1;
        ASSERT_EQ(wait4(process, &status, 0, &used), process);
        EXPECT_EQ(status, 0);
        const auto computed = std::chrono::seconds(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                              std::chrono::microseconds(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
        EXPECT_GT(Clock::now() - begun, 3 * computed);
    }
    close(out);
}

TEST(SlowMotionTest, LetsAProcessGoWhenItEnds) {
    int out = -1;
    const int process = spawn({"sh", "-c", "read line"}, &out);
    { const CpuThrottle slow(process, 1000); }
    kill(process, SIGTERM);
    int status = 0;
    ASSERT_EQ(waitpid(process, &status, 0), process);
    EXPECT_TRUE(WIFSIGNALED(status) || WIFEXITED(status));
    close(out);
}

}  // namespace
}  // namespace lightnet
