#include "tools/cli/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <utility>

#include "tests/support/fake_registry.hpp"
#include "tools/cli/launcher.hpp"

namespace lightnet::options_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::StartsWith;
using testing::UnorderedElementsAre;
using Words = std::vector<std::string>;

struct GraphRun {
    GraphOptions graph;
    RunningOptions running;
};

/// What the groups of options make of a command line: a verb of the test's own keeps it.
GraphRun options_of(const Words& words) {
    GraphRun seen;
    const auto describe = [](CLI::App& app, GraphRun& options) {
        add_graph(app, options.graph);
        add_running(app, options.running);
        add_output(app, options.running.picture.output, "the picture");
    };
    const auto keep = [&](const GraphRun& options, const Launcher&) {
        seen = options;
        return 0;
    };
    std::ostringstream out, err;
    const Registry registry = test::fake_registry();
    const auto never = [](const RunRequest&) { return 1; };
    const Launcher launcher{registry, never, out, err, {verb<GraphRun>("run", "a test", describe, keep)}};
    EXPECT_EQ(launcher(words), 0) << err.str();
    return seen;
}

Finished finished_of(const Words& words) {
    const auto understood = understand(words, standard_verbs());
    const auto* finished = std::get_if<Finished>(&understood);
    if (!finished) ADD_FAILURE() << "the command line was taken";
    return finished ? *finished : Finished{};
}

// Every mistake is told on standard error, with exit code 2.
std::string usage_error(const Words& words) {
    const Finished finished = finished_of(words);
    EXPECT_EQ(finished.code, 2);
    EXPECT_THAT(finished.out, IsEmpty());
    return finished.err;
}

TEST(Options, AreAbsentWhereNothingIsSaid) {
    const auto [graph, running] = options_of({"run", "g.lua"});
    EXPECT_EQ(graph.file, "g.lua");
    EXPECT_EQ(running.hosts, "");
    EXPECT_FALSE(running.threads || running.local_workers || running.picture.samples || running.picture.size);
    EXPECT_EQ(running.progress, ProgressMode::automatic);
}

TEST(Options, TakeACrop) {
    EXPECT_EQ(options_of({"run", "g.lua", "--crop", "1,2,30,40"}).running.picture.crop, (PictureCrop{1, 2, 30, 40}));
    for (const char* wrong : {"1,2,3", "1,2,3,4,5", "a,2,3,4", "1,2,3,-4", "1 2 3 4", ""})
        EXPECT_THAT(usage_error({"run", "g.lua", "--crop", wrong}), HasSubstr("a crop is like 10,20,110,80")) << wrong;
    EXPECT_EQ(options_of({"run", "g.lua", "--preview", "0.5"}).running.preview, 0.5);
}

TEST(Options, TakePreviewsForTheDiskAndForAViewer) {
    const auto both = options_of({"run", "g.lua", "--preview", "60", "--preview", "tev"}).running;
    EXPECT_EQ(both.preview, 60);
    EXPECT_EQ(both.viewer, (WatchAddress{"127.0.0.1", 14158}));
    EXPECT_EQ(options_of({"run", "g.lua", "--preview", "tev:127.0.0.1:99"}).running.viewer,
              (WatchAddress{"127.0.0.1", 99}));
    EXPECT_THAT(usage_error({"run", "g.lua", "--preview", "tev:desk"}), HasSubstr("--insecure"));
    EXPECT_EQ(options_of({"run", "g.lua", "--preview", "tev:desk", "--insecure"}).running.viewer,
              (WatchAddress{"desk", 14158}));
    for (const char* wrong : {"tev:", "tev:desk:", "tev:300.1.1.1", "tev:a b", "tevs"})
        EXPECT_THAT(usage_error({"run", "g.lua", "--preview", wrong}), HasSubstr("tev:")) << wrong;
}

