#include "tools/http/byte_line.hpp"

#include <utility>  // which Asio forgets

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include <array>
#include <chrono>
#include <optional>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Fault = boost::system::error_code;

constexpr auto name_patience = std::chrono::seconds(2), fresh_name = std::chrono::seconds(2);
constexpr auto glance = std::chrono::milliseconds(50);  // between two questions whether patience goes on

}  // namespace

ByteTarget::ByteTarget(std::string host, std::uint16_t port) : host_(std::move(host)), port_(port) {
    const auto found = names_->wait_for(host_, name_patience);
    if (found.state == Whereabout::State::gone) throw Error(found.why);
}

std::vector<std::string> ByteTarget::addresses() const {
    std::vector<std::string> all;
    for (const auto& one : names_->look(host_, std::chrono::steady_clock::now(), fresh_name).addresses)
        all.push_back(one.text());
    return all;
}

std::string ByteTarget::trouble() const { return names_->look(host_, std::chrono::steady_clock::now()).why; }

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
    const auto addresses = target.addresses();
    for (const auto& address : addresses) {
        const auto end = std::chrono::steady_clock::now() + one_of_several;
        const bool last = address == addresses.back();
        auto parts = std::make_unique<Parts>();
        std::optional<Fault> done;
        parts->socket.async_connect({asio::ip::make_address(address), target.port()},
                                    [&](Fault fault) { done = fault; });
        const auto patient_here = [&] { return patient() && (last || std::chrono::steady_clock::now() < end); };
        if (!parts->finish(done, patient_here)) continue;
        Fault ignored;
        parts->socket.non_blocking(true, ignored);
        return std::unique_ptr<ByteLine>(new ByteLine(std::move(parts)));
    }
    return nullptr;
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
