// pbrt's lights without a shape, its cameras and its film.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <numbers>

#include "core/readers/common/spectra.hpp"
#include "core/scene/bare_lights/slide_light.hpp"
#include "core/scene/camera/camera.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/both_ways.hpp"
#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_lights_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr float pi = std::numbers::pi_v<float>;
const std::string dark(4, '\0');  // a pixel of Radiance HDR

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }

template <class Light>
Light light(const std::string& statement, MemoryFiles files = {}) {
    return std::get<Light>(read_world(statement, std::move(files)).lights.at(0));
}

/// A picture of that many columns and rows of one colour (RGBE).
std::string picture(int columns, int rows, const std::string& pixel = "\x80\x40\x20\x81") {
    std::string file = "#?RADIANCE\n\n-Y " + std::to_string(rows) + " +X " + std::to_string(columns) + "\n";
    for (int i = 0; i < columns * rows; ++i) file += pixel;
    return file;
}

TEST(PbrtPointLights, StandWhereTheyAreSet) {
    const auto lamp = light<PointLight>(
        "Translate 1 2 3 LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"float scale\" 2 \"point3 from\" [ 0 0 4 ]");
    expect_near(lamp.position, {1, 2, 7});
    EXPECT_EQ(lamp.intensity, (Rgb{2, 4, 6}));
}

TEST(PbrtPointLights, HaveThePowerThatIsAskedFor) {
    EXPECT_NEAR(light<PointLight>("LightSource \"point\" \"float power\" 100").intensity.g * 4 * pi, 100, 1e-4f);
}

// Its corners stand in the world, whatever the transform.
TEST(PbrtInfiniteLights, MayShineThroughAPortal) {
    const auto scene = read_world(
        "Rotate 90 1 0 0 LightSource \"infinite\" \"rgb L\" [ 1 2 3 ]\n"
        "\"point3 portal\" [ 0 2 0  0 2 1  3 2 1  3 2 0 ]");
    ASSERT_TRUE(scene.environments.at(0).portal);
    const Portal& portal = *scene.environments[0].portal;
    expect_near(portal.corner, {0, 2, 0});
    expect_near(portal.side, {3, 0, 0});
    expect_near(portal.other, {0, 0, 1});
    EXPECT_TRUE(portal.passes({1, 5, 0.5f}, {0, -1, 0}));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtSpotLights, HaveACone) {
    const auto lamp = light<SpotLight>(
        "LightSource \"spot\" \"point3 from\" [ 0 5 0 ] \"point3 to\" [ 0 0 0 ] \"float coneangle\" 40 "
        "\"float conedeltaangle\" 10");
    expect_near(lamp.position, {0, 5, 0});
    expect_near(lamp.axis, {0, -1, 0});
    EXPECT_NEAR(lamp.inner, pi / 6, 1e-6f);
    EXPECT_NEAR(lamp.outer, 40 * pi / 180, 1e-6f);
    EXPECT_EQ(lamp.falloff, SpotLight::Falloff::smoothstep);
}

TEST(PbrtSpotLights, MayBeWiderThanHalfOfAllDirections) {
    const auto lamp = light<SpotLight>("LightSource \"spot\" \"float coneangle\" 150 \"float conedeltaangle\" 40");
    EXPECT_NEAR(lamp.inner, 110 * pi / 180, 1e-6f);
    EXPECT_NEAR(lamp.outer, 150 * pi / 180, 1e-6f);
}

// pbrt takes the cosine of -5 degrees
TEST(PbrtSpotLights, AreSoftBeyondTheirAxis) {
    const auto lamp = light<SpotLight>("LightSource \"spot\" \"float coneangle\" 10 \"float conedeltaangle\" 15");
    EXPECT_NEAR(lamp.inner, 5 * pi / 180, 1e-6f);
}

// ∫ smoothstep over the cosine between the two cones is half their difference.
TEST(PbrtSpotLights, HaveThePowerThatIsAskedFor) {
    const auto lamp = light<SpotLight>("LightSource \"spot\" \"float power\" 30");
    const float inner = 1 - std::cos(lamp.inner), outer = 1 - std::cos(lamp.outer);
    EXPECT_NEAR(lamp.intensity.r * 2 * pi * (inner + outer) / 2, 30, 1e-3f);
}

