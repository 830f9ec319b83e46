// Mitsuba's bsdfs, textures and colours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/readers/common/spectra.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/textures/look_up.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_materials_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// 2 × 2 pixels of Radiance HDR: red, green over blue, white
const std::string picture = [] {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n";
    for (const auto& p : {"\x80\0\0\x81", "\0\x80\0\x81", "\0\0\x80\x81", "\x80\x80\x80\x81"})
        text += std::string(p, 4);
    return text;
}();

const Material& material_of(const SceneData& scene, std::size_t shape = 0) {
    return scene.materials[scene.shapes[shape].material];
}

Rgb reflectance(const std::string& colour) {
    const auto scene = read_mitsuba_bsdf("<bsdf type='diffuse'>" + colour + "</bsdf>");
    return colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance);
}

SceneData textured(const std::string& texture) {
    return read_mitsuba_bsdf("<bsdf type='diffuse'>" + texture + "</bsdf>", {{"p.hdr", picture}});
}

Rgb seen(const SceneData& scene, Vec2 uv) {
    return look_up(scene.textures, model_of<DiffuseMaterial>(scene).reflectance, {uv});
}

TEST(MitsubaColours, AreWrittenInManyWays) {
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='0.1, 0.2, 0.3'/>"), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='0.25'/>"), (Rgb{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(reflectance("<spectrum name='reflectance' value='0.5'/>"), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='#ff0000'/>"), (Rgb{1, 0, 0}));
    EXPECT_NEAR(reflectance("<srgb name='reflectance' value='0.5 0.5 0.5'/>").g, 0.2140f, 1e-3f);
    const Rgb flat = reflectance("<spectrum name='reflectance' value='400:0.3, 700:0.3'/>");
    EXPECT_NEAR(flat.r, 0.3f, 1e-3f);
    EXPECT_NEAR(flat.b, 0.3f, 1e-3f);
    EXPECT_EQ(reflectance(""), (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(MitsubaColours, SayWhatIsWrong) {
    const auto errors = [](const std::string& colour) {
        return errors_of_mitsuba("<shape type='sphere'><bsdf type='diffuse'>" + colour + "</bsdf></shape>");
    };
    EXPECT_THAT(errors("<rgb name='reflectance' value='1 2'/>"), HasSubstr("a colour has one or three numbers, not 2"));
    EXPECT_THAT(errors("<rgb name='reflectance' value='#12'/>"), HasSubstr("'#rrggbb'"));
    EXPECT_THAT(errors("<spectrum name='reflectance' value='700:1, 400:2'/>"), HasSubstr("ascending wavelengths"));
    EXPECT_THAT(errors("<transform name='reflectance'/>"),
                HasSubstr("a colour or a texture expected, not <transform>"));
}

TEST(MitsubaDiffuse, IsBlackFromBehindUnlessTwoSided) {
    EXPECT_TRUE(material_of(read_mitsuba_bsdf("<bsdf type='diffuse'/>")).one_sided);
    EXPECT_FALSE(material_of(read_mitsuba_bsdf("<bsdf type='twosided'><bsdf type='diffuse'/></bsdf>")).one_sided);
    EXPECT_TRUE(material_of(read_mitsuba_bsdf("<bsdf type='plastic'/>")).one_sided);
    EXPECT_FALSE(material_of(read_mitsuba_bsdf("<bsdf type='dielectric'/>")).one_sided);
}

TEST(MitsubaTwoSided, MayHaveAnotherBack) {
    const auto scene = read_mitsuba_bsdf("<bsdf type='twosided'><bsdf type='diffuse'/><bsdf type='conductor'/></bsdf>");
    const auto& faces = model_of<TwoFacedMaterial>(scene);
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(scene.materials[faces.front].model));
    EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(scene.materials[faces.back].model));
    EXPECT_FALSE(scene.materials[faces.back].one_sided);
}

TEST(MitsubaDielectric, KnowsItsSubstances) {
    EXPECT_NEAR(model_of<DielectricMaterial>(read_mitsuba_bsdf("<bsdf type='dielectric'/>")).eta, 1.5046f / 1.000277f,
                1e-5f);
    const auto scene = read_mitsuba_bsdf(
        "<bsdf type='thindielectric'><string name='int_ior' value='water'/><string name='ext_ior' "
        "value='vacuum'/></bsdf>");
    EXPECT_EQ(model_of<DielectricMaterial>(scene).eta, 1.333f);
    EXPECT_TRUE(model_of<DielectricMaterial>(scene).thin);
    EXPECT_THAT(errors_of_mitsuba(
                    "<shape type='sphere'><bsdf type='dielectric'><string name='intIOR' value='watr'/></bsdf></shape>"),
                HasSubstr("there is no dielectric 'watr' (did you mean 'water'?)"));
    const auto rough = read_mitsuba_bsdf(
        "<bsdf type='roughdielectric'><float name='alpha' value='0.3'/><string name='distribution' "
        "value='ggx'/></bsdf>");
    EXPECT_EQ(model_of<DielectricMaterial>(rough).roughness.u, 0.3f);
    EXPECT_EQ(model_of<DielectricMaterial>(rough).roughness.means, Roughness::Means::alpha);
}

TEST(MitsubaDielectric, HasAnIndexForEachColour) {
    const auto dispersing = [](const std::string& type, const std::string& more = "") {
        return read_mitsuba_bsdf("<bsdf type='" + type + "'><spectrum name='int_ior' value='400:1.7, 700:1.5'/>" +
                                 more + "<float name='ext_ior' value='1'/></bsdf>");
    };
    const auto solid = dispersing("dielectric");
    const auto& glass = model_of<PrincipledMaterial>(solid);
    EXPECT_NEAR(glass.eta, 1.6f, 0.03f);
    EXPECT_GT(glass.dispersion, 0.03f);
    EXPECT_LT(glass.dispersion, 0.1f);
    EXPECT_FALSE(glass.thin);
    EXPECT_EQ(colour_of(solid, glass.base_colour), (Rgb{1, 1, 1}));
    EXPECT_THAT(warnings_of(solid), HasSubstr("dispersion is approximated by three indices"));
    const auto rough = dispersing("roughdielectric", "<float name='alpha' value='0.3'/>");
    EXPECT_EQ(model_of<PrincipledMaterial>(rough).roughness.u, 0.3f);
    EXPECT_EQ(model_of<PrincipledMaterial>(rough).roughness.means, Roughness::Means::alpha);
    for (const auto& scene : {dispersing("thindielectric"),
                              dispersing("dielectric", "<rgb name='specular_transmittance' value='1, .5, .5'/>")}) {
        EXPECT_TRUE(std::holds_alternative<DielectricMaterial>(material_of(scene).model));
        EXPECT_THAT(warnings_of(scene), HasSubstr("dispersion is left out"));
    }
}

TEST(MitsubaConductor, KnowsItsMetals) {
    const auto gold = read_mitsuba_bsdf("<bsdf type='conductor'><string name='material' value='Au'/></bsdf>");
    EXPECT_NEAR(colour_of(gold, model_of<ConductorMaterial>(gold).metal.eta).r, 0.143119f, 1e-5f);
    const auto mirror = read_mitsuba_bsdf("<bsdf type='conductor'><string name='material' value='none'/></bsdf>");
    EXPECT_EQ(colour_of(mirror, *model_of<ConductorMaterial>(mirror).metal.reflectance), (Rgb{1, 1, 1}));
    const auto chrome = read_mitsuba_bsdf(
        "<bsdf type='roughconductor'><string name='material' value='Cr'/><float name='alphaU' value='0.1'/>"
        "<float name='alphaV' value='0.2'/><string name='distribution' value='beckmann'/></bsdf>");
    EXPECT_EQ(model_of<ConductorMaterial>(chrome).roughness.v, 0.2f);
    EXPECT_NEAR(colour_of(chrome, model_of<ConductorMaterial>(chrome).metal.k).g, 4.231365f, 1e-5f);
    EXPECT_THAT(warnings_of(chrome), testing::Not(HasSubstr("distribution")));
}

TEST(MitsubaRoughness, FollowsTheLawThatTheFileNames) {
    const auto law_of = [](const std::string& distribution) {
        const auto metal = read_mitsuba_bsdf("<bsdf type='roughconductor'>" + distribution + "</bsdf>");
        return model_of<ConductorMaterial>(metal).roughness.law;
    };
    const FacetLaw beckmann{FacetLaw::Normals::beckmann, FacetLaw::Masking::independent},
        ggx{FacetLaw::Normals::ggx, FacetLaw::Masking::independent};
    EXPECT_EQ(law_of(""), beckmann) << "Mitsuba's default";
    EXPECT_EQ(law_of("<string name='distribution' value='beckmann'/>"), beckmann);
    EXPECT_EQ(law_of("<string name='distribution' value='ggx'/>"), ggx);
    EXPECT_THAT(warnings_of(read_mitsuba_bsdf(
                    "<bsdf type='roughconductor'><string name='distribution' value='phong'/></bsdf>")),
                HasSubstr("distribution 'phong' is taken as 'ggx'"));
}

TEST(MitsubaPlastic, IsADiffuseBaseUnderACoat) {
    const auto scene = read_mitsuba_bsdf(
        "<bsdf type='roughplastic'><rgb name='diffuse_reflectance' value='.1 .2 .3'/><float name='int_ior' "
        "value='1.9'/>"
        "<float name='ext_ior' value='1'/><boolean name='nonlinear' value='true'/><string name='distribution' "
        "value='ggx'/></bsdf>");
    const auto& model = model_of<CoatedDiffuseMaterial>(scene);
    EXPECT_EQ(model.eta, 1.9f);
    EXPECT_EQ(model.roughness.u, 0.1f);
    EXPECT_TRUE(model.base_colours_repeat);
    EXPECT_FALSE(model_of<CoatedDiffuseMaterial>(read_mitsuba_bsdf("<bsdf type='plastic'/>")).base_colours_repeat);
}

// Copper is the default of version 0.6 alone.
TEST(MitsubaConductor, IsAPerfectMirrorUnlessItNamesAMetal) {
    const auto of = [](const std::string& version, const std::string& bsdf) {
        return read_as("scene.xml",
                       "<scene version='" + version + "'><shape type='sphere'>" + bsdf + "</shape></scene>");
    };
    for (const std::string type : {"conductor", "roughconductor"}) {
        for (const std::string version : {"3.0.0", "2.1.0"}) {
            const auto scene = of(version, "<bsdf type='" + type + "'/>");
            const auto& metal = model_of<ConductorMaterial>(scene).metal;
            ASSERT_TRUE(metal.reflectance.has_value());
            EXPECT_EQ(colour_of(scene, *metal.reflectance), (Rgb{1, 1, 1}));
        }
        const auto old = of("0.6.0", "<bsdf type='" + type + "'/>");
        EXPECT_EQ(colour_of(old, model_of<ConductorMaterial>(old).metal.eta), named_index("metal-Cu-eta")->rgb);
    }
    const auto own = of("3.0.0", "<bsdf type='conductor'><rgb name='eta' value='.2'/></bsdf>");
    EXPECT_EQ(colour_of(own, model_of<ConductorMaterial>(own).metal.eta), (Rgb{0.2f, 0.2f, 0.2f}));
    EXPECT_EQ(colour_of(own, model_of<ConductorMaterial>(own).metal.k), (Rgb{1, 1, 1}));
}

// All of Mitsuba's documentation. Nickel and carbon as Palik has them at 550 nm: |(n - 1 + ik) / (n + 1 + ik)|².
TEST(MitsubaConductor, KnowsAllOfMitsubasNames) {
    for (const char* name :
         {"a-C",        "Ag",       "Al",         "AlAs",     "AlAs_palik", "AlSb",     "AlSb_palik", "Au",
          "Be",         "Be_palik", "Cr",         "CsI",      "CsI_palik",  "Cu",       "Cu_palik",   "Cu2O",
          "Cu2O_palik", "CuO",      "CuO_palik",  "d-C",      "d-C_palik",  "Hg",       "Hg_palik",   "HgTe",
          "HgTe_palik", "Ir",       "Ir_palik",   "K",        "K_palik",    "Li",       "Li_palik",   "MgO",
          "MgO_palik",  "Mo",       "Mo_palik",   "Na_palik", "Nb",         "Nb_palik", "Ni_palik",   "Rh",
          "Rh_palik",   "Se",       "Se_palik",   "SiC",      "SiC_palik",  "SnTe",     "SnTe_palik", "Ta",
          "Ta_palik",   "Te",       "Te_palik",   "ThF4",     "ThF4_palik", "TiC",      "TiC_palik",  "TiN",
          "TiN_palik",  "TiO2",     "TiO2_palik", "VC",       "VC_palik",   "V_palik",  "VN",         "VN_palik",
          "W"}) {
        const auto scene = read_mitsuba_bsdf(std::string("<bsdf type='conductor'><string name='material' value='") +
                                             name + "'/></bsdf>");
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("metal"))) << name;
        EXPECT_GT(colour_of(scene, model_of<ConductorMaterial>(scene).metal.eta).g, 0) << name;
    }
    const auto green = [](const char* name) {
        const auto scene = read_mitsuba_bsdf(std::string("<bsdf type='conductor'><string name='material' value='") +
                                             name + "'/></bsdf>");
        const auto& metal = model_of<ConductorMaterial>(scene).metal;
        return fresnel_conductor(1, colour_of(scene, metal.eta), colour_of(scene, metal.k)).g;
    };
    EXPECT_NEAR(green("Ni_palik"), 0.608f, 0.01f);
    EXPECT_NEAR(green("a-C"), 0.212f, 0.01f);
}

TEST(MitsubaConductor, IsGreyRatherThanOfAWrongColour) {
    const auto scene = read_mitsuba_bsdf("<bsdf type='conductor'><string name='material' value='Unobtainium'/></bsdf>");
    EXPECT_EQ(colour_of(scene, model_of<ConductorMaterial>(scene).metal.reflectance.value()), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_THAT(warnings_of(scene), HasSubstr("the metal 'Unobtainium' is not known: grey is taken"));
}

// Scenes are read, and what is missing in them is said.
TEST(MitsubaTextures, ForNumbersAreLeftOutAndNamed) {
    const std::string checks = " type='checkerboard'><float name='color0' value='.4'/></texture>";
    for (const auto& [type, name] : {std::pair{"dielectric", "int_ior"},
                                     {"plastic", "ext_ior"},
                                     {"roughdiffuse", "alpha"},
                                     {"phong", "exponent"},
                                     {"ward", "alpha_u"},
                                     {"principled", "eta"}}) {
        const auto scene = read_mitsuba_bsdf(std::string("<bsdf type='") + type + "'><texture name='" + name + "'" +
                                             checks + "</bsdf>");
        EXPECT_THAT(warnings_of(scene), HasSubstr(std::string("'") + name + "'")) << type;
    }
}

TEST(MitsubaBlend, MixesTwo) {
    const auto scene = read_mitsuba_bsdf(
        "<bsdf type='blendbsdf'><float name='weight' value='.3'/><bsdf type='diffuse'/><bsdf "
        "type='conductor'/></bsdf>");
    const auto& model = model_of<MixtureMaterial>(scene);
    EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(scene.materials[model.second].model));
    EXPECT_EQ(colour_of(scene, model.amount).r, 0.3f);
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><bsdf type='blendbsdf'><bsdf type='diffuse'/></bsdf></shape>"),
                HasSubstr("bsdf 'blendbsdf' needs 2 bsdfs inside of it"));
}

