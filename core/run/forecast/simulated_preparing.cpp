#include "core/run/forecast/simulated_preparing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/light/mapped.hpp"
#include "core/run/forecast/event_queue.hpp"
#include "core/run/master/shard_dealer.hpp"

namespace lightnet {
namespace {

constexpr double shards_worth_the_way = 0.05;   // seconds of shards that go together, see Preparer
constexpr double patience_with_the_late = 0.5;  // seconds, with those who are late for a rehearsal

/// The way to a copy that does shards.
class SimulatedCopy final : public Channel<Step> {
public:
    using Send = std::function<void(const SimulatedCopy&, const Bundle<Step>&)>;
    SimulatedCopy(PlaceAt at, Send send) : at_(std::move(at)), send_(std::move(send)) {}

    const PlaceAt& at() const { return at_; }
    bool send(const Bundle<Step>& bundle) override {
        send_(*this, bundle);
        return true;
    }
    Credit credit() const override { return ShardDealer::credit_of_each; }
    bool within_process() const override { return at_.host.empty(); }
    std::uint64_t pulse() const override { return ++pulse_; }
    std::string host() const override { return at_.host; }

private:
    PlaceAt at_;
    Send send_;
    mutable std::uint64_t pulse_ = 0;  // it never hangs
};

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
        find_those_beside();
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
    std::map<std::string, std::uint32_t> copies_of(std::size_t node) const {
        std::map<std::string, std::uint32_t> copies;
        for (const auto place : plan_.places_of[node]) ++copies[plan_.places[place].host];
        return copies;
    }
    double first_ready(std::size_t node) const {
        double first = EventQueue::never;
        for (const auto& [host, count] : copies_of(node)) first = std::min(first, result_.ready.at(host));
        return first == EventQueue::never ? 0 : first;
    }

    void prepare(std::size_t node) {
        const auto& cost = costs_.nodes[node].preparing;
        if (cost.shards == 0 && cost.own_seconds <= 0) return;
        const double before = first_ready(node);
        if (cost.rehearses) wait_for_the_late(before);
        const double there = cost.shards > 0 ? do_shards(node, cost) : 0;
        for (const auto& [host, count] : copies_of(node)) {
            auto& ready = result_.ready.at(host);
            if (cost.shards == 0) ready = bring(host, ready, cost.bytes);
            ready = std::max(ready, there) + cost.own_seconds / facts(host).power_of(count);
            result_.work += cost.own_seconds;
        }
        result_.work += cost.shard_seconds;
        result_.by_node[node] = first_ready(node) - before;
    }

    // Nodes of one rank prepare together: one fills the pauses in which others wait for the end of a round.
    void find_those_beside() {
        std::vector<std::size_t> rank(costs_.nodes.size(), 0);
        const auto behind = [&](std::size_t node, std::size_t other) {
            rank[node] = std::max(rank[node], rank[other] + 1);
        };
        for (const auto node : costs_.order) {
            for (const auto& edge : costs_.edges)
                if (edge.from == node) behind(node, edge.to);
            for (const auto& [taker, taken] : costs_.beside)
                if (taker == node) behind(node, taken);
        }
        const auto together = [&](std::size_t node) {
            return costs_.nodes[node].preparing.rounds > 0 && !costs_.nodes[node].preparing.rehearses;
        };
        beside_.assign(costs_.nodes.size(), 1);
        for (const auto node : costs_.order)
            beside_[node] =
                std::max<std::uint32_t>(1, std::uint32_t(std::ranges::count_if(costs_.order, [&](std::size_t other) {
                                            return together(node) && together(other) && rank[other] == rank[node];
                                        })));
    }

    // Who takes part in a rehearsal is known when it begins, see Rehearsals.
    void wait_for_the_late(double first) {
        double last = 0;
        for (const auto& [host, ready] : result_.ready) last = std::max(last, ready);
        const double begin = std::min(last, first + std::max(patience_with_the_late, (first - all_waited_) / 2));
        for (auto& [host, ready] : result_.ready) ready = std::max(ready, begin);
        all_waited_ = begin;
    }

