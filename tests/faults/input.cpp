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
        EXPECT_EQ(run.wait(slowdown * seconds(20)), 0) << texture << "\n" << run.output();
        EXPECT_NE(run.output().find("textured.pbrt:4"), std::string::npos) << run.output();
        EXPECT_NE(run.output().find("mid-grey is taken instead"), std::string::npos) << run.output();
    }
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    done(fmt::format("{} damaged scenes, 6 pictures that are missing, huge, cut short, endless", read + refused));
    seen(fmt::format("{} refused with file and line, {} still sound; {:.0f} MB at most", refused, read, memory));
    EXPECT_GT(refused, 0);
    figure("memory", memory, "MB", 512, false);
}

// Light that a node makes too bright for a float here and there, of a lamp as bright as wanted.
std::string graph_too_bright(const Folder& folder, const std::string& lamp, const std::string& factor) {
    auto scene = bytes_of(graph_file("cornell_box.pbrt"));
    const std::string before = "[ 17 12 4 ]";
    scene.replace(scene.find(before), before.size(), "[ " + lamp + " ]");
    folder.write("bright.pbrt", scene);
    return folder.write("bright.lua",
                        "scene = Scene { 'bright.pbrt' }\ndirect = DirectLighting {}\nbounce = PathTracing {}\n"
                        "loud = Scale { direct, factor = " +
                            factor +
                            " }\nlighting = Combine { loud, bounce }\n"
                            "image = RayTracer { lighting, scene = scene, samples = 32, film = { 48, 48 } }\n");
}

std::size_t not_finite_in(const std::filesystem::path& exr) {
    std::size_t bad = 0;
    for (const auto& pixel : read_exr(exr).beauty)
        bad += !(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    return bad;
}

TEST_F(Faults, OfLightThatIsNotFiniteIsCounted) {
    const Daemon one(folder), two(folder);
    const auto hosts = hosts_file({"'" + one.endpoint + "' { image = 1, direct = 1, lighting = 1 }",
                                   "'" + two.endpoint + "' { image = 1, loud = 1, bounce = 1 }"});
    const auto loud = graph_too_bright(folder, "1700 1200 400", "3e38");
    std::vector<std::string> pictures;
    for (const Words& mode : {Words{"--threads", "1"}, Words{"--threads", "2"}, Words{"--hosts", hosts}}) {
        Process run(launch_words(loud, out, mode));
        const int code = run.wait(slowdown * seconds(60));
        EXPECT_EQ(code, 0) << run.output();
        EXPECT_NE(run.output().find("were not finite and count as black"), std::string::npos) << run.output();
        EXPECT_NE(run.output().find("Scale 'loud' gave"), std::string::npos) << "it should name the node\n"
                                                                             << run.output();
        if (code != 0) return;
        EXPECT_EQ(not_finite_in(out), 0u);
        pictures.push_back(bytes_of(out));
    }
    EXPECT_TRUE(pictures[0] == pictures[1] && pictures[0] == pictures[2]) << "the bytes differ";
    // Each layer is finite, and their sum is not.
    Process run(launch_words(graph_too_bright(folder, "3e38 3e38 3e38", "1"), out, {"--threads", "2"}));
    EXPECT_EQ(run.wait(slowdown * seconds(60)), 0) << run.output();
    const auto bad = not_finite_in(out);
    EXPECT_EQ(bad, 0u) << "of a lamp of 3e38";
    done("a node that multiplies by 1e38 (one thread, two, two hosts), a lamp of 3e38");
    seen(fmt::format("{} pixels NaN or infinite with the lamp", bad));
}

}  // namespace
}  // namespace lightnet::test
