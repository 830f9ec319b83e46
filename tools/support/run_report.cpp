#include "tools/support/run_report.hpp"

#include "core/base/atomic_file.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/printable.hpp"

namespace lightnet {
namespace {

JsonTree tree_of(const NodeReport& node) {
    JsonTree tree = {{"name", node.name},
                     {"kind", node.kind},
                     {"questions", node.questions},
                     {"answered", node.answered},
                     {"bundles", node.bundles},
                     {"seconds", node.seconds},
                     {"own_seconds", node.own_seconds},
                     {"latency", node.latency}};
    if (const auto& shards = node.shards; shards.count || shards.seconds > 0 || shards.own_seconds > 0)
        tree["preparing"] = {{"shards", shards.count},
                             {"rounds", shards.rounds},
                             {"seconds", shards.seconds},
                             {"own_seconds", shards.own_seconds},
                             {"bytes", shards.bytes}};
    if (node.spread.empty()) return tree;
    JsonTree spread = JsonTree::list();
    for (const auto& [seconds, count] : node.spread) {
        JsonTree entry = JsonTree::list();
        entry.push_back(seconds);
        entry.push_back(count);
        spread.push_back(std::move(entry));
    }
    tree["spread"] = std::move(spread);
    return tree;
}

}  // namespace

std::string to_json(const RunReport& report) {
    JsonTree places = JsonTree::list(), phases = JsonTree::list();
    for (const auto& place : report.places)
        places.push_back({{"host", place.host},
                          {"index", place.index},
                          {"nodes", place.nodes},
                          {"seconds", place.seconds},
                          {"waiting", place.waiting},
                          {"idle", place.idle}});
    JsonTree nodes = JsonTree::list(), edges = JsonTree::list();
    for (const auto& node : report.nodes) nodes.push_back(tree_of(node));
    for (const auto& edge : report.edges)
        edges.push_back({{"from", edge.from},
                         {"to", edge.to},
                         {"asks", edge.asks},
                         {"questions", edge.questions},
                         {"called_seconds", edge.called_seconds},
                         {"waiting_seconds", edge.waiting_seconds},
                         {"bundles", edge.bundles},
                         {"sent", edge.sent},
                         {"bytes", edge.bytes},
                         {"learning", edge.learning},
                         {"learning_seconds", edge.learning_seconds}});
    JsonTree layers = JsonTree::list();
    for (const auto& [name, mean, share] : report.layers)
        layers.push_back({{"name", name}, {"mean", mean}, {"share", share}});
    JsonTree hosts = JsonTree::list();
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
    for (const auto& [name, seconds, processor] : report.phases)
        phases.push_back({{"name", name}, {"seconds", seconds}, {"processor", processor}});

    JsonTree preparing = JsonTree::list();
    for (const auto& [node, what, seconds] : report.preparing)
        preparing.push_back({{"node", node}, {"what", what}, {"seconds", seconds}});

    JsonTree moves = JsonTree::list();
    for (const auto& move : report.moves)
        moves.push_back({{"seconds", move.seconds}, {"gain", move.gain}, {"nodes", move.nodes}});

    JsonTree json;
    json["format"] = "lightnet run 2";
    json["outcome"] = report.outcome;
    json["graph"] = {{"file", report.graph}, {"hash", report.graph_hash}};
    if (!report.network.empty()) {
        json["graph"]["folder"] = report.folder;
        json["graph"]["network"] = JsonTree(parse_json(report.network));
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
    if (const auto& noise = report.noise) {
        JsonTree paths = JsonTree::list();
        for (const auto& [word, part] : noise->paths) paths.push_back({{"word", word}, {"part", part}});
        json["noise"] = {{"relmse", noise->error}, {"pixels", noise->pixels}, {"paths", paths}};
    }
    if (!report.hosts.empty()) json["hosts"] = hosts;
    json["phases"] = phases;
    if (!report.preparing.empty()) json["preparing"] = preparing;
    if (!report.moves.empty()) json["moves"] = moves;
    json["counters"] = report.counters;
    json["settings"] = report.settings;
    json["versions"] = report.versions;
    json["warnings"] = report.warnings;
    json.change_texts(in_utf8);  // names of files may be in any encoding, and JSON is UTF-8
    return to_text(json, {.indent = 2}) + "\n";
}

std::filesystem::path report_beside(const std::filesystem::path& picture) {
    return std::filesystem::path(picture).replace_extension(".run.json");
}

std::filesystem::path failed_report_beside(const std::filesystem::path& picture) {
    return std::filesystem::path(picture).replace_extension(".run.failed.json");
}

void write_report(const std::filesystem::path& path, const RunReport& report) { write_file(path, to_json(report)); }

}  // namespace lightnet
