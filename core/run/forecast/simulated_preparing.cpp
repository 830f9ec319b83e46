#include "core/run/forecast/simulated_preparing.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.hpp"
#include "core/run/forecast/event_queue.hpp"
#include "core/run/master/shard_dealer.hpp"

namespace lightnet {
namespace {

constexpr double shards_worth_the_way = 0.05;  // seconds of shards that go together, see Preparer

/// Prepares one node after the other.
class Preparation {
public:
    Preparation(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                const LineCost& launcher)
        : costs_(costs),
          plan_(plan),
          launcher_(launcher),
          out_(launcher.bytes_per_second),
          in_(launcher.bytes_per_second) {
        for (const auto& host : hosts) facts_.emplace(host.name, &host);
        for (const auto& place : plan.places) {
            if (!facts_.contains(place.host)) throw Error("nothing is known of host '" + place.host + "'");
            result_.ready.emplace(place.host, 0);
        }
        for (auto& [host, time] : result_.ready) time = bring(host, 0, costs.host_bytes);
        result_.by_node.assign(costs.nodes.size(), 0);
    }

    SimulatedPreparing all() {
        for (const auto node : costs_.order) prepare(node);
        for (const auto node : costs_.order) result_.seconds = std::max(result_.seconds, first_ready(node));
        result_.launcher_line = std::max(out_.busy(), in_.busy());
        return result_;
    }

private:
    const ForecastHost& facts(const std::string& host) const { return *facts_.at(host); }
    double way_to(const std::string& host) const {
        return host.empty() ? 0 : facts(host).line.seconds + launcher_.seconds;
    }
    // When it is there, of what the launcher sends at `time`.
    double bring(const std::string& host, double time, double bytes) {
        if (host.empty() || bytes <= 0) return time;
        return out_.pass(time, bytes) + bytes / facts(host).line.bytes_per_second + way_to(host);
    }
    std::set<std::string> holders(std::size_t node) const {
        std::set<std::string> hosts;
        for (const auto place : plan_.places_of[node]) hosts.insert(plan_.places[place].host);
        return hosts;
    }
    double first_ready(std::size_t node) const {
        double first = EventQueue::never;
        for (const auto& host : holders(node)) first = std::min(first, result_.ready.at(host));
        return first == EventQueue::never ? 0 : first;
    }

    void prepare(std::size_t node) {
        const auto& cost = costs_.nodes[node].preparing;
        if (cost.shards == 0 && cost.own_seconds <= 0) return;
        const double before = first_ready(node);
        const double there = cost.shards > 0 ? do_shards(node, cost) : 0;
        for (const auto& host : holders(node)) {
            auto& ready = result_.ready.at(host);
            ready = bring(host, std::max(ready, there), cost.bytes) + cost.own_seconds / facts(host).speed;
            result_.work += cost.own_seconds;
        }
        result_.work += cost.shard_seconds;
        result_.by_node[node] = first_ready(node) - before;
    }

    // When the last shard is there.
    double do_shards(std::size_t node, const PreparingCost& cost) {
        EventQueue events;
        ShardDealer dealer;
        dealer.begin(cost.shards);
        std::size_t missing = cost.shards;
        const double each = cost.shard_seconds / cost.shards;
        const auto copies = plan_.places_of[node].size();
        std::uint64_t pulse = 0;
        const auto deal = [&](const auto& again) -> void {
            dealer.feel_pulses([&](const std::string&) { return ++pulse; }, events.now());
            for (const auto& dealt : dealer.deal(copies, events.now()))
                events.at(events.now(), [&, dealt, again] { work(events, dealer, missing, each, dealt, again); });
        };
        for (const auto place : plan_.places_of[node]) {
            const auto& at = plan_.places[place];
            events.at(result_.ready.at(at.host) + way_to(at.host), [&, at] {
                dealer.join({at, node}, 0, events.now());
                deal(deal);
            });
        }
        while (missing > 0 && events.next() < EventQueue::never) events.step();
        if (missing > 0) throw Error("what '" + costs_.nodes[node].name + "' prepares comes to no end");
        return events.now();
    }

    // A place does what it is asked, or as much of it as takes little time.
    template <class Again>
    void work(EventQueue& events, ShardDealer& dealer, std::size_t& missing, double each,
              const ShardDealer::Deal& dealt, const Again& again) {
        const auto& host = dealt.to.place.host;
        const double seconds = each / facts(host).speed;
        const auto most =
            static_cast<std::uint32_t>(std::min(1e9, 1 + std::floor(shards_worth_the_way / std::max(seconds, 1e-9))));
        const auto done = std::min(dealt.shards.count, most);
        auto& free = free_[dealt.to.place];
        free = std::max(free, events.now() + way_to(host)) + done * seconds;
        const auto& cost = costs_.nodes[dealt.to.node].preparing;
        const double bytes = cost.bytes * done / cost.shards;
        events.at(free + way_to(host), [&, id = dealt.id, done, bytes, own = host.empty(), again] {
            const auto answer = [&, id, done, again] {
                if (dealer.answered(id, done, events.now())) missing -= done;
                again(again);
            };
            events.at(own ? events.now() : in_.pass(events.now(), bytes), answer);
        });
    }

    const RunCosts& costs_;
    const Plan& plan_;
    LineCost launcher_;
    SimulatedLine out_, in_;
    std::map<std::string, const ForecastHost*> facts_;
    std::map<PlaceAt, double> free_;
    SimulatedPreparing result_;
};

}  // namespace

SimulatedPreparing simulate_preparing(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                                      const LineCost& launcher) {
    return Preparation(costs, plan, hosts, launcher).all();
}

}  // namespace lightnet
