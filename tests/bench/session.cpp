// Time from an edit to the first picture of a session, a coarse look, written to its files, and what it goes into.
// Edits of the camera, of a node, of what is around the scene, of a lamp and a material by their names, and in the
// scene's file, where instances of an object are moved, too; on two threads and on two daemons. Scenes of the project,
// and real ones where they are.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/json.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/references.hpp"

namespace {

using namespace std::chrono_literals;
namespace bench = lightnet::bench;
namespace fs = std::filesystem;

const int edits = bench::sized(40, 2);

/// A scene that is edited: its file, what of that is a lamp's number and what is a material's, and how it is looked at.
struct Edited {
    std::string name, file;
    std::string lamp, material;  // behind either a number follows; "": its file has no such number
    std::string camera;          // of an edit, with the number of the edit in the place of {}
    std::string painted;         // the name of a material
    double goal;                 // ms, for the slowest of twenty edits
    std::string rest;            // the folder of what the file names, if that is not beside it
};

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// Three instances of an object of so many triangles, of which the first is moved, in words of pbrt.
std::string instances(int number) {
    constexpr int side = 100;
    std::string points, triangles;
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x) points += fmt::format("{} {} {} ", x, y, (x * y) % 7);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const int first = y * (side + 1) + x;
            triangles += fmt::format("{} {} {} {} {} {} ", first, first + 1, first + side + 1, first + 1,
                                     first + side + 2, first + side + 1);
        }
    std::string text = "ObjectBegin \"wave\"\nMaterial \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [ " + points +
                       "] \"integer indices\" [ " + triangles + "]\nObjectEnd\n";
    for (int i = 0; i < 3; ++i)
        text += fmt::format("AttributeBegin\nTranslate {} {} {}\nObjectInstance \"wave\"\nAttributeEnd\n",
                            100 + 100 * i + (i == 0 ? 0.1 * number : 0), 100, 200);
    return text;
}

/// A session whose edits go through a pipe with a name.
class Session {
public:
    Session(const Edited& scene, const std::string& layout, const std::string& more)
        : file_(folder_.file("scene.pbrt")), text_(text_of(scene.file)) {
        if (!scene.rest.empty())
            for (const auto& entry : fs::directory_iterator(scene.rest))
                fs::create_symlink(entry.path(), folder_.path() / entry.path().filename());
        std::ofstream(file_) << text_ << more;
        std::ofstream(folder_.file("g.lua"))
            << "scene = Scene { \"scene.pbrt\" }\ndirect = DirectLighting { samples = 1 }\nbounce = PathTracing { "
               "samples = 1 }\nboth = Combine { direct, bounce }\nimage = RayTracer { both, scene = scene, samples = "
               "1000, "
               "film = { 256, 256 } }\n";
        const std::string pipe = folder_.file("edits");
        if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
        const auto command = fmt::format("exec '{}' session '{}' {} --size {} --cache none --json -o '{}' <'{}'",
                                         LIGHTNET_STARTS_LIGHTNET, folder_.file("g.lua"), layout,
                                         bench::sized("256x256", "16x16"), folder_.file("now.exr"), pipe);
        events_.reset(::popen(command.c_str(), "r"));
        edits_.file = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);
        wait_for_picture(0);
    }
    ~Session() { say(R"({"set":{"image.samples":1},"end":true})"); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    void say(const std::string& edit) const {
        const std::string line = edit + "\n";
        if (::write(edits_.file, line.data(), line.size()) != ssize_t(line.size()))
            throw std::runtime_error("it is gone");
    }
    /// Another number behind `name` in the scene's file.
    void write(const std::string& name, int number) const {
        std::string text = text_;
        const auto at = text.find(name);
        if (at == std::string::npos) throw std::runtime_error("there is no " + name);
        const auto begin = at + name.size(), end = text.find_first_of(" ]", begin + 1);
        text.replace(begin, end - begin,
                     fmt::format(" {}", std::stod(text.substr(begin)) * (1 + 0.001 * (number + 1))));
        put(text);
    }
    /// Something else behind what its file has.
    void write_behind(const std::string& more) const { put(text_ + more); }
    /// The first one of an edit; what it took, in ms.
    std::map<std::string, double> wait_for_picture(std::uint64_t edit) {
        for (std::string line; next(line);) {
            const auto event = lightnet::parse_json(line);
            if (event.at("event").text() == "error") throw std::runtime_error(line);
            if (event.at("event").text() != "picture" || event.at("edit").whole<std::uint64_t>() != edit) continue;
            std::map<std::string, double> took;
            for (const auto& [part, seconds] : event.at("took").object()) took[part] = 1000 * seconds.number();
            return took;
        }
        throw std::runtime_error("the session has ended");
    }

private:
    void put(const std::string& text) const {
        std::ofstream(file_ + ".new") << text;
        fs::rename(file_ + ".new", file_);
    }
    struct Closes {
        void operator()(std::FILE* file) const { ::pclose(file); }
    };
    struct Pipe {
        int file = -1;
        Pipe() = default;
        ~Pipe() { ::close(file); }
        Pipe(const Pipe&) = delete;
        Pipe& operator=(const Pipe&) = delete;
    };
    bool next(std::string& line) {
        line.clear();
        for (int c = std::getc(events_.get()); c != EOF && c != '\n'; c = std::getc(events_.get())) line += char(c);
        return !line.empty();
    }

    lightnet::test::Folder folder_;
    std::string file_, text_;
    std::unique_ptr<std::FILE, Closes> events_;
    Pipe edits_;  // closed before the session is waited for, which ends by that
};

