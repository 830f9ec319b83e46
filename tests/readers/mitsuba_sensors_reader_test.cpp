// Mitsuba's sensors and films, and the numbers of its meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/scene/bare_lights/slide_light.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_sensors_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr float degrees = 3.14159265f / 180;
const std::string one_ball = "<shape type='sphere'/>";

SceneData seen_by(const std::string& sensor) { return read_mitsuba(one_ball + "<sensor " + sensor + "</sensor>"); }

const std::string wide_film =
    "<film type='hdrfilm'><integer name='width' value='200'/><integer name='height' value='100'/></film>";

TEST(MitsubaSensor, IsTheFirstOfSeveralThatCanBeChosenByTheirIds) {
    const auto scene = read_mitsuba(one_ball +
                                    "<sensor type='perspective' id='front'><float name='fov' value='30'/></sensor>"
                                    "<sensor type='perspective'><float name='fov' value='60'/></sensor>");
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "front");
    EXPECT_EQ(scene.camera.fov, scene.cameras[0].camera.fov);
    EXPECT_GT(scene.cameras[1].camera.fov, scene.camera.fov);
}

TEST(MitsubaSensor, HasItsAngleAcrossTheAxisThatItNames) {
    const auto angle = [](const std::string& more) {
        return seen_by("type='perspective'><float name='fov' value='90'/>" + wide_film + more).camera.fov;
    };
    const float half = 2 * std::atan(0.5f) / degrees;
    EXPECT_NEAR(angle(""), half, 1e-3f);
    EXPECT_NEAR(angle("<string name='fovAxis' value='y'/>"), 90, 1e-3f);
    EXPECT_NEAR(angle("<string name='fov_axis' value='smaller'/>"), 90, 1e-3f);
    EXPECT_NEAR(angle("<string name='fov_axis' value='larger'/>"), half, 1e-3f);
    EXPECT_NEAR(angle("<string name='fov_axis' value='diagonal'/>"), 2 * std::atan(1 / std::sqrt(5.0f)) / degrees,
                1e-3f);
    EXPECT_THAT(errors_of_mitsuba(one_ball + "<sensor type='perspective'><float name='fov' value='200'/></sensor>"),
                HasSubstr("between 0 and 180"));
}

std::string film_of(int width, int height) {
    return "<film type='hdrfilm'><integer name='width' value='" + std::to_string(width) +
           "'/><integer name='height' value='" + std::to_string(height) + "'/></film>";
}

// The diagonal of 36 × 24 mm; across the shorter side of 4:3 that is atan(0.6 × 43.27 / 100).
TEST(MitsubaSensor, HasTheLensOf50mmOnTheDiagonalUnlessToldOtherwise) {
    for (const std::string type : {"perspective", "thinlens"})
        for (const std::string lens : {"", "<string name='focal_length' value='50mm'/>",
                                       "<string name='focalLength' value='50'/><string name='fov_axis' value='y'/>"}) {
            const auto seen = [&](int w, int h) {
                const auto scene = seen_by("type='" + type + "'>" + lens + film_of(w, h));
                EXPECT_THAT(warnings_of(scene), Not(HasSubstr("sensor")));
                return scene.camera.fov;
            };
            const float half = std::hypot(36.0f, 24.0f) / 2 / 50;
            EXPECT_NEAR(seen(60, 60), 34.022f, 2e-3f) << type << lens;
            EXPECT_NEAR(seen(80, 60), 2 * std::atan(half * 0.6f) / degrees, 2e-3f);
            EXPECT_NEAR(2 * std::atan(half * 0.8f) / degrees, 38.18f, 5e-3f) << "across the longer side";
            EXPECT_NEAR(seen(60, 80), 2 * std::atan(half * 0.6f) / degrees, 2e-3f);
        }
    const auto tele = seen_by("type='perspective'><string name='focal_length' value='100mm'/>" + film_of(60, 60));
    EXPECT_NEAR(tele.camera.fov, 2 * std::atan(std::hypot(36.0f, 24.0f) / 200 / std::sqrt(2.0f)) / degrees, 2e-3f);
    EXPECT_THAT(warnings_of(seen_by("type='perspective'><float name='fov' value='9'/><string name='focal_length' "
                                    "value='50mm'/>")),
                HasSubstr("a sensor has a 'fov' or a 'focal_length': the latter is taken"));
}

