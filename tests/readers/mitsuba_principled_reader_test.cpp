// Mitsuba's principled materials, held to its formulas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_principled_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;

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
    EXPECT_TRUE(scene.materials[scene.shapes[0].material].one_sided);
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

// A texture of one colour says what the number says.
TEST(MitsubaPrincipled, TakesTexturesForItsSpecularAndItsGrooves) {
    const auto even = [](const std::string& name, float value) {
        return "<texture type='checkerboard' name='" + name + "'>" + number("color0", value) + number("color1", value) +
               "</texture>";
    };
    const Vec3 up{0, 0, 1}, out = normalize({0.4f, 0.2f, 1});
    for (const std::string name : {"specular", "anisotropic"})
        for (const float value : {0.0f, 0.3f, 1.0f}) {
            const Rgb by_number = principled("principled", number(name.c_str(), value)).evaluate(out, up, lobe::all);
            const Rgb by_texture = principled("principled", even(name, value)).evaluate(out, up, lobe::all);
            EXPECT_NEAR(by_texture.r, by_number.r, 1e-4f * by_number.r) << name << ' ' << value;
        }
    EXPECT_NE(principled("principled", number("specular", 1)).evaluate(out, up, lobe::all),
              principled("principled", number("specular", 0.3f)).evaluate(out, up, lobe::all));
    const auto scene = read_mitsuba_bsdf("<bsdf type='principled'>" + even("specular", 0.5f) + "</bsdf>");
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("specular")));
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

}  // namespace
}  // namespace lightnet::test::mitsuba_principled_reader_test
