// `lightnet render` and `lightnet scene info`.
#include "tools/cli/render.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/gltf_text.hpp"
#include "tools/cli/launcher.hpp"

namespace lightnet::render_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

/// A launcher that remembers its run, and a folder with a scene.
class Bench {
public:
    Bench() {
        scene = folder_.write("ball.pbrt",
                              "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20\n"
                              "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n"
                              "AttributeBegin Scale 0 1 1 Shape \"sphere\" AttributeEnd\n");
    }

    int operator()(std::vector<std::string> words) {
        std::ostringstream to_out, to_err;
        const auto remember = [&](const RunRequest& request) {
            runs.push_back(request);
            return 7;
        };
        const int code = Launcher{registry, remember, to_out, to_err}(words);
        out = to_out.str(), err = to_err.str();
        return code;
    }

    SceneOverrides overrides() const { return scene_overrides(runs.at(0).graph, registry); }
    std::string write(const std::string& name, const std::string& text) { return folder_.write(name, text); }

    const Registry registry{standard_nodes()};
    std::string scene, out, err;
    std::vector<RunRequest> runs;

private:
    const test::Folder folder_;
};

TEST(Render, MakesAGraphOfASceneFile) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"render", lightnet.scene}), 7) << lightnet.err;
    const RunRequest& run = lightnet.runs.at(0);
    EXPECT_EQ(film_of(run.graph, lightnet.registry), (GraphFilm{30, 20, ""})) << "the scene's own size";
    EXPECT_EQ(scene_file(run.graph, lightnet.registry), run.scene);
    EXPECT_EQ(run.scene, lightnet.scene);
    EXPECT_EQ(run.output, "ball.exr");
    EXPECT_EQ(layers_of(run.graph, lightnet.registry).film, (std::vector<std::string>{"emission", "direct", "bounce"}))
        << "all light, in layers";
    EXPECT_EQ(run.read->scene.shapes.size(), 1u) << "read once, for its size and for the run";
}

