// Netpbm's PBM, PGM, PPM (in letters and in bytes) and PAM; and PFM, Debevec's of floats.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

/// Words between blanks and remarks, then bytes.
class NetpbmText {
public:
    explicit NetpbmText(Input bytes) : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

    std::string_view word() {
        skip_blanks();
        const auto end = std::min(text_.find_first_of(" \t\r\n\v\f#", at_), text_.size());
        const auto word = text_.substr(at_, end - at_);
        at_ = end;
        if (word.empty()) throw Error("PNM: the file ends early");
        return word;
    }
    std::uint32_t number() {
        const auto digits = word();
        std::uint32_t value = 0;
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (problem != std::errc{} || end != digits.data() + digits.size())
            throw Error("PNM: a whole number expected, not '" + std::string(digits.substr(0, 32)) + "'");
        return value;
    }
    /// Of PBM in letters, which may stand without blanks.
    bool bit() {
        skip_blanks();
        if (at_ == text_.size()) throw Error("PNM: the file ends early");
        return text_[at_++] == '1';
    }
    /// The bytes behind the blank that ends the header.
    std::string_view data(std::size_t count) {
        ++at_;
        if (at_ > text_.size() || count > text_.size() - at_) throw Error("PNM: the file ends early");
        return text_.substr(at_, count);
    }

private:
    void skip_blanks() {
        for (;; at_ = std::min(text_.find('\n', at_), text_.size())) {
            at_ = std::min(text_.find_first_not_of(" \t\r\n\v\f", at_), text_.size());
            if (at_ == text_.size() || text_[at_] != '#') return;
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

struct NetpbmHeader {
    std::uint32_t width = 0, height = 0, channels = 1, most = 1;
    bool bits = false, letters = false;
};

/// Lines of a name and a value each, up to ENDHDR.
NetpbmHeader pam_header(NetpbmText& text) {
    NetpbmHeader header;
    const std::map<std::string_view, std::uint32_t*> known{
        {"WIDTH", &header.width}, {"HEIGHT", &header.height}, {"DEPTH", &header.channels}, {"MAXVAL", &header.most}};
    for (auto word = text.word(); word != "ENDHDR"; word = text.word())
        if (const auto found = known.find(word); found != known.end()) *found->second = text.number();
    return header;
}

NetpbmHeader netpbm_header(NetpbmText& text) {
    const char kind = text.word()[1];
    if (kind == '7') return pam_header(text);
    NetpbmHeader header;
    header.bits = kind == '1' || kind == '4';
    header.letters = kind <= '3';
    header.channels = kind == '3' || kind == '6' ? 3 : 1;
    header.width = text.number(), header.height = text.number();
    if (!header.bits) header.most = text.number();
    return header;
}

// Black is 1.
std::vector<std::uint8_t> netpbm_bits(NetpbmText& text, const NetpbmHeader& header) {
    const std::size_t width = header.width, row = (width + 7) / 8;
    std::vector<std::uint8_t> bytes(width * header.height);
    const auto packed = header.letters ? std::string_view() : text.data(row * header.height);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const std::size_t x = i % width, byte = i / width * row + x / 8;
        const bool black = header.letters ? text.bit() : static_cast<std::uint8_t>(packed[byte]) >> (7 - x % 8) & 1;
        bytes[i] = black ? 0 : 255;
    }
    return bytes;
}

}  // namespace

Raster read_netpbm(Input bytes) {
    NetpbmText text(bytes);
    const NetpbmHeader header = netpbm_header(text);
    check_size(header.width, header.height, bytes, 8);
    if (header.channels < 1 || header.channels > 4 || header.most < 1 || header.most > 65535)
        throw Error("PNM: only 1 to 4 channels, and numbers up to 65535, are supported");
    Raster raster{header.width, header.height, int(header.channels), header.most > 255, {}};
    if (header.bits) {
        raster.bytes = netpbm_bits(text, header);
        return raster;
    }
    const std::size_t count = std::size_t{header.width} * header.height * header.channels, size = raster.wide ? 2 : 1;
    const auto data = header.letters ? std::string_view() : text.data(count * size);
    const std::uint32_t full = raster.wide ? 65535 : 255;
    raster.bytes.reserve(header.letters ? 0 : count * size);  // letters grow with what is there
    for (std::size_t i = 0; i < count; ++i) {
        const auto byte = [&](std::size_t at) { return std::uint32_t{static_cast<std::uint8_t>(data[at])}; };
        const std::uint32_t said = header.letters ? text.number()
                                   : raster.wide  ? byte(2 * i) * 256 + byte(2 * i + 1)
                                                  : byte(i);
        const std::uint32_t value = (std::min(said, header.most) * full + header.most / 2) / header.most;
        if (raster.wide) raster.bytes.push_back(static_cast<std::uint8_t>(value >> 8));
        raster.bytes.push_back(static_cast<std::uint8_t>(value));
    }
    return raster;
}

Image read_pfm(Input bytes) {
    NetpbmText text(bytes);
    const bool grey = text.word() == "Pf";
    const std::uint32_t width = text.number(), height = text.number();
    const auto written = text.word();
    double scale = 0;
    const auto digits = written.substr(written.starts_with('+'));
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), scale);
    if (problem != std::errc{} || scale == 0 || !std::isfinite(scale))
        throw Error("PFM: a number but 0 must say the order of its bytes, not '" + std::string(written.substr(0, 32)) +
                    "'");
    check_size(width, height, bytes, 1);
    const std::size_t channels = grey ? 1 : 3, row = std::size_t{width} * channels;
    const auto data = text.data(row * height * sizeof(float));
    const bool swapped = (scale > 0) == (std::endian::native == std::endian::little);
    const auto strength = static_cast<float>(std::fabs(scale));
    const auto number = [&](std::size_t at) {
        std::uint32_t raw = 0;
        std::memcpy(&raw, data.data() + at * sizeof raw, sizeof raw);
        return std::bit_cast<float>(swapped ? __builtin_bswap32(raw) : raw) * strength;
    };
    std::vector<Rgb> pixels(std::size_t{width} * height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = (height - 1 - y) * row + x * channels;  // from the lowest row
            pixels[y * width + x] = {number(at), number(at + (grey ? 0 : 1)), number(at + (grey ? 0 : 2))};
        }
    return {width, height, pixels};
}

}  // namespace lightnet::decoders
