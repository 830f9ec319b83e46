// A whole cluster in one thread: real places and dispatchers, behind lines, clocks and mishaps that are simulated.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"
#include "core/network/graph/hosts.hpp"
#include "tests/modes/one_thread_lines.hpp"

namespace lightnet::test {

/// The launcher's carrier to hosts, as Cluster is: waiting makes time pass. What lies between, it does as Cluster,
/// HostLink and HostService do: lines keep their order and are lost as a whole, who is lost is begun with again, who is
/// told to stop answers what it has. Same world, same story.
class OneThreadCluster final : public Carrier, public OneThreadLines {
public:
    OneThreadCluster(const OneThreadWorld& world, SimulatedClock& clock, const Network& network)
        : OneThreadLines(world, clock, network) {
        for (auto& host : hosts_) {
            at(host.of.comes_after, [this, &host] { start(host); });
            at(host.of.comes_after + 0.1 * chance_.part(), [this, &host] { call(host); });
            beat(host);
        }
    }
    /// Until one host at least takes part.
    void gather() {
        while (offers().empty()) {
            wait(std::chrono::seconds(1));
            arrived_.clear();
        }
    }
    const Plan& plan() const { return plan_; }
    /// How often each kind of mishap came to pass.
    const std::map<Mishap::Kind, std::size_t>& happened() const { return happened_; }

    bool ask(const PlaceAt& to, Message& message) override {
        auto* host = find(to.host);
        const auto* steps = std::get_if<Questions<Step>>(&message.questions);
        if (!host || !(host->state == State::ready || (steps && host->state == State::leaving))) return false;
        if (refuses()) return false;
        if (steps && (*steps)->front().kind == Step::Kind::go_on && world_.by_hash) message.data = nullptr;
        const auto line = host->line;
        if (tells()) tell("the launcher asks " + to.host + " " + words_for(message));
        send_down(*host, [this, line, place = to.index, sent = packet::pack(message, to.index)](Host& at) {
            auto arrived = packet::unpack(sent.header, sent.body);
            if (!arrived || !at.serving) return;
            arrived->route.hops = {"launcher", std::to_string(line)};
            take_ask(at, place, std::move(*arrived));
        });
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override {
        if (arrived_.empty()) return std::nullopt;
        auto message = std::move(arrived_.front());
        arrived_.pop_front();
        return message;
    }
    void wait(std::chrono::nanoseconds most) override {
        const double began = clock_.seconds(), end = began + 1e-9 * static_cast<double>(most.count());
        while (arrived_.empty() && queue_.next() <= end) next_event();
        clock_.set(arrived_.empty() ? end : std::max(began, queue_.now()));
        clock_.slow_down(1);
    }
    bool bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) override {
        if (!world_.by_hash && packet::goes_along(bytes)) return true;
        auto* host = find(to.host);
        if (!host || host->state != State::ready) return false;
        if (host->has.contains(name)) return true;
        if (!host->expects.insert(name).second) return false;
        std::vector<std::string> holders;
        for (const auto& other : hosts_)
            if (world_.by_holders && &other != host && other.has.contains(name)) holders.push_back(other.name);
        send_down(*host, [this, name, bytes, holders](Host& at) {
            known_results_[name] = bytes;
            if (at.process->brought.contains(name)) return say_it_is_here(at, name);
            at.process->from_others.want(name, bytes->size(), holders);
            fetch_soon(at);
        });
        return false;
    }
    /// How often a result came from another host, and how often one was left for the launcher that was asked of one.
    std::pair<std::size_t, std::size_t> fetched() const { return {came_from_others_, left_to_launcher_}; }
    void adopt(const Plan& plan) override {
        in_force_ = std::make_shared<const Plan>(plan);
        if (tells()) tell("in force " + to_json(plan));
        for (auto& host : hosts_)
            if (host.state == State::ready || host.state == State::leaving) use(host);
    }
    bool take_out(const std::string& host, const std::string& why) override {
        fault(host, why);
        return true;
    }
    void doubt(const Failure& lie) override { fault(lie.host, lie.why); }
    std::uint64_t pulse(const std::string& name) const override {
        for (const auto& host : hosts_)
            if (host.name == name) return host.pulse;
        return 0;
    }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return counters_; }

private:
    using Happens = std::function<void(Host&)>;
    static constexpr std::uint64_t run = 1;
    static constexpr double lease = 1.5, call_again = 0.2;  // seconds

