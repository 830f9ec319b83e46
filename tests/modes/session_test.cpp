// Sessions, as users and programs drive them: each picture has the bytes of a fresh run, whatever was at work before.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"

namespace lightnet::session_test {
namespace {

using test::Folder;
using test::slowdown;
using testing::HasSubstr;
using Tree = nlohmann::json;
using namespace std::chrono_literals;

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

const std::string graph_text = R"(samples = 4
scene = Scene { "box.pbrt" }
light = DirectLighting { samples = 1 }
image = RayTracer { light, scene = scene, samples = samples, film = { 32, 24 } }
)";

class SessionTest : public ::testing::Test {
protected:
    SessionTest() {
        std::filesystem::copy_file(test::graph_file("cornell_box.pbrt"), folder / "box.pbrt");
        write(folder / "g.lua", graph_text);
    }
    ~SessionTest() override {
        if (edits_ >= 0) ::close(edits_);
    }

    // Lines are given by a pipe with a name, as the programs of tests have no standard input of their own.
    void begin(const std::vector<std::string>& more = {"--threads", "2"}) {
        const std::string pipe = folder / "edits";
        ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
        std::vector<std::string> words{"/bin/sh",
                                       "-c",
                                       "exec \"$0\" \"$@\" <" + pipe,
                                       test::program("lightnet"),
                                       "session",
                                       folder / "g.lua",
                                       "-o",
                                       folder / "now.exr",
                                       "--json",
                                       "--cache",
                                       "none"};
        words.insert(words.end(), more.begin(), more.end());
        session_.emplace(words);
        edits_ = ::open(pipe.c_str(), O_WRONLY);
        ASSERT_GE(edits_, 0);
    }
    void say(const std::string& line) {
        const std::string whole = line + "\n";
        ASSERT_EQ(::write(edits_, whole.data(), whole.size()), ssize_t(whole.size()));
    }
    // The finished picture of the edit called `id`; an edit of a file has none.
    void wait_for_picture(std::size_t edit) {
        const auto end = std::chrono::steady_clock::now() + slowdown * 60s;
        while (std::chrono::steady_clock::now() < end) {
            for (const auto& event : events())
                if (event["event"] == "picture" && event["edit"] == edit && event["finished"] == true) return;
            session_->wait_for("never said", 20ms);
        }
        FAIL() << session_->output();
    }
    std::vector<Tree> events() const {
        std::vector<Tree> found;
        std::istringstream lines(session_->output());
        for (std::string line; std::getline(lines, line) && !lines.eof();)
            if (line.starts_with('{')) found.push_back(Tree::parse(line));
        return found;
    }
    int end() {
        if (edits_ >= 0) ::close(edits_);
        edits_ = -1;
        return session_->wait();
    }
    std::string now() const { return test::bytes_of(folder / "now.exr"); }
    // A run of the graph as it is, with other words in it.
    std::string fresh(const std::string& before = "", const std::string& after = "") {
        std::string text = graph_text;
        if (!before.empty()) text.replace(text.find(before), before.size(), after);
        write(folder / "fresh.lua", text);
        test::Process run({test::program("lightnet"), "run", folder / "fresh.lua", "-o", folder / "fresh.exr",
                           "--threads", "1", "--cache", "none"});
        EXPECT_EQ(run.wait(), 0) << run.output();
        return test::bytes_of(folder / "fresh.exr");
    }

