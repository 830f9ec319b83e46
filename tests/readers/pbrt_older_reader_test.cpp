// Scenes of pbrt-v3: how they are told from those of pbrt-v4, and what they mean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/math/samples.hpp"
#include "core/readers/pbrt/older_materials.hpp"
#include "core/scene/bare_lights/slide_light.hpp"
#include "core/scene/camera/camera.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_older_reader_test {
namespace {

using pbrt::older_alpha;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr float pi = std::numbers::pi_v<float>;

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-4f) << a.x << ' ' << a.y << ' ' << a.z; }
void expect_near(Rgb a, Rgb b, float by) {
    expect_near(Vec3{a.r, a.g, a.b} / by * 1e-4f, Vec3{b.r, b.g, b.b} / by * 1e-4f);
}

/// Of version 3, by its film.
SceneData older(const std::string& statements, MemoryFiles files = {}) {
    return read_text("Film \"image\" WorldBegin\n" + statements + "\nWorldEnd", std::move(files));
}

/// What is said of it beside its version.
std::string others(const SceneData& scene) {
    SceneData rest = scene;
    std::erase_if(rest.warnings,
                  [](const Problem& p) { return p.what.find("is read as one of pbrt-v3") != std::string::npos; });
    EXPECT_EQ(rest.warnings.size() + 1, scene.warnings.size());
    return warnings_of(rest);
}

/// The material on a triangle in the xy plane, seen from +z.
struct Looked {
    explicit Looked(const std::string& material, MemoryFiles files = {})
        : data(older(material + "\n" + triangle, std::move(files))), scene(data) {}
    Bsdf bsdf() const { return scene.bsdf(scene.surface(Query{.primitive = 0, .u = 0.25f, .v = 0.25f})); }
    Rgb value(Vec3 out, Vec3 in) const { return bsdf().evaluate(normalize(out), normalize(in), lobe::all); }
    /// All that comes back of light from everywhere.
    Rgb furnace(Vec3 out) const {
        Rgb sum;
        const Bsdf here = bsdf();
        constexpr int many = 1 << 14;
        for (int i = 0; i < many; ++i) {
            Samples samples(7, std::uint32_t(i));
            const float choice = samples.next();
            if (const auto sample = here.sample(normalize(out), choice, samples.next_2d(), lobe::all))
                sum += sample->weight;
        }
        return sum / many;
    }

    SceneData data;
    Scene scene;
};

TEST(PbrtVersions, AreToldByTheFirstWordThatOnlyOneOfThemHas) {
    for (const std::string text :
         {"Film \"image\" WorldBegin", "Sampler \"02sequence\" WorldBegin", "WorldBegin Material \"matte\"",
          "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"uber\"", "WorldBegin WorldEnd",
          "WorldBegin Texture \"t\" \"color\" \"constant\"", "Camera \"environment\" WorldBegin",
          "WorldBegin Shape \"cone\"", "SurfaceIntegrator \"path\" WorldBegin",
          "WorldBegin LightSource \"point\" \"xyz I\" [ 1 1 1 ]", "Film \"image\" WorldBegin # Material \"diffuse\""}) {
        const auto scene = read_text(text);
        ASSERT_THAT(scene.warnings, Not(IsEmpty())) << text;
        EXPECT_THAT(warnings_of(scene),
                    HasSubstr("scene.pbrt:1: the scene is read as one of pbrt-v3, of which only that says"))
            << text;
    }
    for (const std::string text :
         {"WorldBegin", "Film \"rgb\" WorldBegin Shape \"sphere\"", "Sampler \"zsobol\" WorldBegin",
          "WorldBegin Material \"diffuse\"", "WorldBegin # Material \"matte\""})
        EXPECT_THAT(read_text(text).warnings, IsEmpty()) << text;
    EXPECT_THAT(errors_of("Film \"rgb\" WorldBegin Material \"matte\""), HasSubstr("unknown material 'matte'"));
    EXPECT_THAT(errors_of("Film \"image\" WorldBegin Material \"diffuse\""), HasSubstr("unknown material 'diffuse'"));
}

