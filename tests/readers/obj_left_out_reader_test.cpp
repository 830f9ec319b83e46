// Whatever OBJ, MTL and PLY files say either changes the scene, or is named in a warning, or has no effect on any
// picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "core/scene/data/identity.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::obj_left_out_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string model = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
const std::string picture = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x40\x20\x80", 4);

/// What stands around a statement that is not as it would be without it.
struct Statement {
    std::string before, text;
    friend std::ostream& operator<<(std::ostream& out, const Statement& s) { return out << s.before << s.text; }
};

SceneData with(const std::string& material) {
    return read_as("a.obj", model, {{"m.mtl", "newmtl a\n" + material + "\n"}, {"p.hdr", picture}});
}

class EveryStatement : public testing::TestWithParam<Statement> {};

TEST_P(EveryStatement, CountsOrIsNamed) {
    const auto& [before, text] = GetParam();
    const auto without = with(before), scene = with(before + "\n" + text);
    if (identity_of(without) != identity_of(scene)) return;
    EXPECT_THAT(warnings_of(scene), HasSubstr("'" + text.substr(0, text.find(' ')) + "'"));
}

std::vector<Statement> all_statements() {
    const std::string matt = "Kd .5 .5 .5", shiny = matt + "\nKs .5 .5 .5\nNs 20\nillum 2", glass = "illum 4\nKd 0 0 0",
                      mirror = "illum 3\nKs .9 .9 .9\nKd 0 0 0", modern = matt + "\nPr .5";
    std::vector<Statement> all;
    const auto add = [&](const std::string& before, std::initializer_list<const char*> texts) {
        for (const char* text : texts) all.push_back({before, text});
    };
    const std::initializer_list<const char*> everywhere{
        "Ke 1 1 1",       "map_Ke p.hdr", "map_d p.hdr",  "bump p.hdr",   "norm p.hdr",
        "map_Bump p.hdr", "map_Kn p.hdr", "disp p.hdr",   "decal p.hdr",  "refl p.hdr",
        "map_Ka p.hdr",   "map_Ns p.hdr", "map_Ps p.hdr", "map_Pc p.hdr", "map_Pcr p.hdr",
        "map_refl p.hdr", "strange 1",    "anisor .5",    "map_Kd p.hdr", "map_Ks p.hdr"};
    for (const auto& before : {matt, shiny, mirror, glass, modern}) add(before, everywhere);
    add(matt,
        {"Kd .1 .2 .3", "Ks .5 .5 .5", "d .5", "Tr .5", "Tf .5 .5 .5", "Pr .2", "Pm 1", "Ps 1", "Pc 1", "illum 4"});
    add(shiny, {"Ks .2 .2 .2", "Ns 90", "Ni 2", "illum 0", "Tf .5 .5 .5"});
    add(mirror, {"Ks .2 .2 .2", "Ns 90", "Tf .5 .5 .5"});
    add(glass, {"Ni 2", "Tf .5 .5 .5"});
    add(modern, {"Pm .5", "Ps .5", "Pc .5", "Pc .5\nPcr .5", "aniso .5", "map_Pr p.hdr", "map_Pm p.hdr", "Ni 2",
                 "Tf .5 .5 .5"});
    return all;
}
INSTANTIATE_TEST_SUITE_P(OfMtl, EveryStatement, testing::ValuesIn(all_statements()));

TEST(ObjLeftOut, IsNamedWhateverItIs) {
    for (const std::string word : {"l 1 2", "p 1", "curv 0 1", "surf 0 1", "call a.obj", "f 1 2"})
        EXPECT_THAT(warnings_of(read_as("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + word + "\n")),
                    HasSubstr("left out"))
            << word;
    EXPECT_THAT(warnings_of(read_as("a.obj", "o a\ng b\ns 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
                Not(HasSubstr("left out")));
}

TEST(PlyLeftOut, IsNamedByElementAndProperty) {
    const auto said = [](const std::string& of_vertices, const std::string& of_faces, const std::string& more) {
        const std::string zeros = of_vertices.empty() ? "" : " 0", none = of_faces.empty() ? "" : " 0";
        return warnings_of(read_as(
            "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                         of_vertices + "element face 1\nproperty list uchar int vertex_indices\n" + of_faces + more +
                         "end_header\n0 0 0" + zeros + "\n1 0 0" + zeros + "\n0 1 0" + zeros + "\n3 0 1 2" + none +
                         "\n" + (more.empty() ? "" : "0\n")));
    };
    EXPECT_THAT(said("", "", ""), Not(HasSubstr("left out")));
    EXPECT_THAT(said("property uchar alpha\n", "", ""), HasSubstr("property 'alpha' of 'vertex' is left out"));
    EXPECT_THAT(said("", "property uchar flags\n", ""), HasSubstr("property 'flags' of 'face' is left out"));
    EXPECT_THAT(said("property uchar red\n", "property uchar red\n", ""),
                HasSubstr("property 'red' of 'face' is left out"));
    EXPECT_THAT(said("", "", "element edge 1\nproperty int vertex1\n"), HasSubstr("element 'edge' is left out"));
}

}  // namespace
}  // namespace lightnet::test::obj_left_out_reader_test