// As Mitsuba 3 has it: what is seen at x is what is seen at x + offset without it, in shares of the picture, y down.
TEST(MitsubaSensor, MovesWhatItSeesByItsPrincipalPoint) {
    const auto scene = seen_by(
        "type='perspective'><float name='fov' value='90'/><float name='principal_point_offset_x' value='.25'/>"
        "<float name='principalPointOffsetY' value='.5'/>" +
        film_of(200, 100));
    EXPECT_EQ(scene.camera.screen, (std::array<float, 4>{-1, 3, -2, 0}));
}

// Two triangles of a square.
std::string ply_of(const std::string& of_vertex, const std::string& of_face, const std::string& vertex,
                   const std::vector<std::string>& faces) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + of_vertex +
        "element face 2\nproperty list uchar int vertex_indices\n" + of_face + "end_header\n";
    for (const char* position : {"-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0"}) text += std::string(position) + vertex + "\n";
    return text + "3 0 1 2" + faces[0] + "\n3 0 2 3" + faces[1] + "\n";
}

std::string painted(const std::string& attribute) {
    return "<shape type='ply'><string name='filename' value='m.ply'/><bsdf type='twosided'><bsdf type='diffuse'>"
           "<texture type='mesh_attribute' name='reflectance'><string name='name' value='" +
           attribute + "'/></texture></bsdf></bsdf></shape>";
}

TEST(MitsubaAttributes, OfVerticesGoByTheBeginningOfTheirNames) {
    for (const std::string ends : {"012", "rgb", "xyz"}) {
        std::string properties;
        for (const char end : ends) properties += std::string("property float color_") + end + "\n";
        const auto scene =
            read_mitsuba(painted("vertex_color"), {{"m.ply", ply_of(properties, "", " .25 .5 .75", {"", ""})}});
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("attribute")));
        ASSERT_THAT(mesh_of(scene).colours, SizeIs(4)) << ends;
        EXPECT_EQ(mesh_of(scene).colours[1], (Rgb{0.25f, 0.5f, 0.75f}));
    }
    std::string paints;
    for (const char end : {'r', 'g', 'b'}) paints += std::string("property float rust_") + end + "\n";
    const auto rust =
        read_mitsuba(painted("vertex_rust_color"), {{"m.ply", ply_of(paints, "", " .25 .5 .75", {"", ""})}});
    EXPECT_EQ(mesh_of(rust).colours.at(0), (Rgb{0.25f, 0.5f, 0.75f}));
    const auto heat =
        read_mitsuba(painted("vertex_heat"), {{"m.ply", ply_of("property float heat_0\n", "", " .25", {"", ""})}});
    EXPECT_EQ(mesh_of(heat).colours.at(2), (Rgb{0.25f, 0.25f, 0.25f}));
}

TEST(MitsubaAttributes, OfFacesAreTheirTriangles) {
    const auto scene =
        read_mitsuba(painted("face_color"),
                     {{"m.ply", ply_of("", "property float color_0\nproperty float color_1\nproperty float color_2\n",
                                       "", {" 1 0 0", " 0 .5 1"})}});
    const Mesh& mesh = mesh_of(scene);
    ASSERT_THAT(mesh.positions, SizeIs(6));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(mesh.colours[mesh.triangles[0][i]], (Rgb{1, 0, 0}));
        EXPECT_EQ(mesh.colours[mesh.triangles[1][i]], (Rgb{0, 0.5f, 1}));
    }
}

TEST(MitsubaAttributes, ThatAreNotThereAreNamed) {
    const auto scene = read_mitsuba(painted("vertex_dust"), {{"m.ply", ply_of("", "", "", {"", ""})}});
    EXPECT_THAT(warnings_of(scene), HasSubstr("there is no mesh attribute 'vertex_dust' in 'm.ply': white is taken"));
}

