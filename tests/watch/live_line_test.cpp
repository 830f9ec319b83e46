// The way of `watch` to a run, from whoever may listen there.
#include "tools/http/live_line.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <utility>  // which Asio forgets

#include <boost/asio.hpp>

#include "core/base/error.hpp"

namespace lightnet::test {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// Answers one caller with a beginning, and then with as much as he takes.
class Talker {
public:
    explicit Talker(std::string beginning) : beginning_(std::move(beginning)) {}
    std::uint16_t port() const { return door_.local_endpoint().port(); }
    std::size_t taken() {
        thread_.join();
        return taken_;
    }

private:
    void talk() {
        boost::system::error_code fault;
        tcp::socket caller(io_);
        door_.accept(caller, fault);
        const std::string more(1 << 20, 'x');
        asio::write(caller, asio::buffer(beginning_), fault);
        while (!fault && taken_ < most) taken_ += caller.write_some(asio::buffer(more), fault);
    }
    static constexpr std::size_t most = std::size_t{1} << 30;
    std::string beginning_;
    asio::io_context io_;
    tcp::acceptor door_{io_, {asio::ip::make_address("127.0.0.1"), 0}};
    std::size_t taken_ = 0;
    std::thread thread_{[this] { talk(); }};
};

constexpr std::size_t buffers_of_the_system = 64 << 20;

TEST(LiveLine, TakesInNoEndlessAnswer) {
    for (const std::string answer : {"HTTP/1.1 404 Not Found\r\nContent-Length: 90000000000\r\n\r\n",
                                     "HTTP/1.1 200 OK\r\n\r\n", "HTTP/1.1 101 Go on\r\nX: ", "x"}) {
        Talker talker(answer);
        EXPECT_THROW(LiveLine("127.0.0.1", talker.port(), "/live"), Error) << answer;
        EXPECT_LT(talker.taken(), buffers_of_the_system) << answer;
    }
}

TEST(LiveLine, TakesAnAnswerThatCantBeKeptForNone) {
    for (const std::string size : {"652147483648", "18446744073709551615"}) {
        Talker talker("HTTP/1.1 404 Not Found\r\nContent-Length: " + size + "\r\n\r\n");
        EXPECT_THROW(LiveLine("127.0.0.1", talker.port(), "/live"), Error) << size;
        EXPECT_LT(talker.taken(), buffers_of_the_system);
    }
}

}  // namespace
}  // namespace lightnet::test
