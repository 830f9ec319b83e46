// Other renderers that are found on the path, beside path tracing here: the same scenes at the same size with 64
// samples per pixel (here 16 of 4 paths) on two threads, in turns, from launch to the written file. What is compared is
// seconds x relative square error (compare.hpp), without the worst thousandth of the pixels; with it, and processor
// seconds, in the lines before. The figure is the least product of all others over ours. `blender` is Cycles, on the
// processor and without guiding, cleaning or adaptive sampling; `mitsuba` is either of 0.6 and 3, which says itself
// which one it is. Arguments: names of scenes; without any, all.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/references.hpp"
#include "tools/pictures/compare.hpp"
#include "transport/start/child.hpp"

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const int rounds = repeated(3);
constexpr auto longest = std::chrono::minutes(60);
constexpr const char* threads = "2";
const std::string samples = smoke() ? "1" : "64", own_samples = smoke() ? "1" : "16";

constexpr const char* where_from =
    "neither blender (Debian: apt-get install --no-install-recommends blender) nor mitsuba (3: pip install mitsuba; "
    "0.6: "
    "built from its sources) is on the path";

struct PeerScene {
    std::string name, reference;
    double noise = 0;  // of the reference
    double goal = 1;   // times as good as the best of the others
};

const std::vector<PeerScene>& scenes() {
    static const std::vector<PeerScene> all{{"cornell_grey", "mits_path_2048", 0, 5},
                                            {"indirect", "mits_path_2048", 6e-4, 6},
                                            {"caustic", "mits_bdpt_1280", 6e-4, 4},
                                            {"terrain", "combined", 2e-4, 3}};
    return all;
}

/// One picture that is to be made.
struct Take {
    const PeerScene& scene;
    const fs::path& folder;  // for files
    std::string seed, out;
};

/// A renderer, and the command by which it makes a picture; none: files of the scene lack, which it names by throwing.
struct Peer {
    std::string name;
    std::function<Words(const Take&)> command;
};

fs::path file_of(const std::string& name) {
    const auto file = test::reference_file(name);
    if (!file) throw std::runtime_error(test::is_not_here("reference/" + name));
    return *file;
}

// "": there is none.
std::string on_path(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (const auto file = fs::path(folder) / program; ::access(file.c_str(), X_OK) == 0) return file;
    return "";
}

void replace_all(std::string& text, const std::string& word, const std::string& with) {
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + with.size()))
        text.replace(at, word.size(), with);
}

// Mitsuba's own description of the scene beside its meshes, with changes.
std::string described_for_mitsuba(const Take& take, const std::map<std::string, std::string>& changes) {
    const auto original = file_of(take.scene.name + ".path.xml");
    std::ifstream in(original);
    std::string text(std::istreambuf_iterator<char>(in), {});
    replace_all(text, "value=\"pfm\"", "value=\"openexr\"");
    for (const auto& [word, with] : changes) replace_all(text, word, with);
    for (const auto& entry : fs::directory_iterator(original.parent_path()))
        if (const auto link = take.folder / entry.path().filename();
            entry.path().extension() == ".ply" && !fs::exists(link))
            fs::create_symlink(entry.path(), link);
    const auto file = take.folder / "scene.xml";
    std::ofstream(file) << text;
    return file.string();
}

Peer cycles(const std::string& blender) {
    return {"cycles", [=](const Take& take) {
                return Words{blender,
                             "-b",
                             "--factory-startup",
                             "--python-exit-code",
                             "1",
                             "--python",
                             LIGHTNET_SOURCE_DIR "/tests/bench/peers_cycles.py",
                             "--",
                             file_of(take.scene.name + ".scene.json").string(),
                             samples,
                             take.out,
                             threads,
                             take.seed};
            }};
}

Peer mitsuba(const std::string& program) {
    const auto said = run_program({program, "--help"}, "", longest).text;
    if (said.find("version 0.") != said.npos)
        return {"mitsuba_0.6", [=](const Take& take) {
                    return Words{program, "-q",     "-p",
                                 threads, "-D",     "spp=" + samples,
                                 "-o",    take.out, described_for_mitsuba(take, {})};
                }};
    const Words variants{"llvm_ad_rgb", "llvm_rgb", "scalar_rgb"};
    const auto variant =
        std::find_if(variants.begin(), variants.end(), [&](const auto& name) { return said.find(name) != said.npos; });
    const auto mode = variant == variants.end() ? variants.back() : *variant;
    return {"mitsuba_3", [=](const Take& take) {
                const auto scene = described_for_mitsuba(take, {{"type=\"sobol\"", "type=\"independent\""}});
                return Words{program, "-m",      mode, "-t",     threads, "-Dspp=" + samples,
                             "-s",    take.seed, "-o", take.out, scene};
            }};
}

