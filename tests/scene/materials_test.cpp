// From materials as data to scattering at a point.
#include "core/scene/surfaces/materials.hpp"
#include "core/scene/lamps/lights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surfaces/shading.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::materials_test {
namespace {

using namespace test;
using testing::HasSubstr;

/// The point of the square at (x, y), 0 < y < x < 1: on the first triangle.
SurfacePoint at(const Shading& shading, float x, float y) { return shading.point(0, 0, x - y, y); }

constexpr Vec3 up{0, 0, 1};

TEST(Materials, MixAsTheirAmountSays) {
    SceneData data;
    const auto first = diffuse(data, 0.8f), second = diffuse(data, 0.2f);
    add(data, textured_square(), material(data, MixtureMaterial{first, second, colour(data, {0.25f, 0.25f, 0.25f})}));
    const Shading shading(data);
    const auto [value, pdf] = shading.bsdf(at(shading, 0.5f, 0.2f)).value_and_pdf(up, up, lobe::all);
    EXPECT_NEAR(value.r * pi, 0.65f, 1e-6f);
    EXPECT_NEAR(pdf * pi, 1, 1e-6f);
}

TEST(Materials, MixMixtures) {
    SceneData data;
    const auto half = colour(data, {0.5f, 0.5f, 0.5f});
    const auto inner = material(data, MixtureMaterial{diffuse(data, 0.8f), diffuse(data, 0.4f), half});
    add(data, textured_square(), material(data, MixtureMaterial{inner, diffuse(data, 0), half}));
    const Shading shading(data);
    EXPECT_NEAR(shading.bsdf(at(shading, 0.5f, 0.2f)).evaluate(up, up, lobe::all).r * pi, 0.3f, 1e-6f);
}

std::string error_of(const SceneData& data) {
    try {
        const Materials materials(data);
        return "no error";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Materials, ThatContainThemselvesAreRefused) {
    SceneData data;
    const auto half = colour(data, {0.5f, 0.5f, 0.5f});
    const auto grey = diffuse(data, 0.5f);
    material(data, MixtureMaterial{grey, 2, half});
    material(data, TwoFacedMaterial{1, grey});
    EXPECT_THAT(error_of(data), HasSubstr("mixed from itself"));
}

// Each is made of the one before, so that whoever goes through them in order has seen every part already.
SceneData chain(int levels, bool twice) {
    SceneData data;
    const auto half = colour(data, {0.5f, 0.5f, 0.5f});
    const auto grey = diffuse(data, 0.5f);
    auto last = grey;
    for (int i = 0; i < levels; ++i) last = material(data, MixtureMaterial{last, twice ? last : grey, half});
    return data;
}

TEST(Materials, MixedTooDeeplyAreRefused) {
    EXPECT_EQ(error_of(chain(64, false)), "no error");
    EXPECT_THAT(error_of(chain(65, false)), HasSubstr("more than 64 deep"));
    EXPECT_THAT(error_of(chain(100'000, false)), HasSubstr("more than 64 deep"));
    SceneData upside_down = chain(100'000, false);
    std::reverse(upside_down.materials.begin() + 1, upside_down.materials.end());
    for (std::uint32_t i = 1; i < upside_down.materials.size(); ++i)
        upside_down.materials[i].model = MixtureMaterial{i + 1 < upside_down.materials.size() ? i + 1 : 0, 0, 0};
    EXPECT_THAT(error_of(upside_down), HasSubstr("more than 64 deep"));
}

// Each level doubles what a surface's light is worked out for.
TEST(Materials, MixedFromTooManyAreRefused) {
    EXPECT_EQ(error_of(chain(10, true)), "no error");
    EXPECT_THAT(error_of(chain(11, true)), HasSubstr("mixed from more than 1024 materials"));
    EXPECT_THAT(error_of(chain(60, true)), HasSubstr("mixed from more than 1024 materials"));
}

TEST(Materials, WithoutTheirTexturesAreRefused) {
    SceneData data;
    ConductorMaterial metal;
    metal.roughness.texture = 7;
    colour(data, {1, 1, 1});
    material(data, metal);
    EXPECT_THROW(Materials{data}, Error);
}

TEST(Materials, MayDifferFromBehind) {
    SceneData data;
    const auto front = diffuse(data, 0.8f), back = diffuse(data, 0.2f);
    add(data, textured_square(), material(data, TwoFacedMaterial{front, back}));
    const Shading shading(data);
    const Bsdf bsdf = shading.bsdf(at(shading, 0.5f, 0.2f));
    EXPECT_NEAR(bsdf.evaluate(up, up, lobe::all).r * pi, 0.8f, 1e-6f);
    EXPECT_NEAR(bsdf.evaluate(-up, -up, lobe::all).r * pi, 0.2f, 1e-6f);
    EXPECT_NEAR(bsdf.sample(-up, 0.5f, {0.3f, 0.4f}, lobe::all)->weight.r, 0.2f, 1e-6f);
}

TEST(Materials, MayBeBlackFromBehind) {
    SceneData data;
    add(data, textured_square(), diffuse(data, 0.8f));
    data.materials[0].one_sided = true;
    const Shading shading(data);
    const Bsdf bsdf = shading.bsdf(at(shading, 0.5f, 0.2f));
    EXPECT_GT(bsdf.evaluate(up, up, lobe::all).r, 0);
    EXPECT_EQ(bsdf.evaluate(-up, -up, lobe::all).r, 0);
    EXPECT_FALSE(bsdf.sample(-up, 0.5f, {0.3f, 0.4f}, lobe::all));
}

// What is known of a whole surface holds at each of its points.
TEST(Materials, KnowTheirLobesWhereTheseAreTheSameEverywhere) {
    SceneData data;
    const auto stripes = picture(data, 2, 1, {{0, 0, 0}, {1, 1, 1}});
    const Roughness smooth{}, satin{0.3f, 0.3f}, striped{0.5f, 0.5f, stripes};
    const auto eta = colour(data, {0.2f, 0.9f, 1.5f}), k = colour(data, {3.9f, 2.4f, 1.9f});
    const auto known = [&](auto model) {
        SceneData one = data;
        add(one, textured_square(), material(one, model));
        const Shading shading(one);
        const std::uint8_t everywhere = shading.lobes(0);
        for (const float x : {0.25f, 0.75f}) {
            const std::uint8_t here = shading.bsdf(at(shading, x, 0.2f)).lobes();
            EXPECT_TRUE(everywhere == 0 || everywhere == here);
        }
        return everywhere != 0;
    };
    EXPECT_TRUE(known(DiffuseMaterial{eta}));
    EXPECT_TRUE(known(DiffuseMaterial{stripes}));
    EXPECT_TRUE(known(CoatedDiffuseMaterial{stripes, 1.5f, smooth}));
    EXPECT_TRUE(known(CoatedDiffuseMaterial{stripes, 1.5f, satin}));
    EXPECT_FALSE(known(CoatedDiffuseMaterial{stripes, 1.5f, striped}));
    EXPECT_TRUE(known(ConductorMaterial{{eta, k}, smooth}));
    EXPECT_TRUE(known(ConductorMaterial{{eta, k}, satin, stripes}));
    EXPECT_FALSE(known(ConductorMaterial{{eta, k}, striped}));
    EXPECT_TRUE(known(DielectricMaterial{}));
    EXPECT_FALSE(known(MixtureMaterial{diffuse(data, 0.5f), mirror(data, 0.8f), stripes}));
}

TEST(Materials, TakeRoughnessFromTextures) {
    SceneData data;
    ConductorMaterial metal;
    metal.metal.reflectance = colour(data, {0.9f, 0.9f, 0.9f});
    metal.roughness = {0.5f, 0.5f, picture(data, 2, 1, {{0, 0, 0}, {1, 1, 1}}), Roughness::Means::square};
    add(data, textured_square(), material(data, metal));
    const Shading shading(data);
    EXPECT_EQ(shading.bsdf(at(shading, 0.25f, 0.2f)).lobes(), lobe::specular);
    const Bsdf rough = shading.bsdf(at(shading, 0.75f, 0.2f));
    const Bsdf same(Frame::around(up), up,
                    ConductorBsdf{{1, 1, 1}, absorption_for({0.9f, 0.9f, 0.9f}), {0.25f, 0.25f}});
    const Vec3 in = normalize({0.3f, 0.1f, 1});
    EXPECT_FLOAT_EQ(rough.evaluate(up, in, lobe::all).r, same.evaluate(up, in, lobe::all).r);
}

TEST(Materials, AbsorbBehindTheSurfaceOfSolidGlass) {
    SceneData data;
    add(data, textured_square(), material(data, DielectricMaterial{}));
    data.materials[0].absorption = {1, 2, 3};
    const Shading shading(data);
    const Bsdf bsdf = shading.bsdf(at(shading, 0.5f, 0.2f));
    ASSERT_TRUE(bsdf.absorption(-up));
    EXPECT_EQ(*bsdf.absorption(-up), (Rgb{1, 2, 3}));
    EXPECT_FALSE(bsdf.absorption(up));
    data.materials[0].model = DielectricMaterial{.thin = true};
    const Shading panes(data);
    EXPECT_FALSE(panes.bsdf(at(panes, 0.5f, 0.2f)).absorption(-up));
}

TEST(Opacity, DecidesByItsCutoff) {
    SceneData data;
    add(data, textured_square(), diffuse(data, 0.5f));
    data.materials[0].opacity = picture(data, 2, 1, {{0.3f, 0, 0}, {0.7f, 0, 0}});
    data.materials[0].opacity_cutoff = 0.5f;
    const Shading shading(data);
    EXPECT_TRUE(shading.has_holes(0));
    EXPECT_FALSE(shading.is_there(0, 0, 0.05f, 0.2f));
    EXPECT_TRUE(shading.is_there(0, 0, 0.55f, 0.2f));
}

TEST(Opacity, LetsThroughItsShareAndAlwaysTheSame) {
    SceneData data;
    add(data, textured_square(), diffuse(data, 0.5f));
    data.materials[0].opacity = colour(data, {0.3f, 0, 0});
    const Shading shading(data);
    int there = 0;
    constexpr int tries = 20000;
    for (std::uint32_t i = 0; i < tries; ++i) {
        const Vec2 u = Samples(1, i).next_2d();
        const bool here = shading.is_there(0, i % 2, u.x * 0.5f, u.y * 0.5f);
        EXPECT_EQ(here, shading.is_there(0, i % 2, u.x * 0.5f, u.y * 0.5f));
        there += here;
    }
    EXPECT_NEAR(double(there) / tries, 0.3, 5 * std::sqrt(0.3 * 0.7 / tries));
}

TEST(Opacity, IsNothingWhereThereIsNoMaterial) {
    SceneData data;
    add(data, textured_square(), material(data, NoMaterial{}));
    add(data, textured_square(), diffuse(data, 0.5f));
    const Shading shading(data);
    EXPECT_TRUE(shading.has_holes(0));
    EXPECT_FALSE(shading.is_there(0, 0, 0.2f, 0.2f));
    EXPECT_FALSE(shading.has_holes(1));
}

/// The shading normal under a map, found by the mirror's direction.
Vec3 normal_under(const SceneData& data, float x, float y) {
    const Shading shading(data);
    const auto s = shading.bsdf(at(shading, x, y)).sample(up, 0, {}, lobe::all);
    return s ? normalize(s->incoming + up) : Vec3{};
}

TEST(NormalMaps, TurnTheNormalAlongTheTexture) {
    SceneData data;
    const Vec3 n = normalize({0.2f, 0.1f, 1});
    add(data, textured_square(), mirror(data, 1));
    data.materials[0].normal_map = NormalMap{picture(data, 1, 1, {{n.x / 2 + 0.5f, n.y / 2 + 0.5f, n.z / 2 + 0.5f}})};
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - n), 0, 1e-5f);
    data.materials[0].normal_map->scale = 0;
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - up), 0, 1e-6f);
}

TEST(NormalMaps, KnowTexturesThatAreLaidTheOtherWayRound) {
    SceneData data;
    const Vec3 n = normalize({0.2f, 0.1f, 1});
    Mesh mesh = textured_square();
    for (Vec2& uv : mesh.uvs) uv.x = 1 - uv.x;
    add(data, mesh, mirror(data, 1));
    data.materials[0].normal_map = NormalMap{picture(data, 1, 1, {{n.x / 2 + 0.5f, n.y / 2 + 0.5f, n.z / 2 + 0.5f}})};
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - Vec3{-n.x, n.y, n.z}), 0, 1e-5f);
    data.materials[0].normal_map->green = NormalMap::Green::across;
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - Vec3{-n.x, -n.y, n.z}), 0, 1e-5f);
}