void edit(const Session& session, const Edited& scene, const std::string& kind, int number) {
    if (kind == "camera") {
        std::string text = scene.camera;
        text.replace(text.find("{}"), 2, std::to_string(number));
        session.say(text);
    } else if (kind == "node") {
        session.say(fmt::format(R"({{"set":{{"direct.samples":{}}}}})", 1 + number % 2));
    } else if (kind == "around") {
        session.say(fmt::format(R"({{"set":{{"scene.environment_scale":{}}}}})", 2 + number));
    } else if (kind == "lamp_by_name") {
        session.say(fmt::format(R"({{"set":{{"scene.lamps":{{"*":{}}}}}}})", 1 + 0.01 * (number + 1)));
    } else if (kind == "material_by_name") {
        session.say(
            fmt::format(R"({{"set":{{"scene.colours":{{"{}":[0.5,{},0.4]}}}}}})", scene.painted, 0.5 + 0.002 * number));
    } else if (kind == "moved") {
        session.write_behind(instances(number + 1));
    } else {
        session.write(kind == "lamp" ? scene.lamp : scene.material, number);
    }
}

double at(double part, std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times[std::size_t(part * double(times.size() - 1))];
}

// Each edit comes while the picture of the one before is at work.
void measure(const Edited& scene, const std::string& name, const std::string& layout) {
    for (const std::string kind :
         {"camera", "node", "around", "lamp_by_name", "material_by_name", "lamp", "material", "moved"}) {
        if (kind == "lamp" && scene.lamp.empty()) continue;
        Session session(scene, layout, kind == "moved" ? instances(0) : "");
        std::vector<double> times;
        std::map<std::string, std::vector<double>> parts;
        for (int i = 0; i < edits; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(150 + 37 * i % 100));
            edit(session, scene, kind, i);
            times.push_back(1000 * bench::seconds_of([&] {
                                for (const auto& [part, took] : session.wait_for_picture(std::uint64_t(i) + 1))
                                    parts[part].push_back(took);
                            }));
        }
        std::printf("  %s, %s, %s: p50 %.0f ms, p95 %.0f, p99 %.0f;", scene.name.c_str(), name.c_str(), kind.c_str(),
                    at(0.5, times), at(0.95, times), at(0.99, times));
        for (const char* part : {"stop", "read", "load", "prepare", "render", "write"})
            std::printf(" %s %.0f/%.0f", part, at(0.5, parts[part]), at(0.95, parts[part]));
        std::printf("\n");
        bench::print_figure("session " + scene.name + " " + name + " " + kind, {at(0.95, times)}, {"", "ms ", 1, 0},
                            kind == "moved" ? 120 : scene.goal, false);
    }
}

std::vector<Edited> scenes() {
    const std::string graphs = LIGHTNET_SOURCE_DIR "/graphs/";
    std::vector<Edited> all{{"cornell", graphs + "cornell_box.pbrt", "\"rgb L\" [", "\"rgb reflectance\" [",
                             R"({"camera":{"from":[270.{},273,-800],"to":[278,273,280]}})", "red", 60, ""},
                            {"studio", graphs + "studio.pbrt", "\"diffuse\" \"rgb L\" [", "\"rgb reflectance\" [",
                             R"({"camera":{"fov":40.{}}})", "plaster", 60, ""}};
    using Painted = std::pair<std::string, std::string>;
    for (const auto& [name, painted] : {Painted{"living-room", "MattePaint"}, Painted{"bmw-m6", "LEATHER"}})
        if (const auto rest = lightnet::test::shared_file("scenes/" + name + "-pbrt"); rest && !bench::smoke())
            all.push_back({name, (*rest / (name + ".pbrt")).string(), "", "\"rgb reflectance\" [",
                           R"({"camera":{"fov":50.{}}})", painted, 120, rest->string()});
    return all;
}

}  // namespace

int main() {
    return bench::run("session", [] {
        for (const auto& scene : scenes()) {
            measure(scene, "threads", "--threads 2");
            measure(scene, "daemons", "--local-workers 2");
        }
    });
}