TEST(PbrtDistantLights, ShineFromOnePointToAnother) {
    const auto sun = light<DirectionalLight>(
        "Scale 2 2 2 LightSource \"distant\" \"point3 from\" [ 0 3 0 ] \"float illuminance\" 5 \"blackbody L\" 5000");
    expect_near(sun.direction, normalize(Vec3{0, -3, 1}));
    EXPECT_NEAR(luminance(sun.irradiance), 5, 1e-4f);
}

// An invisible lamp, which no ray meets, and which shines all the same.
TEST(PbrtLamps, OfWhichNothingIsThereShine) {
    const std::string lamp = "AreaLightSource \"diffuse\" ";
    const auto emission = [&](const std::string& shape) { return read_world(lamp + shape).shapes.at(0).emission; };
    EXPECT_TRUE(emission("Shape \"sphere\" \"float alpha\" 0").value().unseen);
    EXPECT_TRUE(
        emission("Texture \"t\" \"float\" \"constant\" \"float value\" 0 Shape \"disk\" \"texture alpha\" \"t\"")
            .value()
            .unseen);
    EXPECT_FALSE(emission("Shape \"sphere\" \"float alpha\" .5").value().unseen);
    EXPECT_FALSE(emission("Shape \"sphere\"").value().unseen);
}

// Radiance that a white floor sends up: ρ L r²/d² below a ball of radius r at height d, whoever looks for the light.
TEST(PbrtLamps, OfWhichNothingIsThereLightLikeOthers) {
    const std::string floor =
        "Shape \"trianglemesh\" \"point3 P\" [ -5 0 -5 5 0 -5 0 0 5 ]\n AttributeBegin AreaLightSource \"diffuse\" "
        "\"rgb L\" [ 4 4 4 ] Translate 0 1 0 ";
    for (const std::string shape : {"Shape \"sphere\" \"float radius\" .5 \"float alpha\" 0",
                                    "Shape \"sphere\" \"float radius\" .5 \"float alpha\" 0 \"float zmin\" -.49999"}) {
        const Scene scene(
            read_world("Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] " + floor + shape + " AttributeEnd"));
        const SurfacePoint point = scene.surface(Query{.primitive = 0, .u = 0.25f, .v = 0.5f});
        const Bsdf bsdf = scene.bsdf(point);
        double sum = 0;
        constexpr std::uint32_t many = 1 << 14;
        for (std::uint32_t i = 0; i < many; ++i) sum += both_ways(scene, point, bsdf, Samples(4, i)).g;
        EXPECT_NEAR(sum / many, 4 * 0.25, 0.02);
        EXPECT_FALSE(scene.intersect({{0, 0.1f, 0}, {0, 1, 0}}));
    }
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

TEST(PbrtLights, MayShineByAPictureOfDirections) {
    // brighter below: of a square of equal areas the middle is +y, and its rim -y
    std::string square = "#?RADIANCE\n\n-Y 3 +X 3\n";
    for (int i = 0; i < 9; ++i)
        square += i == 4 ? std::string("\x80\x80\x80\x82", 4) : std::string("\x80\x80\x80\x80", 4);
    const MemoryFiles files{{"p.hdr", square}};
    const std::string plain = "LightSource \"goniometric\" \"string filename\" \"p.hdr\" ",
                      lamp = plain + "\"rgb I\" [ 3 3 3 ] ";
    const auto scene = read_world(lamp + ball, files);
    EXPECT_THAT(scene.warnings, IsEmpty());
    const Scene made(scene);
    const auto from = [&](const Scene& which, Vec3 place) {
        return which.lights().sample(LitPoint(place), 0.5f, {0.5f, 0.5f});
    };
    EXPECT_NEAR(from(made, {0, 2, 0})->radiance.g, 3 * 2.0f / 4, 1e-3f);
    EXPECT_NEAR(from(made, {0, -2, 0})->radiance.g, 3 * 0.5f / 4, 1e-3f);
    // its power is that over all directions
    const Scene strong(read_world(plain + "\"float power\" 10 " + ball, files));
    EXPECT_NEAR(power_of(strong), 10, 0.1f);
}

// Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere": the equator joins the middles of the sides; of
// pbrt-v4's lights y and z change places (GoniometricLight::Create()).
TEST(PbrtLights, TurnGoniogramsAsPbrtDoes) {
    std::string square = "#?RADIANCE\n\n-Y 9 +X 9\n";
    const auto strength = [](int x, int y) { return x == 8 ? 128 : x == 0 ? 64 : y == 8 ? 32 : 16; };
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) {
            const bool side =
                (std::abs(x - 4) == 4 && std::abs(y - 4) < 3) || (std::abs(y - 4) == 4 && std::abs(x - 4) < 3);
            const char byte = char(side ? strength(x, y) : 0);
            square += {byte, byte, byte, char(0x81)};
        }
    const Scene scene(read_world(
        "LightSource \"goniometric\" \"string filename\" \"p.hdr\" \"rgb I\" [ 4 4 4 ] " + ball, {{"p.hdr", square}}));
    const auto from = [&](Vec3 place) {
        return scene.lights().sample(LitPoint(place), 0.5f, {0.5f, 0.5f}).value().radiance.g;
    };
    EXPECT_NEAR(from({2, 0, 0}), 1, 1e-3f);
    EXPECT_NEAR(from({-2, 0, 0}), 0.5f, 1e-3f);
    EXPECT_NEAR(from({0, 0, 2}), 0.25f, 1e-3f);
    EXPECT_NEAR(from({0, 0, -2}), 0.125f, 1e-3f);
}