TEST(NormalMaps, LetNoLightThrough) {
    SceneData data;
    add(data, textured_square(), diffuse(data, 1));
    data.materials[0].normal_map = NormalMap{picture(data, 1, 1, {{0.99f, 0.5f, 0.3f}})};  // points into the surface
    const Shading shading(data);
    const Bsdf bsdf = shading.bsdf(at(shading, 0.5f, 0.2f));
    for (std::uint32_t i = 0; i < 2000; ++i) {
        Samples samples(3, i);
        Vec3 out = sphere(samples.next_2d());
        const auto s = bsdf.sample(out, 0, samples.next_2d(), lobe::all);
        EXPECT_TRUE(!s || s->incoming.z * out.z > 0);
        const Vec3 in = sphere(samples.next_2d());
        EXPECT_TRUE(in.z * out.z > 0 || is_black(bsdf.evaluate(out, in, lobe::all)));
    }
}

TEST(BumpMaps, AreSlopesOfTheirHeights) {
    SceneData data;
    add(data, textured_square(), mirror(data, 1));
    std::vector<Rgb> ramp;  // rises by 0.2 m per metre along x
    for (int x = 0; x < 64; ++x) ramp.push_back({0.2f * (float(x) + 0.5f) / 64, 0, 0});
    data.materials[0].bump_map = picture(data, 64, 1, ramp);
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - normalize({-0.2f, 0, 1})), 0, 1e-4f);
}

