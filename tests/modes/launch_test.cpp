// What the launcher says of wrong launches, before work starts.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "core/film/exr.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/support/pixels_in.hpp"

namespace lightnet::test {
namespace {

Launch launch_to(const std::string& output, const std::vector<std::string>& more = {}) {
    Process process(launch_words(graph_file("cornell.lua"), output, more));
    Launch launch;
    launch.code = process.wait();
    launch.said = process.output();
    return launch;
}

TEST(Launch, RefusesAnOutputThatCannotBeWrittenBeforeItRenders) {
    const Folder folder;
    const auto nowhere = launch_to(folder / "no" / "such" / "x.exr");
    EXPECT_EQ(nowhere.code, 2);
    EXPECT_NE(nowhere.said.find("there is no folder"), std::string::npos) << nowhere.said;
    const auto png = launch_to(folder / "x.png");
    EXPECT_EQ(png.code, 2);
    EXPECT_NE(png.said.find("written as .exr"), std::string::npos) << png.said;
}

bool catches(int process, int signal) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:")) return std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1;
    return false;
}

TEST(Launch, EndsInWordsWhenItIsToldToBeforeItHasBegun) {
    const Folder folder;
    std::ofstream(folder / "endless.lua") << "while true do end\n";
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        Process run(launch_words(folder / "endless.lua", folder / "x.exr", {}));
        while (!catches(run.id(), signal)) ASSERT_TRUE(run.lives());
        run.signal(signal);
        EXPECT_EQ(run.wait(), 130);
        EXPECT_EQ(run.output(), "lightnet: stopped by a signal\n");
    }
}

TEST(Launch, TellsAllThatIsWrongWithASceneAtOnce) {
    const Folder folder;
    const auto scene = folder.write(
        "bad.pbrt", "WorldBegin\nMaterial \"difuse\"\nShape \"plymesh\" \"string filename\" \"none.ply\"\n");
    Process process(launch_words(graph_file("path.lua"), folder / "x.exr", {"-D", "file=" + scene}));
    EXPECT_EQ(process.wait(), 2);
    EXPECT_NE(process.output().find("bad.pbrt:2: Material 'difuse'"), std::string::npos) << process.output();
    EXPECT_NE(process.output().find("bad.pbrt:3: can't read 'none.ply'"), std::string::npos) << process.output();
}

TEST(Launch, SaysInEveryModeThatHostsAreSentFilesFromElsewhere) {
    const Folder folder;
    folder.write("secret.pbrt", "# mine\n");
    const auto scene = folder.write("scene/s.pbrt",
                                    "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n"
                                    "Include \"../secret.pbrt\"\n");
    const auto said = [&](const std::vector<std::string>& where) {
        std::vector<std::string> words{
            program("lightnet"), "render", scene,        "-o",  folder / "x.exr", "--size", "8x8",
            "--samples",         "1",      "--progress", "none"};
        words.insert(words.end(), where.begin(), where.end());
        Process run(words);
        EXPECT_EQ(run.wait(), 0) << run.output();
        return run.output();
    };
    EXPECT_NE(said({"--local-workers", "1", "--cache", folder / "cache"}).find("secret.pbrt': hosts are sent them"),
              std::string::npos);
    EXPECT_EQ(said({"--threads", "1"}), "") << "nobody is sent anything";
}

TEST(Launch, WritesPictureTinyPictureAndReport) {
    const Folder folder;
    const auto run = launch(graph_file("cornell.lua"), folder, {"--size", "16x16", "--samples", "1"});
    ASSERT_EQ(run.code, 0) << run.said;
    EXPECT_EQ(bytes_of(folder / "picture.png").substr(1, 3), "PNG");
    EXPECT_GT(counter(run.report, "rays"), 0);
    EXPECT_NE(run.report.find("\"outcome\": \"done\""), std::string::npos);
}

TEST(Launch, EndsByTellingWhatItMade) {
    const Folder folder;
    const auto run = launch(graph_file("cornell.lua"), folder, {"--size", "16x16", "--samples", "1", "--threads", "2"});
    ASSERT_EQ(run.code, 0) << run.said;
    for (const auto& part : {"wrote " + (folder / "picture.exr").string() + ", " + (folder / "picture.png").string(),
                             std::string("layers: emission, direct, bounce"), std::string("2 threads of this machine")})
        EXPECT_NE(run.said.find(part), std::string::npos) << part << "\n" << run.said;
    EXPECT_EQ(run.said.find(" %,"), std::string::npos) << "a run of a second needs no percentages\n" << run.said;
}

TEST(Launch, HintsAtAnExposureThatDoesShowThePicture) {
    const Folder folder;
    const std::vector<std::string> small{"--size", "32x32", "--samples", "4"};
    const auto exposed = [&](const std::string& stops) {
        auto words = small;
        words.insert(words.end(), {"--exposure", stops});
        return launch(graph_file("cornell.lua"), folder, words).said;
    };
    for (const char* stops : {"9", "-15"}) {
        const auto said = exposed(stops);
        const auto at = said.find("--exposure ");
        ASSERT_NE(at, std::string::npos) << said;
        const auto hinted = said.substr(at + 11, said.find(' ', at + 11) - at - 11);
        EXPECT_EQ(exposed(hinted).find("hint:"), std::string::npos) << hinted;
    }
}