// twice as wide as high: the angle is that of its height; its first row lies at +y (ProjectionLight::Create())
TEST(PbrtLights, MayProjectPictures) {
    const MemoryFiles files{{"p.hdr", "#?RADIANCE\n\n-Y 2 +X 4\n" + std::string("\x80\0\0\x81", 4) + dark + dark +
                                          dark + dark + dark + dark + std::string("\0\x80\0\x81", 4)}};
    const std::string lamp =
        "Translate 0 0 5 LightSource \"projection\" \"string filename\" \"p.hdr\" \"float fov\" 90 ";
    const auto scene = read_world(lamp, files);
    EXPECT_THAT(scene.warnings, IsEmpty());
    const SlideLight slide(std::get<SpotLight>(scene.lights.at(0)));
    EXPECT_EQ(slide.position, (Vec3{0, 0, 5}));
    EXPECT_NEAR(slide.towards(normalize({-1.5f, 0.5f, 1})).r, 1, 1e-4f);
    EXPECT_NEAR(slide.towards(normalize({1.5f, -0.5f, 1})).g, 1, 1e-4f);
    EXPECT_TRUE(is_black(slide.towards(normalize({1.5f, 0.5f, 1}))));
    EXPECT_TRUE(is_black(slide.towards(normalize({0, 1.01f, 1}))));
    const SlideLight strong(std::get<SpotLight>(read_world(lamp + "\"float power\" 30", files).lights.at(0)));
    EXPECT_NEAR(luminance(strong.power()), 30, 0.01f);
}

TEST(PbrtLamps, MayHavePictures) {
    const MemoryFiles files{{"p.hdr", picture(2, 2, "\x80\x80\x80\x82")}};
    const std::string lamp = "AreaLightSource \"diffuse\" \"string filename\" \"p.hdr\" \"float scale\" 3 ";
    const auto plain = read_world(lamp + ball, files).shapes.at(0).emission.value();
    EXPECT_EQ(plain.radiance, (Rgb{3, 3, 3}));
    EXPECT_TRUE(plain.texture);
    // of luminance 2: half the radiance gives the power
    const auto strong = read_world(lamp + "\"float power\" 100 " + ball, files).shapes.at(0).emission.value();
    EXPECT_NEAR(strong.radiance.r * 2 / 3 * 4 * pi * pi, 100, 1e-3f);
}

TEST(PbrtEnvironments, AreConstant) {
    const auto scene = read_world("LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2");
    ASSERT_THAT(scene.environments, SizeIs(1));
    EXPECT_EQ(scene.environments[0].radiance, (Rgb{2, 4, 6}));
    EXPECT_FALSE(scene.environments[0].image);
}