    Folder folder;
    std::optional<test::Process> session_;

private:
    int edits_ = -1;
};

class FirstLook : public SessionTest, public testing::WithParamInterface<std::vector<std::string>> {};

TEST_P(FirstLook, ShowsWhatPreparesNothingBeforeTheRestDoes) {
    const auto graph = [](const std::string& samples) {
        return R"(scene = Scene { "box.pbrt" }
glow = PhotonMap { photons = 3000, paths = "diffuse" }
light = DirectLighting { samples = )" +
               samples + R"( }
both = Combine { light, glow }
image = RayTracer { both, scene = scene, samples = 4, film = { 32, 24 } }
)";
    };
    write(folder / "g.lua", graph("1"));
    begin(GetParam());
    wait_for_picture(0);
    say(R"({"set":{"light.samples":2}})");
    wait_for_picture(1);
    EXPECT_EQ(end(), 0) << session_->output();
    std::vector<Tree> first;
    for (const auto& event : events())
        if (event["event"] == "picture" && (first.empty() || event["edit"] != first.back()["edit"]))
            first.push_back(event);
    ASSERT_EQ(first.size(), 2u);
    for (const auto& event : first) {
        EXPECT_EQ(event["coarse"], true);
        EXPECT_EQ(event["without"], Tree::array({"glow"})) << event;
    }
    write(folder / "fresh.lua", graph("2"));
    test::Process run({test::program("lightnet"), "run", folder / "fresh.lua", "-o", folder / "fresh.exr", "--threads",
                       "1", "--cache", "none"});
    EXPECT_EQ(run.wait(), 0) << run.output();
    EXPECT_TRUE(now() == test::bytes_of(folder / "fresh.exr"));
    if (!test::schemas_can_be_checked()) return;
    write(folder / "events", session_->output());
    EXPECT_EQ(test::complaints_of_schema("session", folder / "events", true), "");
}

INSTANTIATE_TEST_SUITE_P(Modes, FirstLook,
                         testing::Values(std::vector<std::string>{"--threads", "2"},
                                         std::vector<std::string>{"--local-workers", "1"},
                                         std::vector<std::string>{"--threads", "1"}));

TEST_F(SessionTest, GivesEachEditTheBytesOfAFreshRun) {
    begin();
    wait_for_picture(0);
    EXPECT_TRUE(now() == fresh());
    say(R"({"id": "a", "set": {"light.samples": 4}})");
    wait_for_picture(1);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 4"));
    say(R"({"camera": {"from": [420, 400, -700], "to": [278, 250, 280]}, "set": {"light.samples": null}})");
    wait_for_picture(2);
    EXPECT_TRUE(now() == fresh("pbrt\"", "pbrt\", camera = { from = { 420, 400, -700 }, to = { 278, 250, 280 } }"));
    say(R"({"camera": null, "constants": {"samples": 20}})");
    wait_for_picture(3);
    EXPECT_TRUE(now() == fresh("samples = 4", "samples = 20"));
    EXPECT_EQ(end(), 0) << session_->output();
    if (!test::schemas_can_be_checked()) return;
    write(folder / "events", session_->output());
    EXPECT_EQ(test::complaints_of_schema("session", folder / "events", true), "");
}

TEST_F(SessionTest, FirstShowsAQuarterOfThePixelsAndThenASampleOfEach) {
    begin({"--threads", "2", "--samples", "40"});
    wait_for_picture(0);
    std::vector<double> samples;
    for (const auto& event : events()) {
        samples.push_back(event["samples"]);
        EXPECT_EQ(event["coarse"], samples.size() == 1) << event;
    }
    ASSERT_GE(samples.size(), 4u);
    EXPECT_EQ(samples[0], 0.25);
    EXPECT_EQ(samples[1], 1);
    EXPECT_EQ(samples.back(), 40);
    EXPECT_EQ(end(), 0);
}

TEST_F(SessionTest, SaysWhereTheTimeOfAnEditWent) {
    begin();
    wait_for_picture(0);
    say(R"({"set": {"light.samples": 2}})");
    wait_for_picture(1);
    for (const auto& event : events()) {
        double sum = 0;
        for (const auto& [part, seconds] : event["took"].items()) {
            EXPECT_GE(seconds, 0) << part;
            sum += seconds.get<double>();
        }
        for (const char* part : {"stop", "read", "load", "prepare", "render", "write"})
            EXPECT_TRUE(event["took"].contains(part)) << part;
        EXPECT_LE(sum, event["seconds"].get<double>());
        EXPECT_GE(sum, event["seconds"].get<double>() / 4) << event;
    }
    EXPECT_EQ(end(), 0);
}

class EditedParts : public SessionTest, public testing::WithParamInterface<std::vector<std::string>> {};

