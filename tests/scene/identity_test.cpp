// What makes another scene of a scene: everything that light meets, and nothing else.
#include "core/scene/data/identity.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "core/base/error.hpp"

namespace lightnet::identity_test {
namespace {

std::shared_ptr<const Image> picture(float grey) {
    return std::make_shared<const Image>(2, 1, std::vector<Rgb>{{grey, 0, 0}, {0, 0, 1}}, std::vector<float>{1, 0.5f});
}

std::shared_ptr<const Measurement> measured(float red) {
    Measurement::Numbers numbers;
    numbers.azimuths = numbers.angles = {0};
    numbers.facet_grid = numbers.area_grid = numbers.seen_grid = numbers.light_grid = {2, 2};
    numbers.facets = numbers.areas = numbers.seen = numbers.light = {1, 1, 1, 1};
    numbers.colours = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {red, 1, 1}};
    return std::make_shared<const Measurement>(numbers);
}

ImageTexture image_texture() { return {picture(0.5f), Wrap::repeat, Wrap::repeat, {}, {}, false}; }
Roughness rough() { return {0.1f, 0.2f, TextureId{1}, Roughness::Means::alpha}; }

// One of each kind, with everything that may be left out.
std::vector<Material> all_materials() {
    std::vector<Material> materials;
    const auto add = [&](auto model) {
        Material& material = materials.emplace_back();
        material.name = "named";
        material.model = std::move(model);
        material.opacity = material.bump_map = TextureId{0};
        material.normal_map = NormalMap{0, 0.5f, NormalMap::Green::across};
    };
    add(DiffuseMaterial{1, 0.1f, TextureId{1}});
    add(ConductorMaterial{{1, 1, TextureId{1}}, rough(), TextureId{1}});
    add(DielectricMaterial{1.5f, rough(), TextureId{1}, TextureId{1}, false});
    add(CoatedDiffuseMaterial{1, 1.5f, rough(), TextureId{1}, true, {}});
    add(CoatedConductorMaterial{{1, 1, TextureId{1}}, rough(), 1.5f, rough(), {}});
    PrincipledMaterial all;
    all.metallic_texture = all.transmission_texture = all.specular_texture = all.specular_colour_texture =
        all.sheen_texture = all.sheen_roughness_texture = all.clearcoat_texture = all.grooves.texture =
            all.film.share_texture = all.film.thickness_texture = all.translucence.share_texture =
                all.translucence.colour_texture = TextureId{1};
    all.coat_normal.map = NormalMap{1};
    all.roughness = all.clearcoat_roughness = rough();
    add(all);
    add(MixtureMaterial{0, 1, 1});
    add(TwoFacedMaterial{0, 1});
    add(NoMaterial{});
    add(BurleyMaterial{1, 1, 1, 1, rough(), 1, 1, 1, 1, 1, 1, 1, true, true, 1, 1});
    add(MeasuredMaterial{measured(1)});
    add(HairMaterial{1, 1, HairMaterial::Colour::melanin, 1, 1, 1, 1, true});
    return materials;
}

std::vector<Texture> all_textures() {
    return {{{1, 1, 1}, {}, false},
            {{1, 1, 1}, image_texture(), false},
            {{1, 1, 1}, CheckerTexture{0, 1, {}}, false},
            {{1, 1, 1}, ProductTexture{0, 1}, false},
            {{1, 1, 1}, MixTexture{0, 1, 2}, false},
            {{1, 1, 1}, VertexColour{}, false},
            {{1, 1, 1}, ProjectedTexture{1, {}, {}}, false},
            {{1, 1, 1}, CubesTexture{0, 1, {}}, false},
            {{1, 1, 1}, DotsTexture{0, 1, {}}, false},
            {{1, 1, 1}, DirectionTexture{0, 1, {0, 0, 1}}, false},
            {{1, 1, 1}, NoiseTexture{}, false},
            {{1, 1, 1}, MarbleTexture{}, false},
            {{1, 1, 1}, OtherUvTexture{1}, false},
            {{1, 1, 1}, VertexAlpha{}, false},
            {{1, 1, 1}, GreyTexture{1}, false}};
}

SceneData room() {
    SceneData scene;
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                    {{0, 0, 1}, {0, 0, 1}, {0, 1, 1}},
                    {{0, 0}, {1, 0}, {0, 1}},
                    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    {{0, 1, 2}},
                    false,
                    {{{{0, 1}, {1, 1}, {0, 0}}}, {1, 1, 0.5f}},
                    {{{1, 0, 0}, 1}, {{1, 0, 0}, -1}, {{0, 1, 0}, 1}}};
    scene.shapes.push_back({mesh, 1, AreaEmission{{1, 2, 3}, false, TextureId{1}}, {"room.pbrt", 7}, "lamp"});
    scene.shapes.push_back({Sphere{{1, 2, 3}, 2, false, {}}, 0, {}, {"room.pbrt", 8}, "ball"});
    scene.objects.push_back({"chair", {1}});
    scene.instances.push_back({0, {}});
    scene.materials = all_materials();
    scene.textures = all_textures();
    scene.environments.push_back({{1, 1, 1}, picture(0.25f), {}, {}});
    scene.lights = {PointLight{{0, 0, 1}, {1, 1, 1}},
                    SpotLight{{}, {0, 0, 1}, {1, 1, 1}, 0.1f, 0.2f, {}, {}, Slide{picture(0.5f)}},
                    DirectionalLight{{0, 0, -1}, {1, 1, 1}}};
    Medium medium;
    medium.extinction.grid = std::make_shared<const VolumeGrid>(VolumeGrid{.values = {0.5f}});
    medium.phase.table = {1, 2};
    medium.phase.parts = {{}};
    scene.media = {medium};
    scene.shapes[0].media = MediumSides{0, 1};
    scene.shapes.push_back({Curves{Curves::Basis::bezier, {{0, 0, 0, 1}, {}, {}, {1, 0, 0, 1}}, {0}, {0}},
                            0,
                            {},
                            {"room.pbrt", 9},
                            "hair"});
    scene.motion.shapes = {{0, {mesh}}};
    scene.motion.instances = {{0, {Matrix{}}}};
    scene.motion.lights = {{0, {PointLight{{0, 1, 1}, {1, 1, 1}}}}};
    return scene;
}