TEST(BumpMaps, MayLieBelowTheSurface) {
    SceneData data;
    add(data, textured_square(), mirror(data, 1));
    std::vector<Rgb> ramp;
    for (int x = 0; x < 64; ++x) ramp.push_back({0.2f * (float(x) + 0.5f) / 64, 0, 0});
    const TextureId heights = picture(data, 64, 1, ramp);
    data.textures[heights].scale = {-1, -1, -1};
    data.materials[0].bump_map = heights;
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - normalize({0.2f, 0, 1})), 0, 1e-4f);
}

// A ramp twice as long as the square, across its texture coordinates.
TEST(BumpMaps, FollowPlacesWhereTheirTexturesDo) {
    SceneData data;
    add(data, textured_square(), mirror(data, 1));
    std::vector<Rgb> ramp;
    for (int x = 0; x < 64; ++x) ramp.push_back({0.2f * (float(x) + 0.5f) / 64, 0, 0});
    Matrix across;
    across.m[0] = {0, 0.5, 0, 0.2};
    across.m[1] = {1, 0, 0, 0};
    const TextureId heights = picture(data, 64, 1, ramp);
    data.textures.push_back({{1, 1, 1}, ProjectedTexture{heights, ProjectedTexture::By::plane, across}, false});
    data.materials[0].bump_map = TextureId(data.textures.size() - 1);
    EXPECT_NEAR(length(normal_under(data, 0.5f, 0.2f) - normalize({0, -0.1f, 1})), 0, 1e-4f);
}