TEST_P(EditedParts, GiveTheBytesOfAFreshRun) {
    begin(GetParam());
    wait_for_picture(0);
    const std::string scene = R"("box.pbrt")";
    const auto fresh_with = [&](const std::string& params) { return fresh(scene, scene + ", " + params); };
    say(R"({"set": {"scene.lamps": {"black": [2, 1, 0.5]}}})");
    wait_for_picture(1);
    EXPECT_TRUE(now() == fresh_with("lamps = { black = { 2, 1, 0.5 } }"));
    say(R"({"set": {"scene.colours": {"red": [0.1, 0.2, 0.9], "wh*": 0.4}}, "camera": {"fov": 30}})");
    wait_for_picture(2);
    EXPECT_TRUE(now() == fresh_with("lamps = { black = { 2, 1, 0.5 } }, camera = { fov = 30 }, "
                                    "colours = { red = { 0.1, 0.2, 0.9 }, [\"wh*\"] = 0.4 }"));
    say(R"({"set": {"scene.lamps": {"blakc": 2}}})");
    ASSERT_TRUE(session_->wait_for("did you mean 'black'")) << session_->output();
    say(R"({"set": {"scene.lamps": null, "scene.environment_scale": 2}})");
    wait_for_picture(4);
    EXPECT_TRUE(now() == fresh_with("camera = { fov = 30 }, environment_scale = 2, "
                                    "colours = { red = { 0.1, 0.2, 0.9 }, [\"wh*\"] = 0.4 }"));
    say(R"({"set": {"scene.colours": null, "scene.environment_scale": null}, "camera": null})");
    wait_for_picture(5);
    EXPECT_TRUE(now() == fresh());
    EXPECT_EQ(end(), 0);
}

INSTANTIATE_TEST_SUITE_P(Modes, EditedParts,
                         testing::Values(std::vector<std::string>{"--threads", "2"},
                                         std::vector<std::string>{"--local-workers", "2"}));

TEST_F(SessionTest, NoticesFilesThatAreWrittenOrReplaced) {
    begin();
    wait_for_picture(0);
    std::string text = graph_text;
    text.replace(text.find("samples = 1"), 11, "samples = 2");
    write(folder / "g.lua", text);
    wait_for_picture(1);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 2"));
    std::string scene = test::bytes_of(folder / "box.pbrt");
    const auto lamp = scene.find("\"rgb L\"");
    ASSERT_NE(lamp, std::string::npos);
    scene.replace(lamp, scene.find(']', lamp) + 1 - lamp, "\"rgb L\" [ 1 2 3 ]");
    write(folder / "new", scene);
    std::filesystem::rename(folder / "new", folder / "box.pbrt");
    wait_for_picture(2);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 2"));
    EXPECT_EQ(end(), 0);
}

TEST_F(SessionTest, ChangesNothingByAMistake) {
    begin();
    wait_for_picture(0);
    say(R"({"id": 7, "set": {"lihgt.samples": 2}})");
    ASSERT_TRUE(session_->wait_for("did you mean 'light'")) << session_->output();
    say(R"({"id": 8, "cmaera": {}})");
    ASSERT_TRUE(session_->wait_for("did you mean 'camera'")) << session_->output();
    say("no JSON");
    ASSERT_TRUE(session_->wait_for("malformed JSON")) << session_->output();
    say(R"({"set": {"light.samples": 3, "light.smaples": 2}})");
    ASSERT_TRUE(session_->wait_for("did you mean 'samples'")) << session_->output();
    say(R"({"set": {"light.samples": 2}})");
    wait_for_picture(5);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 2"));
    say(R"({"id": 9, "set": {"light.samples": 3, "scene.lamps": {"blakc": 2}}})");  // seen when the scene is edited
    ASSERT_TRUE(session_->wait_for("did you mean 'black'")) << session_->output();
    say(R"({"scene": "nowhere.pbrt"})");
    ASSERT_TRUE(session_->wait_for("nowhere.pbrt")) << session_->output();
    say(R"({"camera": {"fov": 30}, "set": {"light.samples": null}})");
    wait_for_picture(8);
    EXPECT_TRUE(now() == fresh("\"box.pbrt\"", "\"box.pbrt\", camera = { fov = 30 }"));
    for (const auto& event : events())
        if (event["event"] == "error") {
            EXPECT_EQ(event["refused"], true) << event;
        }
    for (const int id : {7, 8, 9}) {
        const auto all = events();
        EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Tree& event) {
            return event["event"] == "error" && event.value("id", 0) == id;
        })) << session_->output();
    }
    EXPECT_EQ(end(), 0);
}