Peer own() {
    return {"lightnet", [](const Take& take) {
                Words words{LIGHTNET_STARTS_LIGHTNET,
                            "render",
                            file_of(take.scene.name + ".pbrt").string(),
                            "--lighting",
                            "path_all",
                            "--samples",
                            own_samples,
                            "--threads",
                            threads,
                            "--seed",
                            take.seed,
                            "--forget",
                            "--progress",
                            "none",
                            "-o",
                            take.out};
                if (smoke()) words.insert(words.end(), {"--size", "32x32"});
                return words;
            }};
}

std::vector<Peer> others() {
    std::vector<Peer> found;
    if (const auto program = on_path("blender"); !program.empty()) found.push_back(cycles(program));
    if (const auto program = on_path("mitsuba"); !program.empty()) found.push_back(mitsuba(program));
    return found;
}

double seconds_of_children() {
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// What pictures of one renderer took, and how far they are off.
struct Pictures {
    std::vector<double> seconds, processor, errors, with_fireflies;
    double cost() const { return median(seconds) * median(errors); }
};

void add(const Peer& peer, const PeerScene& scene, const Picture& reference, int round, Pictures& pictures) {
    const test::Folder folder;
    const auto out = (folder / "x.exr").string();
    const auto command = peer.command({scene, folder.path(), std::to_string(round), out});
    const double before = seconds_of_children();
    ProgramOutput ended;
    const double seconds = seconds_of([&] { ended = run_program(command, "", longest); });
    if (ended.code != 0 || !fs::exists(out)) throw std::runtime_error(peer.name + " ended badly: " + ended.text);
    pictures.seconds.push_back(seconds);
    pictures.processor.push_back(seconds_of_children() - before);
    if (smoke()) return;
    const Difference found = compare(reference, picture_in(out));
    pictures.errors.push_back(std::max(1e-7, found.relative_square_trimmed - scene.noise));
    pictures.with_fireflies.push_back(std::max(1e-7, found.relative_square - scene.noise));
}

void measure(const PeerScene& scene, const std::vector<Peer>& peers) {
    const auto name = "peers." + scene.name, picture = scene.name + "." + scene.reference + ".exr";
    if (!test::reference_file(picture)) return not_run(name, test::is_not_here("reference/" + picture));
    const Picture reference = read_exr(*test::reference_file(picture));
    std::map<std::string, Pictures> all;
    for (int round = 1; round <= rounds; ++round)
        for (const auto& peer : peers) add(peer, scene, reference, round, all[peer.name]);
    double best = 1e300;
    if (smoke()) return quantity(name, {1}, "times", scene.goal, true);
    for (const auto& peer : peers) {
        const Pictures& made = all[peer.name];
        std::printf("  %s, %s: %.2f s (%.2f s of processors) x %.3e = %.3e; with fireflies %.3e\n", scene.name.c_str(),
                    peer.name.c_str(), median(made.seconds), median(made.processor), median(made.errors), made.cost(),
                    median(made.seconds) * median(made.with_fireflies));
        if (peer.name != "lightnet") best = std::min(best, made.cost());
    }
    quantity(name, {best / all["lightnet"].cost()}, "times as good as the best other", scene.goal, true);
}

void measure_all(const std::vector<std::string>& names) {
    auto peers = others();
    if (peers.empty()) return not_run("peers", where_from);
    peers.push_back(own());
    for (const PeerScene& scene : scenes()) {
        if (!names.empty() && std::find(names.begin(), names.end(), scene.name) == names.end()) continue;
        try {
            measure(scene, peers);
        } catch (const std::exception& error) {
            broken("peers." + scene.name, error.what());
        }
    }
}

}  // namespace
}  // namespace lightnet::bench

int main(int count, char** words) {
    return lightnet::bench::run("peers", [&] { lightnet::bench::measure_all({words + 1, words + count}); });
}
