// The report of a run, for people and scripts: x.run.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightnet {

/// One place, and the nodes that it held.
struct PlaceReport {
    std::string host;         // endpoint; "here" for a place of the launcher's process
    std::uint32_t index = 0;  // among the places of its host
    std::vector<std::string> nodes;
    double seconds = 0;  // for which it served; 0: it was lost, or is not done
    double waiting = 0;  // of them: with nothing to do but wait for answers of others
    double idle = 0;     // of them: with no work at all
};

/// What preparing a node took. Seconds are those of threads.
struct ShardsReport {
    std::uint64_t count = 0;   // that all copies did together
    std::uint64_t rounds = 0;  // in which these were done, and rehearsals: all copies wait for the end of each
    double seconds = 0;        // for them, for what was done twice, and for tiles of rehearsals
    double own_seconds = 0;    // of all copies of a host beside them: of the host for which it was most
    std::uint64_t bytes = 0;   // of results that one copy was given, at most
};

/// A node of the graph, all places together. Seconds are those of threads.
struct NodeReport {
    std::string name, kind;
    std::uint64_t questions = 0;  // that other nodes asked it
    std::uint64_t answered = 0;   // of them, and of tiles (blocks) and shards: for other places, or the launcher
    std::uint64_t bundles = 0;    // that took them there
    double seconds = 0;           // that it ran, with the nodes that it called
    double own_seconds = 0;       // without them
    double latency = 0;           // seconds from sending a bundle to its answer, on average
    ShardsReport shards{};        // all 0: it does not prepare
    std::vector<std::pair<double, std::uint64_t>> spread{};  // seconds of a question or a block of tiles, and of how
                                                             // many; of what other places or the launcher asked
};

/// Of the graph, all places together.
struct EdgeReport {
    std::string from, to;  // who asks whom
    std::uint64_t asks = 0, questions = 0;
    double called_seconds = 0;    // running in calls, with what was called from there
    double waiting_seconds = 0;   // of askers, for answers from elsewhere; their places may have done other work
    std::uint64_t bundles = 0;    // with its questions, that went to other places; questions of others may be in them
    std::uint64_t sent = 0;       // questions that went so
    std::uint64_t bytes = 0;      // of them and of their answers, as they lie in memory
    std::uint64_t learning = 0;   // of the questions: that were asked for shards of preparing, or in a rehearsal ...
    double learning_seconds = 0;  // ... and of called_seconds
};

/// A layer of the picture: what one operator adds, of one group of lamps where it keeps these apart.
struct LayerReport {
    std::string name;
    double mean = 0;   // luminance, over all pixels, times its gain
    double share = 0;  // of that of all layers
};

/// One host that took part, and its machine, as it said itself.
struct HostReport {
    std::string host;   // as in the places
    std::string state;  // at the end: "is ready", "is lost: …"
    std::string machine, cpu, isa, version;
    std::uint64_t cores = 0, memory = 0;  // bytes
    std::uint32_t places = 0;
    std::uint64_t peak_memory = 0;  // of its process, in this run; bytes
};

/// A part of the life of a run: "load", "prepare", "render", …
struct PhaseReport {
    std::string name;
    double seconds = 0;
    double processor = 0;  // of them: that the launcher's own thread ran
};

/// What a node did while it prepared, as it said itself.
struct PrepareReport {
    std::string node, what;
    double seconds = 0;
};

/// Nodes that went to other hosts in mid-run.
struct MoveReport {
    std::uint64_t at_ns = 0;         // by steady_nanoseconds() of the launcher
    double seconds = 0;              // since the run began
    double gain = 0;                 // predicted, of the time that was left: 0 to 1
    std::vector<std::string> nodes;  // "caustic goes from a to b"
};

/// How far the picture that was written is from a reference.
struct ErrorReport {
    std::string reference;  // file
    double samples = 0;     // per pixel, on average
    double relative_square = 0, square = 0;
};

/// What is known of the noise of the picture that was written, from some pixels that were computed again.
struct NoiseReport {
    double error = 0;          // relative square, as in ErrorReport: without a reference, from how samples differ
    std::uint32_t pixels = 0;  // that were looked at
    std::vector<std::pair<std::string, double>> paths;  // words of light paths, and their parts of the error
};

/// What ran where, for how long, and what was counted. All that changes from run to run stands here and never in the
/// picture. A value.
struct RunReport {
    std::string outcome = "done";      // "done", "failed", "cancelled"
    std::string graph, graph_hash;     // file as the user named it; hash of its canonical text
    std::string network, folder;       // the graph as it was run, canonical JSON; where its file names are taken from
    std::string mode;                  // "serial", "threads", "network"
    std::uint64_t peak_memory = 0;     // of the launcher's process, bytes
    std::vector<std::string> outputs;  // files written
    std::vector<PlaceReport> places;
    std::vector<NodeReport> nodes;
    std::vector<EdgeReport> edges;
    std::vector<LayerReport> layers;
    std::optional<ErrorReport> error;
    std::optional<NoiseReport> noise;
    std::vector<HostReport> hosts;
    std::vector<PhaseReport> phases;
    std::vector<PrepareReport> preparing;
    std::vector<MoveReport> moves;
    std::map<std::string, std::uint64_t> counters;  // questions, bundles, bytes, rays, tiles, lost, duplicates, …
    std::map<std::string, std::string> versions;    // of the program and the libraries
    std::map<std::string, std::string> settings;    // samples, size, seed, tone, …
    std::vector<std::string> warnings;
};

/// Bytes of one that is read.
inline constexpr std::uint64_t longest_report = std::uint64_t{256} << 20;

/// All reports begin with this.
inline constexpr std::string_view report_beginning = "{\n  \"format\": \"lightnet run ";

/// x.exr → x.run.json
std::filesystem::path report_beside(const std::filesystem::path& picture);
/// x.exr → x.run.failed.json: of a run that left the picture of an earlier one as it was.
std::filesystem::path failed_report_beside(const std::filesystem::path& picture);

/// The text of such a file. Key order is fixed.
std::string to_json(const RunReport& report);

/// Writes it, whole or not at all. Throws Error.
void write_report(const std::filesystem::path& path, const RunReport& report);

}  // namespace lightnet
