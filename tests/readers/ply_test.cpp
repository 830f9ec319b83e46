#include "core/readers/ply/mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "core/base/error.hpp"
#include "tests/support/memory_files.hpp"

namespace lightnet::ply_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Triangle = std::array<std::uint32_t, 3>;

Mesh read(const std::string& text) { return read_ply(*test::bytes_of(text)); }

std::string error_of(const std::string& text) {
    try {
        read(text);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// A square of four vertices with normals and texture coordinates, and one face of four corners.
const std::string header_of_square =
    "comment made by hand\n"
    "element vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\n"
    "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
    "element face 1\nproperty list uchar int vertex_indices\nproperty ushort group\nend_header\n";

std::string ascii_square() {
    return "ply\nformat ascii 1.0\n" + header_of_square +
           "0 0 0 255 0 0 1 0 0\n1 0 0 255 0 0 1 1 0\n1 1 0 255 0 0 1 1 1\n0 1 0 255 0 0 1 0 1\n4 0 1 2 3 7\n";
}

template <class Value>
void put(std::string& text, Value value, bool little) {
    std::array<char, sizeof(Value)> raw{};
    std::memcpy(raw.data(), &value, raw.size());
    if (little != (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
    text.append(raw.data(), raw.size());
}

std::string binary_square(bool little) {
    std::string text =
        std::string("ply\r\nformat ") + (little ? "binary_little_endian" : "binary_big_endian") + " 1.0\n";
    text += header_of_square;
    const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const auto& c : corners) {
        put(text, c[0], little), put(text, double(c[1]), little), put(text, 0.0f, little);
        put(text, std::uint8_t{255}, little);
        for (const float n : {0.0f, 0.0f, 1.0f, c[0], c[1]}) put(text, n, little);
    }
    put(text, std::uint8_t{4}, little);
    for (std::int32_t i = 0; i < 4; ++i) put(text, i, little);
    put(text, std::uint16_t{7}, little);
    return text;
}

void expect_square(const Mesh& mesh) {
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
    EXPECT_THAT(mesh.normals, testing::Each(Vec3{0, 0, 1}));
    EXPECT_THAT(mesh.uvs, ElementsAre(Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

std::string triangle(const std::string& vertices, const std::string& face) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_index\nend_header\n" +
           vertices + face;
}

TEST(Ply, ReadsAscii) { expect_square(read(ascii_square())); }
TEST(Ply, ReadsLittleEndian) { expect_square(read(binary_square(true))); }
TEST(Ply, ReadsBigEndian) { expect_square(read(binary_square(false))); }

TEST(Ply, CutsLargeFacesLikeAFan) {
    const Mesh mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0  2 0 0  3 1 0  1 2 0  -1 1 0   5 0 1 2 3 4");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
    EXPECT_THAT(mesh.normals, IsEmpty());
    EXPECT_THAT(mesh.uvs, IsEmpty());
}

TEST(Ply, CutsConcaveFacesInside) {
    const std::string vertices = "1 -1 0\n0 0 0\n1 1 0\n-1 1 0\n-1 -1 0\n", faces = "3 0 1 4\n5 0 1 2 3 4\n";
    const std::string of_vertices = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n",
                      of_faces = "element face 2\nproperty list uchar int vertex_indices\n",
                      start = "ply\nformat ascii 1.0\n";
    for (const auto& text : {start + of_vertices + of_faces + "end_header\n" + vertices + faces,
                             start + of_faces + of_vertices + "end_header\n" + faces + vertices}) {
        const Mesh mesh = read(text);
        ASSERT_EQ(mesh.triangles.size(), 4u);
        float area = 0;  // with its sign: all look at +z
        for (std::size_t i = 1; i < 4; ++i) {
            const auto [a, b, c] = mesh.triangles[i];
            const float part =
                cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]).z / 2;
            EXPECT_GT(part, 0);
            area += part;
        }
        EXPECT_FLOAT_EQ(area, 3);
    }
}

// Triangles are read at once where they are whole numbers of 32 bits; what lies between them is read as ever.
TEST(Ply, ReadsBinaryFacesOfAnyLengthInTheirOrder) {
    const auto faces = [](std::int32_t last) {
        std::string text =
            "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
            "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n";
        for (int i = 0; i < 15; ++i) put(text, float(i), true);
        for (const std::vector<std::int32_t>& face : {std::vector{0, 1, 2}, {1, 2, 3, 4}, {2, 3, last}}) {
            put(text, std::uint8_t(face.size()), true);
            for (const std::int32_t index : face) put(text, index, true);
        }
        return text;
    };
    EXPECT_THAT(read(faces(4)).triangles,
                ElementsAre(Triangle{0, 1, 2}, Triangle{1, 2, 3}, Triangle{1, 3, 4}, Triangle{2, 3, 4}));
    EXPECT_THAT(error_of(faces(-1)), HasSubstr("impossible vertex index"));
    EXPECT_THAT(error_of(faces(5)), HasSubstr("has the vertex index 5"));
    std::string cut = faces(4);
    cut.pop_back();
    EXPECT_NE(error_of(cut), "");
}

TEST(Ply, SkipsOtherElements) {
    const Mesh mesh = read(
        "ply\nformat ascii 1.0\nelement material 1\nproperty list uchar float weights\nproperty int id\n"
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "2 .5 .5 9\n0 0 0  1 0 0  0 1 0\n3 0 1 2");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Ply, RefusesIndicesWithoutAVertex) {
    EXPECT_THAT(error_of(triangle("0 0 0 1 0 0 0 1 0 ", "3 0 1 3")), HasSubstr("vertex index 3, but there are 3"));
    EXPECT_THAT(error_of(triangle("0 0 0 1 0 0 0 1 0 ", "3 0 1 -1")), HasSubstr("impossible vertex index"));
    EXPECT_THAT(error_of(triangle("0 0 0 1 0 0 0 1 0 ", "3 0 1 1.5")), HasSubstr("impossible vertex index"));
}

TEST(Ply, RefusesPositionsThatAreNoNumbers) {
    EXPECT_THAT(error_of(triangle("0 0 0 1 nan 0 0 1 0 ", "3 0 1 2")), HasSubstr("position of vertex 1 is not finite"));
    EXPECT_THAT(error_of(triangle("0 0 0 1 inf 0 0 1 0 ", "3 0 1 2")), HasSubstr("not finite"));
    EXPECT_THAT(error_of(triangle("0 0 0 1 two 0 0 1 0 ", "3 0 1 2")), HasSubstr("not 'two'"));
}

TEST(Ply, RefusesFacesOfTwoCorners) {
    EXPECT_THAT(error_of(triangle("0 0 0 1 0 0 0 1 0 ", "2 0 1")), HasSubstr("2 corners"));
}

TEST(Ply, ChecksCountsAgainstTheFileBeforeItAllocates) {
    std::string text = ascii_square();
    text.replace(text.find("vertex 4"), 8, "vertex 999999999999");
    EXPECT_THAT(error_of(text), HasSubstr("promises 999999999999 of 'vertex'"));
    EXPECT_THAT(error_of(triangle("0 0 0 1 0 0 0 1 0 ", "4000000000 0 1")), HasSubstr("impossible length"));
}

TEST(Ply, SaysWhatIsWrongWithAHeader) {
    EXPECT_THAT(error_of("plx\n"), HasSubstr("does not begin with 'ply'"));
    EXPECT_THAT(error_of("ply\nformat ebcdic 1.0\n"), HasSubstr("unknown format 'ebcdic'"));
    EXPECT_THAT(error_of("ply\nend_header\n"), HasSubstr("names no format"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nend_header\n"), HasSubstr("no vertices"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex -1\n"), HasSubstr("no sound count"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"),
                HasSubstr("unknown type 'quad'"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex 1\nend_header\n0\n"), HasSubstr("no properties"));
}

class EveryPly : public testing::TestWithParam<std::string> {};

TEST_P(EveryPly, IsRefusedOnceItIsCutAnywhere) {
    const std::string& text = GetParam();
    for (std::size_t length = 0; length + 3 < text.size(); ++length)
        EXPECT_THROW(read(text.substr(0, length)), Error) << length;
}

TEST_P(EveryPly, NeverCrashesWithABrokenByte) {
    const std::string& text = GetParam();
    for (std::size_t i = 0; i < text.size(); ++i)
        for (const char byte : {'\0', '\x7f', '\xff', '9', ' '}) {
            std::string broken = text;
            broken[i] = byte;
            error_of(broken);
        }
}

INSTANTIATE_TEST_SUITE_P(Format, EveryPly, testing::Values(ascii_square(), binary_square(true), binary_square(false)));

}  // namespace
}  // namespace lightnet::ply_test
