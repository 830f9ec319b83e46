#include "core/scene/textures/look_up.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/math/sampling.hpp"
#include "core/scene/textures/noise.hpp"

#include <gtest/gtest.h>

namespace lightnet::textures_test {
namespace {

// red   green
// blue  white
Texture four_pixels() {
    ImageTexture picture;
    picture.image = std::make_shared<const Image>(2, 2, std::vector<Rgb>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    Texture texture;
    texture.pattern = picture;
    return texture;
}

ImageTexture& picture_of(Texture& texture) { return std::get<ImageTexture>(texture.pattern); }

Rgb look_up(const Texture& texture, Vec2 uv) { return lightnet::look_up({&texture, 1}, 0, {uv, {1, 1, 1}}); }

TEST(Texture, CountsRowsFromTheBottom) {
    const Texture texture = four_pixels();
    EXPECT_EQ(look_up(texture, {0.25f, 0.75f}), (Rgb{1, 0, 0}));
    EXPECT_EQ(look_up(texture, {0.75f, 0.75f}), (Rgb{0, 1, 0}));
    EXPECT_EQ(look_up(texture, {0.25f, 0.25f}), (Rgb{0, 0, 1}));
}

TEST(Texture, MixesNeighbours) {
    EXPECT_EQ(look_up(four_pixels(), {0.5f, 0.75f}), (Rgb{0.5f, 0.5f, 0}));
    EXPECT_EQ(look_up(four_pixels(), {0.5f, 0.5f}), (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(Texture, WrapsAsItIsTold) {
    Texture texture = four_pixels();
    EXPECT_EQ(look_up(texture, {-0.75f, 3.75f}), (Rgb{1, 0, 0}));
    picture_of(texture).wrap_u = picture_of(texture).wrap_v = Wrap::clamp;
    EXPECT_EQ(look_up(texture, {-7, 9}), (Rgb{1, 0, 0}));
    picture_of(texture).wrap_u = picture_of(texture).wrap_v = Wrap::black;
    EXPECT_EQ(look_up(texture, {-7, 9}), (Rgb{0, 0, 0}));
    EXPECT_EQ(look_up(texture, {0.25f, 0.75f}), (Rgb{1, 0, 0}));
}

TEST(Texture, ScalesColoursAndCoordinates) {
    Texture texture = four_pixels();
    texture.scale = {2, 2, 2};
    picture_of(texture).uv.scale = {2, 1};
    picture_of(texture).uv.offset = {0.5f, 0};
    EXPECT_EQ(look_up(texture, {0.125f, 0.75f}), (Rgb{0, 2, 0}));
}

TEST(Texture, InvertsToWhatIsMissingFromOne) {
    Texture texture;
    texture.scale = {0.2f, 1, 3};
    texture.invert = true;
    EXPECT_EQ(look_up(texture, {}), (Rgb{0.8f, 0, 0}));
}

TEST(Texture, SurvivesWildCoordinates) {
    for (const float wild : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")})
        EXPECT_TRUE(finite(look_up(four_pixels(), {wild, wild})));
}

// ---- by where points lie ----

Matrix moved_by(double x, double y, double z) {
    Matrix matrix;
    matrix.m[0][3] = x, matrix.m[1][3] = y, matrix.m[2][3] = z;
    return matrix;
}

// The texture coordinates that a projection comes to, as red and green.
struct Coordinates {
    std::vector<Texture> textures;
    explicit Coordinates(ProjectedTexture::By by, const Matrix& from_world = {}) {
        ImageTexture ramp;
        ramp.image = std::make_shared<const Image>(2, 2, std::vector<Rgb>{{0, 1, 0}, {1, 1, 0}, {0, 0, 0}, {1, 0, 0}});
        ramp.wrap_u = ramp.wrap_v = Wrap::clamp;
        ramp.uv = {{0.5f, 0.5f}, {0.25f, 0.25f}, 0};
        textures.push_back({{1, 1, 1}, ramp, false});
        textures.push_back({{1, 1, 1}, ProjectedTexture{0, by, from_world}, false});
    }
    Vec2 at(Vec3 position) const {
        const Rgb found = lightnet::look_up(textures, 1, {{0.9f, 0.9f}, {1, 1, 1}, position, {0, 0, 1}});
        return {found.r, found.g};
    }
};

void expect_near(Vec2 found, Vec2 wanted) {
    EXPECT_NEAR(found.x, wanted.x, 1e-5f);
    EXPECT_NEAR(found.y, wanted.y, 1e-5f);
}

TEST(ProjectedTexture, TakesCoordinatesFromAPlane) {
    const Coordinates plane(ProjectedTexture::By::plane, moved_by(-1, 0, 0));
    expect_near(plane.at({1.25f, 0.75f, 99}), {0.25f, 0.75f});
}

TEST(ProjectedTexture, TakesAnglesFromASphere) {
    const Coordinates sphere(ProjectedTexture::By::sphere, moved_by(0, 0, -5));
    expect_near(sphere.at({0, 0, 7}), {0, 0});
    expect_near(sphere.at({0, 3, 5}), {0.5f, 0.25f});
    expect_near(sphere.at({0, -2, 5}), {0.5f, 0.75f});
    expect_near(sphere.at({-1, -1e-6f, 4}), {0.75f, 0.5f});
}

TEST(ProjectedTexture, TakesAnAngleAndAHeightFromACylinder) {
    const Coordinates cylinder(ProjectedTexture::By::cylinder);
    expect_near(cylinder.at({7, 0, 0.3f}), {0.5f, 0.3f});
    expect_near(cylinder.at({0, 2, 1}), {0.75f, 1});
    expect_near(cylinder.at({0, -2, 0}), {0.25f, 0});
}

TEST(Texture, AlternatesFromCubeToCube) {
    const std::vector<Texture> textures{
        {{1, 0, 0}, {}, false}, {{0, 1, 0}, {}, false}, {{1, 1, 1}, CubesTexture{0, 1, moved_by(0.5, 0, 0)}, false}};
    const auto at = [&](Vec3 position) { return lightnet::look_up(textures, 2, {{}, {1, 1, 1}, position, {}}); };
    EXPECT_EQ(at({0, 0.5f, 0.5f}), (Rgb{1, 0, 0}));
    EXPECT_EQ(at({0.6f, 0.5f, 0.5f}), (Rgb{0, 1, 0}));
    EXPECT_EQ(at({0.6f, 0.5f, -0.5f}), (Rgb{1, 0, 0}));
    EXPECT_EQ(at({-0.6f, 0.5f, 0.5f}), (Rgb{0, 1, 0}));
}

TEST(Texture, MixesByHowASurfaceIsTurned) {
    const std::vector<Texture> textures{
        {{1, 0, 0}, {}, false}, {{0, 1, 0}, {}, false}, {{1, 1, 1}, DirectionTexture{0, 1, {0, 1, 0}}, false}};
    const auto at = [&](Vec3 normal) { return lightnet::look_up(textures, 2, {{}, {1, 1, 1}, {}, normal}); };
    EXPECT_EQ(at({0, 1, 0}), (Rgb{1, 0, 0}));
    EXPECT_EQ(at({0, -1, 0}), (Rgb{1, 0, 0}));
    EXPECT_EQ(at({1, 0, 0}), (Rgb{0, 1, 0}));
    EXPECT_EQ(at({0.6f, 0.8f, 0}), (Rgb{0.8f, 1 - 0.8f, 0}));
}

TEST(Texture, SaysWhetherItDependsOnThePlace) {
    const std::vector<Texture> textures{four_pixels(),
                                        {{1, 1, 1}, NoiseTexture{}, false},
                                        {{1, 1, 1}, MixTexture{0, 0, 0}, false},
                                        {{1, 1, 1}, MixTexture{0, 0, 1}, false},
                                        {{1, 1, 1}, DotsTexture{0, 0, {}}, false},
                                        {{1, 1, 1}, ProjectedTexture{0, {}, {}}, false}};
    std::vector<bool> found;
    for (std::uint32_t i = 0; i < textures.size(); ++i) found.push_back(depends_on_place(textures, i));
    EXPECT_EQ(found, (std::vector<bool>{false, true, false, true, false, true}));
}

// Heights may lie below 0; light and reflectances may not.
TEST(Texture, IsBelowZeroAsAValueButNotAsAColour) {
    Texture texture = four_pixels();
    texture.scale = {-2, -2, -2};
    const TexturePlace place{{0.25f, 0.75f}, {1, 1, 1}};
    EXPECT_EQ(value_at({&texture, 1}, 0, place).r, -2);
    EXPECT_EQ(lightnet::look_up({&texture, 1}, 0, place), (Rgb{0, 0, 0}));
}

// ---- noise ----

TEST(Noise, IsPerlinsWithPbrtsDirections) {
    EXPECT_NEAR(noise({3.14f, 42, 7}), 0.136920f, 1e-5f);
    EXPECT_NEAR(noise({0.5f, 0.25f, 0.75f}), -0.375079f, 1e-5f);
    EXPECT_NEAR(noise({-1.3f, 2.7f, 100.1f}), 0.228035f, 2e-5f);
    EXPECT_NEAR(noise({12.9f, -7.2f, 3.3f}), -0.112089f, 1e-5f);
    for (int i = -3; i < 300; i += 7) EXPECT_EQ(noise({float(i), float(2 * i), float(-i)}), 0);
}

TEST(Noise, SumsItsOctaves) {
    const Vec3 p{0.3f, 0.6f, -0.2f};
    EXPECT_NEAR(fractal_noise(p, 8, 0.5f), 0.016708f, 1e-4f);
    EXPECT_EQ(fractal_noise(p, 1, 0.5f), noise(p));
    EXPECT_NEAR(turbulence(p, 1, 0.5f), std::fabs(noise(p)) + 0.1f, 1e-6f);
    EXPECT_EQ(fractal_noise(p, 0, 0.5f), 0);
}

TEST(Noise, IsANumberEverywhere) {
    for (const float wild : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        EXPECT_TRUE(std::isfinite(noise({wild, 1, wild})));
        EXPECT_TRUE(std::isfinite(marble({wild, wild, 1}, 8, 0.5f, 0.2f).r));
        in_dot({wild, wild});
    }
}

TEST(Noise, PutsDotsIntoFewerThanHalfOfAllSquares) {
    int dots = 0, inside = 0;
    for (int x = -50; x < 50; ++x)
        for (int y = -50; y < 50; ++y) {
            int found = 0;
            for (int i = 0; i < 25; ++i)
                found += in_dot({float(x) + float(i % 5) / 5 - 0.4f, float(y) + float(i / 5) / 5 - 0.4f});
            dots += found > 0, inside += found;
        }
    EXPECT_NEAR(dots / 1e4, 0.3915, 0.001) << "the share of squares whose noise is above 0";
    EXPECT_NEAR(inside / (25.0 * dots), pi * 0.35 * 0.35, 0.02) << "of a dot's square";
}

TEST(Noise, VeinsLieBetweenTheColoursOfMarble) {
    float least = 1, most = 0;
    for (int i = 0; i < 2000; ++i) {
        const Rgb c = marble({0.1f * float(i), 0.37f * float(i), 0}, 8, 0.5f, 0.2f);
        least = std::min(least, c.r), most = std::max(most, c.r);
        EXPECT_GE(c.b, c.r - 0.03f) << i;
    }
    EXPECT_NEAR(most, 1.5f * 0.59f, 0.03f);
    EXPECT_LT(least, 1.5f * 0.45f);
    EXPECT_GT(least, 1.5f * 0.2f);
}

}  // namespace
}  // namespace lightnet::textures_test