TEST(PbrtVersions, AreLookedForInFilesThatAreIncluded) {
    const MemoryFiles files{{"lib/a.pbrt", "Include \"lib/b.pbrt\""}, {"lib/b.pbrt", "\nMaterial \"matte\""}};
    const auto scene = read_world("Include \"lib/a.pbrt\" " + triangle, files);
    EXPECT_THAT(
        warnings_of(scene),
        HasSubstr("lib/b.pbrt:2: the scene is read as one of pbrt-v3, of which only that says Material 'matte'"));
    const MemoryFiles circle{{"a.pbrt", "Include \"a.pbrt\""}};
    EXPECT_THAT(errors_of_world("Include \"a.pbrt\"", circle), HasSubstr("includes itself"));
}

TEST(OlderPbrt, HasItsOwnFilm) {
    const auto scene = read_text(
        "Camera \"perspective\" \"float halffov\" 20 \"float shutterclose\" 0 Film \"image\" \"float scale\" "
        "3\nWorldBegin");
    EXPECT_EQ(scene.film.width, 640u);
    EXPECT_EQ(scene.film.height, 480u);
    EXPECT_EQ(scene.film.scale, 3);
    EXPECT_EQ(scene.camera.fov, 40);
    EXPECT_EQ(older("").film.scale, 1);
}

TEST(OlderPbrt, LooksAroundFromAnEnvironmentCamera) {
    const auto scene = read_text("Camera \"environment\" WorldBegin");
    expect_near(Camera(scene.camera, 8, 4).ray(2, 2).direction, {0, 0, 1});
    expect_near(Camera(scene.camera, 8, 4).ray(0, 2).direction, {1, 0, 0});
}

TEST(OlderPbrt, EndsWithItsWorld) {
    const auto scene = read_text("Film \"image\" WorldBegin " + triangle + "WorldEnd\nWorldBegin " + ball + "WorldEnd");
    EXPECT_THAT(scene.shapes, SizeIs(1));
    EXPECT_THAT(warnings_of(scene), HasSubstr("scene.pbrt:3: what stands behind the first WorldEnd is left out"));
    EXPECT_THAT(errors_of("Film \"image\" WorldBegin AttributeBegin WorldEnd"),
                HasSubstr("this block is never closed"));
}

TEST(OlderPbrt, TakesParametersByTheirTypes) {
    const auto scene = older("LightSource \"point\" \"float scale\" 5 \"color I\" [ 1 2 3 ]");
    EXPECT_EQ(std::get<PointLight>(scene.lights.at(0)).intensity, (Rgb{1, 2, 3}));
    EXPECT_THAT(others(scene), HasSubstr("parameter 'scale' is of type float, not rgb, and has no effect"));
    const auto bright =
        older("LightSource \"point\" \"rgb scale\" [ 2 2 .5 ] \"color I\" [ 1 2 3 ] \"integer nsamples\" 4");
    EXPECT_EQ(std::get<PointLight>(bright.lights.at(0)).intensity, (Rgb{2, 4, 1.5f}));
    EXPECT_EQ(others(bright), "");
    const auto mesh = older(
        "Shape \"trianglemesh\" \"point P\" [ 0 0 0 1 0 0 0 1 0 ] \"float uv\" [ 0 0 1 0 0 1 ] \"integer indices\" [ 0 "
        "1 2 ]");
    EXPECT_THAT(mesh_of(mesh).uvs, SizeIs(3));
    EXPECT_EQ(others(mesh), "");
}

TEST(OlderPbrt, HasLightsAsBrightAsTheirNumbers) {
    const auto radiance = [](const std::string& l) {
        return older("LightSource \"infinite\" " + l).environments.at(0).radiance;
    };
    // the white that is equal at all wavelengths
    expect_near(radiance("\"spectrum L\" [ 300 2 900 2 ]"), Rgb{1.205f, 0.948f, 0.909f} * 2, 0.02f);
    // D65 in XYZ
    expect_near(radiance("\"xyz L\" [ .9505 1 1.089 ]"), Rgb{1, 1, 1}, 0.001f);
    // of 1 at the brightest wavelength, which at 5270 K is that to which the eye is about most sensitive
    const Rgb warm = radiance("\"blackbody L\" [ 5270 3 ]");
    EXPECT_GT(luminance(warm), 2.8f);
    EXPECT_LT(luminance(warm), 3.0f);
    EXPECT_GT(warm.r, 1.2f * warm.b);
    EXPECT_THAT(errors_of("Film \"image\" WorldBegin LightSource \"infinite\" \"blackbody L\" 6500"),
                HasSubstr("needs a temperature above 0, in kelvin, and a scale"));
}

