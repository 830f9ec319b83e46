// A TCP connection that is called, and on which bytes are sent.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace lightnet {

/// Where somebody listens: found once, by its name or address. A value. Throws Error where nobody is called so.
class ByteTarget {
public:
    ByteTarget(const std::string& host, std::uint16_t port);
    const std::string& address() const { return address_; }
    std::uint16_t port() const { return port_; }

private:
    std::string address_;  // of numbers
    std::uint16_t port_;
};

/// One thread's. Nothing waits longer than `patient` says yes, which is asked about twenty times a second.
class ByteLine {
public:
    using Patient = std::function<bool()>;

    /// Null: nobody listens there, or patience ended first.
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