TEST(MitsubaMixture, TakesAnyNumber) {
    const auto scene = read_mitsuba_bsdf(
        "<bsdf type='mixturebsdf'><string name='weights' value='.5, .25, .25'/>"
        "<bsdf type='diffuse'/><bsdf type='conductor'/><bsdf type='dielectric'/></bsdf>");
    const auto& outer = model_of<MixtureMaterial>(scene);
    const auto& inner = std::get<MixtureMaterial>(scene.materials[outer.first].model);
    EXPECT_NEAR(colour_of(scene, outer.amount).r, 0.25f, 1e-6f);
    EXPECT_NEAR(colour_of(scene, inner.amount).r, 1.0f / 3, 1e-6f);
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><bsdf type='mixturebsdf'><string name='weights' value='1 "
                                  "2'/><bsdf type='diffuse'/></bsdf></shape>"),
                HasSubstr("there are 2 weights for 1 bsdfs"));
}

TEST(MitsubaMaps, AreKeptWithTheInnerBsdf) {
    const MemoryFiles files{{"p.hdr", picture}};
    const std::string map =
        "<texture type='bitmap'><string name='filename' value='p.hdr'/><boolean name='raw' value='true'/></texture>";
    const auto bumpy = read_mitsuba_bsdf(
        "<bsdf type='bumpmap'>" + map + "<float name='scale' value='3'/><bsdf type='diffuse'/></bsdf>", files);
    EXPECT_EQ(bumpy.textures[material_of(bumpy).bump_map.value()].scale.r, 3);
    const auto turned = read_mitsuba_bsdf("<bsdf type='normalmap'>" + map + "<bsdf type='diffuse'/></bsdf>", files);
    ASSERT_TRUE(material_of(turned).normal_map.has_value());
    EXPECT_EQ(material_of(turned).normal_map->green, NormalMap::Green::across);
    const auto masked =
        read_mitsuba_bsdf("<bsdf type='mask'><float name='opacity' value='.25'/><bsdf type='diffuse'/></bsdf>");
    EXPECT_EQ(colour_of(masked, material_of(masked).opacity.value()).r, 0.25f);
    EXPECT_TRUE(std::holds_alternative<NoMaterial>(material_of(read_mitsuba_bsdf("<bsdf type='null'/>")).model));
}

