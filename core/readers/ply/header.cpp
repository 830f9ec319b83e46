#include "core/readers/ply/header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/base/error.hpp"
#include "core/readers/files/trimmed.hpp"

namespace lightnet::ply {
namespace {

Scalar scalar_named(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, Scalar>, 16> names{{{"char", Scalar::i8},
                                                                         {"int8", Scalar::i8},
                                                                         {"uchar", Scalar::u8},
                                                                         {"uint8", Scalar::u8},
                                                                         {"short", Scalar::i16},
                                                                         {"int16", Scalar::i16},
                                                                         {"ushort", Scalar::u16},
                                                                         {"uint16", Scalar::u16},
                                                                         {"int", Scalar::i32},
                                                                         {"int32", Scalar::i32},
                                                                         {"uint", Scalar::u32},
                                                                         {"uint32", Scalar::u32},
                                                                         {"float", Scalar::f32},
                                                                         {"float32", Scalar::f32},
                                                                         {"double", Scalar::f64},
                                                                         {"float64", Scalar::f64}}};
    for (const auto& [word, type] : names)
        if (word == name) return type;
    fail(fmt::format("unknown type '{}'", name.substr(0, 32)));
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t i = 0; i < line.size();) {
        while (i < line.size() && is_space(line[i])) ++i;
        const std::size_t start = i;
        while (i < line.size() && !is_space(line[i])) ++i;
        if (i > start) words.push_back(line.substr(start, i - start));
    }
    return words;
}

Format format_named(std::string_view name) {
    if (name == "ascii") return Format::ascii;
    if (name == "binary_little_endian") return Format::little;
    if (name == "binary_big_endian") return Format::big;
    fail(fmt::format("unknown format '{}'", name.substr(0, 32)));
}

Element read_element(const std::vector<std::string_view>& words) {
    Element element;
    if (words.size() != 3) fail("an element needs a name and a count");
    element.name = words[1];
    const auto [end, problem] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (problem != std::errc{} || end != words[2].data() + words[2].size())
        fail(fmt::format("element '{}' has no sound count", element.name.substr(0, 32)));
    return element;
}

Property read_property(const std::vector<std::string_view>& words) {
    if (words.size() == 3) return {words[2], scalar_named(words[1])};
    if (words.size() == 5 && words[1] == "list")
        return {words[4], scalar_named(words[3]), true, scalar_named(words[2])};
    fail("a property needs a type and a name");
}

}  // namespace

std::uint64_t Input::plain_triangles(Format format, const Property& list, std::uint64_t most,
                                     std::vector<std::array<std::uint32_t, 3>>& to) {
    constexpr std::size_t size = 1 + 3 * sizeof(std::uint32_t);
    const bool plain = format == Format::little && std::endian::native == std::endian::little &&
                       list.count_type == Scalar::u8 && (list.type == Scalar::i32 || list.type == Scalar::u32);
    if (!plain) return 0;
    const std::uint32_t sign = list.type == Scalar::i32 ? 0x80000000u : 0;
    const char* at = text_.data() + at_;
    const std::uint64_t room = std::min<std::uint64_t>(most, left() / size);
    std::uint64_t count = 0;
    for (; count < room && *at == 3; ++count, at += size) {
        std::array<std::uint32_t, 3> corners;
        std::memcpy(corners.data(), at + 1, sizeof corners);
        if (((corners[0] | corners[1] | corners[2]) & sign) != 0) break;
        to.push_back(corners);
    }
    at_ += count * size;
    return count;
}

void fail(const std::string& what) { throw Error("PLY: " + what); }

std::size_t size_of(Scalar type) {
    switch (type) {
        case Scalar::i8:
        case Scalar::u8:
            return 1;
        case Scalar::i16:
        case Scalar::u16:
            return 2;
        case Scalar::f64:
            return 8;
        default:
            return 4;
    }
}

template <class Value>
Value Input::get(bool swap) {
    std::array<char, sizeof(Value)> raw{};
    if (left() < raw.size()) fail("the file ends early");
    std::memcpy(raw.data(), text_.data() + at_, raw.size());
    at_ += raw.size();
    if (swap) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Value>(raw);
}

std::string_view Input::line() {
    const auto end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail("the header ends early");
    auto line = text_.substr(at_, end - at_);
    at_ = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

double Input::word() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    auto digits = text_.substr(start, at_ - start);
    if (digits.empty()) fail("the file ends early");
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (problem != std::errc{} || end != digits.data() + digits.size())
        fail(fmt::format("a number expected, not '{}'", digits.substr(0, 32)));
    return value;
}

double Input::binary(Format format, Scalar type) {
    const bool swap = (format == Format::big) == (std::endian::native == std::endian::little);
    switch (type) {
        case Scalar::i8:
            return get<std::int8_t>(swap);
        case Scalar::u8:
            return get<std::uint8_t>(swap);
        case Scalar::i16:
            return get<std::int16_t>(swap);
        case Scalar::u16:
            return get<std::uint16_t>(swap);
        case Scalar::i32:
            return get<std::int32_t>(swap);
        case Scalar::u32:
            return get<std::uint32_t>(swap);
        case Scalar::f32:
            return static_cast<double>(get<float>(swap));
        case Scalar::f64:
            return get<double>(swap);
    }
    return 0;
}

Header read_header(Input& input) {
    constexpr std::size_t most_properties = 1000;
    Header header;
    bool formatted = false;
    std::size_t properties = 0;
    if (input.line() != "ply") fail("the file does not begin with 'ply'");
    for (;;) {
        const auto line = input.line();
        const auto words = words_of(line);
        if (words.size() > 2 && words[0] == "comment" && words[1] == "TextureFile" && header.texture.empty())
            header.texture = trimmed(line.substr(static_cast<std::size_t>(words[2].data() - line.data())), " \t");
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
        if (words[0] == "end_header") break;
        if (words[0] == "format" && words.size() >= 2) {
            header.format = format_named(words[1]);
            formatted = true;
        } else if (words[0] == "element") {
            header.elements.push_back(read_element(words));
        } else if (words[0] == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(read_property(words));
        } else {
            fail(fmt::format("unknown header line '{}'", words[0].substr(0, 32)));
        }
        if (++properties > most_properties) fail("the header is too long");
    }
    if (!formatted) fail("the header names no format");
    return header;
}

}  // namespace lightnet::ply
