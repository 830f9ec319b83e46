// How hair scatters, as pbrt and Mitsuba write it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/scene/bsdf/hair.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::hair_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string strand = "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [ 0 0 0 0 0 1 0 0 2 0 0 3 ]\n";

SceneData hair(const std::string& parameters) { return read_world("Material \"hair\" " + parameters + "\n" + strand); }

float number_of(const SceneData& scene, TextureId texture) { return colour_of(scene, texture).r; }

/// What a fibre absorbs over its radius.
Rgb absorption_of(const SceneData& scene) {
    return model_of<HairMaterial>(scene).at({scene.textures, TexturePlace{}}).absorption;
}

TEST(PbrtHair, IsBrownUnlessItIsSaidOtherwise) {
    const auto scene = hair("");
    const auto& model = model_of<HairMaterial>(scene);
    EXPECT_EQ(absorption_of(scene), melanin_absorption(1.3f, 0));
    EXPECT_EQ(number_of(scene, model.eta), 1.55f);
    EXPECT_EQ(number_of(scene, model.along), 0.3f);
    EXPECT_EQ(number_of(scene, model.around), 0.3f);
    EXPECT_EQ(number_of(scene, model.tilt), 2);
    EXPECT_TRUE(model.across_by_v);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
}

TEST(PbrtHair, HasTheColourThatIsSaid) {
    EXPECT_EQ(absorption_of(hair("\"rgb sigma_a\" [ 1 2 30 ]")), (Rgb{1, 2, 30}));
    EXPECT_EQ(absorption_of(hair("\"rgb reflectance\" [ .1 .5 .9 ] \"float beta_n\" .5")),
              hair_absorption({0.1f, 0.5f, 0.9f}, 0.5f));
    EXPECT_EQ(absorption_of(hair("\"rgb color\" [ .1 .5 .9 ]")), hair_absorption({0.1f, 0.5f, 0.9f}, 0.3f));
    EXPECT_EQ(absorption_of(hair("\"float eumelanin\" .3")), melanin_absorption(0.3f, 0));
    EXPECT_EQ(absorption_of(hair("\"float pheomelanin\" .6")), melanin_absorption(0, 0.6f));
    const auto both = hair("\"rgb sigma_a\" [ 1 2 3 ] \"rgb reflectance\" [ .1 .5 .9 ] \"float eumelanin\" .3");
    EXPECT_EQ(absorption_of(both), (Rgb{1, 2, 3}));
    EXPECT_THAT(warnings_of(both), HasSubstr("scene.pbrt:2: Material 'hair': 'reflectance' is left out beside "
                                             "'sigma_a'"));
    EXPECT_THAT(warnings_of(both), HasSubstr("'eumelanin' is left out beside 'sigma_a'"));
}

TEST(PbrtHair, MayHaveTexturesForAll) {
    const auto scene = read_world(
        "Texture \"n\" \"float\" \"checkerboard\" \"float tex1\" .25 \"float tex2\" .25\n"
        "Texture \"c\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ .1 .2 .3 ] \"rgb tex2\" [ .1 .2 .3 ]\n"
        "Material \"hair\" \"texture reflectance\" \"c\" \"texture beta_m\" \"n\" \"texture beta_n\" \"n\" "
        "\"texture alpha\" \"n\"\n" +
        strand);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    const HairBsdf found = model_of<HairMaterial>(scene).at({scene.textures, TexturePlace{}});
    const HairBsdf wanted = hair_fibre(hair_absorption({0.1f, 0.2f, 0.3f}, 0.25f), 1.55f, {0.25f, 0.25f, 0.25f});
    EXPECT_EQ(found.absorption, wanted.absorption);
    EXPECT_EQ(found.along[0].variance, wanted.along[0].variance);
    EXPECT_EQ(found.along[2].scales.sine, wanted.along[2].scales.sine);
    EXPECT_EQ(found.spread, wanted.spread);
}

