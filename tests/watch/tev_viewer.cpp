#include "tests/watch/tev_viewer.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace lightnet::test {
namespace {

// Reads a packet's members in their order.
class TevReader {
public:
    explicit TevReader(const std::string& bytes) : bytes_(bytes) {}
    template <class Number>
    Number number() {
        Number value{};
        if (left() < sizeof value) throw std::runtime_error("the packet is too short");
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text() {
        const auto end = bytes_.find('\0', at_);
        if (end == std::string::npos) throw std::runtime_error("a text does not end");
        const auto text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        return text;
    }
    std::size_t left() const { return bytes_.size() - at_; }
    void expect_end() const {
        if (left()) throw std::runtime_error("there is more than belongs to the packet");
    }

private:
    const std::string& bytes_;
    std::size_t at_ = 0;
};

void create(TevReader& reader, TevViewer::Seen& seen) {
    reader.number<char>();
    const auto name = reader.text();
    TevViewer::Image image;
    image.width = reader.number<std::int32_t>(), image.height = reader.number<std::int32_t>();
    for (auto left = reader.number<std::int32_t>(); left > 0; --left)
        image.channels[reader.text()].resize(static_cast<std::size_t>(image.width * image.height));
    reader.expect_end();
    seen.images[name] = image;
}

void update(TevReader& reader, TevViewer::Seen& seen) {
    reader.number<char>();
    auto& image = seen.images.at(reader.text());
    const auto count = static_cast<std::size_t>(reader.number<std::int32_t>());
    std::vector<std::vector<float>*> channels;
    for (std::size_t k = 0; k < count; ++k) channels.push_back(&image.channels.at(reader.text()));
    const auto x = reader.number<std::int32_t>(), y = reader.number<std::int32_t>();
    const auto width = reader.number<std::int32_t>(), height = reader.number<std::int32_t>();
    if (x < 0 || y < 0 || x + width > image.width || y + height > image.height)
        throw std::runtime_error("an update lies outside of its image");
    std::vector<std::int64_t> offsets, strides;
    for (std::size_t k = 0; k < count; ++k) offsets.push_back(reader.number<std::int64_t>());
    for (std::size_t k = 0; k < count; ++k) strides.push_back(reader.number<std::int64_t>());
    std::vector<float> values(reader.left() / sizeof(float));
    for (auto& value : values) value = reader.number<float>();
    reader.expect_end();
    for (std::size_t k = 0; k < count; ++k)
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                (*channels[k])[static_cast<std::size_t>((y + row) * image.width + x + column)] =
                    values.at(static_cast<std::size_t>(offsets[k] + (row * width + column) * strides[k]));
    ++seen.updates;
}

}  // namespace

TevViewer::TevViewer(std::uint16_t port) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || ::listen(listener_, 4) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0 || ::pipe2(ends_, O_CLOEXEC) != 0)
        throw std::runtime_error("no viewer can listen here");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
}

TevViewer::~TevViewer() {
    ::close(ends_[1]);
    thread_.join();
    ::close(ends_[0]);
    ::close(listener_);
}

TevViewer::Seen TevViewer::seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
}

bool TevViewer::wait_for(const std::function<bool(const Seen&)>& what) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, slowdown * std::chrono::seconds(30), [&] { return what(seen_); });
}

void TevViewer::serve() {
    while (true) {
        std::array<pollfd, 2> items{pollfd{listener_, POLLIN, 0}, pollfd{ends_[0], POLLIN, 0}};
        ::poll(items.data(), items.size(), -1);
        if (items[1].revents) return;
        const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (connection < 0) continue;
        {
            const std::lock_guard lock(mutex_);
            ++seen_.connections;
        }
        take(connection);
        ::close(connection);
    }
}

void TevViewer::take(int connection) {
    std::string come;
    std::array<char, 65536> part{};
    while (true) {
        std::array<pollfd, 2> items{pollfd{connection, POLLIN, 0}, pollfd{ends_[0], POLLIN, 0}};
        ::poll(items.data(), items.size(), -1);
        if (items[1].revents) return;
        const auto size = ::recv(connection, part.data(), part.size(), 0);
        if (size <= 0) return;
        come.append(part.data(), static_cast<std::size_t>(size));
        for (std::uint32_t length = 0; come.size() >= sizeof length;) {
            std::memcpy(&length, come.data(), sizeof length);
            if (come.size() < length || length <= sizeof length) break;
            take_packet(come.substr(sizeof length, length - sizeof length));
            come.erase(0, length);
        }
    }
}

void TevViewer::take_packet(const std::string& packet) {
    const std::lock_guard lock(mutex_);
    TevReader reader(packet);
    try {
        switch (reader.number<char>()) {
            case 0:
                reader.number<char>(), seen_.opened.push_back(reader.text()), reader.expect_end();
                break;
            case 2:
                seen_.images.erase(reader.text()), reader.expect_end();
                break;
            case 4:
                create(reader, seen_);
                break;
            case 6:
                update(reader, seen_);
                break;
            default:
                throw std::runtime_error("nobody knows this kind of packet");
        }
    } catch (const std::exception& error) {
        seen_.errors.emplace_back(error.what());
    }
    changed_.notify_all();
}

}  // namespace lightnet::test