/// The mean flux of what all its lights send out.
float power_of(const Scene& scene) {
    double sum = 0;
    constexpr std::uint32_t many = 1 << 14;
    for (std::uint32_t i = 0; i < many; ++i) {
        Samples samples(9, i);
        const float choice = samples.next();
        const Vec2 place = samples.next_2d();
        if (const auto sent = scene.lights().emit(choice, place, samples.next_2d())) sum += sent->flux.g;
    }
    return float(sum / many);
}

TEST(OlderPbrt, HasSpotsThatFallOffWithTheFourthPower) {
    const auto scene =
        older("LightSource \"spot\" \"float coneangle\" 60 \"float conedeltaangle\" 60 \"rgb I\" [ 2 2 2 ] " + ball);
    const auto& spot = std::get<SpotLight>(scene.lights.at(0));
    EXPECT_EQ(spot.falloff, SpotLight::Falloff::fourth_power);
    // cos 60° = 1/2: t = (cos a - 1/2) · 2; ∫ t⁴ over the cone is 2π · 1/2 · 1/5
    EXPECT_NEAR(power_of(Scene(scene)), 2 * 2 * pi / 10, 0.02f);
    const float cosine = std::cos(0.5f), t = (cosine - 0.5f) * 2;
    const auto seen =
        Scene(scene).lights().sample(LitPoint(Vec3{std::sin(0.5f), 0, cosine} * 5.0f), 0.5f, {0.5f, 0.5f});
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->radiance.g, 2 * t * t * t * t / 25, 1e-4f);
}

/// A picture by latitude and longitude of 4 x 2 pixels, each of another red.
std::string sky() {
    std::string file = "#?RADIANCE\n\n-Y 2 +X 4\n";
    for (int i = 0; i < 8; ++i) file += {char(16 * (i + 1)), 0, 0, char(0x81)};
    return file;
}

// z is up; the picture begins at x and goes on to y: the middle of pixel i of the lower row lies at φ = (i + 1/2) 90°.
TEST(OlderPbrt, LaysTheSkyByLatitudeAndLongitude) {
    const MemoryFiles files{{"sky.hdr", sky()}};
    for (const bool turned : {false, true}) {
        const auto data =
            older(std::string(turned ? "Rotate 90 0 0 1 " : "") +
                      "LightSource \"infinite\" \"string mapname\" \"sky.hdr\" \"rgb L\" [ 2 2 2 ] " + ball,
                  files);
        EXPECT_EQ(others(data), "");
        const Scene scene(data);
        for (int i = 0; i < 4; ++i)
            for (const float z : {1.0f, -1.0f}) {
                const float phi = (float(i) + 0.5f) * pi / 2 + (turned ? pi / 2 : 0);
                const Vec3 direction = normalize({std::cos(phi), std::sin(phi), z});
                const Ray ray{{}, direction};
                SkyRadiance seen;
                scene.lights().look_at_sky({&ray, 1}, {&seen, 1});
                EXPECT_NEAR(seen.radiance.r, 2 * 16 * float((z > 0 ? 0 : 4) + i + 1) / 128, 0.01f) << i << ' ' << z;
            }
    }
}

