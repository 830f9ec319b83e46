#include "tools/http/byte_line.hpp"

#include <utility>  // which Asio forgets

#include <boost/asio.hpp>

#include <array>
#include <chrono>
#include <optional>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Fault = boost::system::error_code;

constexpr auto glance = std::chrono::milliseconds(50);  // between two questions whether patience goes on

}  // namespace

ByteTarget::ByteTarget(const std::string& host, std::uint16_t port) : port_(port) {
    asio::io_context io;
    Fault fault;
    const auto found = Tcp::resolver(io).resolve(host, std::to_string(port), fault);
    if (fault || found.empty()) throw Error("nobody is called '" + host + "'", fault.message());
    address_ = found.begin()->endpoint().address().to_string();
}

struct ByteLine::Parts {
    asio::io_context io{1};
    Tcp::socket socket{io};

    // Runs what was begun, until it is done or patience ends.
    bool finish(const std::optional<Fault>& done, const Patient& patient) {
        io.restart();
        while (!done) {
            io.run_for(glance);
            if (done) break;
            if (patient()) continue;
            socket.close();
            io.run();
            return false;
        }
        return !*done;
    }
};

ByteLine::ByteLine(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ByteLine::~ByteLine() = default;

std::unique_ptr<ByteLine> ByteLine::to(const ByteTarget& target, const Patient& patient) {
    auto parts = std::make_unique<Parts>();
    std::optional<Fault> done;
    parts->socket.async_connect({asio::ip::make_address(target.address()), target.port()},
                                [&](Fault fault) { done = fault; });
    if (!parts->finish(done, patient)) return nullptr;
    Fault ignored;
    parts->socket.non_blocking(true, ignored);
    return std::unique_ptr<ByteLine>(new ByteLine(std::move(parts)));
}

bool ByteLine::send(std::string_view bytes, const Patient& patient) {
    std::optional<Fault> done;
    asio::async_write(parts_->socket, asio::buffer(bytes), [&](Fault fault, std::size_t) { done = fault; });
    if (parts_->finish(done, patient)) return true;
    Fault ignored;
    parts_->socket.close(ignored);
    return false;
}

bool ByteLine::is_open() {
    std::array<char, 1024> said{};
    Fault fault;
    if (!parts_->socket.is_open()) return false;
    while (parts_->socket.read_some(asio::buffer(said), fault) > 0 && !fault) {
    }
    return fault == asio::error::would_block;
}

}  // namespace lightnet
