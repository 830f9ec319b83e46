// The places of a host in a cluster of one thread: real ones, on lines and a clock that are simulated.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/run/assembly/gauge.hpp"
#include "core/run/message/place_name.hpp"
#include "core/run/place/dispatcher.hpp"
#include "core/run/place/place.hpp"
#include "transport/daemon/results_from_others.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::test {

/// What goes on a simulated line between hosts.
struct Parcel {
    packet::Packet packet;
    std::uint32_t place = 0;  // that is meant: of the asked, or of the asker
    std::string from, to;     // hosts
    std::uint32_t asker = 0;  // place
    std::uint64_t line = 0;   // which of all that the asker's host has had there
};

/// Whoever carries parcels and has a clock.
class OneThreadNet {
public:
    virtual ~OneThreadNet() = default;
    virtual double seconds() const = 0;
    virtual void send_ask(Parcel parcel) = 0;
    virtual void send_reply(Parcel parcel) = 0;
    virtual void reply_to_launcher(const std::string& host, std::uint64_t line, Message message) = 0;
    virtual std::uint64_t line_to(const std::string& from, const std::string& to) const = 0;
    virtual void fault(const std::string& host, const std::string& why) = 0;
    virtual bool refuses() = 0;
    /// Is the story told, for people to read?
    virtual bool tells() const = 0;
    virtual void tell(const std::string& what) = 0;
};

/// Its numbers, and what it is about.
inline std::string words_for(const Message& message) {
    const auto* steps = std::get_if<Questions<Step>>(&message.questions);
    return std::to_string(message.channel) + "/" + std::to_string(message.bundle) + " node " +
           std::to_string(message.node) + (steps ? " step " + std::to_string(int((*steps)->front().kind)) : "") +
           (message.type == Message::Type::failure ? " failed: " + message.trouble.why : "");
}

/// A place or the dispatcher of a host, with its carrier. As ZmqCarrier does, it keeps what it asks of other hosts
/// until the reply is there, and sends it again when a line was cut, or after three seconds without an answer.
class OneThreadPlace final : public Carrier {
public:
    /// Of its own process.
    using Beside = std::function<void(std::uint32_t place, Message message)>;
    OneThreadPlace(OneThreadNet& net, PlaceAt me, Beside beside)
        : net_(net), me_(std::move(me)), beside_(std::move(beside)) {}

    void serve(const Network& network, const Plan& plan, std::uint64_t run, const Tuning& tuning,
               const std::atomic<bool>& stop) {
        if (me_.index == any_place) {
            dispatcher_ = std::make_unique<Dispatcher>(me_.host, run, network.graph.nodes.size(), tuning, *this);
            return;
        }
        gauge_ = std::make_unique<Gauge>(network.graph.nodes.size(),
                                         asking_edges(network.graph, network.layers, network.registry).size());
        place_ = std::make_unique<Place>(network, me_, plan, run, tuning, *this, *gauge_, Place::Asks::when_told);
        place_->begin(stop, progress_);
    }
    /// Does what there is to do. Returns when it wants to be called again, in seconds.
    double step() {
        asleep_.reset();
        if (place_) {
            place_->work_once();
        } else {
            dispatcher_->step();
            wait(dispatcher_->until_due());
        }
        return asleep_ ? net_.seconds() + *asleep_ : net_.seconds();
    }
    void put(Message message) { arrived_.push_back(std::move(message)); }
    /// What was under way to a host may be lost.
    void resend(const std::string& host) {
        for (auto& [key, kept] : pending_)
            if (kept.to == host) kept.sent = false;
    }
    /// A reply from another host.
    void put_reply(Message message) {
        if (net_.tells()) net_.tell(my_name() + " hears " + words_for(message));
        const auto found = pending_.find({message.channel, message.bundle});
        if (found != pending_.end()) {
            auto& peer = peers_[found->second.to];
            peer.answered = net_.seconds(), peer.patience = shortest_patience;
            pending_.erase(found);
        }
        put(std::move(message));
    }
    /// What it waits for.
    std::string words() const {
        std::string text = "\n    " + my_name() + ":";
        for (const auto& [key, kept] : pending_)
            text += " " + std::to_string(key.first) + "/" + std::to_string(key.second) +
                    (kept.sent ? " at " : " not yet to ") + kept.to + ";";
        for (std::size_t node = 0; gauge_ && node < gauge_->nodes.size(); ++node)
            if (const auto waiting = gauge_->nodes[node].waiting.get())
                text += " " + std::to_string(waiting) + " questions for node " + std::to_string(node) + ";";
        return text;
    }
    std::uint64_t works() const { return gauge_ ? gauge_->pulse.get() : 0; }
    std::uint32_t index() const { return me_.index; }

    bool ask(const PlaceAt& to, Message& message) override {
        if (to.host == me_.host) {
            message.route.hops = {"beside", std::to_string(me_.index)};
            beside_(to.index, std::move(message));
            return true;
        }
        if (net_.refuses()) return false;
        if (net_.tells()) net_.tell(my_name() + " asks " + to.host + " " + words_for(message));
        const auto key = std::pair(message.channel, message.bundle);
        auto& kept = pending_[key] = {to.host, to.index, packet::pack(message, to.index)};
        send(kept);
        return true;
    }
    void reply(Message message) override {
        const auto& hops = message.route.hops;
        if (hops.empty()) return;
        if (hops[0] == "beside") {
            const auto to = static_cast<std::uint32_t>(std::stoul(hops[1]));
            return beside_(to, std::move(message));
        }
        const auto line = std::stoull(hops[1]);
        if (hops[0] == "launcher") return net_.reply_to_launcher(me_.host, line, std::move(message));
        const auto place = static_cast<std::uint32_t>(std::stoul(hops[3]));
        net_.send_reply({packet::pack(message, 0), place, me_.host, hops[2], place, line});
    }
    std::optional<Message> receive() override {
        look_after_pending();
        if (arrived_.empty()) return std::nullopt;
        auto message = std::move(arrived_.front());
        arrived_.pop_front();
        return message;
    }
    void wait(std::chrono::nanoseconds most) override {
        asleep_ = arrived_.empty() ? std::max(1e-3, 1e-9 * double(most.count())) : 0;
    }
    void give_up(std::uint32_t channel) override {
        std::erase_if(pending_, [&](const auto& one) { return one.first.first == channel; });
    }
    bool take_out(const std::string& host, const std::string& why) override {
        net_.fault(host, why);
        return true;
    }
    void doubt(const Failure& lie) override { net_.fault(lie.host, lie.why); }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return counters_; }

