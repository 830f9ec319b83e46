// Mixing layers anew gives the bytes of a rendering with those gains.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <random>

#include "core/film/gains.hpp"
#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

class Remix : public ::testing::Test {
protected:
    /// The EXR and the PNG, one behind the other.
    std::string written(const std::string& name) const {
        return bytes_of(folder / (name + ".exr")) + bytes_of(folder / (name + ".png"));
    }
    std::string rendered(const Words& more, const std::string& graph = "cornell.lua") const {
        Process run(launch_words(graph_file(graph), folder / "rendered.exr", more));
        EXPECT_EQ(run.wait(), 0) << run.output();
        return written("rendered");
    }
    std::string remixed(const Words& gains) const {
        Words words{program("lightnet"), "remix", folder / "plain.exr", "-o", folder / "mixed.exr"};
        words.insert(words.end(), gains.begin(), gains.end());
        Process run(words);
        EXPECT_EQ(run.wait(), 0) << run.output();
        return written("mixed");
    }
    void render_plain(const Words& more, const std::string& graph = "cornell.lua") const {
        Process run(launch_words(graph_file(graph), folder / "plain.exr", more));
        ASSERT_EQ(run.wait(), 0) << run.output();
    }
    static Words as_options(const Words& gains) {
        Words words;
        for (const auto& gain : gains) words.insert(words.end(), {"--gain", gain});
        return words;
    }
    static Words join(Words a, const Words& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    }
    const Words small{"--size", "16x16", "--samples", "8", "--threads", "1"};
    const Folder folder;
};

// Of layers that are chosen by chance, grey or coloured, small and large.
Words random_gains(std::mt19937& random) {
    const auto number = [&] {
        const float part = static_cast<float>(random() >> 8) * 0x1p-24f;
        return random() % 8 == 0 ? 0.f : std::ldexp(part, int(random() % 12) - 6);
    };
    Words gains;
    for (const char* layer : {"emission", "direct", "bounce"}) {
        if (random() % 4 == 0) continue;
        Gain gain{layer, {number(), number(), number()}};
        if (random() % 2) gain.value.g = gain.value.b = gain.value.r;
        gains.push_back(to_string(gain));
    }
    return gains;
}

TEST_F(Remix, GivesTheBytesOfARenderingWithThoseGains) {
    render_plain(small);
    std::mt19937 random(1);
    for (int i = 0; i < 100 / slowdown; ++i) {
        const auto gains = random_gains(random);
        EXPECT_EQ(remixed(gains), rendered(join(small, as_options(gains)))) << testing::PrintToString(gains);
    }
}

#if defined(LIGHTNET_LARGE)
// A third of them each: serial, threads, and daemons of which one is killed while it works.
TEST_F(Remix, GivesThemForAHundredMixesInEveryMode) {
    const Words words{"--size", "48x48", "--samples", "64", "--tile", "16"};
    render_plain(join(words, {"--threads", "1"}));
    std::mt19937 random(7);
    for (int i = 0; i < 100; ++i) {
        const auto gains = random_gains(random);
        auto more = join(words, as_options(gains));
        if (i % 3 < 2) {
            EXPECT_EQ(rendered(join(more, {"--threads", i % 3 ? "3" : "1"})), remixed(gains)) << i;
            continue;
        }
        const Daemon lost(folder), healthy(folder);
        const auto hosts =
            folder.write("hosts.lua", "place '" + lost.endpoint + "' {}\nplace '" + healthy.endpoint + "' {}\n");
        Process run(launch_words(graph_file("cornell.lua"), folder / "rendered.exr",
                                 join(more, {"--hosts", hosts, "--progress", "json"})));
        run.wait_for("\"event\":\"progress\"");
        lost.process->signal(SIGKILL);
        ASSERT_EQ(run.wait(), 0) << run.output();
        EXPECT_EQ(written("rendered"), remixed(gains)) << i;
    }
}
#endif

TEST_F(Remix, GivesThemForGainsOfTheGraph) {
    auto text = bytes_of(graph_file("cornell.lua"));
    const std::string film = "film = { size, size,";
    text.insert(text.find(film) + film.size(), " gains = { direct = 0.5, bounce = { 1.2, 1.1, 0 } },");
    folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    const auto graph = folder.write("gains.lua", text);
    render_plain(small);
    Process run(launch_words(graph, folder / "rendered.exr", small));
    EXPECT_EQ(run.wait(), 0) << run.output();
    EXPECT_EQ(written("rendered"), remixed({"bounce=1.2,1.1,0", "direct=0.5"}));
    Process again(launch_words(graph, folder / "rendered.exr", join(small, {"--gain", "direct=1"})));
    EXPECT_EQ(again.wait(), 0) << again.output();
    EXPECT_EQ(written("rendered"), remixed({"bounce=1.2,1.1,0"})) << "the command line has the last word";
}