TEST(PbrtEnvironments, OfAnIlluminanceShareItOverTheHemisphere) {
    EXPECT_NEAR(read_world("LightSource \"infinite\" \"float illuminance\" 10").environments[0].radiance.g, 10 / pi,
                1e-5f);
}

TEST(PbrtEnvironments, TellTheirLayoutByTheirShape) {
    const MemoryFiles files{{"square.hdr", picture(2, 2)}, {"wide.hdr", picture(4, 2)}};
    const auto scene = read_world(
        "Rotate 90 1 0 0 LightSource \"infinite\" \"string filename\" \"square.hdr\" \"float scale\" 2\n"
        "LightSource \"infinite\" \"string filename\" \"wide.hdr\"",
        files);
    ASSERT_THAT(scene.environments, SizeIs(2));
    EXPECT_EQ(scene.environments[0].layout, EnvironmentData::Layout::equal_area);
    EXPECT_EQ(scene.environments[0].radiance, (Rgb{2, 2, 2}));
    expect_near(transform_direction(scene.environments[0].to_world, {0, 1, 0}), {0, 0, 1});
    EXPECT_EQ(scene.environments[1].layout, EnvironmentData::Layout::latitude_longitude);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtEnvironments, OfAPictureHaveTheIlluminanceThatIsAskedFor) {
    // of luminance 1 everywhere, it would be π
    const MemoryFiles files{{"p.hdr", picture(32, 32, "\x80\x80\x80\x81")}};
    const auto scene =
        read_world("LightSource \"infinite\" \"string filename\" \"p.hdr\" \"float illuminance\" 10", files);
    EXPECT_NEAR(scene.environments[0].radiance.r, 10 / pi, 0.02f);
}

CameraData camera(const std::string& statements) { return read_text(statements + "\nWorldBegin").camera; }

TEST(PbrtCameras, MayHaveALens) {
    const auto lens = camera("Camera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 3");
    EXPECT_EQ(lens.lens_radius, 0.1f);
    EXPECT_EQ(lens.focus_distance, 3);
    // the world is twice as large as the camera's space
    const auto half = camera("Scale .5 .5 .5 Camera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 3");
    EXPECT_NEAR(half.lens_radius, 0.2f, 1e-6f);
    EXPECT_NEAR(half.focus_distance, 6, 1e-5f);
    EXPECT_NEAR(half.to_world.m[0][0], 1, 1e-12);
}

TEST(PbrtCameras, MayBeOrthographic) {
    const auto flat = camera("Camera \"orthographic\" \"float screenwindow\" [ -2 2 -1 1 ]");
    EXPECT_TRUE(flat.is_orthographic());
    EXPECT_EQ(flat.screen[1], 2);
}

TEST(PbrtCameras, OfOtherTypesAreApproximated) {
    const auto scene = read_text("Camera \"realistic\"\nWorldBegin\n" + ball);
    EXPECT_THAT(warnings_of(scene), HasSubstr("are not supported: a perspective one"));
    EXPECT_FALSE(scene.camera.is_orthographic());
}

// pbrt begins on the right, goes on ahead, to the left and behind.
TEST(PbrtCameras, MayLookAround) {
    const auto look = [&](const std::string& mapping, float x, float y) {
        const auto data = camera("Camera \"spherical\" \"string mapping\" \"" + mapping + "\"");
        return Camera(data, 8, 8).ray(x, y).direction;
    };
    expect_near(look("equirectangular", 0, 4), {1, 0, 0});
    expect_near(look("equirectangular", 2, 4), {0, 0, 1});
    expect_near(look("equirectangular", 4, 4), {-1, 0, 0});
    expect_near(look("equirectangular", 6, 4), {0, 0, -1});
    expect_near(look("equirectangular", 3, 0), {0, 1, 0});
    expect_near(look("equalarea", 4, 4), {0, 1, 0});
    expect_near(look("equalarea", 0, 0), {0, -1, 0});
    expect_near(look("equalarea", 8, 4), {1, 0, 0});
    const auto data = camera("Translate 1 2 3 Rotate 30 1 1 0 Camera \"spherical\"");
    const Camera made(data, 64, 64);
    const Ray ray = made.ray(20, 50);
    const Vec3 back = made.project(ray.origin + ray.direction * 7);
    EXPECT_NEAR(back.x / back.z, 20, 1e-2f);
    EXPECT_NEAR(back.y / back.z, 50, 1e-2f);
    EXPECT_THAT(errors_of("Camera \"spherical\" \"string mapping\" \"round\"\nWorldBegin"),
                HasSubstr("unknown mapping 'round'"));
}