// Holes and lamps, too.
TEST(Textures, OfHolesAndLampsMayFollowPlaces) {
    SceneData data;
    const auto none = colour(data, {0, 0, 0}), whole = colour(data, {1, 1, 1});
    Matrix thirds;
    for (std::size_t i = 0; i < 3; ++i) thirds.m[i][i] = 3;
    data.textures.push_back({{1, 1, 1}, CubesTexture{whole, none, thirds}, false});
    const TextureId cubes(data.textures.size() - 1);
    const auto grey = diffuse(data, 0.5f);
    data.materials[grey].opacity = cubes;
    add(data, textured_square(), grey);
    data.shapes[0].emission = AreaEmission{.radiance = {2, 2, 2}, .texture = cubes};
    const Scene scene(data);
    const auto hit = [&](float x, float y) { return scene.intersect({{x, y, 3}, {0, 0, -1}}); };
    ASSERT_TRUE(hit(0.1f, 0.1f));
    EXPECT_FALSE(hit(0.5f, 0.1f));
    EXPECT_EQ(scene.lights().emission(scene.surface(*hit(0.5f, 0.5f)), {0, 0, 1}), (Rgb{2, 2, 2}));
}

TEST(BumpMaps, OnBallsFollowLongitudeAndLatitude) {
    SceneData data;
    add(data, ball({0, 0, 0}, 2), mirror(data, 1));
    ImageTexture slope;
    slope.image =
        std::make_shared<const Image>(1, 2, std::vector<Rgb>{{0.4f, 0, 0}, {0, 0, 0}});  // higher in the north
    data.textures.emplace_back().pattern = slope;
    data.materials[0].bump_map = TextureId(data.textures.size() - 1);
    const Scene scene(data);
    const SurfacePoint point = scene.surface(*scene.intersect({{6, 0, 0}, {-1, 0, 0}}));
    EXPECT_NEAR(length(point.along_u), 2 * pi * 2, 1e-3f);
    EXPECT_NEAR(length(point.along_v), pi * 2, 1e-3f);
    const auto s = scene.bsdf(point).sample({1, 0, 0}, 0, {}, lobe::all);
    ASSERT_TRUE(s);
    EXPECT_LT(s->incoming.z, -0.01f);  // away from what rises
    EXPECT_NEAR(s->incoming.y, 0, 1e-4f);
}