TEST_F(Remix, GivesThemForGroupsOfLampsThroughEveryCache) {
    const Words maps{"-D",     "photons=2000", "-D",        "rays=32", "-D",      "wanted_error=0.0625",
                     "--size", "16x12",        "--samples", "4",       "--cache", "none"};
    render_plain(join(maps, {"--threads", "1"}), "studio_maps.lua");
    for (const Words& gains : {Words{"key=0.3"}, Words{"rim=0", "fill=2,1.5,0.7", "direct=1.1"},
                               Words{"soft.key=0.6", "key=0.7", "soft=0.9", "emission=0"}})
        EXPECT_EQ(remixed(gains), rendered(join(join(maps, {"--threads", "2"}), as_options(gains)), "studio_maps.lua"))
            << testing::PrintToString(gains);
}

TEST_F(Remix, GivesThemWhereCellsDecideAboutTheirSamples) {
    const Words adaptive{"-D", "error=0.2", "--size", "32x32", "--samples", "256", "--threads", "2"};
    folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    auto text = bytes_of(graph_file("cornell.lua"));
    text = "error = 0\n" + text;
    text.insert(text.find("samples = samples"), "error = error, ");
    const auto graph = folder.write("adaptive.lua", text);
    Process plain(launch_words(graph, folder / "plain.exr", adaptive));
    ASSERT_EQ(plain.wait(), 0) << plain.output();
    Process run(launch_words(graph, folder / "rendered.exr", join(adaptive, {"--gain", "bounce=4"})));
    ASSERT_EQ(run.wait(), 0) << run.output();
    EXPECT_THAT(bytes_of(folder / "rendered.exr"), HasSubstr("samples")) << "their number differs";
    EXPECT_EQ(written("rendered"), remixed({"bounce=4"}));
}

TEST_F(Remix, GivesThemAfterAHostWasLost) {
    const Words more{"--size", "64x64", "--samples", "256", "--tile", "16"};
    render_plain(more);
    const Daemon lost(folder), healthy(folder);
    const auto hosts =
        folder.write("hosts.lua", "place '" + lost.endpoint + "' {}\nplace '" + healthy.endpoint + "' {}\n");
    Process run(launch_words(graph_file("cornell.lua"), folder / "rendered.exr",
                             join(more, {"--hosts", hosts, "--gain", "direct=0,1,2", "--progress", "json"})));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    lost.process->signal(SIGKILL);
    ASSERT_EQ(run.wait(), 0) << run.output();
    EXPECT_EQ(written("rendered"), remixed({"direct=0,1,2"}));
}

TEST_F(Remix, GoesOnFromACheckpointOfOtherGains) {
    render_plain(small);
    rendered(join(small, {"--gain", "bounce=3"}));
    const auto more = rendered({"--size", "16x16", "--samples", "32", "--threads", "1", "--resume"});
    render_plain({"--size", "16x16", "--samples", "32", "--threads", "1"});
    EXPECT_EQ(more, written("plain"));
}

TEST_F(Remix, TellsWhichLayersThereAre) {
    render_plain(small);
    Process mistyped({program("lightnet"), "remix", folder / "plain.exr", "bonce=2", "-o", folder / "x.exr"});
    EXPECT_EQ(mistyped.wait(), 2);
    EXPECT_THAT(mistyped.output(), HasSubstr("there is no layer 'bonce' (did you mean 'bounce'?)"));
    const auto refused = launch(graph_file("cornell.lua"), folder, join(small, {"--gain", "bonce=2"}));
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.said, HasSubstr("there is no layer 'bonce' (did you mean 'bounce'?)"));
    Process negative({program("lightnet"), "remix", folder / "plain.exr", "bounce=-2", "-o", folder / "x.exr"});
    EXPECT_EQ(negative.wait(), 2);
    EXPECT_THAT(negative.output(), HasSubstr("a gain is like bounce=0.5"));
    const auto mine = folder.write("mine.exr", "my notes");
    Process foreign({program("lightnet"), "remix", folder / "plain.exr", "-o", mine});
    EXPECT_EQ(foreign.wait(), 2);
    EXPECT_EQ(bytes_of(mine), "my notes");
}

TEST_F(Remix, FindsTheGainsOfAnotherPicture) {
    render_plain(small);
    remixed({"direct=0.25", "bounce=3,2,1"});
    Process fit(
        {program("lightnet"), "fit", folder / "plain.exr", "--to", folder / "mixed.exr", "-o", folder / "fitted.exr"});
    ASSERT_EQ(fit.wait(), 0) << fit.output();
    Process onto_it(
        {program("lightnet"), "fit", folder / "plain.exr", "--to", folder / "mixed.exr", "-o", folder / "mixed.exr"});
    EXPECT_EQ(onto_it.wait(), 2);
    EXPECT_THAT(onto_it.output(), HasSubstr("would be lost"));
    Process compare(
        {program("lightnet"), "compare", folder / "mixed.exr", folder / "fitted.exr", "--max-relmse", "1e-8"});
    EXPECT_EQ(compare.wait(), 0) << compare.output() << fit.output();
}

}  // namespace
}  // namespace lightnet::test