TEST(Options, TakeSizesOfCachesInUnits) {
    EXPECT_EQ(options_of({"run", "g.lua"}).running.tuning.cache_size, std::uint64_t{4} << 30);
    EXPECT_EQ(options_of({"run", "g.lua", "--cache-size", "500M"}).running.tuning.cache_size, std::uint64_t{500} << 20);
    EXPECT_EQ(options_of({"run", "g.lua", "--cache-size", "12345"}).running.tuning.cache_size, 12345u);
    EXPECT_THAT(usage_error({"run", "g.lua", "--cache-size", "much"}), HasSubstr("--cache-size"));
}

TEST(Options, StandInAnyOrder) {
    for (const Words& words :
         {Words{"run", "g.lua", "--threads", "4", "-o", "x.exr", "--samples", "9", "--size", "64x48", "--seed", "7"},
          Words{"run", "--size=64x48", "--seed", "7", "--samples=9", "-o", "x.exr", "--threads", "4", "g.lua"}}) {
        const auto [graph, running] = options_of(words);
        EXPECT_EQ(graph.file, "g.lua");
        EXPECT_EQ(running.threads, 4u);
        EXPECT_EQ(running.picture.output, "x.exr");
        EXPECT_EQ(running.picture.samples, 9u);
        EXPECT_EQ(running.picture.size, (PictureSize{64, 48}));
        EXPECT_EQ(running.seed, 7u);
    }
}

TEST(Options, TakeConstantsOneByOne) {
    const GraphOptions graph = options_of({"run", "-D", "a=1", "g.lua", "-Db=x=y", "-D", "c="}).graph;
    EXPECT_EQ(graph.file, "g.lua");
    EXPECT_THAT(graph.constants, UnorderedElementsAre(Pair("a", "1"), Pair("b", "x=y"), Pair("c", "")));
    EXPECT_THAT(usage_error({"run", "g.lua", "-D", "a"}), HasSubstr("wants NAME=VALUE"));
}

TEST(Options, MixAllWaysToRun) {
    EXPECT_EQ(options_of({"run", "g.lua", "--hosts", "h.lua"}).running.hosts, "h.lua");
    EXPECT_EQ(options_of({"run", "g.lua", "--local-workers", "2"}).running.local_workers, 2u);
    const auto mixed =
        options_of({"run", "g.lua", "--hosts", "h.lua", "--threads", "2", "--local-workers", "1"}).running;
    EXPECT_EQ(mixed.hosts, "h.lua");
    EXPECT_EQ(mixed.threads, 2u);
    EXPECT_EQ(mixed.local_workers, 1u);
    EXPECT_EQ(mixed.wait, std::nullopt) << "as long as it takes, where hosts are busy";
    EXPECT_THAT(usage_error({"run", "g.lua", "--partition", "main"}), HasSubstr("--slurm"));
}

TEST(Options, GiveLocalWorkersTroubles) {
    const auto troubles = options_of({"run", "g.lua", "--local-workers", "3", "--delay", "20", "--slow", "worker2=8",
                                      "--slow", "worker3=1.5", "--lose", "worker1@30%"})
                              .running.troubles;
    EXPECT_EQ(troubles.delay.count(), 20);
    EXPECT_THAT(troubles.slow, UnorderedElementsAre(Pair(2, 8), Pair(3, 1.5)));
    EXPECT_THAT(troubles.lose, UnorderedElementsAre(Pair(1, 0.3)));
    EXPECT_THAT(usage_error({"run", "g.lua", "--delay", "20"}), HasSubstr("--local-workers"));
    const auto wrong = [](const char* option, const char* text) {
        return usage_error({"run", "g.lua", "--local-workers", "3", option, text});
    };
    for (const char* text : {"worker2", "2=8", "worker=8", "worker2=fast", "worker2=0.5", "worker2=8x", "worker0=8"})
        EXPECT_THAT(wrong("--slow", text), HasSubstr("slowness is like worker2=8")) << text;
    for (const char* text : {"worker2", "worker2=30%", "worker2@30", "worker2@130%", "worker-2@3%"})
        EXPECT_THAT(wrong("--lose", text), HasSubstr("a loss is like worker2@30%")) << text;
    EXPECT_THAT(wrong("--lose", "worker4@30%"), HasSubstr("there is no worker4 among 3 local workers"));
    EXPECT_THAT(usage_error({"bench-hosts", "g.lua", "--local-workers", "3", "--slow", "worker4=2"}),
                HasSubstr("there is no worker4 among 3 local workers"));
}

