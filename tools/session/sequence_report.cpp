#include "tools/session/sequence_report.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/base/atomic_file.hpp"
#include "core/base/hash.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/own_files.hpp"
#include "core/base/own_process.hpp"
#include "core/base/plain_file.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

std::size_t SequenceReport::count(const std::string& wanted) const {
    return static_cast<std::size_t>(
        std::count_if(frames.begin(), frames.end(), [&](const auto& frame) { return frame.outcome == wanted; }));
}

std::string to_json(const SequenceReport& report) {
    JsonTree frames = JsonTree::list();
    for (const auto& [frame, file, outcome, seconds] : report.frames)
        frames.push_back({{"frame", frame},
                          {"file", file},
                          {"outcome", outcome},
                          {"seconds", seconds},
                          {"report", report_beside(file).string()}});
    JsonTree json;
    json["format"] = "lightnet sequence 1";
    json["outcome"] = report.outcome;
    json["graph"] = report.graph;
    json["seconds"] = report.seconds;
    json["peak_memory"] = peak_memory();
    json["frames"] = std::move(frames);
    return to_text(json, {.indent = 2}) + "\n";
}

void write_report(const std::string& file, const SequenceReport& report) {
    expect_ours(file, sequence_report_beginning);
    write_file(file, to_json(report));
}

std::string recipe_of_frame(const Job& job) {
    Graph graph = job.graph;
    graph.file.clear();
    for (auto& node : graph.nodes) node.where = {};
    const MadeFrom made = made_from(job);
    return to_hex(content_hash(made.run + '\n' + made.files + '\n' + to_json(graph) + '\n' +
                               std::to_string(fingerprint(job.isa))));
}

bool is_there(const std::string& exr, const std::string& recipe) try {
    std::error_code none;
    if (!std::filesystem::exists(exr, none)) return false;
    const auto text = text_of_plain_file(report_beside(exr), longest_report);
    if (!text) return false;
    const Json report = parse_json(*text, {.bytes = longest_report});
    const Json& settings = report.at("settings");
    return report.at("outcome").text() == "done" && settings.has("recipe") && settings.at("recipe").text() == recipe;
} catch (const Error&) {  // no report of ours
    return false;
}

}  // namespace lightnet