TEST_F(SessionTest, GoesOnWithThePictureBeforeAMistake) {
    begin({"--threads", "2", "-D", "samples=16000000"});
    ASSERT_TRUE(session_->wait_for("\"samples\":1")) << session_->output();
    say(R"({"set": {"scene.lamps": {"blakc": 2}}})");
    ASSERT_TRUE(session_->wait_for("did you mean 'black'")) << session_->output();
    ASSERT_TRUE(session_->wait_for("\"event\":\"picture\",\"edit\":1")) << session_->output();
    say(R"({"constants": {"samples": 4}})");
    wait_for_picture(2);
    EXPECT_TRUE(now() == fresh());
    say(R"({"set": {"light.samples": -1}})");
    EXPECT_EQ(end(), 2) << "the last edit was refused";
}

TEST_F(SessionTest, KeepsEditsWhileAFileIsAtFault) {
    begin();
    wait_for_picture(0);
    write(folder / "g.lua", "x = = 3\n");
    ASSERT_TRUE(session_->wait_for("g.lua")) << session_->output();
    ASSERT_TRUE(session_->wait_for("\"line\":1")) << session_->output();
    say(R"({"set": {"light.samples": 2}})");
    ASSERT_TRUE(session_->wait_for("\"edit\":2")) << session_->output();
    write(folder / "g.lua", graph_text);
    wait_for_picture(3);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 2"));
    for (const auto& event : events())
        if (event["event"] == "error") {
            EXPECT_EQ(event["refused"], false) << event;
        }
    EXPECT_EQ(end(), 0);
}

TEST_F(SessionTest, EndsAPictureThatNobodyWantsAnyMore) {
    begin({"--threads", "2", "-D", "samples=16000000"});
    ASSERT_TRUE(session_->wait_for("\"samples\":1")) << session_->output();
    say(R"({"constants": {"samples": 4}})");
    wait_for_picture(1);
    EXPECT_TRUE(now() == fresh());
    EXPECT_FALSE(std::filesystem::exists(folder / "now.exr.checkpoint"));
    EXPECT_EQ(end(), 0);
}

TEST_F(SessionTest, KeepsItsBytesOnDaemonsOneOfWhichIsLost) {
    std::vector<test::Daemon> daemons;
    daemons.emplace_back(folder, 1, "tcp://127.0.0.1:*");
    daemons.emplace_back(folder, 1, "tcp://127.0.0.1:*", std::vector<std::string>{"--cache", folder / "other"});
    begin({"--hosts", daemons[0].endpoint + "," + daemons[1].endpoint});
    wait_for_picture(0);
    EXPECT_TRUE(now() == fresh());
    say(R"({"set": {"light.samples": 2}})");
    wait_for_picture(1);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 2"));
    daemons[0].process->signal(SIGKILL);
    say(R"({"set": {"light.samples": 3}})");
    wait_for_picture(2);
    EXPECT_TRUE(now() == fresh("samples = 1", "samples = 3"));
    EXPECT_EQ(end(), 0);
}

TEST_F(SessionTest, EndsWithoutRenderingAnewWhatIsFinished) {
    begin();
    wait_for_picture(0);
    say(R"({"end": true})");
    EXPECT_EQ(session_->wait(), 0) << session_->output();
    for (const auto& event : events()) EXPECT_TRUE(event["event"] != "picture" || event["edit"] == 0) << event;
}

TEST_F(SessionTest, IsOverWhenItIsTold) {
    begin();
    say(R"({"end": true})");
    EXPECT_EQ(session_->wait(), 0) << session_->output();
    EXPECT_TRUE(now() == fresh());
    EXPECT_EQ(events().back()["event"], "end");
}

TEST_F(SessionTest, IsOverWhenItIsInterrupted) {
    begin({"--threads", "2", "-D", "samples=16000000"});
    ASSERT_TRUE(session_->wait_for("\"samples\":1")) << session_->output();
    session_->signal(SIGINT);
    EXPECT_EQ(session_->wait(), 130) << session_->output();
    EXPECT_TRUE(test::processes_with(folder / "g.lua").empty());
}

}  // namespace
}  // namespace lightnet::session_test