TEST(Options, ChooseHowProgressIsShown) {
    EXPECT_EQ(options_of({"run", "g.lua", "--progress", "json"}).running.progress, ProgressMode::json);
    EXPECT_THAT(usage_error({"run", "g.lua", "--progress", "loud"}), HasSubstr("--progress"));
}

TEST(Options, HaveARunWatchedOnThisMachineUnlessTold) {
    EXPECT_FALSE(options_of({"run", "g.lua"}).running.watch);
    EXPECT_EQ(options_of({"run", "g.lua", "--watch"}).running.watch, WatchAddress{});
    EXPECT_EQ(options_of({"run", "g.lua", "--watch", "8080", "--seed", "7"}).running.watch,
              (WatchAddress{"127.0.0.1", 8080}));
    EXPECT_THAT(usage_error({"run", "g.lua", "--watch", "0.0.0.0:8080"}), HasSubstr("say --insecure if"));
    EXPECT_TRUE(options_of({"run", "g.lua", "--watch", "0.0.0.0:8080", "--insecure"}).running.watch);
    EXPECT_EQ(options_of({"run", "--watch", "g.lua"}).graph.file, "g.lua");
    EXPECT_THAT(usage_error({"run", "g.lua", "--watch", "farm"}), HasSubstr("at an address like 127.0.0.1:8080"));
    EXPECT_THAT(usage_error({"run", "g.lua", "--report", "run.json"}), HasSubstr("a report is a file like run.html"));
}

TEST(Options, SuggestTheVerbYouMeant) {
    EXPECT_EQ(usage_error({"rnu", "g.lua"}),
              "lightnet: there is no verb 'rnu' (did you mean 'run'?)\ntry: lightnet --help\n");
    EXPECT_THAT(usage_error({"chekc"}), HasSubstr("(did you mean 'check'?)"));
}

TEST(Options, SuggestTheOptionYouMeant) {
    EXPECT_THAT(usage_error({"run", "g.lua", "--thread", "2"}),
                HasSubstr("there is no option '--thread' (did you mean '--threads'?)"));
    EXPECT_THAT(usage_error({"run", "g.lua", "--sample=2"}), HasSubstr("(did you mean '--samples'?)"));
    EXPECT_THAT(usage_error({"run", "g.lua", "other.lua"}), HasSubstr("what is 'other.lua' for?"));
}

TEST(Options, SuggestTheVerbBelowAVerb) {
    EXPECT_THAT(usage_error({"scene", "inf", "x.pbrt"}),
                HasSubstr("there is no 'lightnet scene inf' (did you mean 'info'?)"));
    EXPECT_THAT(usage_error({"scene"}), HasSubstr("'lightnet scene' wants one of these behind it: info"));
}

TEST(Options, PointToTheHelpOfTheirVerb) {
    EXPECT_THAT(usage_error({"run", "g.lua", "--thread", "2"}), HasSubstr("\ntry: lightnet run --help\n"));
    EXPECT_THAT(usage_error({"render", "--size", "3", "x.pbrt"}), HasSubstr("\ntry: lightnet render --help\n"));
    EXPECT_THAT(usage_error({"scene", "info", "--deep", "x.pbrt"}), HasSubstr("\ntry: lightnet scene info --help\n"));
    EXPECT_THAT(usage_error({"run", "--thread", "2"}), HasSubstr("did you mean '--threads'?"))
        << "though the graph lacks as well";
    EXPECT_THAT(usage_error({"--threads", "2", "run", "g.lua"}),
                HasSubstr("stands after the verb: lightnet run --threads"));
}

