#include "core/readers/ply/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "core/base/unwanted.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/ply/header.hpp"

namespace lightnet {
namespace {

using ply::Element;
using ply::fail;
using ply::Format;
using ply::Input;
using ply::Property;
using ply::Scalar;

/// Throws unless the file has room for all that the header promises of the element, before anything is allocated.
void check_room(const Input& input, Format format, const Element& element) {
    std::size_t least = 0;
    for (const auto& property : element.properties)
        least += format == Format::ascii ? 2 : ply::size_of(property.list ? property.count_type : property.type);
    if (element.count && !least) fail(fmt::format("element '{}' has no properties", element.name.substr(0, 32)));
    // the last number of an ASCII file needs no space behind it
    if (element.count && element.count > (input.left() + 1) / least)
        fail(fmt::format("the header promises {} of '{}', but the file is too short for them", element.count,
                         element.name.substr(0, 32)));
    if (element.count > std::numeric_limits<std::uint32_t>::max()) fail("too many elements");
}

std::size_t list_length(Input& input, Format format, const Property& list) {
    const double length = input.number(format, list.count_type);
    const std::size_t least = format == Format::ascii ? 2 : ply::size_of(list.type);
    if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>((input.left() + 1) / least))
        fail(fmt::format("list '{}' has an impossible length", list.name.substr(0, 32)));
    return static_cast<std::size_t>(length);
}

void skip(Input& input, Format format, const Property& property) {
    const std::size_t length = property.list ? list_length(input, format, property) : 1;
    for (std::size_t i = 0; i < length; ++i) input.number(format, property.type);
}

constexpr int red = 8, slots = 11;

/// Which of the values of a vertex a property is: x y z nx ny nz u v red green blue; none: -1.
int slot_of(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, int>, 23> names{{{"x", 0},
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
                                                                      {"texture_t", 7},
                                                                      {"red", red},
                                                                      {"green", red + 1},
                                                                      {"blue", red + 2},
                                                                      {"r", red},
                                                                      {"g", red + 1},
                                                                      {"b", red + 2},
                                                                      {"diffuse_red", red},
                                                                      {"diffuse_green", red + 1},
                                                                      {"diffuse_blue", red + 2}}};
    for (const auto& [word, slot] : names)
        if (word == name) return slot;
    return -1;
}

bool is_list_of_corners(const Property& property) {
    return property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// What properties of an element are told apart by.
struct Names {
    std::string_view attribute{};  // without "vertex_" or "face_"; "": of nobody's
    bool own_colours = true;       // red, green and blue count

    /// Which number of the attribute a property is; none: -1.
    int number_of(std::string_view name) const {
        if (attribute.empty() || name.size() < 3) return -1;
        const auto prefix = name.substr(0, name.size() - 2), end = name.substr(prefix.size());
        constexpr std::string_view ends[] = {"_0_r_x", "_1_g_y", "_2_b_z"}, colour = "_color";
        // Mitsuba calls foo_r, foo_g and foo_b "foo_color"
        const bool coloured = attribute.ends_with(colour) &&
                              prefix == attribute.substr(0, attribute.size() - colour.size()) &&
                              (end == "_r" || end == "_g" || end == "_b");
        if (prefix != attribute && !coloured) return -1;
        for (int i = 0; i < 3; ++i)
            if (ends[i].find(end) != std::string_view::npos) return i;
        return -1;
    }
    int slot(std::string_view name) const {
        if (const int number = number_of(name); number >= 0) return red + number;
        const int known = slot_of(name);
        return known >= red && !own_colours ? -1 : known;
    }
};

/// Colours in whole numbers are encoded as sRGB, those in floats are linear.
float colour_value(double value, Scalar type) {
    if (type == Scalar::f32 || type == Scalar::f64) return static_cast<float>(value);
    const double encoded = value / (type == Scalar::u16 || type == Scalar::i16 ? 65535 : 255);
    return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

bool all_floats(const Element& element) {
    return std::all_of(element.properties.begin(), element.properties.end(),
                       [](const Property& p) { return !p.list && p.type == Scalar::f32; });
}

/// One number alone is a grey.
Rgb colour_of(const float* first, bool grey) {
    return grey ? Rgb{*first, *first, *first} : Rgb{first[0], first[1], first[2]};
}

void read_vertices(Input& input, Format format, const Element& element, const Names& names, Mesh& mesh) {
    std::array<bool, slots> has{};
    std::vector<int> slot_by_property;
    for (const auto& property : element.properties) {
        slot_by_property.push_back(property.list ? -1 : names.slot(property.name));
        if (slot_by_property.back() >= 0) has[slot_by_property.back()] = true;
    }
    if (!has[0] || !has[1] || !has[2]) fail("the vertices have no x, y and z");
    const bool normals = has[3] && has[4] && has[5], uvs = has[6] && has[7];
    const bool grey = !names.attribute.empty() && has[red] && !has[red + 1] && !has[red + 2];
    const bool colours = grey || (has[red] && has[red + 1] && has[red + 2]);
    std::vector<float> row(all_floats(element) ? element.properties.size() : 0);
    mesh.positions.reserve(element.count);
    if (normals) mesh.normals.reserve(element.count);
    if (uvs) mesh.uvs.reserve(element.count);
    if (colours) mesh.colours.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
        end_if_unwanted();
        std::array<float, slots> v{};
        const bool plain = !row.empty() && input.plain_floats(format, row);
        for (std::size_t j = 0; j < element.properties.size(); ++j) {
            const auto& property = element.properties[j];
            const int slot = slot_by_property[j];
            if (plain) {
                if (slot >= 0) v[slot] = row[j];
                continue;
            }
            if (slot < 0) {
                skip(input, format, property);
                continue;
            }
            const double value = input.number(format, property.type);
            v[slot] = slot < red ? static_cast<float>(value) : colour_value(value, property.type);
        }
        if (!finite(Vec3{v[0], v[1], v[2]})) fail(fmt::format("the position of vertex {} is not finite", i));
        mesh.positions.push_back({v[0], v[1], v[2]});
        if (normals) mesh.normals.push_back({v[3], v[4], v[5]});
        if (uvs) mesh.uvs.push_back({v[6], v[7]});
        if (colours) mesh.colours.push_back(colour_of(&v[red], grey));
    }
}

// Up to `most` faces. Returns how many. Those of more than three corners are cut like a fan.
std::uint64_t read_faces(Input& input, Format format, const Property& list, std::uint64_t most, Mesh& mesh) {
    if (const std::uint64_t count = input.plain_triangles(format, list, most, mesh.triangles)) return count;
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
    return 1;
}

/// Strips one behind the other, with -1 between them.
std::uint64_t read_strip(Input& input, Format format, const Property& list, std::uint64_t, Mesh& mesh) {
    const std::size_t length = list_length(input, format, list);
    std::array<std::uint32_t, 2> last{};
    std::size_t seen = 0;
    for (std::size_t i = 0; i < length; ++i) {
        const double index = input.number(format, list.type);
        if (index < 0) {
            seen = 0;
            continue;
        }
        if (!(index <= std::numeric_limits<std::uint32_t>::max()) || index != std::floor(index))
            fail("a triangle strip has an impossible vertex index");
        const auto corner = static_cast<std::uint32_t>(index);
        if (seen >= 2 && seen % 2 == 0) mesh.triangles.push_back({last[0], last[1], corner});
        if (seen >= 2 && seen % 2 == 1) mesh.triangles.push_back({last[1], last[0], corner});
        last = {last[1], corner};
        ++seen;
    }
    return 1;
}

/// Reads the elements whose list of corners `read` understands: at least one at a time, and several where they have
/// nothing but that list. Numbers of theirs that have the name go to their triangles.
template <class Read>
void read_lists(Input& input, Format format, const Element& element, const Names& names, AttributedMesh& to,
                const Read& read) {
    Mesh& mesh = to.mesh;
    const auto corners = is_list_of_corners;
    if (std::none_of(element.properties.begin(), element.properties.end(), corners))
        fail(fmt::format("'{}' has no list 'vertex_indices'", element.name.substr(0, 32)));
    mesh.triangles.reserve(mesh.triangles.size() + element.count);
    const bool alone = element.properties.size() == 1;
    const auto number_of = [&](const Property& p) {
        if (p.list) return -1;
        return names.attribute == "color" && slot_of(p.name) >= red ? slot_of(p.name) - red : names.number_of(p.name);
    };
    const auto numbers = std::count_if(element.properties.begin(), element.properties.end(),
                                       [&](const Property& p) { return number_of(p) >= 0; });
    for (std::uint64_t i = 0; i < element.count;) {
        end_if_unwanted();
        std::uint64_t count = 1;
        std::array<float, 3> colour{};
        for (const auto& property : element.properties) {
            if (corners(property))
                count = read(input, format, property, alone ? element.count - i : 1, mesh);
            else if (const int number = number_of(property); number >= 0)
                colour[std::size_t(number)] = colour_value(input.number(format, property.type), property.type);
            else
                skip(input, format, property);
        }
        if (numbers) to.of_triangles.resize(mesh.triangles.size(), colour_of(colour.data(), numbers == 1));
        i += count;
    }
}

void check_indices(const Mesh& mesh) {
    for (const auto& triangle : mesh.triangles)
        for (const auto index : triangle)
            if (index >= mesh.positions.size())
                fail(fmt::format("a face has the vertex index {}, but there are {} vertices", index,
                                 mesh.positions.size()));
}

/// Faces that were cut like a fan: their triangles, from the first of them.
struct Fan {
    std::uint32_t first, triangles;
};

// A fan covers what a concave polygon leaves open. Vertices may stand behind faces, so that this comes last.
void cut_inside(std::span<const Fan> fans, Mesh& mesh) {
    std::vector<std::uint32_t> corners;
    for (const Fan& fan : fans) {
        end_if_unwanted();
        corners.assign({mesh.triangles[fan.first][0], mesh.triangles[fan.first][1]});
        for (std::uint32_t i = 0; i < fan.triangles; ++i) corners.push_back(mesh.triangles[fan.first + i][2]);
        std::uint32_t next = fan.first;
        triangulate(mesh.positions, corners, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mesh.triangles[next++] = {a, b, c};
        });
    }
}

AttributedMesh read_all(std::span<const std::byte> bytes, const Names& of_vertices, const Names& of_faces) {
    Input input({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const ply::Header header = ply::read_header(input);
    AttributedMesh result;
    bool vertices = false, faces = false;
    std::vector<Fan> fans;
    const auto read_and_note = [&](Input& from, Format format, const Property& list, std::uint64_t most, Mesh& mesh) {
        const std::size_t before = mesh.triangles.size();
        const std::uint64_t count = read_faces(from, format, list, most, mesh);
        if (const std::size_t made = mesh.triangles.size() - before; count == 1 && made > 1)
            fans.push_back({static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(made)});
        return count;
    };
    for (const auto& element : header.elements) {
        check_room(input, header.format, element);
        if (element.name == "vertex" && !std::exchange(vertices, true)) {
            read_vertices(input, header.format, element, of_vertices, result.mesh);
        } else if (element.name == "face" && !std::exchange(faces, true)) {
            read_lists(input, header.format, element, of_faces, result, read_and_note);
        } else if (element.name == "tristrips" && !std::exchange(faces, true)) {
            read_lists(input, header.format, element, of_faces, result, read_strip);
        } else {
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const auto& property : element.properties) skip(input, header.format, property);
        }
    }
    if (!vertices || !faces) fail("there are no vertices or no faces");
    check_indices(result.mesh);
    cut_inside(fans, result.mesh);
    result.found = !result.mesh.colours.empty() || !result.of_triangles.empty();
    return result;
}

}  // namespace

Mesh read_ply(std::span<const std::byte> bytes) { return read_all(bytes, {}, {}).mesh; }

std::string texture_of_ply(std::span<const std::byte> bytes) {
    Input input({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return ply::read_header(input).texture;
}

std::vector<std::string> skipped_in_ply(std::span<const std::byte> bytes) {
    Input input({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    std::vector<std::string> skipped;
    bool coloured = false;  // its vertices are, whose colours count more than those of faces
    for (const auto& element : ply::read_header(input).elements) {
        const bool vertices = element.name == "vertex", faces = element.name == "face" || element.name == "tristrips";
        if (!vertices && !faces) skipped.push_back(fmt::format("element '{}'", element.name.substr(0, 32)));
        if (!vertices && !faces) continue;
        const auto is_colour = [](const Property& property) { return slot_of(property.name) >= red; };
        coloured |= vertices && std::ranges::any_of(element.properties, is_colour);
        for (const auto& property : element.properties)
            if (vertices ? slot_of(property.name) < 0
                         : !is_list_of_corners(property) && (coloured || !is_colour(property)))
                skipped.push_back(fmt::format("property '{}' of '{}'", property.name.substr(0, 32), element.name));
    }
    return skipped;
}

AttributedMesh read_ply(std::span<const std::byte> bytes, std::string_view attribute) {
    constexpr std::string_view vertex = "vertex_", face = "face_";
    Names of_vertices{"", attribute == "vertex_color"}, of_faces;
    if (attribute.starts_with(vertex)) of_vertices.attribute = attribute.substr(vertex.size());
    if (attribute.starts_with(face)) of_faces.attribute = attribute.substr(face.size());
    return read_all(bytes, of_vertices, of_faces);
}

}  // namespace lightnet
