#include "core/run/message/place_record.hpp"

#include <utility>

#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"

namespace lightnet {

void keep_of_work(double share, PlaceRecord& record) {
    const auto keep = [share](std::uint64_t& ns) { ns = static_cast<std::uint64_t>(share * static_cast<double>(ns)); };
    for (auto& [name, node] : record.nodes) {
        for (auto* ns : {&node.busy_ns, &node.shard_ns, &node.prepare_ns}) keep(*ns);
        CostSpread costs;
        for (const auto& [step, count] : node.costs.counts) costs.add(share * CostSpread::ns_of(step), count);
        node.costs = std::move(costs);
    }
    for (auto& [ends, edge] : record.edges)
        for (auto* ns : {&edge.called_ns, &edge.learning_ns}) keep(*ns);
}

// Lists of numbers in the order of the members: many hosts send one at the same time.
std::string to_text(const std::vector<PlaceRecord>& records) {
    JsonTree all = JsonTree::list();
    for (const auto& record : records) {
        JsonTree nodes = JsonTree::list(), edges = JsonTree::list();
        for (const auto& [name, node] : record.nodes) {
            JsonTree costs = JsonTree::list();
            for (const auto& [step, count] : node.costs.counts) costs.push_back({step, count});
            nodes.push_back({name, node.answered, node.busy_ns, node.bundles, node.replies, node.latency_ns,
                             node.shards, node.rounds, node.shard_ns, node.prepare_ns, node.prepared,
                             std::move(costs)});
        }
        for (const auto& [ends, edge] : record.edges)
            edges.push_back({ends.first, ends.second, edge.asks, edge.questions, edge.called_ns, edge.waited_ns,
                             edge.bundles, edge.sent, edge.bytes, edge.learning, edge.learning_ns});
        all.push_back({record.host, record.index, record.lived_ns, record.waited_ns, record.idle_ns, std::move(nodes),
                       std::move(edges)});
    }
    return to_text(all);
}

std::vector<PlaceRecord> place_records_from(std::string_view text) {
    std::vector<PlaceRecord> records;
    const auto count = [](const Json& json) { return json.whole<std::uint64_t>(); };
    const Json json = parse_json(text);
    for (const auto& place : json.list()) {
        const auto& part = place.list(7);
        auto& record = records.emplace_back(PlaceRecord{
            part[0].text(), part[1].whole<std::uint32_t>(), count(part[2]), count(part[3]), count(part[4]), {}, {}});
        for (const auto& node : part[5].list()) {
            const auto& one = node.list(12);
            auto& to = record.nodes[one[0].text()];
            to = {count(one[1]),
                  count(one[2]),
                  count(one[3]),
                  count(one[4]),
                  count(one[5]),
                  count(one[6]),
                  count(one[7]),
                  count(one[8]),
                  count(one[9]),
                  count(one[10]),
                  {}};
            for (const auto& cost : one[11].list())
                to.costs.counts[cost.list(2)[0].whole<std::uint32_t>()] = count(cost.list(2)[1]);
        }
        for (const auto& edge : part[6].list()) {
            const auto& one = edge.list(11);
            record.edges[{one[0].text(), one[1].text()}] = {count(one[2]), count(one[3]), count(one[4]),
                                                            count(one[5]), count(one[6]), count(one[7]),
                                                            count(one[8]), count(one[9]), count(one[10])};
        }
    }
    return records;
}

}  // namespace lightnet