TEST(Options, TellWhichVerbAFileIsFor) {
    EXPECT_THAT(usage_error({"x.lua"}), HasSubstr("'x.lua' is a graph file; to render it: lightnet run x.lua"));
    EXPECT_THAT(usage_error({"x.glb"}), HasSubstr("'x.glb' is a scene file; to render it: lightnet render x.glb"));
    for (const char* scene : {"box.pbrt", "box.xml", "box.gltf", "box.GLB", "box.obj", "box.ply"})
        EXPECT_THAT(usage_error({"run", scene}), HasSubstr(std::string("to render it: lightnet render ") + scene));
    EXPECT_THAT(usage_error({"check", "box.pbrt"}), HasSubstr("to look at it: lightnet scene info box.pbrt"));
    EXPECT_THAT(usage_error({"render", "x.lua"}), HasSubstr("to render it: lightnet run x.lua"));
}

TEST(Options, TellAPictureThatIsTooLargeFromASizeThatIsNone) {
    EXPECT_THAT(usage_error({"run", "g.lua", "--size", "100000x100000"}),
                HasSubstr("a picture has at most 16384 pixels along each side, not 100000x100000"));
    for (const char* wrong : {"64", "x", "64x", "x64", "0x64", "64x48x3", "64x1e9", "-1x5"})
        EXPECT_THAT(usage_error({"run", "g.lua", "--size", wrong}), HasSubstr("a size is like 640x480")) << wrong;
}

TEST(Options, HelpWithAVerbWhenAskedByAVerb) {
    EXPECT_EQ(finished_of({"help"}).out, finished_of({"--help"}).out);
    EXPECT_EQ(finished_of({"help", "run"}).out, finished_of({"run", "--help"}).out);
    EXPECT_EQ(finished_of({"help", "scene", "info"}).out, finished_of({"scene", "info", "--help"}).out);
    EXPECT_THAT(usage_error({"help", "rnu"}), HasSubstr("did you mean 'run'?"));
}

TEST(Options, WantEndpointsToListenAt) {
    EXPECT_THAT(usage_error({"run", "g.lua", "--listen", "foo"}),
                HasSubstr("--listen: must be like tcp://127.0.0.1:7777"));
    EXPECT_EQ(options_of({"run", "g.lua", "--listen", "tcp://127.0.0.1:*"}).running.listen, "tcp://127.0.0.1:*");
}

TEST(Options, RefuseNumbersThatMakeNoSense) {
    for (const Words& words :
         {Words{"run", "g.lua", "--threads", "0"}, Words{"run", "g.lua", "--threads", "many"},
          Words{"run", "g.lua", "--samples", "-1"}, Words{"run", "g.lua", "--samples", "4294967297"},
          Words{"run", "g.lua", "--samples", "1.5"}, Words{"run", "g.lua", "--size", "64"},
          Words{"run", "g.lua", "--size", "0x64"}, Words{"run", "g.lua", "--size", "64x1e9"},
          Words{"run", "g.lua", "--seed", "-1"}, Words{"run", "g.lua", "--preview", "0"},
          Words{"run", "g.lua", "--preview", "soon"}, Words{"run", "g.lua", "--local-workers", "0"}, Words{"run"}})
        EXPECT_THAT(usage_error(words), StartsWith("lightnet: ")) << words.back();
}

TEST(Options, TellTheirUseOnStandardOutput) {
    const Finished help = finished_of({"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, HasSubstr("describe"));
    EXPECT_THAT(help.err, IsEmpty());
    EXPECT_THAT(finished_of({"run", "--help"}).out, HasSubstr("--local-workers"));
    EXPECT_THAT(usage_error({}), HasSubstr("describe"));
}

TEST(Options, TellTheVersion) {
    const Finished version = finished_of({"--version"});
    EXPECT_EQ(version.code, 0);
    EXPECT_THAT(version.out, StartsWith("lightnet "));
}

}  // namespace
}  // namespace lightnet::options_test
