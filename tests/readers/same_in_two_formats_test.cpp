// The same scene in two formats is the same scene; and scenes of all formats that others made are read, where a folder
// with them is known (references.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/scene/shapes/placed_quadric.hpp"
#include "tests/support/references.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::same_in_two_formats_test {
namespace {

struct Summary {
    std::size_t triangles = 0, spheres = 0, lamps = 0;
    double area = 0;
    Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

    void add(Vec3 p) {
        for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    }
};

/// Triangles without any area don't count: formats cut poles and centres in different ways.
Summary summary(const SceneData& scene) {
    Summary result;
    for (const auto& shape : scene.shapes) {
        result.lamps += shape.emission.has_value();
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            for (const auto& t : mesh->triangles) {
                const Vec3 a = mesh->positions[t[0]], b = mesh->positions[t[1]], c = mesh->positions[t[2]];
                const double area = double(length(cross(b - a, c - a))) / 2;
                result.triangles += area > 1e-12;
                result.area += area;
                for (const Vec3 p : {a, b, c}) result.add(p);
            }
        } else if (const auto* quadric = std::get_if<Quadric>(&shape.geometry)) {
            const Box box = PlacedQuadric(*quadric).bounds();
            result.area += double(PlacedQuadric(*quadric).area());
            result.add(box.low), result.add(box.high);
        } else {
            const auto& ball = std::get<Sphere>(shape.geometry);
            const Vec3 r{ball.radius, ball.radius, ball.radius};
            result.spheres += 1;
            result.add(ball.center - r), result.add(ball.center + r);
        }
    }
    return result;
}

void expect_near(Vec3 a, Vec3 b, float by) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], by) << "axis " << i;
}

void expect_same(const SceneData& a, const SceneData& b) {
    const Summary x = summary(a), y = summary(b);
    EXPECT_EQ(x.triangles, y.triangles);
    EXPECT_EQ(x.spheres, y.spheres);
    EXPECT_EQ(x.lamps, y.lamps);
    EXPECT_NEAR(x.area / y.area, 1, 1e-3);
    const float size = length(y.high - y.low);
    expect_near(x.low, y.low, 1e-4f * size);
    expect_near(x.high, y.high, 1e-4f * size);
    const auto& camera = a.camera.to_world;
    expect_near(transform_point(camera, {0, 0, 0}), transform_point(b.camera.to_world, {0, 0, 0}), 1e-4f * size);
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        expect_near(transform_direction(camera, axis), transform_direction(b.camera.to_world, axis), 1e-4f);
    EXPECT_NEAR(a.camera.fov, b.camera.fov, 0.01f);
    EXPECT_EQ(a.film.width, b.film.width);
    EXPECT_EQ(a.film.height, b.film.height);
}

SceneData from_disk(const std::string& path) {
    DiskFiles files;
    return read_scene(files, path);
}

TEST(TwoFormats, DescribeTheSameSquare) {
    const auto xml = read_mitsuba(
        "<sensor type='perspective'><float name='fov' value='40'/><transform name='to_world'><lookat origin='1 2 5' "
        "target='0 0 0' "
        "up='0 1 0'/></transform><film type='hdrfilm'><integer name='width' value='64'/><integer name='height' "
        "value='64'/></film></sensor>"
        "<shape type='rectangle'><emitter type='area'/></shape>");
    // pbrt is left-handed: mirrored, its camera sees what a right-handed one does
    const auto pbrt = read_text(
        "Scale -1 1 1 LookAt 1 2 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 40 Film \"rgb\" \"integer "
        "xresolution\" 64 "
        "\"integer yresolution\" 64\nWorldBegin AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [ -1 "
        "-1 0 1 -1 0 1 1 0 -1 1 0 ] "
        "\"integer indices\" [ 0 1 2 0 2 3 ]");
    expect_same(xml, pbrt);
}

TEST(TwoFormats, DescribeTheSameReferences) {
    for (const std::string name : {"cornell_grey", "caustic", "indirect", "furnace05", "furnace08"}) {
        SCOPED_TRACE(name);
        expect_same(from_disk(reference_file(name + ".path.xml").value()),
                    from_disk(reference_file(name + ".path.pbrt").value()));
    }
}

#ifdef LIGHTNET_SHARED_FOLDER
const std::string shared = LIGHTNET_SHARED_FOLDER;

TEST(TwoFormats, DescribeTheSameStaircase) {
    const std::string scenes = shared + "/scenes/";
    expect_same(from_disk(scenes + "staircase2-mitsuba/scene.xml"),
                from_disk(scenes + "staircase2-pbrt/staircase2.pbrt"));
}

TEST(RealScenes, OfAllFormatsAreRead) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(shared + "/scenes")) {
        const auto path = entry.path();
        const auto ending = path.extension();
        const bool scene = path.filename() == "scene.xml" || ending == ".gltf" ||
                           (ending == ".obj" && path.string().find("mitsuba") == std::string::npos);
        if (!scene) continue;
        SCOPED_TRACE(path.string());
        const auto read = from_disk(path.string());
        EXPECT_GT(summary(read).triangles, 30u);
        EXPECT_TRUE(summary(read).lamps || !read.environments.empty() || !read.lights.empty());
        ++count;
    }
    EXPECT_GE(count, 11u);
}
#endif

}  // namespace
}  // namespace lightnet::test::same_in_two_formats_test
