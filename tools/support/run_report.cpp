#include "tools/support/run_report.hpp"

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.hpp"
#include "core/base/printable.hpp"

namespace lightnet {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Names of files may be in any encoding, and JSON is UTF-8.
void spell_out(OrderedJson& json) {
    if (json.is_string()) json = in_utf8(json.get_ref<const std::string&>());
    if (json.is_structured())
        for (auto& part : json) spell_out(part);
}

}  // namespace

std::string to_json(const RunReport& report) {
    OrderedJson places = OrderedJson::array(), phases = OrderedJson::array();
    for (const auto& place : report.places)
        places.push_back({{"host", place.host},
                          {"index", place.index},
                          {"nodes", place.nodes},
                          {"seconds", place.seconds},
                          {"waiting", place.waiting},
                          {"idle", place.idle}});
    OrderedJson nodes = OrderedJson::array(), edges = OrderedJson::array();
    for (const auto& node : report.nodes)
        nodes.push_back({{"name", node.name},
                         {"kind", node.kind},
                         {"questions", node.questions},
                         {"answered", node.answered},
                         {"bundles", node.bundles},
                         {"seconds", node.seconds},
                         {"own_seconds", node.own_seconds},
                         {"latency", node.latency}});
    for (const auto& edge : report.edges)
        edges.push_back({{"from", edge.from},
                         {"to", edge.to},
                         {"asks", edge.asks},
                         {"questions", edge.questions},
                         {"called_seconds", edge.called_seconds},
                         {"waiting_seconds", edge.waiting_seconds},
                         {"bundles", edge.bundles},
                         {"sent", edge.sent},
                         {"bytes", edge.bytes}});
    OrderedJson layers = OrderedJson::array();
    for (const auto& [name, mean, share] : report.layers)
        layers.push_back({{"name", name}, {"mean", mean}, {"share", share}});
    OrderedJson hosts = OrderedJson::array();
    for (const auto& host : report.hosts)
        hosts.push_back({{"host", host.host},
                         {"state", host.state},
                         {"machine", host.machine},
                         {"cpu", host.cpu},
                         {"isa", host.isa},
                         {"version", host.version},
                         {"cores", host.cores},
                         {"memory", host.memory},
                         {"places", host.places},
                         {"peak_memory", host.peak_memory}});
    for (const auto& [name, seconds] : report.phases) phases.push_back({{"name", name}, {"seconds", seconds}});

    OrderedJson preparing = OrderedJson::array();
    for (const auto& [node, what, seconds] : report.preparing)
        preparing.push_back({{"node", node}, {"what", what}, {"seconds", seconds}});

    OrderedJson json;
    json["format"] = "lightnet run 2";
    json["outcome"] = report.outcome;
    json["graph"] = {{"file", report.graph}, {"hash", report.graph_hash}};
    if (!report.network.empty()) {
        json["graph"]["folder"] = report.folder;
        json["graph"]["network"] = OrderedJson::parse(report.network);
    }
    json["mode"] = report.mode;
    json["peak_memory"] = report.peak_memory;
    json["outputs"] = report.outputs;
    json["places"] = places;
    json["nodes"] = nodes;
    json["edges"] = edges;
    if (!report.layers.empty()) json["layers"] = layers;
    if (const auto& error = report.error)
        json["error"] = {{"reference", error->reference},
                         {"samples", error->samples},
                         {"relmse", error->relative_square},
                         {"mse", error->square}};
    if (!report.hosts.empty()) json["hosts"] = hosts;
    json["phases"] = phases;
    if (!report.preparing.empty()) json["preparing"] = preparing;
    json["counters"] = report.counters;
    json["settings"] = report.settings;
    json["versions"] = report.versions;
    json["warnings"] = report.warnings;
    spell_out(json);
    return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::filesystem::path report_beside(const std::filesystem::path& picture) {
    return std::filesystem::path(picture).replace_extension(".run.json");
}

std::filesystem::path failed_report_beside(const std::filesystem::path& picture) {
    return std::filesystem::path(picture).replace_extension(".run.failed.json");
}

void write_report(const std::filesystem::path& path, const RunReport& report) { write_file(path, to_json(report)); }

}  // namespace lightnet