TEST(Render, BlursASequenceOfFilesTowardsTheNext) {
    Bench lightnet;
    const auto triangle = [](const std::string& x) { return "v " + x + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"; };
    const auto first = lightnet.write("m.01.obj", triangle("0"));
    lightnet.write("m.02.obj", triangle("4"));
    const auto files = std::filesystem::path(first).parent_path() / "m.##.obj";
    EXPECT_EQ(lightnet({"render", files, "--shutter", "180", "-o", "x.exr"}), 7) << lightnet.err;
    const auto& motion = lightnet.runs.at(0).read->scene.motion;
    ASSERT_EQ(motion.shapes.size(), 1U);
    EXPECT_FLOAT_EQ(std::get<Mesh>(motion.shapes[0].later.back()).positions.at(0).x, 2) << "half a frame";
}

TEST(Render, ChoosesOneOfTheAnimationsThatSceneInfoLists) {
    Bench lightnet;
    test::GltfText text = test::triangle_text();
    text.vectors("SCALAR", {0, 2});
    text.vectors("VEC3", {0, 0, 0, 0, 0, 8});
    const auto one = [](const char* name) {
        return std::string(R"({"name":")") + name + R"(","samplers":[{"input":1,"output":2}],
            "channels":[{"sampler":0,"target":{"node":0,"path":")" +
               (*name ? "translation" : "scale") + R"("}}]})";
    };
    const auto scene = lightnet.write(
        "walk.glb", text.file(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                              R"("animations":[)" +
                              one("") + "," + one("walk") + "],"));
    EXPECT_EQ(lightnet({"scene", "info", scene}), 0) << lightnet.err;
    EXPECT_THAT(lightnet.out, AllOf(HasSubstr("animation 1    2 s\n"), HasSubstr("animation 2    walk, 2 s\n")));
    for (const char* name : {"walk", "2"})
        EXPECT_EQ(lightnet({"render", scene, "--animation", name, "--shutter", "360", "-o", "x.exr"}), 7)
            << lightnet.err;
    for (const auto& run : lightnet.runs) {
        const auto& later = run.read->scene.motion.shapes.at(0).later.back();
        EXPECT_FLOAT_EQ(std::get<Mesh>(later).positions.at(0).z, 4 / 24.f) << "in a frame";
    }
    EXPECT_EQ(lightnet({"render", scene, "--animation", "run", "-o", "x.exr"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("there is no animation 'run' (there is: 1, walk)"));
}

TEST(Render, MovesTheCameraOfAGraphBetweenItsFrames) {
    Graph graph;
    graph.nodes = {{"scene", "Scene", {{std::string("a.obj")}}, {}, {}}, {"image", "RayTracer", {}, {}, {}}};
    const auto camera = [](double x) {
        return Value{Table{{}, {{"from", {Table{{{x}, {0.0}, {5.0}}, {}}}}, {"fov", {40 + x}}}}};
    };
    auto& params = graph.nodes[0].params;
    params = {{"camera", camera(0)},           {"next_camera", camera(4)},
              {"previous_camera", camera(-8)}, {"shutter", {Table{{{-0.25}, {0.25}}, {}}}},
              {"environment_scale", {1.0}},    {"exposure", {0.0}}};
    graph.nodes[1].params["scene"] = {NodeRef{"scene"}};
    const auto overrides = scene_overrides(graph, Registry{standard_nodes()});
    EXPECT_FLOAT_EQ(overrides.camera->from->x, -2) << "as the shutter opens";
    ASSERT_EQ(overrides.camera_later.size(), 8U);
    EXPECT_FLOAT_EQ(overrides.camera_later[3].from->x, 0);
    EXPECT_FLOAT_EQ(overrides.camera_later[7].from->x, 1);
    EXPECT_FLOAT_EQ(*overrides.camera_later[7].fov, 41);
    EXPECT_FLOAT_EQ(overrides.next_camera->from->x, 3) << "as the next frame's does";
}

// What hosts read by the graph is what was read here for the picture's size.
TEST(Render, ReadsTheSceneByTheConstantsOfItsGraph) {
    Bench lightnet;
    const auto scene = lightnet.write("ball.xml",
                                      "<scene version='3.0.0'><default name='r' value='1'/><shape type='sphere'>"
                                      "<float name='radius' value='$r'/></shape></scene>");
    const auto graph =
        lightnet.write("light.lua",
                       "light = AmbientOcclusion {}\nscene = Scene { 'other.pbrt', constants = { r = 3 } }\n"
                       "image = RayTracer { light, scene = scene, film = { 8, 4 } }\n");
    EXPECT_EQ(lightnet({"render", scene, "--lighting", graph}), 7) << lightnet.err;
    const RunRequest& run = lightnet.runs.at(0);
    EXPECT_EQ(std::get<Sphere>(run.read->scene.shapes.at(0).geometry).radius, 3);
    EXPECT_EQ(scene_constants(run.graph, lightnet.registry).at("r"), "3");
}

TEST(Render, TakesTheOptionsOfRun) {
    Bench lightnet;
    lightnet({"render", lightnet.scene, "--samples", "3", "--size", "8x4", "-o", "y.exr", "--local-workers", "2",
              "--lighting", "ao", "--env", "1,0.5,0.25", "--exposure", "2", "--two-sided"});
    const RunRequest& run = lightnet.runs.at(0);
    EXPECT_EQ(film_of(run.graph, lightnet.registry), (GraphFilm{8, 4, ""}));
    EXPECT_EQ(run.output, "y.exr");
    EXPECT_EQ(run.mode, Mode::network);
    EXPECT_EQ(run.graph.nodes[1].kind, "AmbientOcclusion");
    EXPECT_EQ(lightnet.overrides().environment, (std::variant<std::monostate, Rgb, std::string>(Rgb{1, 0.5f, 0.25f})));
    EXPECT_EQ(run.png.stops, 2);
    EXPECT_EQ(lightnet.overrides().exposure, 0) << "the EXR stays as it is";
    EXPECT_TRUE(lightnet.overrides().two_sided);
}

TEST(Render, LeavesTheExposureOfAGraphToIt) {
    Bench lightnet;
    const std::string graph = lightnet.write("own.lua",
                                             "scene = Scene { 'ball.pbrt', exposure = 1 } light = DirectLighting {}\n"
                                             "image = RayTracer { light, scene = scene, film = { 8, 8 } }");
    EXPECT_EQ(lightnet({"run", graph, "--exposure", "-2.5"}), 7) << lightnet.err;
    EXPECT_EQ(lightnet.overrides().exposure, 1);
    EXPECT_EQ(lightnet.runs.at(0).png.stops, -2.5);
}

TEST(Render, DefinesVariablesOfTheSceneFileOnAllHosts) {
    Bench lightnet;
    const std::string scene =
        lightnet.write("ball.xml",
                       "<scene version='3.0.0'><default name='radius' value='1'/>"
                       "<shape type='sphere'><float name='radius' value='$radius'/></shape></scene>");
    EXPECT_EQ(lightnet({"render", scene, "-D", "radius=3"}), 7) << lightnet.err;
    const RunRequest& run = lightnet.runs.at(0);
    EXPECT_EQ(std::get<Sphere>(run.read->scene.shapes.at(0).geometry).radius, 3);
    DiskFiles files;  // a host has the graph and the files, and nothing else
    const SceneData there = load_scene(run.graph, lightnet.registry, files, scene).data;
    EXPECT_EQ(std::get<Sphere>(there.shapes.at(0).geometry).radius, 3);
    EXPECT_EQ(lightnet({"scene", "info", scene, "-D", "radius=3"}), 0) << lightnet.err;
    EXPECT_THAT(lightnet.out, HasSubstr("(-3, -3, -3) to (3, 3, 3)"));
    EXPECT_EQ(lightnet({"render", scene, "-D", "raduis=3"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("there is no variable 'raduis' to define (did you mean 'radius'?)"));
}

TEST(Render, LightsByAnyGraph) {
    Bench lightnet;
    const std::string graph = lightnet.write("two.lua",
                                             "strong = 2 scene = Scene { 'missing.pbrt', exposure = strong }\n"
                                             "a = DirectLighting {} b = PathTracing {} both = Combine { a, b }\n"
                                             "image = RayTracer { both, scene = scene, film = { 512, 512 } }");
    const std::string sky = lightnet.write("sky.hdr", "");
    lightnet({"render", lightnet.scene, "--lighting", graph, "--env", sky, "-D", "strong=3"});
    const RunRequest& run = lightnet.runs.at(0);
    EXPECT_EQ(run.scene, lightnet.scene);
    EXPECT_EQ(film_of(run.graph, lightnet.registry), (GraphFilm{30, 20, ""}));
    EXPECT_EQ(std::get<std::string>(lightnet.overrides().environment), sky);
    EXPECT_EQ(lightnet.overrides().exposure, 3);
}

// Reading a scene starts threads, of which a child that runs Lua would have nothing but their locks.
TEST(Render, RunsItsGraphBeforeItReadsTheScene) {
    Bench lightnet;
    const std::string graph = lightnet.write("broken.lua", "this is no Lua");
    EXPECT_EQ(lightnet({"render", "no.pbrt", "--lighting", graph}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("broken.lua:1: "));
    EXPECT_THAT(lightnet.err, testing::Not(HasSubstr("no.pbrt")));
}

TEST(Render, RunsItsHostsBeforeItReadsTheScene) {
    Bench lightnet;
    const std::string hosts = lightnet.write("hosts.lua", "print('hosts') place 'tcp://127.0.0.1:1' {}");
    const std::string scene = lightnet.write("slow.pbrt", "WorldBegin Shape \"sphere\" Nonsense\n");
    testing::internal::CaptureStderr();
    EXPECT_EQ(lightnet({"render", scene, "--hosts", hosts}), 2) << "the scene is no scene";
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "hosts\n") << "hosts were not read yet";
}

TEST(Render, KeepsTheCropOfTheScene) {
    Bench lightnet;
    const std::string scene = lightnet.write("part.pbrt",
                                             "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20 "
                                             "\"float cropwindow\" [ 0.25 0.5 0 1 ]\n"
                                             "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n");
    lightnet({"render", scene});
    lightnet({"render", scene, "--size", "100x100"});
    lightnet({"render", scene, "--crop", "1,2,3,4"});
    const auto crop = [&](std::size_t run) { return film_of(lightnet.runs.at(run).graph, lightnet.registry).crop; };
    EXPECT_EQ(crop(0), (Window{8, 0, 7, 20}));
    EXPECT_EQ(crop(1), (Window{25, 0, 25, 100}));
    EXPECT_EQ(crop(2), (Window{1, 2, 2, 2}));
}

TEST(Render, SaysWhatIsWrong) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"render", lightnet.scene, "--lighting", "pth"}), 2);
    EXPECT_THAT(
        lightnet.err,
        HasSubstr(
            "must be auto, path, path_all, irradiance_cache, progressive, guided, figure5, direct, ao or a graph file "
            "(.lua), not 'pth' (did you mean 'path'?)"));
    EXPECT_EQ(lightnet({"render", lightnet.scene, "--env", "no.exr"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("no.exr'"));
    EXPECT_EQ(lightnet({"render", lightnet.scene, "-D", "a=1"}), 2);
    EXPECT_THAT(
        lightnet.err,
        HasSubstr("pbrt's files have no variables but 'pbrt', which of its versions they mean: there is no 'a'"));
    EXPECT_EQ(lightnet({"render", "no.pbrt"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("can't read the scene"));
    EXPECT_EQ(lightnet({"render", lightnet.scene, "--smaples", "3"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("did you mean '--samples'?"));
    EXPECT_THAT(lightnet.runs, IsEmpty());
}

TEST(SceneInfo, TellsWhatIsInAFile) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"scene", "info", lightnet.scene}), 0) << lightnet.err;
    for (const char* part :
         {"0 in 0 meshes", "1 spheres", "1 diffuse", "1 constant environments", "(-1, -1, -1) to (1, 1, 1)",
          "perspective, 90 degrees", "30 x 20", "s to read", "MiB in all", "ball.pbrt:6: ", "singular transform"})
        EXPECT_THAT(lightnet.out, HasSubstr(part));
}

TEST(SceneInfo, CountsInstances) {
    Bench lightnet;
    const std::string scene = lightnet.write(
        "two.pbrt",
        "WorldBegin ObjectBegin \"o\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] ObjectEnd\n"
        "ObjectInstance \"o\" Translate 5 0 0 ObjectInstance \"o\" LightSource \"point\" LightSource \"distant\"");
    EXPECT_EQ(lightnet({"scene", "info", scene}), 0) << lightnet.err;
    for (const char* part :
         {"1 in 1 meshes, 2 with all instances", "0 spheres, 0 quadrics, 0 curves, 1 objects, 2 instances",
          "1 directions, 1 points", "(0, 0, 0) to (6, 1, 0)", "none in the file", "approximations none"})
        EXPECT_THAT(lightnet.out, HasSubstr(part));
}

}  // namespace
}  // namespace lightnet::render_test
