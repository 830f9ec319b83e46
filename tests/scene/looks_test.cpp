// Grooves and coats of surfaces, along their texture coordinates and bumps.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/surfaces/shading.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::looks_test {
namespace {

using namespace test;

/// The point of the square at (x, y), 0 < y < x < 1: on the first triangle.
SurfacePoint at(const Shading& shading, float x, float y) { return shading.point(0, 0, x - y, y); }

constexpr Vec3 up{0, 0, 1};

/// Metal with grooves along the direction that is a quarter of a turn from where u grows.
PrincipledMaterial grooved_metal(SceneData& data) {
    PrincipledMaterial metal;
    metal.base_colour = colour(data, {1, 1, 1});
    metal.metallic = 1;
    metal.roughness = {0.3f, 0.3f, {}, Roughness::Means::square};
    metal.grooves = {1, {0, 1}, {}};
    return metal;
}
/// How much more light comes back to `up` from beside it along y than along x.
float across(const SceneData& data) {
    const Shading shading(data);
    const Bsdf bsdf = shading.bsdf(at(shading, 0.5f, 0.2f));
    const float x = bsdf.evaluate(up, normalize({0.5f, 0, 1}), lobe::all).r;
    const float y = bsdf.evaluate(up, normalize({0, 0.5f, 1}), lobe::all).r;
    return y / x;
}

TEST(Grooves, AreTurnedFromTheDirectionInWhichUGrows) {
    SceneData data;
    const auto metal = grooved_metal(data);
    add(data, textured_square(), material(data, metal));
    EXPECT_GT(across(data), 5) << "rougher along y";
    auto along_u = metal;
    along_u.grooves.along = {1, 0};
    data.materials[0].model = along_u;
    EXPECT_LT(across(data), 0.2f);
    // the texture turns them by another quarter, and halves their strength
    auto half = metal, textured = metal;
    half.grooves = {0.5f, {-1, 0}, {}};
    data.materials[0].model = half;
    const float expected = across(data);
    textured.grooves.texture = picture(data, 1, 1, {{0.5f, 1, 0.5f}});
    data.materials[0].model = textured;
    EXPECT_NEAR(across(data), expected, 1e-3f * expected);
}

TEST(Grooves, GoTheOtherWayWhereTexturesAreMirrored) {
    SceneData data;
    auto metal = grooved_metal(data);
    const float root = std::sqrt(0.5f);
    metal.grooves.along = {root, root};
    const auto diagonal = [&](const Mesh& mesh) {
        data.shapes.clear();
        data.materials.clear();
        add(data, mesh, material(data, metal));
        const Shading shading(data);
        const Bsdf bsdf = shading.bsdf(at(shading, 0.5f, 0.2f));
        return bsdf.evaluate(up, normalize({0.4f, 0.4f, 1}), lobe::all).r /
               bsdf.evaluate(up, normalize({0.4f, -0.4f, 1}), lobe::all).r;
    };
    EXPECT_GT(diagonal(textured_square()), 5);
    Mesh mirrored = textured_square();
    for (Vec2& uv : mirrored.uvs) uv.y = 1 - uv.y;
    EXPECT_LT(diagonal(mirrored), 0.2f);
}

TEST(Coats, MayHaveANormalOfTheirOwn) {
    SceneData data;
    PrincipledMaterial lacquer;
    lacquer.base_colour = colour(data, {0, 0, 0});
    lacquer.specular = 0;
    lacquer.clearcoat = 1;
    lacquer.clearcoat_roughness = {0.2f, 0.2f, {}, Roughness::Means::square};
    add(data, textured_square(), material(data, lacquer));
    const Vec3 n = normalize({0.3f, 0.1f, 1});
    const auto map = picture(data, 1, 1, {{n.x / 2 + 0.5f, n.y / 2 + 0.5f, n.z / 2 + 0.5f}});
    const auto brightest = [&](Vec3 normal) {  // looks along the normal
        const Shading shading(data);
        return shading.bsdf(at(shading, 0.5f, 0.2f)).evaluate(normal, normal, lobe::all).r;
    };
    const float most = brightest(up);
    data.materials[0].normal_map = NormalMap{map};
    EXPECT_NEAR(brightest(n), most, 1e-3f * most) << "it follows the bumps of all";
    lacquer.coat_normal.own = true;
    data.materials[0].model = lacquer;
    EXPECT_NEAR(brightest(up), most, 1e-3f * most) << "it does not";
    data.materials[0].normal_map.reset();
    lacquer.coat_normal.map = NormalMap{map};
    data.materials[0].model = lacquer;
    EXPECT_NEAR(brightest(n), most, 1e-3f * most) << "it has bumps of its own";
}

}  // namespace
}  // namespace lightnet::looks_test