// Twice as wide, the same heights are half as steep.
TEST(BumpMaps, GrowFlatterWithTheirInstance) {
    SceneData data;
    add(data, textured_square(), mirror(data, 1));
    std::vector<Rgb> ramp;
    for (int x = 0; x < 64; ++x) ramp.push_back({0.2f * (float(x) + 0.5f) / 64, 0, 0});
    data.materials[0].bump_map = picture(data, 64, 1, ramp);
    data.objects.push_back({"square", {0}});
    Matrix wide;
    wide.m[0][0] = wide.m[1][1] = wide.m[2][2] = 2;
    data.instances.push_back({0, wide});
    const Scene scene(data);
    const auto hit = scene.intersect({{1, 0.4f, 3}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    const auto s = scene.bsdf(scene.surface(*hit)).sample(up, 0, {}, lobe::all);
    ASSERT_TRUE(s);
    EXPECT_NEAR(length(normalize(s->incoming + up) - normalize({-0.1f, 0, 1})), 0, 1e-4f);
}

TEST(VertexColours, AreMixedOverTheTriangle) {
    SceneData data;
    Mesh mesh = textured_square();
    mesh.colours = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    data.textures.emplace_back().pattern = VertexColour{};
    add(data, mesh, material(data, DiffuseMaterial{}));
    const Shading shading(data);
    const Rgb seen = shading.bsdf(shading.point(0, 0, 0.25f, 0.5f)).evaluate(up, up, lobe::all) * pi;
    EXPECT_NEAR(seen.r, 0.25f, 1e-6f);
    EXPECT_NEAR(seen.g, 0.25f, 1e-6f);
    EXPECT_NEAR(seen.b, 0.5f, 1e-6f);
}

}  // namespace
}  // namespace lightnet::materials_test
