// Numbers of several bytes at any place of a file, the low byte first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {

/// Throws Error, which begins with `kind`, where the file is too short.
class LowFirst {
public:
    LowFirst(Input bytes, std::string kind) : bytes_(bytes), kind_(std::move(kind)) {}

    std::uint64_t number(std::size_t at, std::size_t count) const {
        expect(at, count);
        std::uint64_t value = 0;
        for (std::size_t i = count; i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes_[at + i]);
        return value;
    }
    std::uint32_t byte(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 1)); }
    std::uint32_t two(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 2)); }
    std::uint32_t four(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 4)); }
    std::uint64_t eight(std::size_t at) const { return number(at, 8); }
    Input piece(std::uint64_t at, std::uint64_t count) const {
        expect(at, count);
        return bytes_.subspan(at, count);
    }
    Input all() const { return bytes_; }
    [[noreturn]] void refuse(const std::string& why) const { throw Error(kind_ + ": " + why); }

private:
    void expect(std::uint64_t at, std::uint64_t count) const {
        if (at > bytes_.size() || count > bytes_.size() - at) refuse("the file ends early");
    }

    Input bytes_;
    std::string kind_;
};

}  // namespace lightnet::decoders
