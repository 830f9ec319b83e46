#include "core/scene/ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.hpp"

namespace lightnet {
namespace {

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

[[noreturn]] void fail(const std::string& what) { throw Error("PLY: " + what); }

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

/// What of the file is not yet read.
class Input {
public:
    explicit Input(std::string_view text) : text_(text) {}

    std::size_t left() const { return text_.size() - at_; }

    /// One line of the header, without its end.
    std::string_view line() {
        const auto end = text_.find('\n', at_);
        if (end == std::string_view::npos) fail("the header ends early");
        auto line = text_.substr(at_, end - at_);
        at_ = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    double number(Format format, Scalar type) { return format == Format::ascii ? word() : binary(format, type); }

private:
    double word() {
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

    double binary(Format format, Scalar type) {
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

    template <class Value>
    Value get(bool swap) {
        std::array<char, sizeof(Value)> raw{};
        if (left() < raw.size()) fail("the file ends early");
        std::memcpy(raw.data(), text_.data() + at_, raw.size());
        at_ += raw.size();
        if (swap) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<Value>(raw);
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
};

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

Header read_header(Input& input) {
    constexpr std::size_t most_properties = 1000;
    Header header;
    bool formatted = false;
    std::size_t properties = 0;
    if (input.line() != "ply") fail("the file does not begin with 'ply'");
    for (;;) {
        const auto words = words_of(input.line());
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

/// Throws unless the file has room for all that the header promises of the element, before anything is allocated.
void check_room(const Input& input, Format format, const Element& element) {
    std::size_t least = 0;
    for (const auto& property : element.properties)
        least += format == Format::ascii ? 2 : size_of(property.list ? property.count_type : property.type);
    if (element.count && !least) fail(fmt::format("element '{}' has no properties", element.name.substr(0, 32)));
    // the last number of an ASCII file needs no space behind it
    if (element.count && element.count > (input.left() + 1) / least)
        fail(fmt::format("the header promises {} of '{}', but the file is too short for them", element.count,
                         element.name.substr(0, 32)));
    if (element.count > std::numeric_limits<std::uint32_t>::max()) fail("too many elements");
}

std::size_t list_length(Input& input, Format format, const Property& list) {
    const double length = input.number(format, list.count_type);
    const std::size_t least = format == Format::ascii ? 2 : size_of(list.type);
    if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>((input.left() + 1) / least))
        fail(fmt::format("list '{}' has an impossible length", list.name.substr(0, 32)));
    return static_cast<std::size_t>(length);
}

void skip(Input& input, Format format, const Property& property) {
    const std::size_t length = property.list ? list_length(input, format, property) : 1;
    for (std::size_t i = 0; i < length; ++i) input.number(format, property.type);
}

/// Which of the eight values of a vertex a property is: x y z nx ny nz u v; none: -1.
int slot_of(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, int>, 14> slots{{{"x", 0},
                                                                      {"y", 1},
                                                                      {"z", 2},
                                                                      {"nx", 3},
                                                                      {"ny", 4},
                                                                      {"nz", 5},
                                                                      {"u", 6},
                                                                      {"v", 7},
                                                                      {"s", 6},
                                                                      {"t", 7},
                                                                      {"texture_u", 6},
                                                                      {"texture_v", 7},
                                                                      {"texture_s", 6},
                                                                      {"texture_t", 7}}};
    for (const auto& [word, slot] : slots)
        if (word == name) return slot;
    return -1;
}

void read_vertices(Input& input, Format format, const Element& element, Mesh& mesh) {
    std::array<bool, 8> has{};
    for (const auto& property : element.properties)
        if (const int slot = property.list ? -1 : slot_of(property.name); slot >= 0) has[slot] = true;
    if (!has[0] || !has[1] || !has[2]) fail("the vertices have no x, y and z");
    const bool normals = has[3] && has[4] && has[5], uvs = has[6] && has[7];
    mesh.positions.reserve(element.count);
    if (normals) mesh.normals.reserve(element.count);
    if (uvs) mesh.uvs.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
        std::array<float, 8> v{};
        for (const auto& property : element.properties) {
            const int slot = property.list ? -1 : slot_of(property.name);
            if (slot < 0)
                skip(input, format, property);
            else
                v[slot] = static_cast<float>(input.number(format, property.type));
        }
        if (!finite(Vec3{v[0], v[1], v[2]})) fail(fmt::format("the position of vertex {} is not finite", i));
        mesh.positions.push_back({v[0], v[1], v[2]});
        if (normals) mesh.normals.push_back({v[3], v[4], v[5]});
        if (uvs) mesh.uvs.push_back({v[6], v[7]});
    }
}

void read_face(Input& input, Format format, const Property& list, Mesh& mesh) {
    const std::size_t corners = list_length(input, format, list);
    std::array<std::uint32_t, 3> fan{};
    for (std::size_t i = 0; i < corners; ++i) {
        const double index = input.number(format, list.type);
        if (!(index >= 0) || index != std::floor(index) || index > std::numeric_limits<std::uint32_t>::max())
            fail("a face has an impossible vertex index");
        fan[std::min<std::size_t>(i, 2)] = static_cast<std::uint32_t>(index);
        if (i < 2) continue;
        mesh.triangles.push_back(fan);
        fan[1] = fan[2];
    }
    if (corners < 3) fail(fmt::format("a face has {} corners", corners));
}

void read_faces(Input& input, Format format, const Element& element, Mesh& mesh) {
    const auto corners = [](const Property& p) {
        return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), corners))
        fail("the faces have no list 'vertex_indices'");
    mesh.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const auto& property : element.properties) {
            if (corners(property))
                read_face(input, format, property, mesh);
            else
                skip(input, format, property);
        }
}

void check_indices(const Mesh& mesh) {
    for (const auto& triangle : mesh.triangles)
        for (const auto index : triangle)
            if (index >= mesh.positions.size())
                fail(fmt::format("a face has the vertex index {}, but there are {} vertices", index,
                                 mesh.positions.size()));
}

}  // namespace

Mesh read_ply(std::span<const std::byte> bytes) {
    Input input({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const Header header = read_header(input);
    Mesh mesh;
    bool vertices = false, faces = false;
    for (const auto& element : header.elements) {
        check_room(input, header.format, element);
        if (element.name == "vertex" && !std::exchange(vertices, true)) {
            read_vertices(input, header.format, element, mesh);
        } else if (element.name == "face" && !std::exchange(faces, true)) {
            read_faces(input, header.format, element, mesh);
        } else {
            if (element.name == "tristrips") fail("triangle strips are not supported, only faces");
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const auto& property : element.properties) skip(input, header.format, property);
        }
    }
    if (!vertices || !faces) fail("there are no vertices or no faces");
    check_indices(mesh);
    return mesh;
}

}  // namespace lightnet
