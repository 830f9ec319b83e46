#include "core/base/exr_claims.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_in_a_name = 255;
constexpr std::uint32_t several_parts = 0x1000;

// What a byte holds at most: deflate makes 1032 bytes of it, other kinds fewer; those that pack blocks of 8 x 8 pixels
// into one number before that, so many pixels.
constexpr double bytes_per_byte = 1100, pixels_per_byte_in_blocks = 40'000;
constexpr unsigned char first_in_blocks = 8;  // DWAA, DWAB

[[noreturn]] void damaged() { throw Error("EXR: the header is damaged"); }

// Types whose values have always so many bytes: libraries read these, whatever an attribute says of its size, and would
// take what follows for something else. None: others.
std::optional<std::uint32_t> size_of_type(std::string_view type) {
    static constexpr std::pair<std::string_view, std::uint32_t> sizes[] = {{"box2f", 16},
                                                                           {"box2i", 16},
                                                                           {"chromaticities", 32},
                                                                           {"compression", 1},
                                                                           {"deepImageState", 1},
                                                                           {"double", 8},
                                                                           {"envmap", 1},
                                                                           {"float", 4},
                                                                           {"int", 4},
                                                                           {"keycode", 28},
                                                                           {"lineOrder", 1},
                                                                           {"m33d", 72},
                                                                           {"m33f", 36},
                                                                           {"m44d", 128},
                                                                           {"m44f", 64},
                                                                           {"rational", 8},
                                                                           {"tiledesc", 9},
                                                                           {"timecode", 8},
                                                                           {"v2d", 16},
                                                                           {"v2f", 8},
                                                                           {"v2i", 8},
                                                                           {"v3d", 24},
                                                                           {"v3f", 12},
                                                                           {"v3i", 12}};
    for (const auto& [name, size] : sizes)
        if (name == type) return size;
    return std::nullopt;
}

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
            if (name.size() >= most_in_a_name) damaged();
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
            if (const auto right = size_of_type(type); right && *right != length) damaged();
            take_value(name, type, length);
        }
        if (has_window_) check_pixels();
        return any;
    }
    void take_value(const std::string& name, const std::string& type, std::uint32_t length) {
        if (name == "dataWindow" && type == "box2i") {
            has_window_ = take(std::as_writable_bytes(std::span(window_)));
            return;
        }
        if (type == "chlist") return take_channels(length);
        if (type == "stringvector") return take_strings(length);
        if (type == "preview") length -= take_preview_size(length);
        skip(length, name == "compression");
    }
    void skip(std::uint32_t length, bool compression = false) {
        std::array<std::byte, 4096> piece;
        for (std::uint32_t done = 0; done < length;) {
            const auto part = std::span(piece).first(std::min<std::size_t>(piece.size(), length - done));
            if (!take(part)) return;
            if (compression) blocks_ = std::to_integer<unsigned char>(part[0]) >= first_in_blocks;
            done += static_cast<std::uint32_t>(part.size());
        }
    }
    // One after the other: name, type (1: half), and how far apart its samples are. Libraries read on until a name is
    // empty, so that has to be the end of the list.
    void take_channels(std::uint32_t length) {
        std::string name;
        std::array<std::int32_t, 4> facts{};
        for (std::uint32_t done = 0; take_name(name);) {
            done += static_cast<std::uint32_t>(name.size()) + 1;
            if (name.empty() && done == length) return;
            if (name.empty() || done > length || length - done <= sizeof facts) damaged();
            if (!take(std::as_writable_bytes(std::span(facts)))) return;
            done += sizeof facts;
            const double apart = std::max(1.0, double(facts[2]) * double(facts[3]));
            pixel_bytes_ += (facts[0] == 1 ? 2 : 4) / apart;
        }
    }
    // Each with its size before it.
    void take_strings(std::uint32_t length) {
        std::uint32_t size = 0;
        for (std::uint32_t done = 0; done < length; done += size) {
            if (length - done < sizeof size) damaged();
            if (!take(std::as_writable_bytes(std::span(&size, 1)))) return;
            done += sizeof size;
            if (size > length - done) damaged();
            skip(size);
        }
    }
    // Width and height, which four bytes for each pixel follow. Returns how many bytes they took.
    std::uint32_t take_preview_size(std::uint32_t length) {
        std::array<std::uint32_t, 2> size{};
        if (length < sizeof size) damaged();
        if (!take(std::as_writable_bytes(std::span(size)))) return length;
        const std::uint32_t rest = length - sizeof size;
        if (rest % 4 != 0 || std::uint64_t{size[0]} * size[1] != rest / 4) damaged();
        return sizeof size;
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
