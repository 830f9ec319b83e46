#include "tools/cli/launcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/base/allowance.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "core/network/graph/graph_film.hpp"
#include "tests/support/fake_registry.hpp"
#include "tests/support/folder.hpp"
#include "tools/cli/options.hpp"

namespace lightnet::launcher_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A launcher whose runs are only remembered.
class Bench {
public:
    Bench() {
        folder_.write("box.pbrt", "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n");
        graph = folder_.write("graph.lua",
                              "rays = 4\nlighting = Ambient { rays = rays }\nscene = Scene { 'box.pbrt' }\n"
                              "image = RayTracer { lighting, scene = scene, film = { 8, 4, file = 'x.exr' } }");
    }

    int operator()(std::vector<std::string> words) {
        std::ostringstream to_out, to_err;
        const auto remember = [&](const RunRequest& request) {
            runs.push_back(request);
            return 7;
        };
        const int code = Launcher{registry_, remember, to_out, to_err}(words);
        out = to_out.str();
        err = to_err.str();
        return code;
    }

    std::string write(const std::string& name, const std::string& text) { return folder_.write(name, text); }

    std::string graph, out, err;
    std::vector<RunRequest> runs;

private:
    const Registry registry_ = test::fake_registry();
    const test::Folder folder_;
};

TEST(Launcher, DrawsAGraphWithAPictureOfEachNode) {
    Bench lightnet;
    Picture picture;
    picture.width = picture.height = 2;
    picture.layers = {{"emission", std::vector<Rgb>(4)}, {"lighting", std::vector<Rgb>(4, {1, 0, 0})}};
    picture.shown = {{"first", std::vector<Rgb>(4, {0, 1, 0})}};
    picture.beauty = sum_of(picture.layers);
    const auto exr = lightnet.write("x.exr", "");
    write_exr(exr, picture);
    const auto file = [&](const std::string& node) { return exr.substr(0, exr.size() - 3) + node + ".png"; };

    EXPECT_EQ(lightnet({"dot", lightnet.graph, "--pictures", exr}), 0);
    for (const char* node : {"lighting", "image"}) {
        EXPECT_THAT(lightnet.out, HasSubstr("<IMG SRC=\"" + file(node) + "\"/>"));
        EXPECT_TRUE(std::filesystem::exists(file(node)));
    }
    EXPECT_FALSE(std::filesystem::exists(file("first"))) << "it is no node of this graph";
    EXPECT_EQ(lightnet({"dot", lightnet.graph, "--pictures", "none.exr"}), 1);
    EXPECT_THAT(lightnet.err, HasSubstr("none.exr"));
}