// y is up; the picture begins at x and goes on to z.
TEST(OlderPbrt, LaysGoniogramsByLatitudeAndLongitude) {
    const MemoryFiles files{{"sky.hdr", sky()}};
    const Scene scene(
        older("LightSource \"goniometric\" \"string mapname\" \"sky.hdr\" \"rgb I\" [ 4 1 1 ] " + ball, files));
    for (int i = 0; i < 4; ++i)
        for (const float y : {1.0f, -1.0f}) {
            const float phi = (float(i) + 0.5f) * pi / 2;
            const auto seen =
                scene.lights().sample(LitPoint(Vec3{std::cos(phi), y, std::sin(phi)}), 0.5f, {0.5f, 0.5f});
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->radiance.r, 4 * 16 * float((y > 0 ? 0 : 4) + i + 1) / 128 / 2, 0.02f);
        }
}

TEST(OlderPbrt, ProjectsTheFirstRowOfPicturesDownwards) {
    const auto data = older("LightSource \"projection\" \"string mapname\" \"sky.hdr\" " + ball, {{"sky.hdr", sky()}});
    const SlideLight slide(std::get<SpotLight>(data.lights.at(0)));  // of 45°, twice as wide as high
    const float half = std::tan(pi / 8);
    EXPECT_NEAR(slide.towards(normalize({-1.5f * half, -0.5f * half, 1})).r, 16.0f / 128, 1e-3f);
    EXPECT_NEAR(slide.towards(normalize({1.5f * half, 0.5f * half, 1})).r, 1, 1e-3f);
}

TEST(OlderPbrt, MakesAlphaOfRoughnessByAPolynomial) {
    EXPECT_NEAR(older_alpha(1), 1.62142f, 1e-5f);
    EXPECT_NEAR(older_alpha(0.1f), 0.46176f, 1e-4f);
    EXPECT_NEAR(older_alpha(0), older_alpha(0.001f), 1e-6f);
    const auto metal = older("Material \"metal\" \"float roughness\" .1 " + ball);
    EXPECT_NEAR(model_of<ConductorMaterial>(metal).roughness.u, 0.46176f, 1e-4f);
    const auto plain = older(
        "Material \"metal\" \"float uroughness\" .2 \"float vroughness\" .3 \"bool remaproughness\" \"false\" " + ball);
    EXPECT_FLOAT_EQ(model_of<ConductorMaterial>(plain).roughness.u, 0.2f);
    EXPECT_FLOAT_EQ(model_of<ConductorMaterial>(plain).roughness.v, 0.3f);
}

TEST(OlderPbrt, MapsPicturesOfRoughnessToo) {
    const MemoryFiles files{{"r.hdr", std::string("#?RADIANCE\n\n-Y 1 +X 1\n\x80\x80\x80\x80", 27)}};
    const auto scene = older(
        "Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"r.hdr\"\nMaterial \"metal\" \"texture roughness\" "
        "\"r\" " +
            ball,
        files);
    const auto& rough = model_of<ConductorMaterial>(scene).roughness;
    EXPECT_NEAR(look_up(scene.textures, rough.texture.value(), {{0.5f, 0.5f}}).r, older_alpha(0.5f), 1e-4f);
    EXPECT_EQ(others(scene), "");
}

TEST(OlderMaterials, AreMattBySigma) {
    const Looked matt("Material \"matte\" \"rgb Kd\" [ .2 .4 .6 ]");
    EXPECT_EQ(others(matt.data), "");
    expect_near(matt.value({0, 0, 1}, {0, 0, 1}), Rgb{0.2f, 0.4f, 0.6f} / pi, 1e-4f);
    const auto rough = older("Material \"matte\" \"float sigma\" 30 " + ball);
    EXPECT_NEAR(model_of<DiffuseMaterial>(rough).sigma, pi / 6, 1e-6f);
    EXPECT_THAT(others(rough), HasSubstr("Oren and Nayar"));
}

/// Facets of glass from outside: D F G / (4 cos), by a dielectric that lets nothing in.
Rgb facets_of_glass(float eta, float alpha, Vec3 out, Vec3 in) {
    const DielectricBsdf glass{eta, {alpha, alpha}};
    return glass.evaluate(normalize(out), normalize(in), lobe::all).value;
}

