// Mitsuba's bsdfs, textures and colours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/readers/spectra.hpp"
#include "core/scene/bsdf/bsdf.hpp"
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

Rgb radiance(const std::string& colour) {
    return read_mitsuba("<shape type='sphere'><emitter type='area'>" + colour + "</emitter></shape>")
        .shapes[0]
        .emission->radiance;
}

void expect_near(Rgb got, Rgb wanted, float share) {
    EXPECT_NEAR(got.r, wanted.r, share * wanted.r);
    EXPECT_NEAR(got.g, wanted.g, share * wanted.g);
    EXPECT_NEAR(got.b, wanted.b, share * wanted.b);
}

// By the CIE's tables of 1931 alone.
TEST(MitsubaColours, OfLightAreSeenWithoutDaylight) {
    const Rgb flat{1.2048f, 0.9483f, 0.9087f};
    for (const std::string table :
         {"<spectrum name='radiance' value='360:1, 830:1'/>",
          "<spectrum name='radiance' type='irregular'><string name='wavelengths' value='360, 830'/>"
          "<string name='values' value='1, 1'/></spectrum>",
          "<spectrum name='radiance' type='regular'><string name='values' value='1, 1'/></spectrum>",
          "<spectrum name='radiance' type='uniform'/>"})
        expect_near(radiance(table), flat, 0.01f);
    // the lamp of Mitsuba's Cornell box
    const Rgb lamp = radiance("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>");
    EXPECT_NEAR(lamp.r / lamp.g, 1.891f, 0.02f);
    EXPECT_NEAR(lamp.b / lamp.g, 0.2533f, 0.003f);
    for (const std::string grey : {"<spectrum name='radiance' value='3'/>", "<rgb name='radiance' value='3'/>",
                                   "<spectrum name='radiance' type='d65'><float name='scale' value='3'/></spectrum>"})
        EXPECT_EQ(radiance(grey), (Rgb{3, 3, 3}));
}

TEST(MitsubaColours, OfEveryEmitterAreLight) {
    const Rgb flat{1.2048f, 0.9483f, 0.9087f};
    const MemoryFiles files{{"flat.spd", "360 1\n830 1\n"}};
    const auto emitter = [&](const std::string& type, const std::string& name) {
        return read_mitsuba("<shape type='sphere'/><emitter type='" + type + "'><spectrum name='" + name +
                                "' filename='flat.spd'/></emitter>",
                            files);
    };
    expect_near(std::get<PointLight>(emitter("point", "intensity").lights.at(0)).intensity, flat, 0.01f);
    expect_near(std::get<SpotLight>(emitter("spot", "intensity").lights.at(0)).intensity, flat, 0.01f);
    expect_near(std::get<DirectionalLight>(emitter("directional", "irradiance").lights.at(0)).irradiance, flat, 0.01f);
    expect_near(emitter("constant", "radiance").environments.at(0).radiance, flat, 0.01f);
    // in a texture of light, and in the same one of a surface
    const auto both = read_mitsuba(
        "<texture type='checkerboard' id='t'><spectrum name='color0' value='360:.5, 830:.5'/></texture>"
        "<shape type='sphere'><bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf>"
        "<emitter type='area'><ref name='radiance' id='t'/></emitter></shape>");
    const auto first = [&](TextureId id) {
        return colour_of(both, std::get<CheckerTexture>(both.textures[id].pattern).even);
    };
    expect_near(first(*both.shapes[0].emission->texture), flat * 0.5f, 0.01f);
    expect_near(first(model_of<DiffuseMaterial>(both).reflectance), {0.5f, 0.5f, 0.5f}, 0.01f);
}

TEST(MitsubaColours, AreNothingBeyondTheirTables) {
    const Rgb red = reflectance("<spectrum name='reflectance' value='620:.5, 760:.5'/>");
    EXPECT_GT(red.r, 0.2f);
    EXPECT_LT(red.g, 0.05f);
    const Rgb line = radiance("<spectrum name='radiance' value='585:1, 595:1'/>");
    EXPECT_LT(luminance(line), 0.1f);
    EXPECT_GT(luminance(line), 0.05f);
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

TEST(MitsubaPrincipled, TakesBurleysParameters) {
    const auto scene = read_mitsuba_bsdf(
        "<bsdf type='principled'><rgb name='base_color' value='1 .5 .25'/><float name='roughness' value='.4'/>"
        "<float name='metallic' value='.7'/><float name='specular' value='.5'/><float name='clearcoat' value='1'/>"
        "<float name='clearcoat_gloss' value='1'/><float name='spec_trans' value='0'/></bsdf>");
    const auto& model = model_of<BurleyMaterial>(scene);
    EXPECT_EQ(colour_of(scene, model.metallic).r, 0.7f);
    EXPECT_NEAR(colour_of(scene, model.eta).r, 1.5f, 1e-5f);
    EXPECT_EQ(model.roughness.u, 0.4f);
    EXPECT_EQ(model.roughness.means, Roughness::Means::square);
    EXPECT_EQ(colour_of(scene, model.coat).r, 1);
    EXPECT_EQ(colour_of(scene, model.gloss).r, 1);
    EXPECT_TRUE(material_of(scene).one_sided);
    EXPECT_FALSE(model.thin);
}

Bsdf principled(const std::string& type, const std::string& parameters) {
    const auto scene = read_mitsuba_bsdf("<bsdf type='" + type + "'>" + parameters + "</bsdf>");
    const Frame frame = Frame::around({0, 0, 1});
    return {frame, frame.z, model_of<BurleyMaterial>(scene).at({scene.textures, {}, {}})};
}

std::string number(const char* name, float value) {
    return std::string("<float name='") + name + "' value='" + std::to_string(value) + "'/>";
}

/// Share of even light that is reflected to a viewer at an angle whose cosine is given.
double albedo(const Bsdf& bsdf, float cosine) {
    const Vec3 out{std::sqrt(1 - cosine * cosine), 0, cosine};
    double sum = 0;
    constexpr int rows = 256, columns = 512;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const float z = (float(i) + 0.5f) / rows, turn = 6.2831853f * (float(j) + 0.5f) / columns,
                        sine = std::sqrt(1 - z * z);
            sum += double(
                bsdf.evaluate(out, {sine * std::cos(turn), sine * std::sin(turn), z}, lobe::diffuse | lobe::glossy).g);
        }
    return sum * 2 * 3.14159265358979 / (rows * columns);
}