/// Walks through all numbers of a scene, and changes the one with a given index.
class Change {
public:
    explicit Change(std::size_t which) : left_(which) {}
    bool done() const { return done_; }

    template <class T>
    void operator()(T& value) {
        if constexpr (std::is_same_v<T, bool>)
            here([&] { value = !value; });
        else if constexpr (std::is_enum_v<T>)
            here([&] { value = static_cast<T>(static_cast<int>(value) + 1); });
        else if constexpr (std::is_arithmetic_v<T>)
            here([&] { value += 1; });
        else if constexpr (requires { value.m; })
            (*this)(value.m);
        else if constexpr (requires { value.r; })
            each(value.r, value.g, value.b);
        else if constexpr (requires { value.z; })
            each(value.x, value.y, value.z);
        else if constexpr (requires { value.x; })
            each(value.x, value.y);
        else
            visit_members(value, [&me = *this](auto&... members) { me.each(members...); });
    }
    template <class T>
    void operator()(std::optional<T>& value) {
        if (value) (*this)(*value);
        here([&] { value = value ? std::nullopt : std::optional(T{}); });
    }
    template <class... T>
    void operator()(std::variant<T...>& value) {
        std::visit([this](auto& one) { (*this)(one); }, value);
        here([&] {
            if (value.index() == 0)
                value.template emplace<1>();
            else
                value.template emplace<0>();
        });
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        for (T& value : values) (*this)(value);
        here([&] { values.emplace_back(); });
        if (!values.empty()) here([&] { values.pop_back(); });
    }
    template <class T, std::size_t n>
    void operator()(std::array<T, n>& values) {
        for (T& value : values) (*this)(value);
    }
    void operator()(std::shared_ptr<const Image>& image) {
        here([&] { image = picture(0.75f); });
        here([&] { image = nullptr; });
        here([&] { image = std::make_shared<const Image>(1, 2, std::vector<Rgb>(2), std::vector<float>{1, 1}); });
    }
    void operator()(std::shared_ptr<const Measurement>& measurement) {
        here([&] { measurement = measured(0.5f); });
        here([&] { measurement = nullptr; });
    }
    void operator()(std::shared_ptr<const VolumeGrid>& grid) {
        here([&] { grid = std::make_shared<const VolumeGrid>(VolumeGrid{.values = {0.25f}}); });
        here([&] { grid = std::make_shared<const VolumeGrid>(VolumeGrid{.values = {0.5f}, .fades = true}); });
    }
    void operator()(std::monostate&) {}

private:
    template <class... T>
    void each(T&... members) {
        ((*this)(members), ...);
    }
    template <class Act>
    void here(const Act& act) {
        if (left_-- != 0) return;
        act();
        done_ = true;
    }

