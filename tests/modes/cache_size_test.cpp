// --cache-size bounds a run, and not only what is left after it.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using ::testing::HasSubstr;

class CacheSize : public ::testing::Test {
protected:
    std::string graph(const std::string& name, std::size_t bytes, char fill = 'x') {
        folder.write(name + ".pbrt", R"(LookAt 0 1 -4  0 1 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [ 1 2 3 ]
Material "diffuse" "rgb reflectance" [ .6 .5 .4 ]
Shape "sphere" "float radius" 1
#)" + std::string(bytes, fill) + "\n");
        return folder.write(name + ".lua", "scene = Scene { '" + name + R"(.pbrt' }
light = DirectLighting {}
image = RayTracer { light, scene = scene, samples = 1, film = { 16, 16, file = "box.exr" } }
)");
    }
    std::vector<std::string> on(const Daemon& daemon) {
        return {"--hosts", folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}\n"), "--progress", "json",
                "--forget"};
    }
    std::uintmax_t held() const {
        std::uintmax_t sum = 0;
        for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "cache"))
            if (file.is_regular_file()) sum += file.file_size();
        return sum;
    }

    Folder folder;
};

TEST_F(CacheSize, RefusesARunWhoseFilesAreMoreThanTheCacheMayHold) {
    Daemon daemon(folder, 1, "tcp://127.0.0.1:*", {"--cache-size", "1M"});
    const auto refused = launch(graph("large", 3'500'000), folder, on(daemon));
    EXPECT_NE(refused.code, 0);
    EXPECT_THAT(refused.said, HasSubstr("the files of this run have 3 MiB"));
    EXPECT_THAT(refused.said, HasSubstr("may hold 1 MiB (lightnetd --cache-size)"));
    EXPECT_LT(held(), 10'000u) << "nothing of it was taken in";
    EXPECT_EQ(launch(graph("small", 500'000), folder, on(daemon)).code, 0) << "the daemon serves others";
}

TEST_F(CacheSize, MakesRoomForARunAtTheCostOfEarlierOnes) {
    Daemon daemon(folder, 1, "tcp://127.0.0.1:*", {"--cache-size", "1M"});
    for (const char fill : {'a', 'b', 'c'}) {
        const auto ran = launch(graph("scene", 600'000, fill), folder, on(daemon));
        EXPECT_EQ(ran.code, 0) << ran.said;
        EXPECT_LT(held(), 1'100'000u) << "during the run or after it";
    }
}

TEST_F(CacheSize, IsThereForEachOfTheDaemonsThatShareAFolder) {
    Daemon one(folder, 1, "tcp://127.0.0.1:*", {"--cache-size", "1M"});
    Daemon two(folder, 1, "tcp://127.0.0.1:*", {"--cache-size", "1M"});
    const auto first = graph("first", 800'000, 'a'), second = graph("second", 800'000, 'b');
    for (int round = 0; round < 2; ++round) {
        Process left(launch_words(first, folder / "left.exr",
                                  {"--hosts", folder.write("one.lua", "place '" + one.endpoint + "' {}\n")}));
        Process right(launch_words(second, folder / "right.exr",
                                   {"--hosts", folder.write("two.lua", "place '" + two.endpoint + "' {}\n")}));
        EXPECT_EQ(left.wait(), 0) << left.output();
        EXPECT_EQ(right.wait(), 0) << right.output();
    }
}

}  // namespace
}  // namespace lightnet::test
