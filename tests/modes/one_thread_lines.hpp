// Hosts of a cluster in one thread, and the lines between them, on a clock that goes from event to event.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"
#include "core/run/forecast/event_queue.hpp"
#include "tests/modes/one_thread_host.hpp"
#include "tests/modes/one_thread_world.hpp"
#include "tests/support/simulated_clock.hpp"

namespace lightnet::test {

/// What is asked between hosts may be lost, late, doubled and overtaken; a line that is cut loses all that is on it.
class OneThreadLines : protected OneThreadNet {
public:
    /// Of all that has happened, in its order.
    std::uint64_t story() const { return story_; }
    std::uint64_t events() const { return events_; }
    /// Who waits for what.
    std::string standing() const {
        std::string text;
        for (const auto& host : hosts_)
            text += "\n  " + host.name +
                    (host.serving   ? " serves"
                     : host.process ? " is there"
                                    : " is gone") +
                    (host.state == State::ready ? ", takes part" : "") + (host.process ? host.process->words() : "");
        return text;
    }
    /// Hosts that were said to have failed, and at what. None should.
    const std::vector<std::string>& faults() const { return faults_; }

protected:
    OneThreadLines(const OneThreadWorld& world, SimulatedClock& clock, const Network& network)
        : world_(world), clock_(clock), network_(network), chance_(child(world.seed, 3)) {
        for (std::size_t i = 0; i < world_.hosts.size(); ++i)
            hosts_.push_back({.number = i, .name = "tcp://host" + std::to_string(i) + ":7777", .of = world_.hosts[i]});
    }

    enum class State { calling, building, ready, leaving };
    struct Turn {
        double due = EventQueue::never, busy_until = 0;
    };
    struct Host {
        std::size_t number = 0;
        std::string name;
        OneThreadWorld::Of of;
        std::unique_ptr<OneThreadProcess> process{};
        std::uint64_t process_number = 0;  // of what runs, or ran last
        bool serving = false;
        std::vector<Turn> turns{};
        double frozen_until = 0;
        std::map<std::string, std::uint64_t> lines{};  // to others: how many it has had so far
        // as the launcher sees it
        State state = State::calling;
        std::uint64_t line = 0, known_process = 0, pulse = 0;
        double down_free = 0, up_free = 0;
        std::set<Hash> has{}, expects{};
    };

    virtual void happen(const Mishap& mishap) = 0;

    // ---- time -------------------------------------------------------------------------------------------------------

    double seconds() const override { return clock_.seconds(); }
    bool tells() const override { return tells_; }
    void tell(const std::string& what) override { std::fprintf(stderr, "%.5f %s\n", seconds(), what.c_str()); }
    void at(double time, EventQueue::Happens happens) { queue_.at(time, std::move(happens)); }
    void next_event() {
        clock_.set(queue_.next());
        clock_.slow_down(1);
        note(++events_, static_cast<std::uint64_t>(1e9 * queue_.next()));
        queue_.step();
        for (const auto& mishap : world_.mishaps)
            if (mishap.event == events_) happen(mishap);
    }
    void note(std::uint64_t what, std::uint64_t more) { story_ = child(story_, what, more); }
    double delay() {
        const double often = world_.delay * -std::log(1 - chance_.part());
        return 1e-5 + (chance_.happens(0.01) ? 30 * often : often);
    }
    void wake(Host& host, std::uint32_t place, double time) {
        if (!host.serving) return;
        auto& turn = host.turns[place];
        const double when = std::max({time, turn.busy_until, host.frozen_until});
        if (when >= turn.due) return;
        turn.due = when;
        at(when, [this, &host, place, when, process = host.process_number] {
            if (host.process_number != process || !host.serving || host.turns[place].due != when) return;
            host.turns[place].due = EventQueue::never;
            if (host.frozen_until > when) return wake(host, place, when);
            clock_.slow_down(host.of.slowness);
            const double again = host.process->step(place);
            note(host.number, place);
            host.turns[place].busy_until = clock_.seconds();
            wake(host, place, again);
        });
    }

    // ---- between them ----------------------------------------------------------------------------------------------

    Host* find(const std::string& name) {
        for (auto& host : hosts_)
            if (host.name == name) return &host;
        return nullptr;
    }
    std::uint64_t line_to(const std::string& from, const std::string& to) const override {
        for (const auto& host : hosts_)
            if (host.name == from) {
                const auto found = host.lines.find(to);
                return found == host.lines.end() ? 0 : found->second;
            }
        return 0;
    }
    void send_ask(Parcel parcel) override {
        for (int copies = chance_.happens(world_.twice) ? 2 : 1; copies > 0; --copies) {
            if (chance_.happens(world_.loss)) continue;
            at(seconds() + delay(), [this, parcel] {
                auto& to = *find(parcel.to);
                if (line_to(parcel.from, parcel.to) != parcel.line || !to.serving) return;
                auto ask = packet::unpack(parcel.packet.header, parcel.packet.body);
                if (!ask) return;
                ask->route.hops = {"line", std::to_string(parcel.line), parcel.from, std::to_string(parcel.asker)};
                take_ask(to, parcel.place, std::move(*ask));
            });
        }
    }
    void send_reply(Parcel parcel) override {
        ++find(parcel.from)->process->answered;
        if (chance_.happens(world_.loss) || line_to(parcel.to, parcel.from) != parcel.line) return;
        at(seconds() + delay(), [this, parcel = std::move(parcel)] {
            auto& to = *find(parcel.to);
            if (line_to(parcel.to, parcel.from) != parcel.line || !to.serving) return;
            if (auto reply = packet::unpack(parcel.packet.header, parcel.packet.body))
                to.process->put_reply(parcel.place, std::move(*reply));
        });
    }
    void take_ask(Host& host, std::uint32_t place, Message ask) {
        ++host.process->given;
        host.process->last_work = seconds();
        host.process->put(place, std::move(ask));
    }
    void fault(const std::string& host, const std::string& why) override {
        if (tells()) tell(host + " is at fault: " + why);
        faults_.push_back(host + ": " + why);
    }
    bool refuses() override { return chance_.happens(world_.refused); }
    // A little later.
    void ask_again(Host& asker, const std::string& of) {
        at(seconds() + 0.01 * chance_.part(), [this, &asker, of] {
            if (!asker.serving) return;
            asker.process->resend(of);
            for (std::uint32_t i = 0; i < asker.process->size(); ++i) wake(asker, i, seconds());
        });
    }
    void cut(Host& from, Host& to) {
        ++from.lines[to.name];
        if (from.process) from.process->from_others.lose(to.name);
        ask_again(from, to.name);
    }

    // ---- processes --------------------------------------------------------------------------------------------------

    void start(Host& host) {
        ++host.process_number;
        host.serving = false;
        host.frozen_until = 0;
        OneThreadNet& net = *this;
        host.process =
            std::make_unique<OneThreadProcess>(net, host.name, host.of.places, network_,
                                               [this, &host](std::uint32_t place) { wake(host, place, seconds()); });
        for (auto& other : hosts_)
            if (&other != &host) cut(other, host), ++host.lines[other.name];
    }

    const OneThreadWorld& world_;
    SimulatedClock& clock_;
    const Network& network_;
    Chance chance_;
    EventQueue queue_;
    std::deque<Host> hosts_;
    bool tells_ = std::getenv("LIGHTNET_STORY") != nullptr;
    std::uint64_t story_ = 1, events_ = 0;
    std::vector<std::string> faults_;
};

}  // namespace lightnet::test