    std::size_t left_;
    bool done_ = false;
};

TEST(Identity, IsAnotherWheneverAnyNumberThatLightMeetsIs) {
    std::map<Hash, std::size_t> seen{{identity_of(room()), 0}};
    std::size_t changes = 0;
    for (;; ++changes) {
        SceneData scene = room();
        Change change(changes);
        visit_members(scene, [&](auto&... members) { (change(members), ...); });
        if (!change.done()) break;
        const auto [other, added] = seen.emplace(identity_of(scene), changes);
        EXPECT_TRUE(added) << "change " << changes << " looks like change " << other->second << " or like none";
    }
    EXPECT_GT(changes, 400u) << "the walk came to an early end";
}

void expect_another(const char* what, void (*change)(SceneData&)) {
    SceneData scene = room();
    change(scene);
    EXPECT_NE(identity_of(scene), identity_of(room())) << what;
}

template <class Model>
Model& first(SceneData& scene) {
    for (auto& material : scene.materials)
        if (auto* model = std::get_if<Model>(&material.model)) return *model;
    throw std::logic_error("there is none of that kind");
}

TEST(Identity, KnowsGlassRoughnessMetalsCutOutsBumpsAndTheSidesOfLamps) {
    expect_another("eta", [](SceneData& scene) { first<DielectricMaterial>(scene).eta = 1.33f; });
    expect_another("roughness", [](SceneData& scene) { first<ConductorMaterial>(scene).roughness.v = 0.9f; });
    expect_another("metalness", [](SceneData& scene) { first<PrincipledMaterial>(scene).metallic = 1; });
    expect_another("which texture", [](SceneData& scene) { first<DiffuseMaterial>(scene).reflectance = 0; });
    expect_another("opacity", [](SceneData& scene) { scene.materials[0].opacity = std::nullopt; });
    expect_another("a portal", [](SceneData& scene) {
        scene.environments[0].portal = Portal{{}, {1, 0, 0}, {0, 1, 0}};
    });
    expect_another("bumps", [](SceneData& scene) { scene.materials[0].normal_map = NormalMap{0, 2}; });
    expect_another("normals", [](SceneData& scene) { std::get<Mesh>(scene.shapes[0].geometry).normals[1].x = 1; });
    expect_another("uv", [](SceneData& scene) { std::get<Mesh>(scene.shapes[0].geometry).uvs[2].y = 0.5f; });
    expect_another("sides", [](SceneData& scene) { scene.shapes[0].emission->two_sided = true; });
    expect_another("lamp's picture", [](SceneData& scene) { scene.shapes[0].emission->texture = 0; });
    expect_another("repeated picture",
                   [](SceneData& scene) { std::get<ImageTexture>(scene.textures[1].pattern).wrap_u = Wrap::black; });
    expect_another("one pixel", [](SceneData& scene) {
        std::get<ImageTexture>(scene.textures[1].pattern).image = std::make_shared<const Image>(
            2, 1, std::vector<Rgb>{{0.5f, 0, 0}, {0, 0, 0.999f}}, std::vector<float>{1, 0.5f});
    });
    expect_another("spot", [](SceneData& scene) { std::get<SpotLight>(scene.lights[1]).inner = 0.15f; });
    expect_another("which shapes a chair has", [](SceneData& scene) { scene.objects[0].shapes = {0}; });
}