// As Mitsuba does, but where nothing is cut: there rays begin at the eye.
TEST(MitsubaSensor, CutsWhatIsTooNear) {
    const std::string plate =
        "<shape type='rectangle'><transform name='to_world'><translate z='.5'/></transform></shape>";
    const auto with = [&](const std::string& more) {
        return read_mitsuba(plate + "<sensor type='perspective'><float name='fov' value='40'/>" + more + "</sensor>");
    };
    EXPECT_EQ(with("<float name='near_clip' value='1'/>").camera.nearest, 1);
    EXPECT_EQ(with("<float name='near_clip' value='.25'/>").camera.nearest, 0);
    EXPECT_EQ(with("").camera.nearest, 0);
    const auto cut = with("<float name='far_clip' value='.4'/>");
    EXPECT_EQ(cut.camera.farthest, 0.4f);
    EXPECT_THAT(warnings_of(cut), Not(HasSubstr("far_clip")));
    EXPECT_EQ(with("").camera.farthest, Ray().far) << "nothing is as far away as Mitsuba sees by itself";
}

// 2 × 1 pixels of Radiance HDR: red, green
const std::string two_pixels =
    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string("\x80\0\0\x81\0\x80\0\x81", 8);
const std::string as_texture = "type='bitmap'><string name='filename' value='p.hdr'/></texture>";

// across its cone, which is 45 degrees wide on each side, with u along x
TEST(MitsubaSpot, ThrowsItsTexture) {
    const auto scene = read_mitsuba(one_ball +
                                        "<emitter type='spot'><rgb name='intensity' value='10'/><float "
                                        "name='cutoff_angle' value='45'/><texture name='texture' " +
                                        as_texture + "</emitter>",
                                    {{"p.hdr", two_pixels}});
    const SlideLight light(std::get<SpotLight>(scene.lights.at(0)));
    EXPECT_NEAR(light.towards(normalize({-0.5f, 0, 1})).r, 10, 1e-3f);
    EXPECT_NEAR(light.towards(normalize({0.5f, 0, 1})).g, 10, 1e-3f);
    EXPECT_NEAR(light.towards({0, 0, 1}).r, 5, 1e-3f);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("spot")));
}

TEST(MitsubaSpot, OfARightAngleIsAsBrightAsItsTextureIsOnAverage) {
    const auto scene =
        read_mitsuba(one_ball +
                         "<emitter type='spot'><rgb name='intensity' value='10'/><float name='cutoff_angle' "
                         "value='90'/><texture name='texture' " +
                         as_texture + "</emitter>",
                     {{"p.hdr", two_pixels}});
    EXPECT_NEAR(std::get<SpotLight>(scene.lights.at(0)).intensity.g, 5, 1e-5f);
    EXPECT_THAT(warnings_of(scene), HasSubstr("throws no picture"));
}

// The irradiance of a plane at distance 1 is π times the picture's, all over it; its right is at -x, as a camera's.
TEST(MitsubaProjector, ThrowsItsPicture) {
    const auto scene = read_mitsuba(
        one_ball +
            "<emitter type='projector'><float name='fov' value='90'/><float name='scale' value='2'/><texture "
            "name='irradiance' " +
            as_texture + "</emitter>",
        {{"p.hdr", two_pixels}});
    const SlideLight light(std::get<SpotLight>(scene.lights.at(0)));
    for (const float x : {0.5f, 0.9f}) {
        const double cosine = 1 / std::sqrt(1 + double{x} * x);
        EXPECT_NEAR(light.towards(normalize({x, 0, 1})).r * std::pow(cosine, 3), 2 * std::numbers::pi, 1e-3);
        EXPECT_NEAR(light.towards(normalize({-x, 0, 1})).g * std::pow(cosine, 3), 2 * std::numbers::pi, 1e-3);
    }
    EXPECT_TRUE(is_black(light.towards(normalize({0, 0.51f, 1}))));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("projector")));
    EXPECT_THAT(errors_of_mitsuba(one_ball + "<emitter type='projector'/>"), HasSubstr("needs an 'irradiance'"));
}