TEST(Launcher, DrawsOfANodeThatKeepsGroupsOfLampsTheSum) {
    Bench lightnet;
    const auto graph = lightnet.write(
        "two.lua",
        "direct = Ambient {}\nbounce = Ambient {}\nlight = Combine { direct, bounce }\nscene = Scene { 'box.pbrt' }\n"
        "image = RayTracer { light, scene = scene, film = { 2, 2, file = 'x.exr' } }");
    Picture picture;
    picture.width = picture.height = 2;
    const auto grey = [](float value) { return std::vector<Rgb>(4, {value, value, value}); };
    picture.layers = {
        {"emission.key", grey(8)}, {"direct.key", grey(0.25f)}, {"direct.sky", grey(0.5f)}, {"bounce", grey(0.125f)}};
    picture.beauty = sum_of(picture.layers);
    const auto exr = lightnet.write("x.exr", "");
    write_exr(exr, picture);
    EXPECT_EQ(lightnet({"dot", graph, "--pictures", exr}), 0) << lightnet.err;
    const auto bytes = [&](const std::string& node) {
        std::ifstream file(exr.substr(0, exr.size() - 3) + node + ".png", std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    Picture sum;
    sum.width = sum.height = 2;
    sum.beauty = grey(0.75f);
    const auto expected = lightnet.write("expected.png", "");
    write_png(expected, sum);
    std::ifstream file(expected, std::ios::binary);
    EXPECT_TRUE(bytes("direct") == std::string(std::istreambuf_iterator<char>(file), {}));
    EXPECT_FALSE(bytes("bounce").empty());
    EXPECT_FALSE(bytes("bounce") == bytes("direct"));
}

TEST(Launcher, MixesAPictureAnewBesideIt) {
    Bench lightnet;
    Picture picture;
    picture.width = picture.height = 2;
    picture.layers = {{"emission", std::vector<Rgb>(4)}, {"direct", std::vector<Rgb>(4, {1, 1, 1})}};
    picture.beauty = sum_of(picture.layers);
    const auto exr = lightnet.write("x.exr", "");
    write_exr(exr, picture);
    EXPECT_EQ(lightnet({"remix", exr, "direct=0.5"}), 0) << lightnet.err;
    EXPECT_EQ(read_exr(exr.substr(0, exr.size() - 3) + "remix.exr").beauty[0], (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(read_exr(exr).beauty[0], (Rgb{1, 1, 1}));
}

TEST(Launcher, HasWrappedClassesCheckedWhenAsked) {
    Bench lightnet;
    lightnet({"run", lightnet.graph});
    lightnet({"run", lightnet.graph, "--check-answers", "--side-fibers", "0"});
    ASSERT_EQ(lightnet.runs.size(), 2u);
    EXPECT_FALSE(lightnet.runs[0].tuning.check_answers);
    EXPECT_TRUE(lightnet.runs[1].tuning.check_answers);
    EXPECT_EQ(lightnet.runs[1].tuning.side_fibers, 0u);
}

TEST(Launcher, RunsASoundGraph) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"run", lightnet.graph}), 7) << "the run's own exit code";
    ASSERT_EQ(lightnet.runs.size(), 1u);
    const RunRequest& run = lightnet.runs[0];
    EXPECT_EQ(run.output, "x.exr");
    EXPECT_THAT(run.scene, testing::EndsWith("/box.pbrt"));
    EXPECT_EQ(run.graph.nodes[2].params.at("samples"), Value{16.0}) << "defaults are filled in";
}

TEST(Launcher, UsesAllCoresUnlessToldOtherwise) {
    Bench lightnet;
    const unsigned cores = usable_cores();
    lightnet({"run", lightnet.graph});
    EXPECT_EQ(lightnet.runs.at(0).mode, cores > 1 ? Mode::threads : Mode::serial);
    EXPECT_EQ(lightnet.runs.at(0).threads, cores);
    lightnet({"run", lightnet.graph, "--threads", "1"});
    EXPECT_EQ(lightnet.runs.at(1).mode, Mode::serial);
    const std::vector<std::vector<std::string>> asked{
        {"--hosts", lightnet.write("h.lua", "place 'tcp://127.0.0.1:7777' {}")},
        {"--local-workers", "1"},
        {"--listen", "tcp://127.0.0.1:*"},
        {"--slurm", "2"}};
    for (auto words : asked) {
        words.insert(words.begin(), {"run", lightnet.graph});
        lightnet(words);
        EXPECT_EQ(lightnet.runs.back().mode, Mode::network) << words[2];
        EXPECT_EQ(lightnet.runs.back().threads, 0u) << words[2] << ": the daemons do it";
    }
    lightnet({"run", lightnet.graph, "--local-workers", "1", "--threads", "1"});
    EXPECT_EQ(lightnet.runs.back().mode, Mode::network);
    EXPECT_EQ(lightnet.runs.back().threads, 1u) << "a place beside those of the daemon";
}

TEST(Launcher, ObeysTheLastOfTwoThatContradict) {
    Bench lightnet;
    lightnet({"run", lightnet.graph, "--samples", "16", "--seed", "1", "--samples", "1", "--seed=2"});
    ASSERT_EQ(lightnet.runs.size(), 1u) << lightnet.err;
    EXPECT_EQ(lightnet.runs[0].graph.nodes[2].params.at("samples"), Value{1.0});
    EXPECT_EQ(lightnet.runs[0].seed, 2u);
    lightnet({"run", lightnet.graph, "-D", "rays=5", "-D", "rays=6", "--gain", "lighting=2"});
    EXPECT_EQ(lightnet.runs.at(1).graph.nodes[0].params.at("rays"), Value{6.0})
        << "those that may be repeated still may";
}

