// Sequences, as users run them: the same bytes alone and together in every mode, resumed, shared, and with a loss.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"
#include "tools/pictures/picture_lock.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Tree = nlohmann::json;

class FramesRun : public ::testing::Test {
protected:
    struct Said {
        int code = -1;
        std::string text;
    };
    Said film(const std::string& frames, const std::string& name, const std::vector<std::string>& more = {}) const {
        return run(graph_file("film.lua"), frames, name, more);
    }
    Said run(const std::string& graph, const std::string& frames, const std::string& name,
             const std::vector<std::string>& more = {}) const {
        Process process(words(graph, frames, name, more));
        return said_by(process);
    }
    static Said said_by(Process& process) {
        Said said{process.wait(slowdown * std::chrono::seconds(60)), ""};
        said.text = process.output();
        return said;
    }
    std::vector<std::string> words(const std::string& graph, const std::string& frames, const std::string& name,
                                   const std::vector<std::string>& more) const {
        std::vector<std::string> words{program("lightnet"),
                                       "run",
                                       graph,
                                       "--frames",
                                       frames,
                                       "-o",
                                       folder.file(name),
                                       "--size",
                                       "40x40",
                                       "--samples",
                                       "4",
                                       "--progress",
                                       "plain",
                                       "--cache",
                                       "none"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::string picture(const std::string& name) const { return bytes_of(folder / name); }
    Tree report(const std::string& name) const { return Tree::parse(bytes_of(folder / name)); }

    Folder folder;
};

TEST_F(FramesRun, GivesEachFrameTheBytesThatItHasAlone) {
    const auto all = film("1-9x4", "all.####.exr", {"--threads", "2"});
    ASSERT_EQ(all.code, 0) << all.text;
    EXPECT_THAT(all.text, HasSubstr("frame 5: " + folder.file("all.0005.exr") + " is done"));
    EXPECT_THAT(all.text, HasSubstr("3 frames in "));
    ASSERT_EQ(film("5", "alone.####.exr", {"--threads", "1"}).code, 0);
    EXPECT_TRUE(picture("all.0005.exr") == picture("alone.0005.exr"));
    EXPECT_FALSE(picture("all.0005.exr") == picture("all.0009.exr")) << "the camera moves";
    EXPECT_FALSE(std::filesystem::exists(folder / "all.0005.exr.checkpoint"));
    const auto sequence = report("all.run.json");
    EXPECT_EQ(sequence["format"], "lightnet sequence 1");
    EXPECT_EQ(sequence["outcome"], "done");
    EXPECT_EQ(sequence["frames"].size(), 3);
    EXPECT_EQ(sequence["frames"][1]["frame"], 5);
    EXPECT_EQ(report("all.0005.run.json")["outcome"], "done");
    EXPECT_EQ(report("all.0005.run.json")["settings"]["frame"], "5");
}

TEST_F(FramesRun, GivesTheSameBytesOnTwoDaemonsOfWhichOneIsLost) {
    ASSERT_EQ(film("1-3", "here.####.exr", {"--threads", "2"}).code, 0);
    const auto there = film("1-3", "there.####.exr", {"--local-workers", "2", "--lose", "worker2@30%"});
    ASSERT_EQ(there.code, 0) << there.text;
    for (const char* frame : {"0001.exr", "0002.exr", "0003.exr"})
        EXPECT_TRUE(picture(std::string("here.") + frame) == picture(std::string("there.") + frame)) << frame;
}

// Daemons count what they load: the second frame finds the scene of the first, though its camera has moved.
TEST_F(FramesRun, SendsAndLoadsASceneOnce) {
    Daemon daemon(folder, 1, "tcp://127.0.0.1:*", {"--log-format", "json"});
    folder.write("hosts.lua", "place '" + daemon.endpoint + "'\n");
    const auto said = film("1-3", "shot.####.exr", {"--hosts", folder.file("hosts.lua")});
    ASSERT_EQ(said.code, 0) << said.text;
    daemon.process->signal(SIGTERM);
    EXPECT_EQ(daemon.process->wait(), 0);
    std::size_t found = 0;
    const auto log = daemon.process->output();
    for (auto at = log.find("has its scene from the run before"); at != log.npos;
         at = log.find("has its scene from the run before", at + 1))
        ++found;
    EXPECT_EQ(found, 2) << log;
}

// Meshes of a sequence of files and the graph's own camera, blurred, with the vectors that lead to the next frame and
// light of photons that are gathered near in time.
TEST_F(FramesRun, BlursFilesOfFramesAlikeInEveryMode) {
    for (const auto& [frame, x] : {std::pair("0001", "0"), std::pair("0002", "0.5"), std::pair("0003", "1.5")})
        folder.write("mesh." + std::string(frame) + ".obj",
                     "v " + std::string(x) + " -1 0\nv 2 -1 0\nv 1 1 0\nf 1 2 3\n");
    folder.write(
        "moving.lua",
        "eye = keys { [1] = { 0, 0, 5 }, [3] = { 0.4, 0, 5 } }\n"
        "scene = Scene { 'mesh.####.obj', camera = { from = eye, to = { 1, 0, 0 } }, environment = { 1, 1, 1 },\n"
        "                shutter = { -0.25, 0.25 } }\n"
        "light = PhotonMap { paths = 'all', photons = 4000, gather = 20 }\n"
        "quick = PhotonIrradiance { of = light }\n"
        "sharper = ProgressivePhotonMapping { paths = 'all', photons = 300 }\n"
        "motion = SurfaceFact { of = 'motion' }\n"
        "image = RayTracer { light, scene = scene, samples = 4, show = { motion, quick, sharper },\n"
        "                    film = { 40, 40 } }\n");
    const auto graph = folder.file("moving.lua");
    const auto serial = run(graph, "1-3", "serial.####.exr", {"--threads", "1"});
    ASSERT_EQ(serial.code, 0) << serial.text;
    EXPECT_THAT(serial.text, HasSubstr("mesh.0000.obj', which can't be read"));
    EXPECT_THAT(serial.text, HasSubstr("mesh.0004.obj', which can't be read"));
    ASSERT_EQ(run(graph, "2", "alone.####.exr", {"--threads", "2"}).code, 0);
    EXPECT_TRUE(picture("serial.0002.exr") == picture("alone.0002.exr"));
    const auto there = run(graph, "1-3", "there.####.exr", {"--local-workers", "2", "--lose", "worker2@30%"});
    ASSERT_EQ(there.code, 0) << there.text;
    for (const char* frame : {"0001.exr", "0002.exr", "0003.exr"})
        EXPECT_TRUE(picture(std::string("serial.") + frame) == picture(std::string("there.") + frame)) << frame;
    EXPECT_THAT(picture("serial.0002.exr"), HasSubstr("motion.X"));
}

// Which is read ahead.
TEST_F(FramesRun, EndsAtAFrameWhoseSceneCannotBeRead) {
    const std::string triangle = "v 0 -1 0\nv 2 -1 0\nv 1 1 0\nf 1 2 3\n";
    folder.write("mesh.0001.obj", triangle);
    folder.write("mesh.0002.obj", triangle);
    folder.write("mesh.0004.obj", triangle);
    folder.write("mesh.0003.obj", "v 0 -1 0\nv 2 -1 0\nf 1 2 9\n");
    const auto graph = folder.write(
        "moving.lua",
        "scene = Scene { 'mesh.####.obj', camera = { from = { 0, 0, 5 }, to = { 1, 0, 0 } }, environment = { 1, 1, 1 } "
        "}\n"
        "light = DirectLighting {}\nimage = RayTracer { light, scene = scene, samples = 4, film = { 40, 40 } }\n");
    const auto said = run(graph, "1-4", "shot.####.exr");
    EXPECT_EQ(said.code, 2) << said.text;
    EXPECT_THAT(said.text, HasSubstr("mesh.0003.obj:3: "));
    EXPECT_THAT(said.text, HasSubstr("shot.0002.exr is done"));
    const auto sequence = report("shot.run.json");
    EXPECT_EQ(sequence["outcome"], "failed");
    EXPECT_EQ(sequence["frames"][1]["outcome"], "done");
    EXPECT_EQ(sequence["frames"][2]["outcome"], "failed");
    EXPECT_EQ(sequence["frames"][3]["outcome"], "waiting");
}

TEST_F(FramesRun, GoesOnWithTheFramesThatAreMissing) {
    ASSERT_EQ(film("1-2", "shot.####.exr").code, 0);
    const auto first = std::filesystem::last_write_time(folder / "shot.0001.exr");
    const auto more = film("1-3", "shot.####.exr", {"--resume"});
    ASSERT_EQ(more.code, 0) << more.text;
    EXPECT_THAT(more.text, HasSubstr("shot.0001.exr is there"));
    EXPECT_THAT(more.text, HasSubstr("1 rendered, 2 were there"));
    EXPECT_EQ(std::filesystem::last_write_time(folder / "shot.0001.exr"), first);
    const auto other = film("1-2", "shot.####.exr", {"--resume", "--seed", "7"});
    EXPECT_THAT(other.text, HasSubstr("2 rendered")) << "those that are there are of another seed";
}

TEST_F(FramesRun, LeavesFramesToWhoeverIsAtThem) {
    const PictureLock lock(folder.file("shot.0001.exr"));
    const auto said = film("1-2", "shot.####.exr");
    ASSERT_EQ(said.code, 0) << said.text;
    EXPECT_THAT(said.text, HasSubstr("frame 1: another run is at it"));
    EXPECT_THAT(said.text, HasSubstr("1 rendered, 1 are left to other runs"));
    EXPECT_FALSE(std::filesystem::exists(folder / "shot.0001.exr"));
    EXPECT_EQ(report("shot.run.json")["frames"][0]["outcome"], "elsewhere");
}

// Each frame is locked from before one looks whether it is there until its report is.
TEST_F(FramesRun, IsSharedByTwoLaunchersThatGoOnWithOneSequence) {
    const auto both = words(graph_file("film.lua"), "1-6", "shot.####.exr", {"--resume", "--threads", "1"});
    Process first(both), second(both);
    const Said one = said_by(first), other = said_by(second);
    EXPECT_EQ(one.code, 0) << one.text;
    EXPECT_EQ(other.code, 0) << other.text;
    const std::string all = one.text + other.text;
    std::size_t rendered = 0;
    for (auto at = all.find(" is done"); at != all.npos; at = all.find(" is done", at + 1)) ++rendered;
    EXPECT_EQ(rendered, 6) << all;
    for (int frame = 1; frame <= 6; ++frame)
        EXPECT_TRUE(std::filesystem::exists(folder / ("shot.000" + std::to_string(frame) + ".exr"))) << frame;
}

// Its files are written while the next one is rendered, which ends as by a signal.
TEST_F(FramesRun, EndsWithAFrameThatCannotBeWritten) {
    auto all = words(graph_file("film.lua"), "1-9", "shot.####.exr", {"--size", "120x120", "--wait", "1"});
    all.insert(all.begin(), {"/bin/bash", "-c", "ulimit -f 40; export TMPDIR=/dev/null HOME=; exec \"$@\"", "bash"});
    Process process(all);
    const auto said = said_by(process);
    EXPECT_EQ(said.code, 1) << said.text;
    EXPECT_THAT(said.text, HasSubstr("the picture can't be written, nor anywhere else: "));
    EXPECT_THAT(said.text, Not(HasSubstr("frame 3")));
    const auto sequence = report("shot.run.json");
    EXPECT_EQ(sequence["outcome"], "failed");
    EXPECT_EQ(sequence["frames"][0]["outcome"], "failed");
    EXPECT_EQ(sequence["frames"][2]["outcome"], "waiting");
    EXPECT_FALSE(std::filesystem::exists(folder / "shot.0001.exr"));
}

TEST_F(FramesRun, WritesWhatIsRenderedWhenItIsToldToEnd) {
    const std::vector<std::string> more{"--threads", "1", "--samples", "64", "--resume"};
    Process process(words(graph_file("film.lua"), "1-40", "shot.####.exr", more));
    ASSERT_TRUE(process.wait_for("frame 2: ")) << process.output();
    process.signal(SIGTERM);
    const auto said = said_by(process);
    EXPECT_EQ(said.code, 130) << said.text;
    EXPECT_THAT(said.text, HasSubstr("--resume goes on with them"));
    const auto sequence = report("shot.run.json");
    EXPECT_EQ(sequence["outcome"], "cancelled");
    std::size_t done = 0;
    for (const auto& frame : sequence["frames"]) {
        if (frame["outcome"] != "done") continue;
        ++done;
        EXPECT_EQ(report(std::filesystem::path(std::string(frame["report"])).filename().string())["outcome"], "done");
    }
    EXPECT_GE(done, 2);
    for (const auto& entry : std::filesystem::directory_iterator(folder / ""))
        EXPECT_THAT(entry.path().string(), Not(HasSubstr(".lock")));
    const auto rest = run(graph_file("film.lua"), "1-5", "shot.####.exr", more);
    ASSERT_EQ(rest.code, 0) << rest.text;
    ASSERT_EQ(run(graph_file("film.lua"), "1-5x4", "alone.####.exr", more).code, 0);
    EXPECT_TRUE(picture("shot.0001.exr") == picture("alone.0001.exr"));
    EXPECT_TRUE(picture("shot.0005.exr") == picture("alone.0005.exr"));
}

TEST_F(FramesRun, SaysWhatIsWrongBeforeItBegins) {
    const auto one = film("1-3", "shot.exr");
    EXPECT_EQ(one.code, 2);
    EXPECT_THAT(one.text, HasSubstr("frames 1 and 2 would be the same file"));
    EXPECT_THAT(one.text, HasSubstr("shot.####.exr"));
    EXPECT_THAT(film("1..3", "shot.####.exr").text, HasSubstr("did you mean '1-3'?"));
    EXPECT_THAT(film("1-3", "shot.####.exr", {"--trace", "t.json"}).text, HasSubstr("t.####.json"));
    EXPECT_THAT(film("1-3", "shot.####.exr", {"-D", "frame=2"}).text, HasSubstr("--frames says which frame"));
    folder.write("box.pbrt", "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n");
    const auto graph = folder.write("late.lua",
                                    "scene = Scene { 'box.pbrt' }\ndirect = DirectLighting { samples = 3 - frame }\n"
                                    "image = RayTracer { direct, scene = scene, samples = 1, film = { 8, 8 } }\n");
    const auto late = run(graph, "1-3", "late.####.exr");
    EXPECT_EQ(late.code, 2);
    EXPECT_THAT(late.text, HasSubstr("(at frame 3)"));
    EXPECT_FALSE(std::filesystem::exists(folder / "late.0001.exr")) << "all is looked at before the first frame";
}

TEST_F(FramesRun, BecomesAFilmByFfmpegOrElseNumberedPictures) {
    ASSERT_EQ(film("1-2", "shot.####.exr").code, 0);
    const auto made = [&](const std::string& path, const std::string& name = "film.mp4") {
        Process process({"/bin/sh", "-c",
                         "PATH='" + path + "' '" + program("lightnet") + "' film '" + folder.file("shot.####.exr") +
                             "' --fps 12 -o '" + folder.file(name) + "'"});
        EXPECT_EQ(process.wait(), 0) << process.output();
        return process.output();
    };
    EXPECT_THAT(made("/nowhere"), HasSubstr("ffmpeg is not installed, so the film is 2 numbered pictures: "));
    EXPECT_TRUE(std::filesystem::exists(folder / "film.0002.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "film.mp4"));
    const auto beside = bytes_of(folder / "shot.0002.png");
    made("/nowhere", "shot.mp4");
    EXPECT_TRUE(std::filesystem::exists(folder / "shot.film.0002.png"));
    EXPECT_TRUE(bytes_of(folder / "shot.0002.png") == beside) << "that of the frame";
    const auto fake = folder.write("bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > \"$last\"\n");
    std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
    EXPECT_THAT(made(folder.file("bin") + ":/usr/bin:/bin"), HasSubstr("2 frames in "));
    EXPECT_THAT(bytes_of(folder / "film.mp4"), HasSubstr("-framerate 12 -i "));
}

TEST_F(FramesRun, SaysALineOfJsonOfEachFrame) {
    const auto said = film("1-2", "shot.####.exr", {"--progress", "json"});
    ASSERT_EQ(said.code, 0) << said.text;
    std::istringstream lines(said.text);
    std::vector<Tree> frames;
    for (std::string line; std::getline(lines, line);)
        if (const auto tree = Tree::parse(line); tree["event"] == "frame") frames.push_back(tree);
    ASSERT_EQ(frames.size(), 2);
    EXPECT_EQ(frames[1]["frame"], 2);
    EXPECT_EQ(frames[1]["frames_done"], 2);
    EXPECT_EQ(frames[1]["frames"], 2);
    EXPECT_EQ(frames[1]["outcome"], "done");
    if (!schemas_can_be_checked()) return;
    EXPECT_EQ(complaints_of_schema("progress", folder.write("lines", said.text), true), "");
    EXPECT_EQ(complaints_of_schema("sequence", folder / "shot.run.json"), "");
    EXPECT_EQ(complaints_of_schema("run", folder / "shot.0001.run.json"), "");
}

}  // namespace
}  // namespace lightnet::test
