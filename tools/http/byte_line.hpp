// A TCP connection that is called, and on which bytes are sent.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "transport/address/resolver.hpp"

namespace lightnet {

/// So long one of several addresses is called before the next.
inline constexpr std::chrono::milliseconds one_of_several{1500};

/// Where somebody listens, by its name or address. Waits two seconds at most for the name, and throws Error where
/// nobody is called so; where nobody knows, the name is asked for again.
class ByteTarget {
public:
    ByteTarget(std::string host, std::uint16_t port);
    /// All of them, in numbers, as far as is known by now; never waits.
    std::vector<std::string> addresses() const;
    std::uint16_t port() const { return port_; }
    /// Why there are none.
    std::string trouble() const;

private:
    std::string host_;
    std::uint16_t port_;
    std::shared_ptr<Resolver> names_ = std::make_shared<Resolver>();
};

/// One thread's. Nothing waits longer than `patient` says yes, which is asked about twenty times a second.
class ByteLine {
public:
    using Patient = std::function<bool()>;

    /// At the first of its addresses that answers. Null: nobody listens there, or patience ended first.
    static std::unique_ptr<ByteLine> to(const ByteTarget& target, const Patient& patient);
    ~ByteLine();
    ByteLine(const ByteLine&) = delete;
    ByteLine& operator=(const ByteLine&) = delete;

    /// False: it was cut, or patience ended before all was taken; then nothing more can be sent.
    bool send(std::string_view bytes, const Patient& patient);
    /// The other end is still there, as far as it is known. What it says is thrown away.
    bool is_open();

private:
    struct Parts;
    explicit ByteLine(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
