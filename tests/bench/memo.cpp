// Costs of an edit with --memo: a room with five lamps, each lit by operators of its own, of which one lamp is moved
// or a wall painted. Its parts of the rays and of the processor time of a fresh run, whose bytes it must have.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"
#include "transport/start/child.hpp"

namespace {

using namespace std::chrono_literals;
namespace bench = lightnet::bench;

constexpr int lamps = 5;
constexpr double goal = 0.23;  // 1/5 and 3 %

std::string scene_with(double place, double red) {
    std::string text = fmt::format(
        "LookAt 0 1 -4  0 .5 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n"
        "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ {} .5 .4 ]\nShape \"sphere\" \"float radius\" .8\n"
        "Shape \"trianglemesh\" \"point3 P\" [ -5 -1 -5  5 -1 -5  5 -1 5  -5 -1 5  -5 4 5  5 4 5 ] "
        "\"integer indices\" [ 0 1 2  0 2 3  3 2 5  3 5 4 ]\n",
        red);
    for (int lamp = 0; lamp < lamps; ++lamp)
        text += fmt::format(
            "AttributeBegin\nAttribute \"light\" \"string name\" \"lamp{0}\"\n"
            "LightSource \"point\" \"rgb I\" [ 9 8 7 ] \"point3 from\" [ {1} 3 -2 ]\nAttributeEnd\n",
            lamp, lamp - 2 + (lamp == 0 ? place : 0));
    return text;
}

std::string graph() {
    std::string groups, nodes, inputs;
    for (int lamp = 0; lamp < lamps; ++lamp) {
        groups += fmt::format("g{0} = \"lamp{0}\", ", lamp);
        nodes += fmt::format(
            "direct{0} = DirectLighting {{ lamps = \"g{0}\" }}\nbounce{0} = PathTracing {{ lamps = \"g{0}\" }}\n",
            lamp);
        inputs += fmt::format("direct{0}, bounce{0}, ", lamp);
    }
    return "scene = Scene { \"room.pbrt\", groups = { " + groups + "} }\n" + nodes + "all = Combine { " + inputs +
           "}\nimage = RayTracer { all, scene = scene, samples = 64, film = { 8, 8 } }\n";
}

std::string text_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Took {
    double rays = 0, seconds = 0;  // of processors
    std::string picture;
};

double seconds_of_children() {
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

class Room {
public:
    Room() { folder_.write("room.lua", graph()); }

    Took render(const std::string& scene, const std::vector<std::string>& more) {
        folder_.write("room.pbrt", scene);
        std::vector<std::string> words{LIGHTNET_STARTS_LIGHTNET,
                                       "run",
                                       folder_.file("room.lua"),
                                       "-o",
                                       folder_.file("x.exr"),
                                       "--threads",
                                       "2",
                                       "--size",
                                       bench::sized("256x256", "8x8"),
                                       "--progress",
                                       "none",
                                       "--forget"};
        words.insert(words.end(), more.begin(), more.end());
        const double before = seconds_of_children();
        const auto ended = lightnet::run_program(std::move(words), "", 1h);
        if (ended.code != 0) throw std::runtime_error(ended.text);
        const auto report = text_of(folder_.file("x.run.json"));
        const std::string name = "\"rays\": ";
        const auto at = report.find(name, report.find("\"counters\": "));
        if (at == std::string::npos) throw std::runtime_error("the report has no rays");
        return {std::stod(report.substr(at + name.size())), seconds_of_children() - before,
                text_of(folder_.file("x.exr"))};
    }
    std::string cache() const { return folder_.file("cache"); }

private:
    lightnet::test::Folder folder_;
};

void measure(const std::string& name, double place, double red, bool judged) {
    std::vector<double> rays, seconds;
    bool sound = true;
    for (int round = 0; round < bench::repeated(3); ++round) {
        Room room;
        const std::string edited = scene_with(place, red);
        room.render(scene_with(0, 0.5), {"--memo", "--cache", room.cache()});
        const Took again = room.render(edited, {"--memo", "--cache", room.cache()});
        const Took fresh = room.render(edited, {"--cache", "none"});
        sound &= again.picture == fresh.picture;
        rays.push_back(again.rays / fresh.rays);
        seconds.push_back(again.seconds / fresh.seconds);
    }
    if (!sound) throw std::runtime_error(name + ": the bytes are not those of a fresh run");
    if (!judged) return bench::show((name + ", part of the rays").c_str(), rays);
    bench::print_figure("memo " + name + " rays", rays, {"", "", 1, 3}, goal, false);
    bench::print_figure("memo " + name + " time", seconds, {"", "", 1, 3}, goal, false);
}

}  // namespace

int main() {
    return bench::run("memo", [] {
        measure("lamp", 0.25, 0.5, true);
        measure("material", 0, 0.6, false);  // which all paths can meet
    });
}