TEST(Launcher, TakesTheNamesOfMachinesForSsh) {
    Bench lightnet;
    lightnet({"run", lightnet.graph, "--ssh", "anna@left,right", "--ssh", "right"});
    ASSERT_EQ(lightnet.runs.size(), 1u) << lightnet.err;
    const auto& keys = lightnet.runs[0].keys;
    ASSERT_EQ(keys.ssh.size(), 3u);
    EXPECT_EQ(keys.ssh[0].address, "anna@left");
    EXPECT_EQ(keys.ssh[0].name, "left");
    EXPECT_EQ(keys.ssh[2].name, "right-2");
    ASSERT_TRUE(keys.join);
    for (const auto& host : keys.ssh) EXPECT_EQ(keys.join->more.name_of(host.key.open), host.name);
    EXPECT_EQ(lightnet.runs[0].listen, "tcp://*:*") << "with keys it may be reached";
    EXPECT_EQ(lightnet({"run", lightnet.graph, "--ssh", "-oProxyCommand=x"}), 2);
    EXPECT_EQ(lightnet({"run", lightnet.graph, "--ssh-command", "ssh"}), 2) << "there is nobody to call";
}

TEST(Launcher, OverridesWhatTheGraphSays) {
    Bench lightnet;
    lightnet(
        {"run", lightnet.graph, "--samples", "3", "--size", "20x10", "-o", "y.exr", "-D", "rays=9", "--threads", "2"});
    ASSERT_EQ(lightnet.runs.size(), 1u) << lightnet.err;
    const RunRequest& run = lightnet.runs[0];
    EXPECT_EQ(film_of(run.graph, test::fake_registry()), (GraphFilm{20, 10, "x.exr"}));
    EXPECT_EQ(run.graph.nodes[2].params.at("samples"), Value{3.0});
    EXPECT_EQ(run.graph.nodes[0].params.at("rays"), Value{9.0});
    EXPECT_EQ(run.output, "y.exr");
    EXPECT_EQ(run.mode, Mode::threads);
    EXPECT_EQ(run.threads, 2u);
}

TEST(Launcher, KnowsTheHosts) {
    Bench lightnet;
    lightnet({"run", lightnet.graph, "--hosts", lightnet.write("h.lua", "place 'tcp://127.0.0.1:7777' { image = 1 }")});
    ASSERT_EQ(lightnet.runs.size(), 1u) << lightnet.err;
    EXPECT_EQ(lightnet.runs[0].mode, Mode::network);
    EXPECT_EQ(lightnet.runs[0].hosts.hosts.at(0).endpoint, "tcp://127.0.0.1:7777");
}

TEST(Launcher, KnowsThePlacesOfThisProcess) {
    Bench lightnet;
    const auto run_on = [&](const std::string& hosts, std::vector<std::string> more = {}) -> RunRequest {
        more.insert(more.begin(), {"run", lightnet.graph, "--hosts", lightnet.write("h.lua", hosts)});
        lightnet(more);
        return lightnet.runs.empty() ? RunRequest{} : lightnet.runs.back();
    };
    const auto alone = run_on("place 'here' { lighting = 2 }\nplace 'here' { image = 1 }");
    EXPECT_EQ(alone.mode, Mode::threads) << lightnet.err;
    EXPECT_EQ(alone.threads, 3u);
    const auto one = run_on("place 'here' { places = 1 }");
    EXPECT_EQ(one.mode, Mode::threads) << "as the file says, even where it makes no difference";
    EXPECT_EQ(one.threads, 1u);
    const auto cores = usable_cores();
    EXPECT_EQ(run_on("place 'here' {}").threads, cores);
    EXPECT_EQ(run_on("place 'here' {}\nplace 'here' { lighting = 1 }").threads, cores + 1);
    const auto mixed = run_on("place 'here' { image = 1 }\nplace 'tcp://127.0.0.1:7777' {}");
    EXPECT_EQ(mixed.mode, Mode::network);
    EXPECT_EQ(mixed.threads, 1u);
    const auto helped = run_on("place 'here' { image = 1 }", {"--local-workers", "1"});
    EXPECT_EQ(helped.mode, Mode::network);
    EXPECT_EQ(helped.threads, 1u);
}