private:
    std::string my_name() const { return me_.host + " place " + std::to_string(static_cast<int>(me_.index)); }

    static constexpr double shortest_patience = 3, look_interval = 0.2;  // seconds
    struct Kept {
        std::string to;
        std::uint32_t place = 0;
        packet::Packet packet;
        bool sent = true;
    };
    struct Peer {
        double asked = 0, answered = 0, patience = shortest_patience;
    };

    void send(Kept& kept) {
        kept.sent = true;
        peers_[kept.to].asked = net_.seconds();
        net_.send_ask({kept.packet, kept.place, me_.host, kept.to, me_.index, net_.line_to(me_.host, kept.to)});
    }
    void look_after_pending() {
        const double now = net_.seconds();
        if (now - looked_ >= look_interval) {
            looked_ = now;
            for (auto& [host, peer] : peers_) {
                const auto waits = [&](const auto& one) { return one.second.to == host; };
                if (now - std::max(peer.asked, peer.answered) <= peer.patience || std::ranges::none_of(pending_, waits))
                    continue;
                peer.patience *= 2;
                resend(host);
            }
        }
        for (auto& [key, kept] : pending_)
            if (!kept.sent) send(kept);
    }

    OneThreadNet& net_;
    PlaceAt me_;
    Beside beside_;
    std::deque<Message> arrived_;
    std::map<std::pair<std::uint32_t, std::uint64_t>, Kept> pending_;  // by channel and bundle
    std::map<std::string, Peer> peers_;
    double looked_ = 0;
    std::optional<double> asleep_;  // for so many seconds
    std::atomic<std::uint64_t> progress_{0};
    Counters counters_;
    std::unique_ptr<Gauge> gauge_;
    std::unique_ptr<Place> place_;  // or:
    std::unique_ptr<Dispatcher> dispatcher_;
};

/// A process that serves the run: the places of one host, and what it was brought.
class OneThreadProcess {
public:
    using Run = std::function<void(std::uint32_t index)>;  // has a place run soon: by its position
    OneThreadProcess(OneThreadNet& net, const std::string& host, std::uint32_t count, const Network& network, Run wake)
        : network_(network), wake_(std::move(wake)) {
        network_.shared = std::make_shared<SharedValues>();
        network_.activity = std::make_shared<Activity>();
        network_.results = [this](const Hash& name) {
            const auto found = brought.find(name);
            return found == brought.end() ? nullptr : found->second;
        };
        for (std::uint32_t i = 0; i <= count; ++i)
            places_.push_back(std::make_unique<OneThreadPlace>(
                net, PlaceAt{host, i < count ? i : any_place},
                [this](std::uint32_t place, Message message) { put(place, std::move(message)); }));
    }
    void serve(const Plan& plan, std::uint64_t run, const Tuning& tuning) {
        for (auto& place : places_) place->serve(network_, plan, run, tuning, stop_);
        for (std::uint32_t i = 0; i < places_.size(); ++i) wake_(i);
    }
    /// A message for a place, or for the dispatcher.
    void put(std::uint32_t place, Message message) {
        const auto at = position(place);
        if (at >= places_.size()) return;
        places_[at]->put(std::move(message));
        wake_(at);
    }
    void put_reply(std::uint32_t place, Message message) {
        const auto at = position(place);
        if (at >= places_.size()) return;
        places_[at]->put_reply(std::move(message));
        wake_(at);
    }
    void tell(const std::shared_ptr<const Plan>& plan, std::uint64_t run) {
        for (std::uint32_t i = 0; i < places_.size(); ++i) {
            Message message;
            message.type = Message::Type::plan;
            message.run = run;
            message.plan = plan;
            put(places_[i]->index(), std::move(message));
        }
    }
    void resend(const std::string& host) {
        for (auto& place : places_) place->resend(host);
    }
    std::string words() const {
        std::string text;
        for (const auto& place : places_) text += place->words();
        return text;
    }
    double step(std::uint32_t at) { return places_[at]->step(); }
    std::size_t size() const { return places_.size(); }
    std::uint64_t pulse() const {
        std::uint64_t sum = 0;
        for (const auto& place : places_) sum += place->works();
        return sum;
    }

    std::map<Hash, Bytes> brought;
    ResultsFromOthers from_others;
    bool fetches = false;                   // a turn of that is due
    std::uint64_t given = 0, answered = 0;  // of what came from elsewhere
    double last_work = 0;
    bool leaving = false, knows_that_it_leaves = false;

private:
    std::uint32_t position(std::uint32_t place) const {
        return place == any_place ? static_cast<std::uint32_t>(places_.size() - 1) : place;
    }

    Network network_;
    Run wake_;
    std::atomic<bool> stop_{false};
    std::vector<std::unique_ptr<OneThreadPlace>> places_;  // the dispatcher is the last
};

}  // namespace lightnet::test