TEST(MitsubaCoating, IsOverMetalsAndDiffuseSurfaces) {
    const auto metal = read_mitsuba_bsdf("<bsdf type='coating'><bsdf type='conductor'/></bsdf>");
    EXPECT_NEAR(model_of<CoatedConductorMaterial>(metal).coat_eta, 1.5046f / 1.000277f, 1e-5f);
    const auto matt =
        read_mitsuba_bsdf("<bsdf type='roughcoating'><float name='alpha' value='.2'/><bsdf type='diffuse'/></bsdf>");
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(matt).roughness.u, 0.2f);
}

// there, light meets the base once
TEST(MitsubaCoating, LetsNothingGoBackAndForth) {
    const auto layer = [](const std::string& more) {
        return model_of<CoatedDiffuseMaterial>(
                   read_mitsuba_bsdf("<bsdf type='coating'>" + more + "<bsdf type='diffuse'/></bsdf>"))
            .layer;
    };
    EXPECT_EQ(layer("").bounces, 1u);
    EXPECT_EQ(layer("").thickness, 0);
    EXPECT_NEAR(layer("<rgb name='sigma_a' value='.5'/><float name='thickness' value='3'/>").thickness, 1.5f, 1e-5f);
    EXPECT_EQ(
        model_of<CoatedConductorMaterial>(read_mitsuba_bsdf("<bsdf type='coating'><bsdf type='conductor'/></bsdf>"))
            .layer.bounces,
        1u);
    EXPECT_THAT(warnings_of(read_mitsuba_bsdf("<bsdf type='coating'><rgb name='sigma_a' value='1,0,0'/><bsdf "
                                              "type='diffuse'/></bsdf>")),
                HasSubstr("it absorbs as grey"));
}

