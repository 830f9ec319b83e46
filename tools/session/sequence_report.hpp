// The report of a sequence: shot.run.json beside shot.0001.exr and the report of each frame.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/run/assembly/job.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// What became of a frame.
struct FrameReport {
    int frame = 0;
    std::string file;
    std::string outcome = "waiting";  // "waiting", "done", "there": before, "elsewhere": by another run, "failed" …
    double seconds = 0;               // that it took here
};

/// Of all frames that were asked for.
struct SequenceReport {
    std::string graph;              // file as the user named it
    std::string outcome = "going";  // "going", "done", "failed", "cancelled"
    std::vector<FrameReport> frames;
    double seconds = 0;  // so far
    std::size_t count(const std::string& outcome) const;
};

/// All such reports begin with this.
inline constexpr std::string_view sequence_report_beginning = "{\n  \"format\": \"lightnet sequence ";

/// The text of such a file. Key order is fixed.
std::string to_json(const SequenceReport& report);
/// Writes it, whole or not at all. Throws Error, also when a file of others is there.
void write_report(const std::string& file, const SequenceReport& report);

/// All that the picture of a frame depends on, its samples included, as one word for its own report.
std::string recipe_of_frame(const Job& job);
/// Is the picture there, and done by that recipe, as its report says?
bool is_there(const std::string& exr, const std::string& recipe);

}  // namespace lightnet
