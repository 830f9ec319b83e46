// Lines so slow that what is sent at once would keep heartbeats waiting for longer than any host may be silent.
#include <gmock/gmock.h>

#include <fstream>
#include <random>

#include "tests/modes/daemons.hpp"
#include "tests/support/bad_line.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double megabit = 1e6 / 8;  // bytes per second

class SlowLine : public ::testing::Test {
protected:
    SlowLine() { line.limit(megabit); }

    // A scene with so many bytes of remarks.
    std::string graph(std::size_t bytes) {
        std::string remarks = "\n#";
        std::mt19937 random(1);
        while (remarks.size() < bytes) remarks += static_cast<char>('a' + random() % 26);
        folder.write("box.pbrt", R"(LookAt 0 1 -4  0 1 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [ 1 2 3 ]
Material "diffuse" "rgb reflectance" [ .6 .5 .4 ]
Shape "sphere" "float radius" 1
)" + remarks + "\n");
        return folder.write("box.lua", R"(scene  = Scene { "box.pbrt" }
light  = DirectLighting {}
image  = RayTracer { light, scene = scene, samples = 1, film = { 16, 16, file = "box.exr" } }
)");
    }
    std::vector<std::string> over(const BadLine& there, std::vector<std::string> more = {}) {
        more.insert(more.end(), {"--hosts", folder.write("hosts.lua", "place '" + there.endpoint() + "' {}\n"),
                                 "--progress", "json"});
        return more;
    }

    Folder folder;
    Daemon daemon{folder, 1};
    BadLine line{daemon.endpoint};
};

TEST_F(SlowLine, TakesInASceneThatTakesLongerThanAHostMayBeSilent) {
    const auto ran = launch(graph(400'000), folder, over(line));
    EXPECT_EQ(ran.code, 0) << ran.said;
    EXPECT_THAT(ran.said, Not(HasSubstr("is lost")));
}

TEST_F(SlowLine, BringsBackAnswersThatTakeLongerThanAHostMayBeSilent) {
    const auto big = std::vector<std::string>{"--size", "256x192", "--tile", "256"};
    const auto ran = launch(graph(0), folder, over(line, big));
    EXPECT_EQ(ran.code, 0) << ran.said;
    EXPECT_THAT(ran.said, Not(HasSubstr("is lost")));
    EXPECT_GT(counter(ran.report, "bytes"), 400'000) << "it was to be long";
    EXPECT_EQ(counter(ran.report, "asked_again"), 0);
    const auto near = launch(graph(0), folder, {"--size", "256x192", "--threads", "1", "--progress", "json"});
    EXPECT_TRUE(ran.picture == near.picture) << "the bytes differ";
}

TEST_F(SlowLine, ThatIsHeldIsStillNoticedSoon) {
    line.limit(0);
    Process run(launch_words(graph(0), folder / "picture.exr", over(line, {"--samples", "1000000"})));
    ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
    line.hold(true);
    ASSERT_TRUE(run.wait_for("; its work waits until a host is there")) << run.output();
    EXPECT_THAT(run.output(), Not(HasSubstr("elsewhere"))) << "there is no elsewhere";
}

TEST_F(SlowLine, ThatIsCutAgainAndAgainIsWarnedOf) {
    line.limit(0);
    Process run(launch_words(graph(0), folder / "picture.exr", over(line, {"--samples", "1000000"})));
    bool warned = false;
    for (int cuts = 0; cuts < 50 && !warned; ++cuts) {
        ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
        line.cut();
        warned = run.wait_for("was lost 2 times", slowdown * std::chrono::milliseconds(300));
    }
    EXPECT_TRUE(warned) << run.output();
    EXPECT_THAT(run.output(), HasSubstr("\"level\":\"warning\""));
}

}  // namespace
}  // namespace lightnet::test