TEST(MitsubaSensor, SeesPlusXOnTheLeft) {
    const auto scene = seen_by(
        "type='perspective'><float name='fov' value='50'/><transform name='to_world'>"
        "<lookat origin='0 0 -5' target='0 0 0' up='0 1 0'/></transform>");
    ASSERT_TRUE(scene.camera_given);
    EXPECT_EQ(transform_direction(scene.camera.to_world, {1, 0, 0}), (Vec3{-1, 0, 0}));
    EXPECT_EQ(transform_direction(scene.camera.to_world, {0, 0, 1}), (Vec3{0, 0, 1}));
    EXPECT_EQ(transform_point(scene.camera.to_world, {0, 0, 0}), (Vec3{0, 0, -5}));
    EXPECT_EQ(scene.film.width, 768u);
}

TEST(MitsubaSensor, MayBeALensOrHaveParallelRays) {
    const auto lens = seen_by(
        "type='thinlens'><float name='fov' value='50'/><float name='apertureRadius' value='.1'/><float "
        "name='focusDistance' value='7'/>");
    EXPECT_EQ(lens.camera.lens_radius, 0.1f);
    EXPECT_EQ(lens.camera.focus_distance, 7);
    const auto flat =
        seen_by("type='orthographic'><transform name='to_world'><scale x='3' y='3'/></transform>" + wide_film);
    EXPECT_TRUE(flat.camera.is_orthographic());
    EXPECT_EQ(flat.camera.screen, (std::array<float, 4>{-3, 3, -1.5f, 1.5f}));
}

// by the formula of version 0.6, where +x is left of a camera
TEST(MitsubaSensor, MaySeeAllAround) {
    const auto scene = seen_by("type='spherical'><transform name='toWorld'><translate x='1'/></transform>" + wide_film);
    ASSERT_TRUE(std::holds_alternative<LatitudeLongitude>(scene.camera.projection));
    const LatitudeLongitude::View view(scene.camera, {200, 100});
    const auto expect_towards = [&](float x, float y, Vec3 direction) {
        EXPECT_LT(length(view.ray(x, y).direction - direction), 1e-5f) << x;
    };
    expect_towards(100, 50, {0, 0, 1});
    expect_towards(50, 50, {1, 0, 0});
    expect_towards(150, 50, {-1, 0, 0});
    expect_towards(0, 50, {0, 0, -1});
    expect_towards(100, 25, {0, std::sqrt(0.5f), std::sqrt(0.5f)});
    EXPECT_EQ(view.ray(3, 4).origin, (Vec3{1, 0, 0}));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("sensor")));
}

TEST(MitsubaFilm, NamesResponsesThatItDoesNotHave) {
    EXPECT_THAT(warnings_of(seen_by(
                    "type='perspective'><film type='specfilm'><spectrum name='a' value='400:1, 700:0'/></film>")),
                HasSubstr("the response functions of 'specfilm' are left out"));
    EXPECT_THAT(warnings_of(seen_by("type='telecentric'>")),
                HasSubstr("sensor 'telecentric' is not known: a perspective"));
}

TEST(MitsubaFilm, MayBeCropped) {
    const auto scene = seen_by(
        "type='perspective'><float name='fov' value='50'/><film type='hdrfilm'><integer name='width' value='100'/>"
        "<integer name='height' value='50'/><integer name='cropOffsetX' value='10'/><integer name='cropOffsetY' "
        "value='5'/>"
        "<integer name='cropWidth' value='20'/><integer name='cropHeight' value='10'/></film>");
    EXPECT_FLOAT_EQ(scene.film.crop[0], 0.1f);
    EXPECT_FLOAT_EQ(scene.film.crop[1], 0.3f);
    EXPECT_FLOAT_EQ(scene.film.crop[3], 0.3f);
    EXPECT_THAT(
        errors_of_mitsuba(
            one_ball +
            "<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='0'/></film></sensor>"),
        HasSubstr("'width' must be from 1 to 65536, not 0"));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_sensors_reader_test
