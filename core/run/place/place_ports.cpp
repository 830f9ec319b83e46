#include "core/run/place/place_ports.hpp"

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/unwanted.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/assembly/direct_port.hpp"
#include "core/run/schedule/sector_port.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

// The node itself, or somebody whom it asks: what is still under way when a rehearsal is over would be noted in the
// next.
bool may_rehearse(const Network& network, std::size_t node) {
    const auto needed = used_nodes(network.graph, node);
    for (std::size_t other = 0; other < needed.size(); ++other)
        if (needed[other] && network.kind_of(other).run.rehearses) return true;
    return false;
}

// Bundles take longer than a nanosecond, so numbers that begin with it are those of no place before, of this name.
std::uint64_t time_of_beginning() {
    return static_cast<std::uint64_t>(PlacePorts::Clock::now().time_since_epoch() / std::chrono::nanoseconds(1));
}

}  // namespace

PlacePorts::PlacePorts(Lent lent, const Plan& plan)
    : at_(std::move(lent)),
      plan_(plan),
      channels_(at_.carrier, at_.run, {at_.me.host, name_of(at_.me), 0, time_of_beginning()}, at_.counters) {}

Port* PlacePorts::port_to(std::size_t node, std::size_t width) {
    const Key key{node, width};
    return sectors_of(at_.network.graph, node).empty() ? port_to_one(key) : port_to_sectors(key);
}

Port* PlacePorts::port_to_sectors(Key key) {
    const auto [node, width] = key;
    std::vector<Port*> ports;
    for (const auto sector : sectors_of(at_.network.graph, node)) ports.push_back(port_to_one({sector, width}));
    const auto sector_of = [&network = at_.network, node = key.first,
                            cut = std::shared_ptr<const Sectors>()](const Query& question) mutable {
        if (!cut) cut = network.sectors(node);  // when it is first needed, as it takes a moment
        return cut->at(network.scene->surface(question).position);
    };
    return within_.emplace_back(std::make_unique<SectorPort>(std::move(ports), width, sector_of)).get();
}

Port* PlacePorts::port_to_one(Key key) {
    auto& port = ports_[key];
    if (!port) {
        const auto direct = [this, key] {
            return within_
                .emplace_back(std::make_unique<DirectPort>(at_.assembly().callee(key.first), key.second,
                                                           at_.counters.local_questions, at_.pause))
                .get();
        };
        port = std::make_unique<RoutingPort>(direct, [this, key] { return bundle_port_to(key); });
        lead(key, *port);
    }
    return port.get();
}

Port* PlacePorts::bundle_port_to(Key key) {
    const auto [node, width] = key;
    const Tuning& tuning = at_.tuning;
    auto& remote = remotes_[key];
    const Credit credit{tuning.credit, tuning.credit_questions, tuning.credit_bytes};
    const BundleRules bundles{tuning.bundle, std::chrono::microseconds(tuning.oldest_us), tuning.eager};
    remote.edge = {static_cast<std::uint32_t>(node), credit, {}, {}};
    if (tuning.call_own_nodes) remote.edge.reserve = at_.me;
    remote.port = std::make_unique<BundlePort>(
        at_.fibers, at_.wake, width, bundles, [this] { return at_.own_time.now(); }, &at_.gauge.nodes[node],
        &at_.gauge);
    remote.port->replicas().follow(multiplexer_rules(node), &at_.counters);
    remote.port->keep_back(called_here(node) && helpers_of(node) > 0);
    channels_.connect(remote.edge, remote.port->replicas(), plan_for(node));
    return remote.port.get();
}

MultiplexerRules PlacePorts::multiplexer_rules(std::size_t node) {
    MultiplexerRules rules;
    rules.scheduling.strategy = plan_.strategy_of(node);
    const bool rehearses = may_rehearse(at_.network, node);
    rules.scheduling.double_tail = !rehearses;
    rules.scheduling.tail_part = 0.01;  // others want answers, too
    rules.at_fault = [this](const Failure& failure) { at_.carrier.take_out(failure.host, failure.why); };
    rules.checks = SpotChecks(at_.tuning.verify, secret_number());
    rules.own = at_.me.host;
    rules.doubt = [this, node](Failure lie) {
        if (!answers_alone(plan_, at_.network.graph, node)) lie.host.clear();
        at_.carrier.doubt(lie);
    };
    // What was asked in a rehearsal, and again as it was late, may be answered otherwise when that is over.
    if (at_.tuning.check_answers && !rehearses) rules.differs = [](const std::string& what) { throw Error(what); };
    return rules;
}

void PlacePorts::use(const Plan& plan) {
    plan_ = plan;
    relieved_.clear();
    for (auto& [key, remote] : remotes_) remote.port->keep_back(false);
    for (auto& [key, port] : ports_) lead(key, *port);
    for (auto& [key, remote] : remotes_) channels_.connect(remote.edge, remote.port->replicas(), plan_for(key.first));
}

bool PlacePorts::flush(bool idle) {
    const auto now = Clock::now();
    if (!relieved_.empty()) share_out(now);
    bool sent = false;
    for (auto& [key, remote] : remotes_) sent |= remote.port->flush(now, idle);
    return sent;
}

void PlacePorts::wait() {
    std::chrono::nanoseconds least = std::chrono::milliseconds(100);
    const auto now = Clock::now();
    for (const auto& [key, remote] : remotes_) least = std::min(least, remote.port->until_due(now));
    at_.carrier.wait(least);
    at_.own_time.slept(least, Clock::now() - now);
}

}  // namespace lightnet