TEST(PbrtFilms, ScaleByIsoAndExposureTime) {
    const auto scene =
        read_text("Camera \"perspective\" \"float shutterclose\" .5 Film \"rgb\" \"float iso\" 400\nWorldBegin");
    EXPECT_EQ(scene.film.scale, 2);
}

TEST(PbrtFilms, ShowTheLightOfTheirWhiteBalanceAsWhite) {
    const auto scene = read_text(
        "Film \"rgb\" \"float whitebalance\" 5000\nWorldBegin\nLightSource \"infinite\" \"spectrum L\" "
        "\"stdillum-D50\"");
    const Rgb white = scene.environments.at(0).radiance;
    EXPECT_NEAR(white.r, white.g, 0.02f);
    EXPECT_NEAR(white.b, white.g, 0.02f);
}

TEST(Daylight, OfD65IsWhite) {
    const Rgb white = daylight_colour(6504).rgb;
    EXPECT_NEAR(white.r, 1, 0.003f);
    EXPECT_NEAR(white.g, 1, 0.003f);
    EXPECT_NEAR(white.b, 1, 0.003f);
    EXPECT_GT(daylight_colour(5000).rgb.r, daylight_colour(5000).rgb.b);
    EXPECT_LT(daylight_colour(10000).rgb.r, daylight_colour(10000).rgb.b);
}

std::string packed(const std::string& text) {
    std::string result(text.size() + 128, '\0');
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::string in = text;
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

TEST(PbrtFiles, MayBePacked) {
    const std::string mesh =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2";
    const MemoryFiles files{{"m.ply.gz", packed(mesh)},
                            {"part.pbrt.gz", packed("Shape \"plymesh\" \"string filename\" \"m.ply.gz\"")}};
    EXPECT_EQ(mesh_of(read_world("Include \"part.pbrt.gz\"", files)).triangles.size(), 1u);
    const MemoryFiles cut{{"m.ply.gz", packed(mesh).substr(0, 60)}};
    EXPECT_THAT(errors_of_world("Shape \"plymesh\" \"string filename\" \"m.ply.gz\"", cut),
                HasSubstr("scene.pbrt:2: Shape 'plymesh': 'm.ply.gz': its gzip packing ends early"));
}

// 0 beyond the ends of a table, lines of any width
TEST(PbrtLightSpectra, EndWithTheirTables) {
    const auto light = [](const std::string& spectrum) {
        return std::get<PointLight>(
                   read_as("s.pbrt", "WorldBegin LightSource \"point\" \"spectrum I\" " + spectrum).lights.at(0))
            .intensity;
    };
    const Rgb red = light("[600 1 650 1]"), line = light("[554 0 555 1 556 0]");
    EXPECT_GT(red.r, 20 * red.g);
    EXPECT_NEAR(luminance(line), 1, 1e-4f);
    EXPECT_GT(line.g, 2 * line.r);
    const auto said = [](const std::string& parameter) {
        return warnings_of(read_as("s.pbrt", "WorldBegin LightSource \"point\" " + parameter));
    };
    EXPECT_THAT(said("\"spectrum I\" [550 1]"), HasSubstr("has one wavelength"));
    EXPECT_THAT(said("\"spectrum I\" [554 0 555 1 556 0]"), HasSubstr("spectrum 'I' is of a colour that sRGB can't"));
    EXPECT_THAT(said("\"blackbody I\" 1500"), HasSubstr("blackbody 'I' is of a colour that sRGB can't"));
    EXPECT_THAT(said("\"blackbody I\" 3000"), Not(HasSubstr("sRGB")));
}

}  // namespace
}  // namespace lightnet::test::pbrt_lights_reader_test
