// The header of a PLY file, and the numbers behind it. Only mesh.cpp reads files with them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
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
    /// Appends the next lists, up to `most`, as long as they are triangles as most large files have them: a byte, and
    /// three whole numbers of 32 bits. Returns how many it has read.
    std::uint64_t plain_triangles(Format format, const Property& list, std::uint64_t most,
                                  std::vector<std::array<std::uint32_t, 3>>& to);
    /// The next `to.size()` numbers, if they are floats as they lie in memory. Else nothing is read.
    bool plain_floats(Format format, std::span<float> to) {
        if (format != Format::little || std::endian::native != std::endian::little || left() < to.size_bytes())
            return false;
        std::memcpy(to.data(), text_.data() + at_, to.size_bytes());
        at_ += to.size_bytes();
        return true;
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
    std::string texture{};  // the picture that 'comment TextureFile' names, as MeshLab writes it; "": none
};

/// Throws Error when it is broken.
Header read_header(Input& input);
/// Bytes of a number in a binary file.
std::size_t size_of(Scalar type);
[[noreturn]] void fail(const std::string& what);

}  // namespace lightnet::ply
