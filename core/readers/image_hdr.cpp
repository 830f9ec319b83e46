// Radiance HDR: Ward 1991, "Real Pixels", Graphics Gems II; run lengths as in Radiance's color.c.
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class Reader {
public:
    explicit Reader(Input bytes) : bytes_(bytes) {}

    std::uint8_t byte() {
        if (at_ == bytes_.size()) throw Error("HDR: the file ends early");
        return std::to_integer<std::uint8_t>(bytes_[at_++]);
    }
    Rgbe pixel() {
        Rgbe p{};
        for (auto& value : p) value = byte();
        return p;
    }
    std::string_view line() {
        const auto* start = reinterpret_cast<const char*>(bytes_.data()) + at_;
        const std::string_view rest(start, bytes_.size() - at_);
        const auto end = rest.find('\n');
        if (end == std::string_view::npos) throw Error("HDR: the header ends early");
        at_ += end + 1;
        return rest.substr(0, end);
    }
    std::size_t left() const { return bytes_.size() - at_; }

private:
    Input bytes_;
    std::size_t at_ = 0;
};

std::int64_t number_after(std::string_view& text, std::string_view axis) {
    std::int64_t value = 0;
    if (!text.starts_with(axis)) throw Error("HDR: only images with the rows '-Y … +X …' are supported");
    text.remove_prefix(axis.size());
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{}) throw Error("HDR: the size is broken");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// A row whose four channels stand one after the other, each with run lengths.
void read_separated(Reader& reader, std::vector<Rgbe>& row) {
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < row.size();) {
            const std::uint8_t code = reader.byte();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128u : code;
            if (count == 0 || count > row.size() - x) throw Error("HDR: a run is longer than its row");
            const std::uint8_t value = run ? reader.byte() : std::uint8_t{0};
            for (std::size_t i = 0; i < count; ++i) row[x++][channel] = run ? value : reader.byte();
        }
}

/// A row of whole pixels, in which {1, 1, 1, n} repeats the latest one.
void read_plain(Reader& reader, std::vector<Rgbe>& row, Rgbe first) {
    unsigned shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        const Rgbe pixel = x == 0 && shift == 0 ? first : reader.pixel();
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            const std::size_t count = std::size_t{pixel[3]} << shift;
            if (x == 0 || shift > 16 || count > row.size() - x) throw Error("HDR: a run is longer than its row");
            for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
            shift += 8;
        } else {
            row[x++] = pixel;
            shift = 0;
        }
    }
}

Rgb to_rgb(const Rgbe& p) {
    if (p[3] == 0) return {};
    const float scale = std::ldexp(1.0f, p[3] - (128 + 8));
    return {float(p[0]) * scale, float(p[1]) * scale, float(p[2]) * scale};
}

}  // namespace

Image read_hdr(Input bytes) {
    Reader reader(bytes);
    for (auto line = reader.line(); !line.empty() && line != "\r"; line = reader.line())
        if (line.starts_with("FORMAT=") && !line.starts_with("FORMAT=32-bit_rle_rgbe"))
            throw Error("HDR: only 32-bit_rle_rgbe is supported");
    auto size = reader.line();
    const std::int64_t height = number_after(size, "-Y "), width = number_after(size, " +X ");
    check_size(width, height);
    // a row takes at least four bytes, run lengths or not
    if (static_cast<std::size_t>(height) > reader.left() / 4) throw Error("HDR: the file is too short for its size");

    std::vector<Rgb> pixels;  // grows with what is there
    std::vector<Rgbe> row(static_cast<std::size_t>(width));
    for (std::int64_t y = 0; y < height; ++y) {
        const Rgbe first = reader.pixel();
        const bool separated = first[0] == 2 && first[1] == 2 && first[2] < 128 && first[2] * 256 + first[3] == width;
        if (separated)
            read_separated(reader, row);
        else
            read_plain(reader, row, first);
        for (const auto& pixel : row) pixels.push_back(to_rgb(pixel));
    }
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), pixels};
}

}  // namespace lightnet::decoders
