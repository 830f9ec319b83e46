// Groups of options that several verbs share: what they hold, and how they are described to the command line.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/film/gains.hpp"
#include "lua/load_graph.hpp"
#include "tools/request/run_request.hpp"
#include "tools/support/progress.hpp"
#include "transport/start/fault_injection.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lightnet {

/// A graph file.
struct GraphOptions {
    std::string file;                              // "-": standard input
    std::map<std::string, std::string> constants;  // -D
    GraphFrame frame{};                            // for which it is evaluated
    std::optional<std::string> text{};             // of the file, where it has been read already
};

/// Width and height, pixels.
struct PictureSize {
    std::uint32_t width = 0, height = 0;
    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// Edges of what is wanted of a picture, pixels; the last column and row are excluded.
struct PictureCrop {
    std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    friend bool operator==(const PictureCrop&, const PictureCrop&) = default;
};

/// What stands in place of what the graph says of its picture. What wasn't given is absent.
struct PictureOptions {
    std::optional<std::uint32_t> samples;  // per pixel
    std::optional<double> noise;           // threshold
    std::optional<PictureSize> size;
    std::optional<PictureCrop> crop;
    std::string camera;       // of the scene's file, name or number; "": as the graph says
    std::vector<Gain> gains;  // of layers
    bool clean = false;       // it is cleaned, whatever the graph says
    bool alpha = false;       // what surrounds the scene is left out, and the part of pixels that it covers kept
    std::string compression;  // of the file; "": as the graph says
    std::string output;       // file; "": as the graph says
};

/// What all verbs that make a picture take: what the run takes as it is said, and what has to be worked out first.
struct RunningOptions : RunSettings {
    PictureOptions picture;
    std::string hosts;                           // file; "": none
    std::string layout, layout_out;              // "auto", "auto=X.run.json"; a hosts file to write. "": none
    std::vector<std::string> layout_memory;      // "16G", "NAME=16G"
    std::optional<std::uint32_t> threads;        // places in this process; 1: serial
    std::optional<std::uint32_t> local_workers;  // daemons to start here
    std::string key;                             // file with our own; "": the usual one
    std::string allow;                           // whose hosts may join, see AllowFile; "": who knows the pass
    bool insecure = false;                       // even beyond this machine
    std::optional<int> wait;                     // seconds for hosts to come or, if given, to be free; none: 30
    std::optional<std::uint32_t> slurm;          // daemons to start as a job array
    std::string partition, slurm_arguments;
    std::vector<std::string> ssh;  // machines on which to start daemons, as ssh calls them
    std::string ssh_command = "ssh -T -o BatchMode=yes -o ConnectTimeout=10";
    std::string ssh_daemon;  // lightnetd there; "": as here, or else in the PATH there
};

void add_graph(CLI::App& verb, GraphOptions& graph);
void add_constants(CLI::App& verb, std::map<std::string, std::string>& constants, const char* help);
/// --samples, --noise, --size and --crop.
void add_picture(CLI::App& verb, PictureOptions& picture);
/// --clean
void add_clean(CLI::App& verb, PictureOptions& picture);
/// An option, or where `name` has no dashes the words of the command line, that gives layers gains.
CLI::Option* add_gains(CLI::App& verb, const char* name, std::vector<Gain>& gains, const char* help);
/// --view
void add_view(CLI::App& verb, PngRequest& png);
/// --view, --exposure and, where help is given for it, --alpha.
void add_png(CLI::App& verb, PngRequest& png, const char* alpha_help);
void add_output(CLI::App& verb, std::string& file, const char* help);
/// --npz
void add_arrays(CLI::App& verb, std::string& file);
CLI::Option* add_hosts(CLI::App& verb, std::string& file);
/// --layout, --layout-out and --layout-memory.
void add_layout(CLI::App& verb, RunningOptions& running);
CLI::Option* add_threads(CLI::App& verb, std::optional<std::uint32_t>& threads, const char* help);
/// All of them but --output, whose help differs.
void add_running(CLI::App& verb, RunningOptions& running);

/// For `when_taken_apart()`: what is wrong with them together. `--slurm` wants a place where daemons can join.
std::optional<std::string> settle(RunningOptions& running);
/// What is wrong where a scene stands for a graph, and a graph for a scene; none: nothing. `instead`: "to render it:
/// lightnet run".
std::optional<std::string> mistaken_scene(const std::string& graph, const std::string& instead);
std::optional<std::string> mistaken_graph(const std::string& scene, const std::string& instead);

}  // namespace lightnet