TEST(PbrtHair, SaysWhatCanNotBe) {
    const auto wrong = [](const std::string& parameters) {
        return errors_of_world("Material \"hair\" " + parameters + "\n" + strand);
    };
    EXPECT_THAT(wrong("\"float beta_m\" 1.5"),
                HasSubstr("scene.pbrt:2: Material 'hair': 'beta_m' of hair is 0 to 1, not 1.5"));
    EXPECT_THAT(wrong("\"float beta_n\" -1"), HasSubstr("'beta_n' of hair is 0 to 1, not -1"));
    EXPECT_THAT(wrong("\"float eta\" .9"), HasSubstr("'eta' of hair is 1 or more, not 0.9"));
    EXPECT_THAT(wrong("\"float eumelanin\" -2"), HasSubstr("'eumelanin' of hair is 0 or more, not -2"));
    EXPECT_THAT(wrong("\"rgb sigma_a\" [ 1 -1 1 ]"), HasSubstr("rgb 'sigma_a' has a negative component"));
    EXPECT_THAT(warnings_of(hair("\"float betam\" .2")), HasSubstr("'betam'"));
}

TEST(PbrtHair, IsThatOfVersion3Too) {
    const auto scene =
        read_text("Film \"image\" WorldBegin\nMaterial \"hair\" \"rgb color\" [ .2 .3 .4 ] \"float beta_m\" .2\n" +
                  strand + "WorldEnd");
    EXPECT_EQ(absorption_of(scene), hair_absorption({0.2f, 0.3f, 0.4f}, 0.3f));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("hair")));
}

SceneData mitsubas(const std::string& inside) { return read_mitsuba_bsdf("<bsdf type='hair'>" + inside + "</bsdf>"); }

TEST(MitsubaHair, IsBrownUnlessItIsSaidOtherwise) {
    const auto scene = mitsubas("");
    const auto& model = model_of<HairMaterial>(scene);
    EXPECT_EQ(absorption_of(scene), melanin_absorption(1.3f, 0.2f));
    EXPECT_FLOAT_EQ(number_of(scene, model.eta), 1.55f / 1.000277f);
    EXPECT_EQ(number_of(scene, model.along), 0.3f);
    EXPECT_EQ(number_of(scene, model.around), 0.3f);
    EXPECT_EQ(number_of(scene, model.tilt), 2);
    EXPECT_FALSE(model.across_by_v);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("hair"))) << warnings_of(scene);
}

TEST(MitsubaHair, HasTheColourThatIsSaid) {
    EXPECT_EQ(absorption_of(mitsubas("<float name='eumelanin' value='.2'/><float name='pheomelanin' value='.4'/>")),
              melanin_absorption(0.2f, 0.4f));
    EXPECT_EQ(absorption_of(mitsubas("<rgb name='sigma_a' value='0.25, 0.5, 0.75'/><float name='scale' value='200'/>")),
              (Rgb{50, 100, 150}));
}

TEST(MitsubaHair, SaysWhatCanNotBe) {
    const auto wrong = [](const std::string& inside) {
        return errors_of_mitsuba("<shape type='sphere'><bsdf type='hair'>" + inside + "</bsdf></shape>");
    };
    EXPECT_THAT(wrong("<rgb name='sigma_a' value='1'/><float name='eumelanin' value='1'/>"),
                HasSubstr("scene.xml:1: hair has either pigments"));
    EXPECT_THAT(wrong("<float name='longitudinal_roughness' value='2'/>"),
                HasSubstr("'longitudinal_roughness' of bsdf 'hair' is 0 to 1, not 2"));
    EXPECT_THAT(wrong("<float name='azimuthal_roughness' value='-1'/>"), HasSubstr("is 0 to 1, not -1"));
    EXPECT_THAT(wrong("<float name='eumelanin' value='-1'/>"),
                HasSubstr("'eumelanin' of bsdf 'hair' is 0 or more, not -1"));
    EXPECT_THAT(wrong("<float name='int_ior' value='1'/>"), HasSubstr("'int_ior' of hair must be above its 'ext_ior'"));
}

}  // namespace
}  // namespace lightnet::test::hair_reader_test
