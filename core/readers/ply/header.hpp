// The header of a PLY file, and the numbers behind it. Only mesh.cpp reads files with them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightnet::ply {

enum class Format { ascii, little, big };
enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
    std::string_view name;
    Scalar type = Scalar::f32;
    bool list = false;
    Scalar count_type = Scalar::u8;
};

struct Element {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

/// What of the file is not yet read.
class Input {
public:
    explicit Input(std::string_view text) : text_(text) {}

    std::size_t left() const { return text_.size() - at_; }
    /// One line of the header, without its end.
    std::string_view line();
    /// The next list, if it is a triangle as most large files have it: a byte, and three whole numbers of 32 bits. Else
    /// nothing is read.
    std::optional<std::array<std::uint32_t, 3>> plain_triangle(Format format, const Property& list) {
        constexpr std::size_t size = 1 + 3 * sizeof(std::uint32_t);
        const bool plain = format == Format::little && std::endian::native == std::endian::little &&
                           list.count_type == Scalar::u8 && (list.type == Scalar::i32 || list.type == Scalar::u32);
        if (!plain || left() < size || text_[at_] != 3) return {};
        std::array<std::uint32_t, 3> corners;
        std::memcpy(corners.data(), text_.data() + at_ + 1, sizeof corners);
        if (list.type == Scalar::i32 && ((corners[0] | corners[1] | corners[2]) >> 31) != 0) return {};
        at_ += size;
        return corners;
    }
    double number(Format format, Scalar type) { return format == Format::ascii ? word() : binary(format, type); }

private:
    double word();
    double binary(Format format, Scalar type);
    template <class Value>
    Value get(bool swap);

    std::string_view text_;
    std::size_t at_ = 0;
};

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
};

/// Throws Error when it is broken.
Header read_header(Input& input);
/// Bytes of a number in a binary file.
std::size_t size_of(Scalar type);
[[noreturn]] void fail(const std::string& what);

}  // namespace lightnet::ply
