// Graph files, scenes and pictures that are hostile or damaged, and light that is not finite.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <random>

#include "core/film/exr.hpp"
#include "tests/faults/faults.hpp"

namespace lightnet::test {
namespace {

const std::vector<std::string> hostile_graphs{
    "while true do end",
    "repeat pcall(function() while true do end end) until false",
    "local t = {} for i = 1, 1e9 do t[i] = i end",
    "x = ('x'):rep(1e9)",
    "local s = 'x' while true do s = s .. s end",
    "string.find(('a'):rep(1e6), ('a*'):rep(50) .. 'b')",
    "setmetatable({}, { __gc = function() while true do end end }) while true do local t = {} end",
    "os.execute('touch lightnet-was-here')",
    "local f = io.open('/etc/passwd')",
    "load(string.dump(function() end))()",
    "local function f() return f() + 1 end f()",
    "local a = ('x'):rep(1e6) for i = 1, 1e5 do local v = _ENV[a .. i] end",
    "for i = 1, 1e6 do Nothing {} end",
    "for i = 1, 1e7 do print(('x'):rep(1e5)) end",
    "require('../../../../etc/passwd')",
    "local last = DirectLighting {} for i = 1, 3e5 do last = Scale { last } _ENV['n' .. i] = last end",
    std::string("\x1bLua\x54\0\x19\x93\r\n\x1a\n", 12)};

TEST_F(Faults, OfHostileGraphFilesEndWithOneError) {
    double slowest = 0;
    std::size_t wordiest = 0;
    for (const auto& text : hostile_graphs) {
        SCOPED_TRACE(text.substr(0, 80));
        const auto file = folder.write("hostile.lua", text);
        const auto begun = Clock::now();
        Process check({program("lightnet"), "check", file});
        EXPECT_EQ(check.wait(slowdown * seconds(30)), 2) << check.output().substr(0, 2000);
        slowest = std::max(slowest, seconds_since(begun));
        wordiest = std::max(wordiest, check.output().size());
        EXPECT_NE(check.output().find("hostile.lua"), std::string::npos) << check.output().substr(0, 2000);
    }
    EXPECT_FALSE(std::filesystem::exists("lightnet-was-here"));
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);  // the largest of all of them
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    done(fmt::format("{} graph files checked", hostile_graphs.size()));
    seen(fmt::format("{:.1f} s, {:.0f} MB and {} bytes of words at most", slowest, memory, wordiest));
    EXPECT_LT(memory, 700);
    EXPECT_LT(wordiest, 200'000u);
    figure("time", slowest, "s", 3, false);
    figure("memory", memory, "MB", 512, false);
}

void append(std::string& bytes, std::uint32_t number) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i));
}

void append(std::string& bytes, const std::string& name, const std::string& type, const std::string& value) {
    bytes += name + '\0' + type + '\0';
    append(bytes, static_cast<std::uint32_t>(value.size()));
    bytes += value;
}

// A header that is sound but for the size that it claims.
std::string exr_of_side(std::uint32_t side) {
    std::string bytes("\x76\x2f\x31\x01\x02\0\0\0", 8), channels, window;
    for (const auto* name : {"B", "G", "R"}) {
        channels += std::string(name) + '\0';
        append(channels, 2);  // float
        append(channels, 0);
        append(channels, 1);
        append(channels, 1);
    }
    append(window, 0);
    append(window, 0);
    append(window, side - 1);
    append(window, side - 1);
    const std::string one("\0\0\x80\x3f", 4), zero(4, '\0');
    append(bytes, "channels", "chlist", channels + '\0');
    append(bytes, "compression", "compression", std::string(1, '\3'));
    append(bytes, "dataWindow", "box2i", window);
    append(bytes, "displayWindow", "box2i", window);
    append(bytes, "lineOrder", "lineOrder", std::string(1, '\0'));
    append(bytes, "pixelAspectRatio", "float", one);
    append(bytes, "screenWindowCenter", "v2f", zero + zero);
    append(bytes, "screenWindowWidth", "float", one);
    return bytes + '\0';
}

// One line behind another, so that a complaint can name it.
std::string scene_with_texture(const std::string& name) {
    return "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
           "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
           name + "\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nTranslate 0 0 4\nShape \"sphere\"\n";
}