TEST(OlderMaterials, OfPlasticAddFacetsToMatt) {
    for (const auto& [kd, ks] : {std::pair{0.25f, 0.25f}, std::pair{0.9f, 0.8f}, std::pair{0.1f, 1.0f}}) {
        const std::string d = std::to_string(kd), s = std::to_string(ks);
        const Looked plastic("Material \"plastic\" \"rgb Kd\" [ " + d + ' ' + d + ' ' + d + " ] \"rgb Ks\" [ " + s +
                             ' ' + s + ' ' + s + " ] \"float roughness\" .2 \"bool remaproughness\" \"false\"");
        EXPECT_EQ(others(plastic.data), "");
        for (const Vec3 in : {Vec3{0, 0, 1}, Vec3{-0.6f, 0, 1}, Vec3{1, 1, 0.3f}}) {
            const Vec3 out{0.5f, 0, 1};
            const float matt = kd / pi * normalize(in).z, shine = ks * facets_of_glass(1.5f, 0.2f, out, in).g;
            EXPECT_NEAR(plastic.value(out, in).g, matt + shine, 2e-3f * (matt + shine) + 1e-6f) << kd;
        }
    }
}

TEST(OlderMaterials, OfGlassAreClearOrRough) {
    const auto clear = older("Material \"glass\" \"rgb Kr\" [ .5 .5 .5 ] \"float index\" 1.4 " + ball);
    const auto& glass = model_of<DielectricMaterial>(clear);
    EXPECT_FLOAT_EQ(glass.eta, 1.4f);
    EXPECT_EQ(colour_of(clear, glass.reflected.value()), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_FALSE(glass.transmitted);
    EXPECT_EQ(glass.roughness.u, 0);
    const auto rough =
        older("Material \"glass\" \"float uroughness\" .1 \"float vroughness\" .1 \"float eta\" 1.6 " + ball);
    EXPECT_NEAR(model_of<DielectricMaterial>(rough).roughness.v, 0.46176f, 1e-4f);
    EXPECT_FLOAT_EQ(model_of<DielectricMaterial>(rough).eta, 1.6f);
    EXPECT_EQ(others(rough), "");
}

TEST(OlderMaterials, OfMirrorsReflectTheSameFromEverywhere) {
    const Looked mirror("Material \"mirror\"");
    for (const Vec3 out : {Vec3{0, 0, 1}, Vec3{1, 0, 0.2f}})
        expect_near(mirror.furnace(out), Rgb{0.9f, 0.9f, 0.9f}, 1e-3f);
    EXPECT_EQ(others(mirror.data), "");
}

// Head-on: Kd + Kr F + Kt (1 - F) / η² with F = 0.04, and facets of Ks, of which a few per cent come back.
TEST(OlderMaterials, OfUberAddAll) {
    const Looked uber(
        "Material \"uber\" \"rgb Kd\" [ .3 .3 .3 ] \"rgb Ks\" [ 0 0 0 ] \"rgb Kr\" [ .5 .5 .5 ] \"rgb Kt\" [ .2 .2 .2 "
        "]");
    EXPECT_EQ(others(uber.data), "");
    const float expected = 0.3f + 0.5f * 0.04f + 0.2f * 0.96f / 2.25f;
    EXPECT_NEAR(uber.furnace({0, 0, 1}).g, expected, 0.003f);
    const auto opaque = older("Material \"uber\" " + ball);
    EXPECT_FALSE(opaque.materials.at(opaque.shapes[0].material).opacity);
    const auto half = older("Material \"uber\" \"rgb opacity\" [ .5 .5 .5 ] " + ball);
    EXPECT_EQ(colour_of(half, half.materials.at(half.shapes[0].material).opacity.value()), (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(OlderMaterials, OfTranslucentSheetsShineThrough) {
    const Looked sheet(
        "Material \"translucent\" \"rgb Kd\" [ .8 .8 .8 ] \"rgb Ks\" [ 0 0 0 ] \"rgb reflect\" [ .25 .25 .25 ] \"rgb "
        "transmit\" [ .5 .5 .5 ]");
    expect_near(sheet.value({0, 0, 1}, {0, 0, 1}), Rgb{1, 1, 1} * (0.2f / pi), 1e-4f);
    expect_near(sheet.value({0, 0, 1}, {0, 0, -1}), Rgb{1, 1, 1} * (0.4f / pi), 1e-4f);
    EXPECT_EQ(others(sheet.data), "");
}

TEST(OlderMaterials, MixByTheShareOfTheFirst) {
    const Looked mix(
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" \"rgb Kd\" [ 1 1 1 ] MakeNamedMaterial \"b\" \"string "
        "type\" \"matte\" \"rgb Kd\" [ 0 0 0 ] "
        "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" [ .8 .8 .8 ]");
    EXPECT_NEAR(mix.value({0, 0, 1}, {0, 0, 1}).g, 0.8f / pi, 1e-5f);
    EXPECT_EQ(others(mix.data), "");
}

TEST(OlderMaterials, HaveBumps) {
    const auto scene = older(
        "Texture \"b\" \"float\" \"constant\" \"float value\" .5 Material \"plastic\" \"texture bumpmap\" \"b\" " +
        ball);
    for (const auto& material : scene.materials)
        if (std::holds_alternative<ConductorMaterial>(material.model)) {
            EXPECT_TRUE(material.bump_map);
        }
}

TEST(OlderMaterials, ThatAreReplacedAreNamed) {
    for (const std::string type : {"substrate", "disney", "subsurface", "kdsubsurface", "measured", "shinymetal"})
        EXPECT_THAT(others(older("Material \"" + type + "\" " + ball)), Not(IsEmpty())) << type;
    const auto gold = older("Material \"fourier\" \"string bsdffile\" \"bsdfs/roughgold_alpha_0.2.bsdf\" " + ball);
    EXPECT_FLOAT_EQ(model_of<ConductorMaterial>(gold).roughness.u, 0.2f);
    EXPECT_THAT(others(gold), HasSubstr("'roughgold_alpha_0.2' is taken as rough gold, by its name"));
    EXPECT_THAT(errors_of("Film \"image\" WorldBegin Material \"mate\""),
                HasSubstr("unknown material 'mate' (did you mean 'matte'?)"));
}

TEST(OlderTextures, ScaleBothAlike) {
    const auto scene = older(
        "Texture \"t\" \"color\" \"scale\" \"color tex1\" [ .5 1 .25 ] \"color tex2\" [ .5 .5 1 ] Material \"matte\" "
        "\"texture Kd\" \"t\" " +
        ball);
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.25f, 0.5f, 0.25f}));
}

TEST(OlderTextures, ThatAreNotThereAreAsIfNotGiven) {
    const auto scene = older("Material \"matte\" \"texture Kd\" \"none\" \"texture sigma\" \"none\" " + ball);
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_THAT(others(scene), HasSubstr("there is no spectrum texture 'none' above: 'Kd' is as if it were not given"));
}

TEST(OlderShapes, StandWherePbrtHasThem) {
    const auto field = older("Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [ 0 1 2 3 4 5 ]");
    EXPECT_EQ(others(field), "");
    EXPECT_THAT(mesh_of(field).triangles, SizeIs(4));
    expect_near(mesh_of(field).positions.at(4), {0.5f, 1, 4});
    const auto cone = older("Shape \"cone\" \"float radius\" 2 \"float height\" 3");
    EXPECT_THAT(others(cone), HasSubstr("cut into triangles"));
    const auto& mesh = mesh_of(cone);
    expect_near(mesh.positions.front(), {2, 0, 0});
    expect_near(mesh.positions.back(), {0, 0, 3});
    // its side leans outwards
    expect_near(mesh.normals.front(), normalize(Vec3{3, 0, 2}));
    const auto bowl = mesh_of(older("Shape \"paraboloid\" \"float zmin\" 0 \"float zmax\" 4 \"float radius\" 2"));
    expect_near(bowl.positions.back(), {2, 0, 4});
    EXPECT_THAT(
        errors_of(
            "Film \"image\" WorldBegin Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 3 \"float Pz\" [ 0 1 ]"),
        HasSubstr("'Pz' needs nu"));
    EXPECT_THAT(others(older("Shape \"nurbs\"")), HasSubstr("'nurbs' are not supported and left out"));
}

}  // namespace
}  // namespace lightnet::test::pbrt_older_reader_test
