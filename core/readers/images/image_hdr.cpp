// Radiance HDR: Ward 1991, "Real Pixels", Graphics Gems II; run lengths as in Radiance's color.c.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/files/trimmed.hpp"
#include "core/readers/images/image_decoders.hpp"

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

/// What the header says of the numbers.
struct Facts {
    bool xyz = false;
    std::array<double, 3> exposure{1, 1, 1};  // by which all have been multiplied
    std::optional<Primaries> primaries;
};

/// The numbers that stand there, up to `most`.
std::vector<double> numbers_in(std::string_view text, std::size_t most) {
    std::vector<double> numbers;
    while (numbers.size() < most) {
        text = trimmed(text, " \t\r");
        double value = 0;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (problem != std::errc{} || !std::isfinite(value)) break;
        numbers.push_back(value);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    return numbers;
}

void note(std::string_view line, Facts& facts) {
    const auto after = [&](std::string_view key) -> std::optional<std::string_view> {
        return line.starts_with(key) ? std::optional(trimmed(line.substr(key.size()), " \t\r")) : std::nullopt;
    };
    if (const auto format = after("FORMAT=")) {
        facts.xyz = *format == "32-bit_rle_xyze";
        if (!facts.xyz && *format != "32-bit_rle_rgbe")
            throw Error("HDR: only 32-bit_rle_rgbe and 32-bit_rle_xyze are supported");
    }
    if (const auto value = after("EXPOSURE="))
        if (const auto n = numbers_in(*value, 1); n.size() == 1 && n[0] > 0)
            for (double& factor : facts.exposure) factor *= n[0];
    if (const auto value = after("COLORCORR="))
        if (const auto n = numbers_in(*value, 3); n.size() == 3 && std::min({n[0], n[1], n[2]}) > 0)
            for (std::size_t i = 0; i < 3; ++i) facts.exposure[i] *= n[i];
    if (const auto value = after("PRIMARIES="))
        if (const auto n = numbers_in(*value, 8); n.size() == 8)
            facts.primaries = Primaries{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
}

/// In which order the rows stand: "-Y 3 +X 4" are three rows of four, the upper one first, each from the left.
struct Order {
    bool columns = false;  // each of its rows is a column of the picture
    bool from_bottom = false, from_right = false;
    std::int64_t rows = 0, length = 0;

    std::int64_t width() const { return columns ? rows : length; }
    std::int64_t height() const { return columns ? length : rows; }
    bool usual() const { return !columns && !from_bottom && !from_right; }
};

Order order_of(std::string_view text) {
    Order order;
    const auto axis = [&](std::int64_t& size) {
        text = trimmed(text, " \t\r");
        if (text.size() < 2 || (text[0] != '+' && text[0] != '-') || (text[1] != 'X' && text[1] != 'Y'))
            throw Error("HDR: the size must be like '-Y 3 +X 4'");
        const char direction = text[0], name = text[1];
        text = trimmed(text.substr(2), " \t\r");
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), size);
        if (problem != std::errc{}) throw Error("HDR: the size is broken");
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        (name == 'Y' ? order.from_bottom : order.from_right) = direction == (name == 'Y' ? '+' : '-');
        return name;
    };
    const char first = axis(order.rows);
    if (axis(order.length) == first) throw Error("HDR: the size must be like '-Y 3 +X 4'");
    order.columns = first == 'X';
    return order;
}

/// Row by row from the top.
std::vector<Rgb> in_usual_order(const Order& order, std::vector<Rgb> read) {
    if (order.usual()) return read;
    const auto width = static_cast<std::size_t>(order.width()), height = static_cast<std::size_t>(order.height());
    std::vector<Rgb> pixels(read.size());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t down = order.from_bottom ? height - 1 - y : y;
            const std::size_t along = order.from_right ? width - 1 - x : x;
            pixels[y * width + x] = read[order.columns ? along * height + down : down * width + along];
        }
    return pixels;
}

void take_back(const std::array<double, 3>& exposure, std::vector<Rgb>& pixels) {
    if (exposure == std::array<double, 3>{1, 1, 1}) return;
    for (Rgb& pixel : pixels)
        pixel = {float(double{pixel.r} / exposure[0]), float(double{pixel.g} / exposure[1]),
                 float(double{pixel.b} / exposure[2])};
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
    Facts facts;
    for (auto line = reader.line(); !line.empty() && line != "\r"; line = reader.line()) note(line, facts);
    const Order order = order_of(reader.line());
    check_size(order.width(), order.height());
    // a row takes at least four bytes, run lengths or not
    if (static_cast<std::size_t>(order.rows) > reader.left() / 4)
        throw Error("HDR: the file is too short for its size");

    std::vector<Rgb> pixels;  // grows with what is there
    std::vector<Rgbe> row(static_cast<std::size_t>(order.length));
    for (std::int64_t y = 0; y < order.rows; ++y) {
        const Rgbe first = reader.pixel();
        const bool separated =
            first[0] == 2 && first[1] == 2 && first[2] < 128 && first[2] * 256 + first[3] == order.length;
        if (separated)
            read_separated(reader, row);
        else
            read_plain(reader, row, first);
        for (const auto& pixel : row) pixels.push_back(to_rgb(pixel));
    }
    take_back(facts.exposure, pixels);
    if (facts.xyz)
        turn_to_ours(cie_xyz, pixels);
    else if (facts.primaries)
        turn_to_ours(*facts.primaries, pixels);
    return {static_cast<std::uint32_t>(order.width()), static_cast<std::uint32_t>(order.height()),
            in_usual_order(order, std::move(pixels))};
}

}  // namespace lightnet::decoders
