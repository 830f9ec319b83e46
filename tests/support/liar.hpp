// A host that is none, for those who were told to ask it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "transport/wire/packet.hpp"

namespace lightnet::test {

/// Listens on a port of its own and gives each packet that comes to `answer`, which says what is sent back.
class Liar {
public:
    using Answer = std::function<std::vector<packet::Packet>(const packet::Header&, std::span<const std::byte> body)>;
    explicit Liar(Answer answer);
    ~Liar();

    const std::string& endpoint() const { return endpoint_; }
    /// Asks that came.
    std::uint64_t asked() const { return asked_; }

    /// Answers to any question: green, and as bright as no lamp.
    static std::vector<packet::Packet> green_light(const packet::Header& ask);

private:
    void serve(const std::stop_token& stop);
    void take(std::vector<std::string> frames);

    struct Door;
    std::shared_ptr<Door> door_;
    Answer answer_;
    std::string endpoint_;
    std::atomic<std::uint64_t> asked_{0};
    std::jthread thread_;
};

}  // namespace lightnet::test