TEST(Launch, ShowsInThePngWhatIsTooDarkOrTooBrightAndLeavesTheExrAsItIs) {
    const Folder folder;
    const auto rendered = [&](const std::string& gain, const std::vector<std::string>& more) {
        std::vector<std::string> words{"--size", "24x24", "--samples", "4"};
        for (const char* layer : {"emission", "direct", "bounce"})
            words.insert(words.end(), {"--gain", layer + ("=" + gain)});
        words.insert(words.end(), more.begin(), more.end());
        auto run = launch(graph_file("cornell.lua"), folder, words);
        EXPECT_EQ(run.code, 0) << run.said;
        return std::pair(run, bytes_of(folder / "picture.png"));
    };
    const auto [hidden, seen] = rendered("0.0001", {});
    const auto [plain, black] = rendered("0.0001", {"--view", "plain"});
    const auto [filmic, soft] = rendered("0.0001", {"--view", "filmic"});
    EXPECT_TRUE(hidden.picture == plain.picture && hidden.picture == filmic.picture);
    EXPECT_NE(seen, black);
    EXPECT_NE(seen, soft);
    EXPECT_NE(hidden.said.find("stops brighter than the EXR"), std::string::npos) << hidden.said;
    EXPECT_NE(hidden.report.find("exposure 2^"), std::string::npos) << hidden.report;
    EXPECT_EQ(rendered("1", {}).second, rendered("1", {"--view", "plain"}).second) << "what can be seen stays as it is";
}

TEST(Launch, ExposesThePngAlone) {
    const Folder folder;
    const auto rendered = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"--size", "16x16", "--samples", "2", "--forget"};
        words.insert(words.end(), more.begin(), more.end());
        const auto run = launch(graph_file("cornell.lua"), folder, words);
        EXPECT_EQ(run.code, 0) << run.said;
        return std::pair(run.picture, bytes_of(folder / "picture.png"));
    };
    const auto usual = rendered({}), bright = rendered({"--exposure", "1.5"});
    EXPECT_TRUE(usual.first == bright.first);
    EXPECT_FALSE(usual.second == bright.second);
}

TEST(Launch, KeepsWhatIsCoveredWhereAlphaIsAskedFor) {
    const Folder folder;
    const auto run = launch(graph_file("studio.lua"), folder, {"--size", "24x18", "--samples", "4", "--alpha"});
    ASSERT_EQ(run.code, 0) << run.said;
    const auto png = bytes_of(folder / "picture.png");
    constexpr std::size_t colour_type = 25;
    constexpr char with_alpha = 6;  // PNG, section 11.2.2
    EXPECT_EQ(png.at(colour_type), with_alpha);
    EXPECT_FALSE(read_exr(folder / "picture.exr").alpha.empty());
}

TEST(Launch, LooksThroughTheCameraThatIsChosen) {
    const Folder folder;
    const std::string film =
        "<film type='hdrfilm'><integer name='width' value='12'/><integer name='height' value='8'/></film>";
    const auto sensor = [&](const std::string& id, const std::string& fov) {
        return "<sensor type='perspective' id='" + id + "'><float name='fov' value='" + fov +
               "'/><transform name='to_world'><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>" + film +
               "</sensor>";
    };
    const auto scene = folder.write("two.xml", "<scene version='3.0.0'>" + sensor("near", "20") + sensor("far", "80") +
                                                   "<shape type='sphere'/><emitter type='constant'/></scene>");
    const auto graph = folder.write("two.lua",
                                    "scene = Scene { 'two.xml' }\ndirect = DirectLighting {}\n"
                                    "image = RayTracer { direct, scene = scene, film = { 12, 8 } }\n");
    const auto seen_by = [&](const std::vector<std::string>& camera) {
        std::vector<std::string> words{"--samples", "4"};
        words.insert(words.end(), camera.begin(), camera.end());
        return launch(graph, folder, words);
    };
    const auto first = seen_by({}), far = seen_by({"--camera", "far"}), number = seen_by({"--camera", "2"});
    ASSERT_EQ(far.code, 0) << far.said;
    EXPECT_TRUE(pixels_in(far.picture) == pixels_in(number.picture));
    EXPECT_FALSE(pixels_in(far.picture) == pixels_in(first.picture));
    EXPECT_TRUE(pixels_in(first.picture) == pixels_in(seen_by({"--camera", "near"}).picture));
    const auto wrong = seen_by({"--camera", "fat"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.said.find("there is no camera 'fat' (did you mean 'far'?)"), std::string::npos) << wrong.said;
}

TEST(Launch, SaysNothingButErrorsWhenNoProgressIsWanted) {
    const Folder folder;
    const std::vector<std::string> quiet{"--size", "16x16", "--samples", "1", "--progress", "none"};
    for (const auto& mode : {std::vector<std::string>{}, {"--local-workers", "1"}}) {
        auto words = quiet;
        words.insert(words.end(), mode.begin(), mode.end());
        const auto run = launch(graph_file("cornell.lua"), folder, words);
        EXPECT_EQ(run.code, 0);
        EXPECT_EQ(run.said, "");
    }
}

}  // namespace
}  // namespace lightnet::test
