#include "transport/launcher/probe_hosts.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "transport/wire/packet.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

constexpr int trips = 8;
constexpr std::size_t load = std::size_t{8} << 20;  // bytes, for the bandwidth

std::chrono::nanoseconds wall_time() { return std::chrono::system_clock::now().time_since_epoch(); }

/// One question after the other at one endpoint.
class Asker {
public:
    Asker(HostTransport& transport, const AskedHost& host, Clock::time_point end)
        : host_(host), line_(transport.connect(host.endpoint, host.keys, Handshakes::noted)), end_(end) {}

    struct Trip {
        Fields fields;
        std::chrono::nanoseconds taken{}, middle{};  // on our wall clock
    };

    /// Sends `more` bytes with the question. Nothing: there is no answer in time.
    std::optional<Trip> ask(std::size_t more) {
        Fields question;
        if (more > 0) question.set("load", std::string(more, 'x'));
        auto frames = frames_of(packet::pack(Type::status, 0, question));
        while (!line_->send(frames)) {
            if (Clock::now() > end_) return std::nullopt;
            wait();
        }
        const auto begin = Clock::now();
        const auto begin_wall = wall_time();
        while (Clock::now() < end_) {
            wait();
            while (auto answer = line_->receive())
                if (auto fields = state_in(*answer)) {
                    const std::chrono::nanoseconds taken = Clock::now() - begin;
                    return Trip{std::move(*fields), taken, begin_wall + taken / 2};
                }
        }
        return std::nullopt;
    }

    HostAnswer no_answer() const { return lightnet::no_answer(host_, *line_, seen_, abandoned_); }

private:
    void wait() {
        Poll poll;
        line_->watch(poll);
        poll.wait(std::chrono::milliseconds(5));
        line_->tick(Clock::now());
        const auto handshake = line_->look_at_handshake();
        if (!handshake) return;
        seen_ = handshake;
        abandoned_ = *seen_ == Handshake::abandoned ? abandoned_ + 1 : 0;
    }
    static std::optional<Fields> state_in(Frames& frames) {
        if (frames.size() != 2) return std::nullopt;  // the greeting
        const auto header = packet::read_header(bytes_of(frames[0]), bytes_of(frames[1]));
        if (!header || header->type != Type::state) return std::nullopt;
        return packet::unpack_fields(bytes_of(frames[1]));
    }

    const AskedHost& host_;
    std::unique_ptr<HostLine> line_;
    std::optional<Handshake> seen_{};
    int abandoned_ = 0;
    Clock::time_point end_;
};

HostProbe probe(HostTransport& transport, const AskedHost& host, std::chrono::milliseconds patience) {
    HostProbe found;
    Asker asker(transport, host, Clock::now() + patience);
    for (int i = 0; i < trips; ++i) {
        const auto trip = asker.ask(0);
        if (!trip) {
            found.answer = asker.no_answer();
            return found;
        }
        if (i > 0 && trip->taken >= found.round_trip) continue;
        found.round_trip = trip->taken;
        found.answer.asked = host.endpoint;
        found.answer.name = trip->fields.text("name"), found.answer.state = trip->fields.text("state");
        found.answer.machine = machine_from(trip->fields);
        found.answer.places = trip->fields.number("places");
        found.plugins = trip->fields.text("plugins");
        if (const auto clock = trip->fields.number("clock"))
            found.clock_ahead = std::chrono::nanoseconds(static_cast<std::int64_t>(clock)) - trip->middle;
    }
    if (const auto trip = asker.ask(load); trip && trip->taken > found.round_trip)
        found.bandwidth =
            static_cast<double>(load) / std::chrono::duration<double>(trip->taken - found.round_trip).count();
    return found;
}

}  // namespace

std::vector<HostProbe> probe_hosts(const std::vector<AskedHost>& hosts, std::chrono::milliseconds patience) {
    const auto transport = zmq_hosts();
    std::vector<HostProbe> probes;
    for (const auto& host : hosts) try {
            probes.push_back(probe(*transport, host, patience));
        } catch (const LineError& error) {
            throw Error(host.endpoint, std::string("can't be called: ") + error.what());
        }
    return probes;
}

}  // namespace lightnet
