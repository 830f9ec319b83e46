// What a run did, for people and scripts: x.run.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lightnet {

/// One place, and the nodes that it held.
struct PlaceReport {
    std::string host;         // endpoint; "" for a place of the launcher's process
    std::uint32_t index = 0;  // among the places of its host
    std::vector<std::string> nodes;
};

/// One host that took part, and its machine, as it said itself.
struct HostReport {
    std::string host;   // as in the places; "" for the launcher's process
    std::string state;  // at the end: "is ready", "is lost: …"
    std::string machine, cpu, isa, version;
    std::uint64_t cores = 0, memory = 0;  // bytes
    std::uint32_t places = 0;
};

/// A part of the life of a run: "load", "prepare", "render", …
struct PhaseReport {
    std::string name;
    double seconds = 0;
};

/// What ran where, for how long, and what was counted. All that changes from run to run stands here and never in the
/// picture. A value.
struct RunReport {
    std::string outcome = "done";      // "done", "failed", "cancelled"
    std::string graph, graph_hash;     // file as the user named it; hash of its canonical text
    std::string mode;                  // "serial", "threads", "network"
    std::vector<std::string> outputs;  // files written
    std::vector<PlaceReport> places;
    std::vector<HostReport> hosts;
    std::vector<PhaseReport> phases;
    std::map<std::string, std::uint64_t> counters;  // questions, bundles, bytes, rays, tiles, lost, duplicates, …
    std::map<std::string, std::string> versions;    // of the program and the libraries
    std::map<std::string, std::string> settings;    // samples, size, seed, tone, …
    std::vector<std::string> warnings;
};

/// All reports begin with this.
inline constexpr std::string_view report_beginning = "{\n  \"format\": \"lightnet run ";

/// x.exr → x.run.json
std::filesystem::path report_beside(const std::filesystem::path& picture);

/// The text of such a file. Key order is fixed.
std::string to_json(const RunReport& report);

/// Writes it, whole or not at all. Throws Error.
void write_report(const std::filesystem::path& path, const RunReport& report);

}  // namespace lightnet