TEST(Identity, IsTheSameForAnotherViewOfTheSameRoom) {
    SceneData scene = room();
    scene.camera.fov = 30;
    scene.camera_given = true;
    scene.film.width = 7;
    scene.warnings.push_back({{"room.pbrt", 1}, "something"});
    scene.materials[0].name = scene.shapes[0].name = scene.objects[0].name = "other";
    scene.shapes[0].where = {"elsewhere.pbrt", 9};
    std::get<ImageTexture>(scene.textures[1].pattern).image = picture(0.5f);  // the same, read again
    EXPECT_EQ(identity_of(scene), identity_of(room()));
}

// Parts of the tree that differ from those of the room as it was.
SceneParts changed_by(const std::function<void(SceneData&)>& change) {
    SceneData scene = room();
    change(scene);
    const SceneTree before = tree_of(room()), after = tree_of(scene);
    SceneParts changed;
    for (const auto& [part, hash] : after.parts)
        if (hash != before.parts.at(part)) changed |= part;
    return changed;
}

// With a shape for each material and texture.
SceneData with_all_used(SceneData scene) {
    const auto add = [&](MaterialId material) {
        Shape ball = scene.shapes[1];
        ball.material = material;
        scene.shapes.push_back(ball);
    };
    for (std::size_t i = 0; i < all_materials().size(); ++i) add(MaterialId(std::uint32_t(i)));
    for (std::size_t i = 0; i < all_textures().size(); ++i) {
        scene.materials.push_back({"", DiffuseMaterial{TextureId(std::uint32_t(i))}});
        add(MaterialId(std::uint32_t(scene.materials.size() - 1)));
    }
    return scene;
}

TEST(SceneTree, IsTheSameWhateverMaterialNobodyHas) {
    EXPECT_EQ(changed_by([](SceneData& scene) {
                  scene.textures.push_back({{7, 7, 7}, {}, false});
              }),
              changed_by([](SceneData& scene) {
                  scene.textures.push_back({{1, 1, 1}, {}, false});
              }));
    SceneData scene = room();
    scene.textures.push_back({{1, 1, 1}, {}, false});
    const TextureId paint(std::uint32_t(scene.textures.size() - 1));
    scene.materials.push_back({"spare", DiffuseMaterial{paint}});
    const auto before = tree_of(scene);
    scene.textures[paint].scale.r = 0.5f;
    std::get<DiffuseMaterial>(scene.materials.back().model).sigma = 0.1f;
    EXPECT_EQ(tree_of(scene).of(scene_of_light), before.of(scene_of_light));
    scene.materials[0].model = TwoFacedMaterial{MaterialId(std::uint32_t(scene.materials.size() - 1)), 1};
    const auto used = tree_of(scene);
    scene.textures[paint].scale.r = 0.25f;
    EXPECT_NE(tree_of(scene).of(scene_of_light), used.of(scene_of_light)) << "it is one side of another";
}

TEST(SceneTree, IsAnotherWheneverAnyNumberThatLightMeetsIs) {
    std::map<Hash, std::size_t> seen{{tree_of(with_all_used(room())).of(scene_of_light), 0}};
    for (std::size_t changes = 0;; ++changes) {
        SceneData scene = room();
        Change change(changes);
        visit_members(scene, [&](auto&... members) { (change(members), ...); });
        if (!change.done()) break;
        const auto [other, added] = seen.emplace(tree_of(with_all_used(std::move(scene))).of(scene_of_light), changes);
        EXPECT_TRUE(added) << "change " << changes << " looks like change " << other->second << " or like none";
    }
}

