// What a mesh's vertices say beside their places: tangents, further texture coordinates, how much is there.
#include <gtest/gtest.h>

#include <memory>

#include "core/scene/scene.hpp"
#include "core/scene/surfaces/shading.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::vertex_values_test {
namespace {

using namespace test;

/// The shading normal on the first triangle under a map, found by the mirror's direction.
Vec3 normal_under(const SceneData& data) {
    constexpr Vec3 up{0, 0, 1};
    const Shading shading(data);
    const auto s = shading.bsdf(shading.point(0, 0, 0.3f, 0.2f)).sample(up, 0, {}, lobe::all);
    return s ? normalize(s->incoming + up) : Vec3{};
}

TEST(VertexTangents, TurnNormalMaps) {
    const Vec3 n = normalize({0.2f, 0.1f, 1});
    for (const float hand : {1.0f, -1.0f}) {
        SceneData data;
        Mesh mesh = textured_square();
        mesh.tangents.assign(mesh.positions.size(), {{0, 1, 0}, hand});
        add(data, mesh, mirror(data, 1));
        data.materials[0].normal_map =
            NormalMap{picture(data, 1, 1, {{n.x / 2 + 0.5f, n.y / 2 + 0.5f, n.z / 2 + 0.5f}})};
        EXPECT_NEAR(length(normal_under(data) - Vec3{-n.y * hand, n.x, n.z}), 0, 1e-5f);
    }
}

TEST(VertexValues, AreMixedOverTheTriangle) {
    SceneData data;
    Mesh mesh = textured_square();
    mesh.values.alphas = {1, 0, 0.5f, 0};
    mesh.values.uvs = {{{0, 0}, {0, 0}, {0, 0}, {0, 0}}, {{0, 0}, {1, 0}, {0, 2}, {0, 0}}};
    const auto picture_of_uv = picture(data, 2, 1, {{0, 0, 0}, {1, 0, 0}});
    data.textures.emplace_back().pattern = OtherUvTexture{picture_of_uv, 1};
    const auto laid = TextureId(data.textures.size() - 1);
    data.textures.emplace_back().pattern = VertexAlpha{};
    const auto alpha = TextureId(data.textures.size() - 1);
    add(data, mesh, diffuse(data, 1));
    data.materials[0].opacity = alpha;
    const Shading shading(data);
    const TexturePlace place = place_of(shading.point(0, 0, 0.25f, 0.5f));
    EXPECT_NEAR(place.vertices.alpha(), 0.25f + 0.25f, 1e-6f);
    EXPECT_NEAR(place.vertices.uv(1).x, 0.25f, 1e-6f);
    EXPECT_NEAR(place.vertices.uv(1).y, 1, 1e-6f);
    EXPECT_EQ(place.vertices.uv(7), Vec2{});
    EXPECT_NEAR(shading.opacity_at(0, 0, 0.25f, 0.5f), 0.5f, 1e-6f);
    // u of 0.25 is the middle of the first pixel: black; of 0.5 half-way to the second
    EXPECT_EQ(value_at(data.textures, laid, place).r, 0);
    const TexturePlace half = place_of(shading.point(0, 0, 0.5f, 0.25f));
    EXPECT_NEAR(value_at(data.textures, laid, half).r, 0.5f, 1e-5f);
}

}  // namespace
}  // namespace lightnet::vertex_values_test
