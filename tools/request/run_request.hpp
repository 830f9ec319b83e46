// A run, as it is asked for.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/tone.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/forecast/mover.hpp"
#include "core/run/message/tuning.hpp"
#include "core/scene/data/scene_data.hpp"
#include "tools/http/watch_rules.hpp"
#include "tools/request/run_keys.hpp"
#include "tools/support/progress.hpp"
#include "transport/start/fault_injection.hpp"

namespace lightnet {

/// How a run is: in one thread, in places of this process, or with hosts of any kind (and places of this process).
enum class Mode { serial, threads, network };

/// A scene that has been read before its run, with the files that it took. As its file says: nothing is overridden yet.
struct ReadScene {
    DiskFiles files;
    SceneData scene;
};

/// Daemons to be started by Slurm.
struct SlurmRequest {
    std::uint32_t daemons = 0;
    std::string partition;               // "": Slurm's usual one
    std::vector<std::string> arguments;  // more words for sbatch
};

/// Daemons to be started by ssh.
struct SshRequest {
    std::vector<std::string> command;  // and its options
    std::string daemon;                // lightnetd there; "": as here, or else in the PATH there
};

/// Which frame of a sequence a run is.
struct FrameOfSequence {
    int number = 1;
    std::size_t index = 0, count = 1;                // among those that are to be rendered
    std::chrono::steady_clock::time_point begun{};   // the sequence
    std::vector<std::pair<int, std::string>> all{};  // frames of it, by number, and what became of each so far
};

/// What was written of a run's picture. A value.
struct PictureShown {
    double samples = 0;                                  // per pixel, on average
    bool finished = false, coarse = false;               // all samples are there; it is a first look, see coarse_look()
    std::vector<std::string> warnings;                   // of the run, so far
    std::vector<std::pair<std::string, double>> took{};  // seconds of its parts, one after the other, by name
    std::vector<std::string> without{};                  // layers that a first look lacks, as their nodes prepare
};

/// What a user may say of a run, and the run takes as it is said: an option of `run` is a member here, and a line where
/// options are described.
struct RunSettings {
    std::uint64_t seed = 0;
    bool resume = false;      // from the checkpoint beside the output, if there is one
    bool forget = false;      // leave no checkpoint beside a finished picture
    bool memo = false;        // take what earlier runs have rendered of the same, and keep it for later ones
    std::string listen;       // endpoint where hosts may join; "": nowhere
    std::string pass;         // file with what hosts must know to join; "": the usual one
    FaultInjection troubles;  // of local workers
    Tuning tuning;
    double time_limit = 0;  // seconds since the run began; 0: none
    ProgressMode progress = ProgressMode::automatic;
    double preview = 0;                  // seconds between two pictures of what is there; 0: none
    std::optional<WatchAddress> viewer;  // tev, to be shown the picture while it grows
    std::optional<WatchAddress> watch;   // serve a page that shows the run
    std::string report;                  // file of a page that shows what the run did; "": none
    std::string trace;                   // file for what places were busy with; "": none
    std::string arrays;                  // file for the picture as arrays of NumPy; "": none
    PngRequest png;                      // beside the picture
    std::string reference, curve;        // a picture to be compared with, and a file for the errors; "": none
};

/// How the scene of a run is lit, where that has a name. A value.
struct LightingOfRun {
    std::string name;    // "": it has none
    std::string trials;  // figures of the trials by which it was chosen; "": somebody has named it
};

/// A run, ready to go.
struct RunRequest : RunSettings {
    LightingOfRun lighting;
    Graph graph;  // checked; --samples and --size are in it, and the sectors of sharded nodes
    Hosts hosts;  // to be called, or that join by name; and places of this process
    std::shared_ptr<const LaidOut> laid_out;  // by what `hosts` hold what they do; null: somebody has said so
    Mode mode = Mode::serial;
    std::uint32_t threads = 0;                      // places in this process, as many as `hosts` names if it names any
    std::uint32_t local_workers = 0;                // mode network: daemons to start
    std::uint32_t local_places = 0;                 // of each; 0: as many as there are cores, dealt out
    RunKeys keys;                                   // mode network: by which hosts and this process know each other
    SlurmRequest slurm;                             // mode network
    SshRequest ssh;                                 // likewise; on which machines: see keys.ssh
    std::chrono::seconds wait{30};                  // for a host when a node has no place any more
    std::optional<std::chrono::seconds> busy_wait;  // for hosts that serve other runs; none: as long as it takes
    std::string scene;                              // file, as seen from here
    std::shared_ptr<ReadScene> read;                // it, read already; the run takes it away. None: still to be read
    std::string output;                             // "x.exr", as seen from here
    std::optional<FrameOfSequence> frame;           // none: a still
    std::optional<double> looks;  // part of its samples that are computed again, to tell what errs; none: a few
    /// Is told whenever the picture was written, which then happens from its first sample on; none: it is written once.
    /// Called by the run's thread.
    std::function<void(const PictureShown&)> shown;
};

}  // namespace lightnet