TEST_F(Faults, OfDamagedInputEndWithFileAndLine) {
    const auto sound = bytes_of(graph_file("cornell_box.pbrt"));
    std::mt19937 random(17);
    int refused = 0, read = 0;
    for (int i = 0; i < 150 && !HasFailure(); ++i) {
        auto damaged = sound;
        if (i % 3 == 0) damaged.resize(random() % damaged.size());
        for (unsigned n = random() % 4; n > 0 && !damaged.empty(); --n)
            damaged[random() % damaged.size()] ^= static_cast<char>(1 << random() % 8);
        const auto file = folder.write("damaged.pbrt", damaged);
        Process info({program("lightnet"), "scene", "info", file});
        const int code = info.wait(slowdown * seconds(20));
        EXPECT_TRUE(code == 0 || code == 2) << "code " << code << ", damage " << i << "\n" << info.output();
        EXPECT_TRUE(code == 0 || info.output().find("damaged.pbrt:") != std::string::npos) << info.output();
        (code == 0 ? read : refused) += 1;
    }
    folder.write("huge.exr", exr_of_side(1u << 30));
    folder.write("broken.exr", exr_of_side(64));
    folder.write("empty.png", "");
    folder.write("broken.png", "\x89PNG\r\n\x1a\n-----");
    for (const std::string texture :
         {"missing.png", "huge.exr", "broken.exr", "empty.png", "broken.png", "/dev/zero"}) {
        const auto scene = folder.write("textured.pbrt", scene_with_texture(texture));
        Process run(launch_words(graph_file("path.lua"), out, {"-D", "file=" + scene, "--threads", "1"}));
        EXPECT_EQ(run.wait(slowdown * seconds(20)), 2) << texture << "\n" << run.output();
        EXPECT_NE(run.output().find("textured.pbrt:4"), std::string::npos) << run.output();
        EXPECT_FALSE(std::filesystem::exists(out)) << "a picture of what can't be read";
    }
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    done(fmt::format("{} damaged scenes, 6 pictures that are missing, huge, cut short, endless", read + refused));
    seen(fmt::format("{} refused with file and line, {} still sound; {:.0f} MB at most", refused, read, memory));
    EXPECT_GT(refused, 0);
    figure("memory", memory, "MB", 512, false);
}

// A lamp so bright that what is reflected from it is infinite.
std::string scene_too_bright(const Folder& folder) {
    auto text = bytes_of(graph_file("cornell_box.pbrt"));
    const std::string lamp = "[ 17 12 4 ]";
    text.replace(text.find(lamp), lamp.size(), "[ 3e38 3e38 3e38 ]");
    return folder.write("bright.pbrt", text);
}

TEST_F(Faults, OfLightThatIsNotFiniteIsCounted) {
    const auto scene = scene_too_bright(folder);
    const Words words{"-D", "file=" + scene, "-D", "width=48", "-D", "height=48", "--samples", "32"};
    const Daemon one(folder), two(folder);
    const auto hosts = hosts_file({"'" + one.endpoint + "' { image = 1, direct = 1, lighting = 1 }",
                                   "'" + two.endpoint + "' { image = 1, bounce = 1 }"});
    std::vector<std::string> pictures;
    std::string said;
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--threads", "2"}, Words{"--hosts", hosts}}) {
        Process run(launch_words(graph_file("path.lua"), out, join(words, mode)));
        EXPECT_EQ(run.wait(slowdown * seconds(60)), 0) << run.output();
        said = run.output();
        EXPECT_NE(said.find("were not finite and count as black"), std::string::npos) << said;
        EXPECT_NE(said.find("answers that are not finite"), std::string::npos) << "it should name the node\n" << said;
        pictures.push_back(bytes_of(out));
    }
    std::size_t bad = 0;
    for (const auto& pixel : read_exr(out).beauty)
        bad += !(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    EXPECT_EQ(bad, 0u);
    EXPECT_TRUE(pictures[0] == pictures[1] && pictures[0] == pictures[2]) << "the bytes differ";
    done("a lamp of 3e38: one thread, two, two hosts");
    seen("the nodes are named, the colours counted, no pixel is NaN or infinite, the bytes are the same");
}

}  // namespace
}  // namespace lightnet::test