TEST(MitsubaBitmap, HasItsTopRowAtVZeroOfMitsuba) {
    const auto scene = textured(
        "<texture name='reflectance' type='bitmap'><string name='filename' value='p.hdr'/>"
        "<string name='filter_type' value='nearest'/></texture>");
    EXPECT_EQ(seen(scene, {0.25f, 0.75f}), (Rgb{1, 0, 0}));  // ours counts from below
    EXPECT_EQ(seen(scene, {0.75f, 0.25f}), (Rgb{1, 1, 1}));
    // a rectangle's lower left corner has Mitsuba's (0, 0): the picture's top row
    EXPECT_EQ(mesh_of(scene).uvs[0], (Vec2{0, 1}));
}

TEST(MitsubaBitmap, IsMovedByToUv) {
    const std::string start =
        "<texture name='reflectance' type='bitmap'><string name='filename' value='p.hdr'/><string name='filterType' "
        "value='nearest'/>";
    const auto old = textured(start + "<float name='uscale' value='2'/><float name='voffset' value='.5'/></texture>");
    EXPECT_EQ(seen(old, {0.125f, 0.75f}), (Rgb{0, 0, 1}));  // Mitsuba's v = 0.25 + 0.5: the lower row
    const auto turned = textured(start + "<transform name='to_uv'><rotate z='1' angle='90'/></transform></texture>");
    // Mitsuba's (u, v) = (0.25, 0.25) becomes (-0.25, 0.25): the right one of the top row
    EXPECT_EQ(seen(turned, {0.25f, 0.75f}), (Rgb{0, 1, 0}));
    const auto scaled = textured(
        "<texture name='reflectance' type='scale'><float name='scale' value='.5'/><texture type='bitmap'>"
        "<string name='filename' value='p.hdr'/><string name='filter_type' value='nearest'/></texture></texture>");
    EXPECT_EQ(seen(scaled, {0.25f, 0.75f}), (Rgb{0.5f, 0, 0}));
}

