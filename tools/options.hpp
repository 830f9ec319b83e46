// What the user typed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/film/progress.hpp"
#include "tools/command_line.hpp"
#include "tools/compare.hpp"
#include "tools/run.hpp"

namespace lightnet {

enum class Verb { run, render, check, dot, describe, scene_info, hosts, compare };

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

/// The command line, taken apart. What wasn't given is absent.
struct Options {
    Verb verb = Verb::run;
    std::string graph;                           // file
    std::string scene;                           // file, for render and scene info
    std::string lighting = "path";               // for render: path, direct, ao or a graph file
    std::string environment;                     // for render: a picture's file or a colour; "": as the scene says
    std::optional<double> exposure;              // stops; none: as the scene says
    bool two_sided = false;                      // for render: no surface is black from behind
    std::string hosts;                           // file; "": none
    std::optional<std::uint32_t> threads;        // places in this process; 1: serial
    std::optional<std::uint32_t> local_workers;  // daemons to start here
    std::string output;                          // file; "": as the graph says
    std::optional<std::uint32_t> samples;        // per pixel
    std::optional<PictureSize> size;
    std::optional<PictureCrop> crop;
    double preview = 0;  // seconds between two pictures of what is there; 0: none
    std::uint64_t seed = 0;
    std::map<std::string, std::string> constants;  // -D
    ProgressMode progress = ProgressMode::automatic;
    std::string listen;                  // endpoint where hosts may join
    bool insecure = false;               // even beyond this machine
    std::string pass;                    // file with what hosts must know to join; "": the usual one
    int wait = 30;                       // seconds for a host to come when a node has no place any more
    std::optional<std::uint32_t> slurm;  // daemons to start as a job array
    std::string partition, slurm_arguments;
    bool resume = false;  // from a checkpoint
    bool forget = false;  // it, when the picture is finished
    Tuning tuning;
    std::string kind;               // for describe; "": all
    std::string pictures;           // for dot: the EXR that shows what each node gives; "": none
    std::vector<std::string> whom;  // for hosts: endpoints and hosts files
    CompareRequest compare;
};

/// Takes a command line (without the program's name) apart. Flags may stand in any order after the verb.
std::variant<Options, Finished> parse_options(const std::vector<std::string>& arguments);

}  // namespace lightnet