TEST(SceneTree, TellsLampsFromWhatTheyShineOn) {
    const SceneParts lamps = ScenePart::lamps;
    EXPECT_EQ(changed_by([](SceneData& scene) { std::get<PointLight>(scene.lights[0]).position.x = 7; }), lamps);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.shapes[0].emission->radiance.r = 7; }), lamps);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.environments[0].radiance.r = 7; }), lamps);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.environment_group = 1; }), lamps);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.motion.lights.clear(); }), lamps);
}

TEST(SceneTree, HasWhatHangsOnSurfacesChangeWithThem) {
    const SceneParts all = scene_of_light;
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.instances[0].to_world.m[0][3] = 7; }),
              ScenePart::geometry | SceneParts(ScenePart::lamps) | ScenePart::media);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.materials[0].normal_map->scale = 7; }), all);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.textures[0].scale.r = 7; }), all);
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.around = 0; }), SceneParts(ScenePart::media));
}

TEST(SceneTree, KnowsNamesAndGroupsOfLamps) {
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.materials[0].name = "another"; }), SceneParts(ScenePart::names));
    EXPECT_EQ(changed_by([](SceneData& scene) { scene.shapes[0].name = "another"; }), SceneParts(ScenePart::names));
    EXPECT_EQ(changed_by([](SceneData& scene) {
                  scene.groups = {"key", "rest"};
              }),
              ScenePart::lamps | ScenePart::names);
}

TEST(SceneTree, HasABranchForEachGroupOfLamps) {
    SceneData scene = room();
    scene.groups = {"key", "fill", "rest"};
    scene.environment_group = 2;
    std::get<SpotLight>(scene.lights[1]).label.group = 1;
    const SceneTree before = tree_of(scene);
    std::get<SpotLight>(scene.lights[1]).position.x = 7;
    const SceneTree after = tree_of(scene);
    ASSERT_EQ(after.lamps.size(), 3u);
    EXPECT_EQ(after.lamps[0], before.lamps[0]);
    EXPECT_NE(after.lamps[1], before.lamps[1]);
    EXPECT_EQ(after.lamps[2], before.lamps[2]);
    const auto lamps = [](const SceneTree& tree, GroupSet groups) { return tree.of(scene_of_light, groups); };
    EXPECT_EQ(lamps(after, 0b101), lamps(before, 0b101)) << "of those who look for others";
    EXPECT_NE(lamps(after, 0b110), lamps(before, 0b110));
    EXPECT_NE(lamps(after, all_groups), lamps(before, all_groups));
    EXPECT_NE(lamps(before, 0b001), lamps(before, 0b100));
    scene.instances[0].to_world.m[0][3] = 7;
    EXPECT_NE(lamps(tree_of(scene), 0b101), lamps(before, 0b101)) << "whatever lamps shine on";
}

TEST(SceneTree, KnowsCameraAndFilmWhenItIsTold) {
    SceneTree tree = tree_of(room());
    EXPECT_THROW(tree.of(ScenePart::camera), Error);
    CameraData camera;
    FilmData film;
    tree.look_by(camera, film);
    SceneTree other = tree;
    film.scale = 2;
    other.look_by(camera, film);
    EXPECT_EQ(other.of(ScenePart::camera), tree.of(ScenePart::camera));
    EXPECT_NE(other.of(ScenePart::film), tree.of(ScenePart::film));
    camera.later = {camera};
    camera.later.front().fov = 7;
    other.look_by(camera, {});
    EXPECT_NE(other.of(ScenePart::camera), tree.of(ScenePart::camera));
    EXPECT_EQ(other.of(scene_of_light), tree.of(scene_of_light));
}

}  // namespace
}  // namespace lightnet::identity_test