TEST(MitsubaBitmap, WrapsAsItIsTold) {
    const auto scene = textured(
        "<texture name='reflectance' type='bitmap'><string name='filename' value='p.hdr'/>"
        "<string name='wrapModeU' value='mirror'/><string name='wrapModeV' value='zero'/></texture>");
    const auto& pattern = std::get<ImageTexture>(scene.textures[model_of<DiffuseMaterial>(scene).reflectance].pattern);
    EXPECT_EQ(pattern.wrap_u, Wrap::mirror);
    EXPECT_EQ(pattern.wrap_v, Wrap::black);
}

TEST(MitsubaCheckerboard, HasTwoSquaresPerUnit) {
    const auto scene = textured(
        "<texture name='reflectance' type='checkerboard'><rgb name='color0' value='1 0 0'/><rgb name='color1' value='0 "
        "0 1'/></texture>");
    EXPECT_EQ(seen(scene, {0.25f, 0.75f}), (Rgb{1, 0, 0}));  // Mitsuba's (0.25, 0.25)
    EXPECT_EQ(seen(scene, {0.75f, 0.75f}), (Rgb{0, 0, 1}));
    EXPECT_EQ(seen(scene, {0.75f, 0.25f}), (Rgb{1, 0, 0}));
    EXPECT_THAT(warnings_of(textured("<texture name='reflectance' type='wood'/>")),
                HasSubstr("texture 'wood' is not supported: grey is taken"));
}

