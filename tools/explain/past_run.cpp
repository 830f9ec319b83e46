#include "tools/explain/past_run.hpp"

#include <charconv>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/printable.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/json.hpp"
#include "core/network/graph/layout.hpp"

namespace lightnet {
namespace {

constexpr JsonLimits report_limits{.depth = JsonLimits{}.depth + 4};  // around the graph's own levels

// A run may have been started in another folder than this one.
std::string as_seen_from_here(const std::string& file, const std::string& folder) {
    std::error_code ignored;
    if (folder.empty() || folder == in_utf8(std::filesystem::current_path(ignored).string())) return file;
    return (std::filesystem::path(folder) / file).string();
}

std::uint64_t seed_in(const Json& report) {
    const std::string& text = report.at("settings").at("seed").text();
    std::uint64_t seed = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (fault != std::errc{} || end != text.data() + text.size()) throw Error("its seed '" + text + "' is no number");
    return seed;
}

std::string text_of_report(const std::filesystem::path& report) try {
    return PlainFile(report, report_limits.bytes).text();
} catch (const Error& error) {
    throw UserError({report.string(), 0},
                    std::string("can't be read; it tells from which graph the picture was made (--report FILE.run.json "
                                "names it): ") +
                        error.what());
}

}  // namespace

PastRun read_past_run(const std::filesystem::path& report, const Registry& registry) {
    const std::string text = text_of_report(report);
    try {
        const Json json = parse_json(text, report_limits);
        const Json& graph = json.at("graph");
        if (!graph.has("network")) throw Error("it was written by an older version, which kept no graph");
        PastRun past{written(graph_from_json(graph.at("network"))), seed_in(json)};
        past.graph.file = as_seen_from_here(past.graph.file, graph.at("folder").text());
        past.graph = check(past.graph, registry);
        return past;
    } catch (const UserError&) {
        throw;
    } catch (const Error& wrong) {
        throw UserError({report.string(), 0},
                        std::string("is no report of a run that can be explained: ") + wrong.what());
    }
}

}  // namespace lightnet
