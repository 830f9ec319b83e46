// The header of a PLY file, and the numbers behind it. Only mesh.cpp reads files with them.
#pragma once

#include <cstddef>
#include <cstdint>
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