const std::string black = "<rgb name='base_color' value='0'/>";
constexpr float slanted = 0.4472136f;  // cosine of 63.4°

// The reflected shares of Disney's sheen, by quadrature of sheen × (1 - cos d)⁵ × cos.
TEST(MitsubaPrincipled, HasDisneysSheen) {
    const auto sheen = principled("principled", black + number("specular", 0) + number("sheen", 1));
    EXPECT_NEAR(albedo(sheen, slanted), 0.0195, 0.0003);
    EXPECT_NEAR(albedo(sheen, 1), 0.00026, 0.00003);
    const auto thin = principled("principledthin", black + number("sheen", 1) + number("diff_trans", 1));
    EXPECT_NEAR(albedo(thin, slanted), 0.0195 / 2, 0.0003);
}

TEST(MitsubaPrincipled, ReflectsNothingWithoutSpecular) {
    for (const auto& none : {number("specular", 0), number("eta", 1)})
        for (const float cosine : {1.0f, slanted, 0.05f}) {
            EXPECT_EQ(albedo(principled("principled", black + none), cosine), 0);
        }
}

// Mitsuba's formulas (3.5, src/bsdfs/principled.cpp) for the light from straight above to a viewer at 60°: the facet
// lies at 30°, and all of this by hand.
TEST(MitsubaPrincipled, FollowsMitsubasFormulas) {
    const Vec3 out{std::sqrt(0.75f), 0, 0.5f}, up{0, 0, 1};
    const float weight = std::pow(0.5f, 5.0f), d = std::cos(3.14159265f / 6), pi = 3.14159265f;
    const auto value = [&](const std::string& parameters, const std::string& type = "principled") {
        return principled(type, parameters).evaluate(out, up, lobe::diffuse | lobe::glossy).g;
    };
    const std::string white = "<rgb name='base_color' value='1'/>", flat = number("specular", 0);
    const float back = 2 * 0.5f * d * d;
    EXPECT_NEAR(value(white + flat), (1 - weight / 2 + back * weight) / pi, 1e-5f);
    const float below = 1 + (back / 2 - 1) * weight, subsurface = 1.25f * (below * (1 / 1.5f - 0.5f) + 0.5f);
    EXPECT_NEAR(value(white + flat + number("flatness", 1)), subsurface / pi, 1e-5f);
    EXPECT_NEAR(value(white + number("flatness", 1) + number("diff_trans", .5f), "principledthin"),
                subsurface * 0.75f / pi, 1e-5f);
    // GTR1 of α = .1 and the masking of α = .25
    const float a2 = 0.01f, density = (a2 - 1) / (pi * std::log(a2) * (1 + (a2 - 1) * d * d));
    const float seen = 2 / (1 + std::sqrt(1 + 0.0625f * 3));
    const float fresnel = 0.04f + 0.96f * std::pow(1 - d, 5.0f);
    EXPECT_NEAR(value(black + flat + number("clearcoat", 1)), 0.25f * fresnel * density * seen, 1e-5f);
    // GGX of α = .25, seen from 60° and from above
    const float alpha2 = 0.0625f, slope = 1 + (alpha2 - 1) * d * d;
    const float ggx = alpha2 / (pi * slope * slope) * (2 / (1 + std::sqrt(1 + alpha2 * 3))) / (4 * 0.5f);
    EXPECT_NEAR(value(black + number("specular", 0.5f)), fresnel_dielectric(d, 1.5f) * ggx, 1e-5f);
    EXPECT_NEAR(value("<rgb name='base_color' value='.5'/>" + number("metallic", 1)),
                (0.5f + 0.5f * std::pow(1 - d, 5.0f)) * ggx, 1e-5f);
    const float tinted = 0.04f + 0.96f * std::pow(1 - d, 5.0f);  // of a grey base, whose hue is white
    EXPECT_NEAR(value("<rgb name='base_color' value='.5'/>" + number("spec_tint", 1)) -
                    value("<rgb name='base_color' value='.5'/>" + flat),
                tinted * ggx, 1e-5f);
}

TEST(MitsubaPrincipled, TakesTexturesForItsNumbers) {
    const std::string checks = " type='checkerboard'><float name='color0' value='.4'/></texture>";
    for (const auto& [type, name] : {std::pair{"principled", "metallic"},
                                     {"principled", "flatness"},
                                     {"principled", "clearcoat"},
                                     {"principled", "sheen"},
                                     {"principled", "spec_tint"},
                                     {"principledthin", "diff_trans"},
                                     {"principledthin", "eta"},
                                     {"principledthin", "spec_trans"}}) {
        const auto scene = read_mitsuba_bsdf(std::string("<bsdf type='") + type + "'><texture name='" + name + "'" +
                                             checks + "</bsdf>");
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr(name))) << type;
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
    EXPECT_TRUE(material_of(turned).normal_map.has_value());
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

}  // namespace
}  // namespace lightnet::test::mitsuba_materials_reader_test