TEST(Launcher, WantsThePlacesOfThisProcessSaidOnce) {
    Bench lightnet;
    const auto hosts = lightnet.write("h.lua", "place 'tcp://127.0.0.1:7777' {}\nplace 'here' { image = 1 }");
    EXPECT_EQ(lightnet({"run", lightnet.graph, "--hosts", hosts, "--threads", "4"}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("h.lua:2: place 'here': this file says which places this process has, and so "
                                        "--threads 4 can't; leave it out, or write places = 4 here"));
    EXPECT_THAT(lightnet.runs, IsEmpty());
}

TEST(Launcher, RunsNothingThatIsWrong) {
    Bench lightnet;
    const std::string bad = lightnet.write("bad.lua",
                                           "lighting = Ambient { ray = 1 }\nscene = Scene { 'bix.pbrt' }\n"
                                           "image = RayTracer { lighting, scene = scene, film = { 8, 4 } }\n"
                                           "local odd = Ambient {}");
    const std::string hosts = lightnet.write("h.lua", "place 'tcp://127.0.0.1:7777' { imag = 1 }");
    EXPECT_EQ(lightnet({"run", bad, "--hosts", hosts}), 2);
    EXPECT_THAT(lightnet.runs, IsEmpty());
    EXPECT_THAT(lightnet.out, IsEmpty());
    EXPECT_THAT(lightnet.err, HasSubstr(":1: Ambient 'lighting': unknown parameter 'ray' (did you mean 'rays'?)\n"));
    EXPECT_THAT(lightnet.err, HasSubstr(":2: Scene 'scene': can't read '"));
    EXPECT_THAT(lightnet.err, HasSubstr(":4: Ambient: the node has no name"));
    EXPECT_THAT(lightnet.err,
                HasSubstr("h.lua:1: place 'tcp://127.0.0.1:7777': no node called 'imag' (did you mean 'image'?)\n"));
}

TEST(Launcher, DoubtsHostsThatCannotBe) {
    Bench lightnet;
    const std::string hosts = lightnet.write("h.lua", "place 'tcp://999.999.999.999:7777' {}");
    EXPECT_EQ(lightnet({"check", lightnet.graph, "--hosts", hosts}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("h.lua:1: place 'tcp://999.999.999.999:7777': no host is called"));
}

TEST(Launcher, ChecksWithoutRunning) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"check", lightnet.graph}), 0);
    EXPECT_THAT(lightnet.out, HasSubstr("sound: 3 nodes, 8x4, layers emission lighting\n"));
    EXPECT_THAT(lightnet.err, IsEmpty());
    EXPECT_THAT(lightnet.runs, IsEmpty());
}

TEST(Launcher, ChecksTheSceneAsWell) {
    Bench lightnet;
    lightnet.write("box.pbrt", "WorldBegin\nShpae \"sphere\"\nShape \"sphere\" \"float radios\" 1\n");
    EXPECT_EQ(lightnet({"check", lightnet.graph}), 2);
    EXPECT_THAT(lightnet.err, HasSubstr("box.pbrt:2: "));
    EXPECT_THAT(lightnet.err, HasSubstr("did you mean 'Shape'?"));
}

TEST(Launcher, WarnsOfIdleNodes) {
    Bench lightnet;
    const std::string graph = lightnet.write("idle.lua",
                                             "a = Ambient {} b = Ambient {}\nscene = Scene { 'box.pbrt' }\n"
                                             "image = RayTracer { a, scene = scene, film = { 8, 4 } }");
    EXPECT_EQ(lightnet({"check", graph}), 0);
    EXPECT_THAT(lightnet.err, StartsWith("warning: "));
    EXPECT_EQ(lightnet({"run", graph}), 7);
    EXPECT_EQ(lightnet.runs.at(0).output, "idle.exr") << "the film has no file, so the graph gives the name";
}

