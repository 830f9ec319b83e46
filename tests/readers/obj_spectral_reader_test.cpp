// Colours of MTL files by measured curves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/readers/common/spectra.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::obj_spectral_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string model = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
const std::string red = "# nm, share\n400 .1\n500, .1\n600 .7\r\n700 .7\n", flat = "\xEF\xBB\xBF 380 .5 780 .5";
const std::vector<SpectrumPoint> red_curve{{400, 0.1f}, {500, 0.1f}, {600, 0.7f}, {700, 0.7f}};

SceneData with(const std::string& material) {
    return read_as("a.obj", model,
                   {{"m.mtl", "newmtl a\n" + material + "\n"}, {"Red.rfl", red}, {"flat.rfl", flat}, {"bad.rfl", "x"}});
}

const Material& material_of(const SceneData& scene) { return scene.materials[scene.shapes[0].material]; }

Rgb matt(const SceneData& scene) {
    return scene.textures[std::get<DiffuseMaterial>(material_of(scene).model).reflectance].scale;
}

void expect_near(Rgb colour, Rgb expected, float most = 1e-5f) {
    EXPECT_NEAR(colour.r, expected.r, most);
    EXPECT_NEAR(colour.g, expected.g, most);
    EXPECT_NEAR(colour.b, expected.b, most);
}

TEST(ObjSpectralColours, OfSurfacesAreSeenUnderDaylight) {
    expect_near(matt(with("Kd spectral flat.rfl")), {0.5f, 0.5f, 0.5f});
    expect_near(matt(with("Kd spectral flat.rfl 0.5 # half of it")), {0.25f, 0.25f, 0.25f});
    expect_near(matt(with("Kd spectral Red.rfl .8")), surface_colour(red_curve).rgb * 0.8f);
    EXPECT_THAT(warnings_of(with("Kd spectral Red.rfl")), Not(HasSubstr("spectral")));
}

// an even spectrum is of the colour of illuminant E
TEST(ObjSpectralColours, OfLampsAreLight) {
    const auto scene = with("Kd 0 0 0\nKe spectral flat.rfl 10");
    expect_near(scene.shapes[0].emission.value().radiance, {5 * 1.205f, 5 * 0.948f, 5 * 0.909f}, 0.04f);
}

TEST(ObjSpectralColours, StandWhereverAColourMay) {
    const auto mirror = with("illum 3\nKd 0 0 0\nKs spectral flat.rfl");
    expect_near(mirror.textures[std::get<ConductorMaterial>(material_of(mirror).model).metal.reflectance.value()].scale,
                {0.5f, 0.5f, 0.5f});
    const auto glass = with("illum 4\nTf spectral flat.rfl");
    expect_near(glass.textures[std::get<DielectricMaterial>(material_of(glass).model).transmitted.value()].scale,
                {0.5f, 0.5f, 0.5f});
}

TEST(ObjSpectralColours, ThatCantBeReadAreNamed) {
    const auto said = [](const std::string& line) { return warnings_of(with(line)); };
    EXPECT_THAT(said("Kd spectral none.rfl"), HasSubstr("m.mtl:2: a colour by 'spectral' is left out: there is no file "
                                                        "'none.rfl': the picture is as without this line"));
    EXPECT_THAT(said("Kd spectral bad.rfl"), HasSubstr("'bad.rfl': a number expected, not 'x'"));
    EXPECT_THAT(said("Kd spectral"), HasSubstr("it names no file"));
    EXPECT_THAT(said("Kd spectral C:\\paint\\red.rfl"), HasSubstr("'Red.rfl' is taken"));
    expect_near(matt(with("Kd spectral C:\\paint\\flat.rfl")), {0.5f, 0.5f, 0.5f});
    expect_near(matt(with("Kd spectral none.rfl")), {0.8f, 0.8f, 0.8f});
    EXPECT_THAT(errors_as("a.obj", model, {{"m.mtl", "newmtl a\nKd spectral f.rfl x\n"}, {"f.rfl", flat}}),
                HasSubstr("m.mtl:2: a finite number expected, not 'x'"));
}

TEST(ObjSpectralColours, OfAmbienceHaveNoEffect) {
    EXPECT_EQ(warnings_of(with("Kd 1 1 1\nKa spectral none.rfl")), warnings_of(with("Kd 1 1 1\nKa .2 .2 .2")));
}

}  // namespace
}  // namespace lightnet::test::obj_spectral_reader_test