    // When the last shard is there. What each round brings, all hosts have to know for the next.
    double do_shards(std::size_t node, const PreparingCost& cost) {
        const auto rounds = std::clamp<std::uint64_t>(cost.rounds / beside_[node], 1, cost.shards);
        double there = 0;
        for (std::uint64_t round = 0; round < rounds; ++round) {
            const auto count = cost.shards * (round + 1) / rounds - cost.shards * round / rounds;
            there = do_round(node, cost, static_cast<std::uint32_t>(count));
            for (const auto& [host, copies] : copies_of(node)) {
                auto& ready = result_.ready.at(host);
                ready = bring(host, std::max(ready, there), cost.bytes / double(rounds));
            }
        }
        return there;
    }

    double do_round(std::size_t node, const PreparingCost& cost, std::uint32_t count) {
        EventQueue events;
        ShardDealer::Job job;
        job.count = count;
        job.clock = [&events] { return events.now(); };
        ShardDealer dealer(std::move(job));
        std::deque<SimulatedCopy> copies;
        std::vector<Channel<Step>*> there;
        const auto deal = [&, all = plan_.places_of[node].size()] { dealer.deal(all, false); };
        const auto send = [&](const SimulatedCopy& copy, const Bundle<Step>& bundle) {
            events.at(events.now(), [&, bundle] { work(events, cost, copy, bundle, deal); });
        };
        for (const auto& [host, held] : copies_of(node)) speed_there_[host] = facts(host).power_of(held) / held;
        for (const auto place : plan_.places_of[node]) {
            const auto& at = plan_.places[place];
            events.at(result_.ready.at(at.host) + way_to(at.host), [&, at] {
                there.push_back(&copies.emplace_back(at, send));
                dealer.use(there);
                deal();
            });
        }
        while (dealer.missing() > 0 && events.next() < EventQueue::never) events.step();
        if (dealer.missing() > 0) throw Error("what '" + costs_.nodes[node].name + "' prepares comes to no end");
        return events.now();
    }

    // A place does what it is asked, or as much of it as takes little time.
    void work(EventQueue& events, const PreparingCost& cost, const SimulatedCopy& copy, const Bundle<Step>& bundle,
              const std::function<void()>& deal) {
        const auto& host = copy.at().host;
        const double seconds = cost.shard_seconds / cost.shards / speed_there_.at(host);
        const auto most =
            static_cast<std::uint32_t>(std::min(1e9, 1 + std::floor(shards_worth_the_way / std::max(seconds, 1e-9))));
        const auto done = std::min(bundle.questions->front().count, most);
        auto& free = free_[copy.at()];
        free = std::max(free, events.now() + way_to(host)) + done * seconds;
        const double bytes = cost.bytes * done / cost.shards;
        events.at(free + way_to(host), [this, &events, bundle, bytes, done, own = host.empty(), deal] {
            events.at(own ? events.now() : in_.pass(events.now(), bytes), [bundle, done, deal] {
                bundle.owner->answered(bundle, join_shards(std::vector<std::vector<std::byte>>(done)));
                deal();
            });
        });
    }

    const RunCosts& costs_;
    const Plan& plan_;
    LineCost launcher_;
    SimulatedLine out_, in_;
    std::map<std::string, const ForecastHost*> facts_;
    std::map<PlaceAt, double> free_;
    std::vector<std::uint32_t> beside_;          // by node: how many prepare together with it
    double all_waited_ = 0;                      // last: when
    std::map<std::string, double> speed_there_;  // of a copy that does shards: all of its host do at the same time
    SimulatedPreparing result_;
};

}  // namespace

SimulatedPreparing simulate_preparing(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                                      const LineCost& launcher) {
    return Preparation(costs, plan, hosts, launcher).all();
}

}  // namespace lightnet