TEST(Launcher, DrawsGraphsAndPlans) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"dot", lightnet.graph}), 0);
    EXPECT_THAT(lightnet.out, StartsWith("digraph lightnet {"));
    EXPECT_THAT(lightnet.out, Not(HasSubstr("cluster")));
    EXPECT_EQ(lightnet({"dot", lightnet.graph, "--threads", "2"}), 0);
    EXPECT_THAT(lightnet.out, HasSubstr("cluster_place_1"));
    EXPECT_EQ(lightnet({"dot", lightnet.graph, "--hosts",
                        lightnet.write("h.lua", "place 'tcp://onyx1:7777' { places = 2 }")}),
              0);
    EXPECT_THAT(lightnet.out, HasSubstr("label=\"tcp://onyx1:7777\""));
    EXPECT_EQ(lightnet({"dot", lightnet.graph, "--hosts",
                        lightnet.write("h.lua", "place 'here' { lighting = 1 } place 'here' { image = 1 }")}),
              0);
    EXPECT_THAT(lightnet.out, HasSubstr("node_image_1 -> node_lighting_0 [label=\"Query → Rgb\\ninproc bundles\"];"));
}

TEST(Launcher, ShowsAndRunsWhatIsSharded) {
    Bench lightnet;
    const std::string hosts =
        lightnet.write("h.lua", "layout = 'sharded'\nplace 'tcp://127.0.0.1:7777' {}\nplace 'tcp://127.0.0.1:7778' {}");
    EXPECT_EQ(lightnet({"check", lightnet.graph, "--hosts", hosts}), 0);
    EXPECT_THAT(lightnet.out, HasSubstr(", lighting in 2 sectors\n"));
    EXPECT_EQ(lightnet({"dot", lightnet.graph, "--hosts", hosts}), 0);
    EXPECT_THAT(lightnet.out, HasSubstr("lighting by place\\n2 sectors"));
    EXPECT_THAT(lightnet.out, HasSubstr("lighting#2"));
    lightnet({"run", lightnet.graph, "--hosts", hosts});
    EXPECT_EQ(lightnet.runs.at(0).graph.sectors.size(), 2u);
    lightnet({"run", lightnet.graph});
    EXPECT_TRUE(lightnet.runs.at(1).graph.sectors.empty());
}

TEST(Launcher, DescribesKinds) {
    Bench lightnet;
    EXPECT_EQ(lightnet({"describe"}), 0);
    EXPECT_THAT(lightnet.out, HasSubstr("RayTracer  image  makes the image"));
    EXPECT_EQ(lightnet({"describe", "Ambient"}), 0);
    EXPECT_THAT(lightnet.out, HasSubstr("rays   integer, in samples, default 4"));
    EXPECT_EQ(lightnet({"describe", "Ambeint"}), 2);
    EXPECT_EQ(lightnet.err, "lightnet: there is no kind 'Ambeint' (did you mean 'Ambient'?)\n");
}

struct Greeting {
    std::string output;
};

TEST(Launcher, HasAnotherVerbByOneLineOfATable) {
    const auto describe = [](CLI::App& app, Greeting& options) { add_output(app, options.output, "who is greeted"); };
    const auto greet = [](const Greeting& options, const Launcher& launcher) {
        launcher.out << "good morning, " << options.output << '\n';
        return 5;
    };
    std::ostringstream out, err;
    const Registry registry = test::fake_registry();
    Launcher lightnet{registry, [](const RunRequest&) { return 7; }, out, err};
    lightnet.verbs.push_back(verb<Greeting>("greet", "say good morning", describe, greet));
    EXPECT_EQ(lightnet({"greet", "-o", "onyx"}), 5);
    EXPECT_EQ(out.str(), "good morning, onyx\n");
    EXPECT_EQ(lightnet({"help"}), 0);
    EXPECT_THAT(out.str(), HasSubstr("say good morning"));
    EXPECT_EQ(lightnet({"gret"}), 2);
    EXPECT_THAT(err.str(), HasSubstr("(did you mean 'greet'?)"));
    EXPECT_EQ(lightnet({"greet", "--outptu", "onyx"}), 2);
    EXPECT_THAT(err.str(), HasSubstr("(did you mean '--output'?)\ntry: lightnet greet --help"));
}

TEST(Launcher, ToldOfARunThatFailsExitsWithOne) {
    Bench lightnet;
    const Registry registry = test::fake_registry();
    std::ostringstream out, err;
    const auto fail = [](const RunRequest&) -> int { throw Error("bounce on onyx2", "it burns"); };
    EXPECT_EQ((Launcher{registry, fail, out, err}({"run", lightnet.graph})), 1);
    EXPECT_EQ(err.str(), "lightnet: bounce on onyx2: it burns\n");
}

}  // namespace
}  // namespace lightnet::launcher_test
