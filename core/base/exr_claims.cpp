#include "core/base/exr_claims.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_in_a_name = 255;
constexpr std::uint32_t several_parts = 0x1000;

// What a byte holds at most: deflate makes 1032 bytes of it, other kinds fewer; those that pack blocks of 8 x 8 pixels
// into one number before that, so many pixels.
constexpr double bytes_per_byte = 1100, pixels_per_byte_in_blocks = 40'000;
constexpr unsigned char first_in_blocks = 8;  // DWAA, DWAB

class Header {
public:
    Header(const std::function<std::size_t(std::span<std::byte>)>& read, std::uint64_t size)
        : read_(read), left_(size), size_(size) {}

    void check() {
        std::array<std::uint32_t, 2> start{};
        if (!take(std::as_writable_bytes(std::span(start)))) return;
        const bool many = start[1] & several_parts;
        while (check_part() && many) {
        }
    }

private:
    bool take(std::span<std::byte> into) {
        const std::size_t there = read_(into);
        left_ -= std::min<std::uint64_t>(left_, there);
        return there == into.size();
    }
    // None: the file ends.
    bool take_name(std::string& name) {
        name.clear();
        for (std::byte letter{}; take({&letter, 1}); name += char(letter)) {
            if (letter == std::byte{0}) return true;
            if (name.size() >= most_in_a_name) throw Error("EXR: the header is damaged");
        }
        return false;
    }
    // False: no further part comes.
    bool check_part() {
        std::string name, type;
        std::uint32_t length = 0;
        bool any = false;
        window_ = {};
        has_window_ = false;
        blocks_ = true;
        pixel_bytes_ = 0;
        while (take_name(name) && !name.empty()) {
            any = true;
            if (!take_name(type) || !take(std::as_writable_bytes(std::span(&length, 1)))) break;
            if (length > left_) throw Error("EXR: the file ends early");
            take_value(name, length);
        }
        if (has_window_) check_pixels();
        return any;
    }
    void take_value(const std::string& name, std::uint32_t length) {
        if (name == "dataWindow" && length == sizeof window_) {
            has_window_ = take(std::as_writable_bytes(std::span(window_)));
            return;
        }
        if (name == "channels") length -= take_channels(length);
        std::array<std::byte, 4096> piece;
        for (std::uint32_t done = 0; done < length;) {
            const auto part = std::span(piece).first(std::min<std::size_t>(piece.size(), length - done));
            if (!take(part)) return;
            if (name == "compression") blocks_ = std::to_integer<unsigned char>(part[0]) >= first_in_blocks;
            done += static_cast<std::uint32_t>(part.size());
        }
    }
    // One after the other: name, type (1: half), and how far apart its samples are.
    // Returns how many of the bytes they took.
    std::uint32_t take_channels(std::uint32_t length) {
        std::string name;
        std::array<std::int32_t, 4> facts{};
        std::uint32_t done = 0;
        while (done < length && take_name(name)) {
            done += static_cast<std::uint32_t>(name.size()) + 1;
            if (name.empty() || done > length || length - done < sizeof facts) break;
            if (!take(std::as_writable_bytes(std::span(facts)))) break;
            done += sizeof facts;
            const double apart = std::max(1.0, double(facts[2]) * double(facts[3]));
            pixel_bytes_ += (facts[0] == 1 ? 2 : 4) / apart;
        }
        return std::min(done, length);
    }
    void check_pixels() {
        const std::int64_t width = std::int64_t{window_[2]} - window_[0] + 1;
        const std::int64_t height = std::int64_t{window_[3]} - window_[1] + 1;
        if (width <= 0 || height <= 0) return;
        const double pixels = double(width) * double(height), bytes = double(size_);
        claimed_ +=
            blocks_ ? pixels / pixels_per_byte_in_blocks : pixels * std::max(pixel_bytes_, 1.0) / bytes_per_byte;
        if (claimed_ > bytes)
            throw Error("EXR: " + std::to_string(size_) + " bytes can't be " + std::to_string(width) + " x " +
                        std::to_string(height) + " pixels");
    }

    const std::function<std::size_t(std::span<std::byte>)>& read_;
    std::uint64_t left_, size_;
    std::array<std::int32_t, 4> window_{};
    bool has_window_ = false, blocks_ = true;
    double pixel_bytes_ = 0;  // of all channels
    double claimed_ = 0;      // bytes of the file that all parts so far take at least
};

}  // namespace

void check_exr_claims(const std::function<std::size_t(std::span<std::byte>)>& read, std::uint64_t size) {
    Header(read, size).check();
}

void check_exr_claims(std::span<const std::byte> file) {
    std::size_t at = 0;
    check_exr_claims(
        [&](std::span<std::byte> into) {
            const std::size_t there = std::min(into.size(), file.size() - at);
            std::memcpy(into.data(), file.data() + at, there);
            at += there;
            return there;
        },
        file.size());
}

}  // namespace lightnet