// Each blends the one before with `other`; with itself if there is none.
std::string blends(const std::string& other) {
    std::string chain = "<bsdf type='diffuse' id='b0'/>";
    for (int i = 1; i <= 200; ++i) {
        const auto n = std::to_string(i), before = "b" + std::to_string(i - 1);
        chain += "<bsdf type='blendbsdf' id='b" + n + "'><ref id='" + before + "'/><ref id='" +
                 (other.empty() ? before : other) + "'/></bsdf>";
    }
    return chain;
}

TEST(MitsubaBsdfs, MayBeNestedButNotForEver) {
    EXPECT_THAT(errors_of_mitsuba(blends("b0") + "<shape type='sphere'><ref id='b200'/></shape>"),
                HasSubstr("bsdfs are nested too deeply"));
    EXPECT_EQ(errors_of_mitsuba(blends("b0") + "<shape type='sphere'><ref id='b60'/></shape>"), "");
    EXPECT_THAT(errors_of_mitsuba(blends("") + "<shape type='sphere'><ref id='b60'/></shape>"),
                HasSubstr("mixed from more than 1024 materials"))
        << "each doubles what is below";
}

TEST(MitsubaMaterials, KnowDielectricsInAnyCase) {
    const auto eta = [](const std::string& name) {
        const auto scene =
            read_mitsuba_bsdf("<bsdf type='dielectric'><string name='int_ior' value='" + name + "'/></bsdf>");
        return std::get<DielectricMaterial>(scene.materials[scene.shapes[0].material].model).eta;
    };
    EXPECT_EQ(eta("Water"), eta("water"));
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><bsdf type='dielectric'><string name='int_ior' value='Wader'/>"
                                  "</bsdf></shape>"),
                HasSubstr("there is no dielectric 'Wader' (did you mean 'water'?)"));
}

TEST(MitsubaMaterials, TakeRawNumbers) {
    const auto colour = [](const std::string& value) {
        const auto scene = read_mitsuba_bsdf("<bsdf type='diffuse'><texture name='reflectance' type='rawconstant'>" +
                                             value + "</texture></bsdf>");
        return colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance);
    };
    EXPECT_EQ(colour("<float name='value' value='.3'/>"), (Rgb{0.3f, 0.3f, 0.3f}));
    EXPECT_EQ(colour("<vector name='value' x='.1' y='.2' z='.3'/>"), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><bsdf type='diffuse'><texture name='reflectance' "
                                  "type='rawconstant'/></bsdf></shape>"),
                HasSubstr("needs a 'value'"));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_materials_reader_test