    // ---- between launcher and hosts ---------------------------------------------------------------------------------

    void send_down(Host& host, Happens arrives) { send(host, host.down_free, std::move(arrives)); }
    void send_up(Host& host, Happens arrives) { send(host, host.up_free, std::move(arrives)); }
    void send(Host& host, double& free, Happens arrives) {
        if (chance_.happens(world_.unnoticed)) {  // both ends count messages
            at(seconds() + 0.4 + 0.4 * chance_.part(), [this, &host, line = host.line] { lose(host, line); });
            return;
        }
        free = std::max(free, seconds() + delay());
        at(free, [&host, line = host.line, process = host.process_number, arrives = std::move(arrives)] {
            if (host.line == line && host.process && host.process_number == process) arrives(host);
        });
    }
    // ---- results, from hosts that have them
    // --------------------------------------------------------------------------

    void fetch_soon(Host& host) {
        if (std::exchange(host.process->fetches, true)) return;
        at(std::max(seconds() + 0.01, host.frozen_until), [this, &host, process = host.process_number] {
            if (host.process && host.process_number == process) fetch(host);
        });
    }
    static LinePace::Time time_of(double seconds) {
        return LinePace::Time(std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * (1 + seconds))));
    }
    void fetch(Host& host) {
        auto& process = *host.process;
        process.fetches = false;
        process.from_others.go_on(time_of(seconds()), [&](const ResultsFromOthers::Ask& ask) {
            const auto line = line_to(host.name, ask.host);
            at(seconds() + delay(), [this, &host, ask, line] {
                if (line_to(host.name, ask.host) == line) give(*find(ask.host), host, ask, line);
            });
            return true;
        });
        for (auto& [name, bytes] : process.from_others.outcomes()) {
            ++(bytes ? came_from_others_ : left_to_launcher_);
            if (bytes) take_result(host, name, bytes);
            if (bytes) continue;
            send_up(host, [this, name = name](Host& lacking) {
                send_down(lacking,
                          [this, name](Host& to_have) { take_result(to_have, name, known_results_.at(name)); });
            });
        }
        if (process.from_others.waits()) fetch_soon(host);
    }
    void give(Host& holder, Host& asker, const ResultsFromOthers::Ask& ask, std::uint64_t line) {
        const auto& has = holder.process ? holder.process->brought : none_;
        const auto found = has.find(ask.hash);
        std::vector<std::byte> piece;
        if (!holder.process || !holder.serving) return;
        if (found != has.end() && ask.offset < found->second->size()) {
            const auto from = found->second->begin() + static_cast<std::ptrdiff_t>(ask.offset);
            piece.assign(from, from + static_cast<std::ptrdiff_t>(
                                          std::min<std::uint64_t>(ask.size, found->second->size() - ask.offset)));
        }
        if (!piece.empty() && chance_.happens(world_.lies)) piece[chance_.below(piece.size())] ^= std::byte{1};
        if (chance_.happens(world_.loss)) return;
        at(std::max(holder.frozen_until, seconds() + delay()), [this, &asker, ask, line, piece, from = holder.name] {
            if (line_to(asker.name, from) != line || !asker.process) return;
            auto& others = asker.process->from_others;
            if (piece.empty())
                others.lacks(from, ask.hash);
            else
                others.take(from, {ask.hash, ask.offset, piece}, time_of(seconds()));
            fetch_soon(asker);
        });
    }
    void take_result(Host& host, const Hash& name, const Bytes& bytes) {
        if (content_hash(*bytes) != name) faults_.push_back(host.name + ": a result arrived damaged");
        host.process->brought[name] = bytes;
        say_it_is_here(host, name);
    }

    void call(Host& host) {
        if (host.state != State::calling) return;
        if (!host.process || host.frozen_until > seconds() || host.process->leaving)
            return at(seconds() + call_again, [this, &host] { call(host); });
        host.state = State::building;
        host.down_free = host.up_free = 0;
        host.known_process = host.process_number;
        const auto expected = std::make_shared<const Plan>(layout(offers_with(&host)));
        send_down(host, [this, expected](Host& begun) { begin(begun, expected); });
    }
    void begin(Host& host, const std::shared_ptr<const Plan>& expected) {
        const auto ready = [this](Host& is_ready) {
            is_ready.state = State::ready;
            if (in_force_) use(is_ready);
            propose();
        };
        if (host.serving) {
            for (const auto& other : hosts_) ask_again(host, other.name);
            return send_up(host, ready);
        }
        const auto process = host.process_number;
        at(seconds() + 0.1 * chance_.part(), [this, &host, process, expected, ready] {
            if (!host.process || host.process_number != process || host.serving) return;
            host.serving = true;
            host.turns.assign(host.process->size(), {});
            host.process->serve(*expected, run, world_.tuning);
            send_up(host, ready);
        });
    }
    void use(Host& host) {
        if (world_.slow_news > 0)
            host.down_free = std::max(host.down_free, seconds() + world_.slow_news * chance_.part());
        send_down(host, [plan = in_force_](Host& told) {
            if (told.process->leaving) told.process->knows_that_it_leaves = true;
            if (told.serving) told.process->tell(plan, run);
        });
    }
    void lose(Host& host, std::uint64_t line) {
        if (host.line != line || host.state == State::calling) return;
        const bool was_there = host.state != State::building;
        ++host.line;
        host.state = State::calling;
        host.has.clear(), host.expects.clear();
        if (was_there) propose();
        at(seconds() + call_again * chance_.part(), [this, &host] { call(host); });
    }
    void beat(Host& host) {
        if (host.process && host.state == State::ready && host.frozen_until <= seconds())
            host.pulse = host.process->pulse();
        at(queue_.now() + 0.4, [this, &host] { beat(host); });
    }
    void say_it_is_here(Host& host, const Hash& name) {
        send_up(host, [name](Host& known) { known.has.insert(name); });
    }
    void reply_to_launcher(const std::string& name, std::uint64_t line, Message message) override {
        auto& host = *find(name);
        ++host.process->answered;
        if (host.line != line) return;
        send_up(host, [this, sent = packet::pack(message, 0)](Host&) {
            if (auto reply = packet::unpack(sent.header, sent.body)) {
                if (tells()) tell("the launcher hears " + words_for(*reply));
                arrived_.push_back(std::move(*reply));
            }
        });
    }

    // ---- plans ------------------------------------------------------------------------------------------------------

    std::vector<const Host*> offers() const { return offers_with(nullptr); }
    std::vector<const Host*> offers_with(const Host* one) const {
        std::vector<const Host*> there;
        for (const auto& host : hosts_)
            if (host.state == State::ready || &host == one) there.push_back(&host);
        return there;
    }
    // Some nodes on some hosts, others after each move.
    Plan layout(const std::vector<const Host*>& there) const {
        const auto& graph = network_.graph;
        Plan made;
        made.places_of.resize(graph.nodes.size());
        if (!there.empty()) {
            Hosts hosts;
            std::vector<HostOffer> given;
            for (const auto* host : there) {
                given.push_back({host->name, host->of.places});
                hosts.hosts.push_back({host->name, {}, static_cast<int>(host->of.places), {}});
            }
            const auto drawn = [&](std::uint64_t who, std::size_t node) {
                return child(child(world_.seed, 1000 + moves_), who, node) >> 7;
            };
            for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
                for (std::size_t i = 0; i < there.size(); ++i)
                    hosts.hosts[i].replicas[graph.nodes[node].name] =
                        drawn(there[i]->number, node) % 2 ? hosts.hosts[i].places : 0;
                hosts.hosts[drawn(99, node) % there.size()].replicas[graph.nodes[node].name] = 1;
            }
            made = lightnet::plan(graph, network_.registry, hosts, given);
        }
        const auto add = [&](const Host& host) {
            for (std::uint32_t i = 0; i < host.of.places; ++i)
                if (const PlaceAt at{host.name, i}; std::ranges::find(made.places, at) == made.places.end())
                    made.places.push_back(at);
            made.processes[host.name] = host.known_process;
        };
        for (const auto* host : there) add(*host);
        for (const auto& host : hosts_)
            if (host.state == State::leaving) add(host);
        return made;
    }
    void propose() {
        plan_ = layout(offers());
        if (tells()) tell("proposes " + to_json(plan_));
        Message message;
        message.type = Message::Type::plan;
        message.run = run;
        message.plan = std::make_shared<const Plan>(plan_);
        arrived_.push_back(std::move(message));
    }

    // ---- mishaps ----------------------------------------------------------------------------------------------------

    // `after`: seconds until another one is there.
    void end(Host& host, double after) {
        host.serving = false;
        host.process.reset();
        for (auto& other : hosts_)
            if (&other != &host) cut(other, host);
        at(seconds() + 0.05 + after, [this, &host] { start(host); });
    }
    void happen(const Mishap& mishap) override {
        auto& host = hosts_[mishap.host % hosts_.size()];
        auto& other = hosts_[(mishap.host + 1) % hosts_.size()];
        if (mishap.kind == Mishap::Kind::move) {
            ++moves_;
            propose();
        } else if (mishap.kind == Mishap::Kind::cut) {
            cut(host, other);
            cut(other, host);
        } else if (mishap.kind == Mishap::Kind::cut_off) {
            lose(host, host.line);
        } else if (!host.process || host.process->leaving) {
            return;
        } else if (mishap.kind == Mishap::Kind::freeze) {
            host.frozen_until = std::max(host.frozen_until, seconds() + mishap.seconds);
            if (mishap.seconds > lease) at(seconds() + lease, [this, &host, line = host.line] { lose(host, line); });
        } else if (mishap.kind == Mishap::Kind::kill) {
            at(seconds() + lease * chance_.part(), [this, &host, line = host.line] { lose(host, line); });
            end(host, mishap.seconds);
        } else if (host.state == State::ready && offers().size() > 1) {
            leave(host, mishap.seconds);
        } else {
            return;
        }
        if (tells()) tell("event " + std::to_string(events_) + ": " + words_for(mishap));
        note(1000 + static_cast<std::uint64_t>(mishap.kind), host.number);
        ++happened_[mishap.kind];
    }
    void leave(Host& host, double after) {
        host.process->leaving = true;
        send_up(host, [this](Host& told) {
            if (told.state != State::ready) return;
            told.state = State::leaving;
            propose();
        });
        look_whether_gone(host, host.process_number, seconds(), after);
    }
    void look_whether_gone(Host& host, std::uint64_t number, double since, double after) {
        at(seconds() + 0.05, [this, &host, number, since, after] {
            if (!host.process || host.process_number != number) return;
            const auto& process = *host.process;
            const bool idle = process.answered >= process.given && seconds() - std::max(since, process.last_work) > 0.3;
            const bool knows = process.knows_that_it_leaves && host.frozen_until <= seconds();
            if (!(knows && idle) && seconds() - since < 10) return look_whether_gone(host, number, since, after);
            at(seconds() + delay(), [this, &host, line = host.line] { lose(host, line); });
            end(host, after);
        });
    }

    std::deque<Message> arrived_;
    Plan plan_;
    std::shared_ptr<const Plan> in_force_;
    std::uint64_t moves_ = 0;
    std::map<Mishap::Kind, std::size_t> happened_;
    std::map<Hash, Bytes> known_results_;  // that the launcher has
    const std::map<Hash, Bytes> none_;
    std::size_t came_from_others_ = 0, left_to_launcher_ = 0;
    Counters counters_;
};

}  // namespace lightnet::test
