#include "transport/launcher/ask_state.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "transport/launcher/key_trouble.hpp"
#include "transport/wire/packet.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

struct Asked {
    AskedHost host;
    std::unique_ptr<HostLine> line;
    std::optional<Handshake> seen{};
    int abandoned = 0;
    bool sent = false, all = false;
    std::vector<HostAnswer> answers{};
    std::vector<AskedHost> beside{};  // daemons that stand for one with it

    HostAnswer answer_in(const Fields& fields) const {
        HostAnswer answer;
        answer.asked = host.endpoint;
        answer.of_launcher = !fields.numbers.contains("broken_packets");  // only daemons count them
        answer.name = fields.text("name"), answer.state = fields.text("state");
        answer.who = fields.text("who"), answer.nodes = fields.text("nodes");
        answer.machine = machine_from(fields);
        answer.places = fields.number("places"), answer.progress = fields.number("progress");
        answer.bundles = fields.number("bundles"), answer.broken_packets = fields.number("broken_packets");
        answer.resident_memory = fields.number("resident_memory");
        return answer;
    }

    void look() {
        line->tick(Clock::now());
        if (const auto handshake = line->look_at_handshake()) {
            seen = handshake;
            abandoned = *seen == Handshake::abandoned ? abandoned + 1 : 0;
        }
        if (!sent) {
            auto frames = frames_of(packet::pack(Type::status, 0, {}));
            sent = line->send(frames);
        }
        while (auto frames = line->receive()) {
            if (frames->size() != 2) continue;  // the greeting
            const auto header = packet::read_header(bytes_of((*frames)[0]), bytes_of((*frames)[1]));
            const auto fields = packet::unpack_fields(bytes_of((*frames)[1]));
            if (!header || header->type != Type::state || !fields) continue;
            answers.push_back(answer_in(*fields));
            all = fields->number("left") == 0;
            find_others(fields->text("ports"));
        }
    }

    // See RunPorts; its own comes first.
    void find_others(const std::string& ports) {
        auto parts = tcp_endpoint(host.endpoint);
        std::istringstream in(ports);
        bool own = true;
        for (unsigned port = 0; parts && in >> port; in.ignore()) {
            parts->port = std::to_string(port);
            if (!std::exchange(own, false)) beside.push_back({parts->text(), host.keys});
        }
    }
};

/// Asks all of some hosts together, each once.
std::vector<Asked> ask_together(const std::vector<AskedHost>& hosts, std::chrono::milliseconds patience) {
    const auto transport = zmq_hosts();
    std::vector<Asked> asked;
    for (const auto& host : hosts) {
        if (std::any_of(asked.begin(), asked.end(),
                        [&](const auto& one) { return one.host.endpoint == host.endpoint; }))
            continue;
        try {
            asked.push_back({host, transport->connect(host.endpoint, host.keys, Handshakes::noted)});
        } catch (const LineError& error) {
            throw Error(host.endpoint, std::string("can't be called: ") + error.what());
        }
    }
    const auto end = Clock::now() + patience;
    while (Clock::now() < end && !std::all_of(asked.begin(), asked.end(), [](const auto& one) { return one.all; })) {
        Poll poll;
        for (const auto& one : asked) one.line->watch(poll);
        poll.wait(std::chrono::milliseconds(5));
        for (auto& one : asked) one.look();
    }
    for (auto& one : asked)
        if (one.answers.empty()) one.answers.push_back(no_answer(one.host, *one.line, one.seen, one.abandoned));
    for (auto& one : asked) one.line.reset();
    return asked;
}

}  // namespace

HostAnswer no_answer(const AskedHost& host, const HostLine& line, std::optional<Handshake> seen, int abandoned) {
    HostAnswer answer{host.endpoint, false, host.endpoint, "does not answer", {}, {}, {}};
    answer.answers = false;
    const bool by_keys = seen && *seen != Handshake::made && *seen != Handshake::unanswered &&
                         (*seen != Handshake::abandoned || abandoned >= abandoned_tells_of_keys);
    if (by_keys) {
        const auto trouble = key_trouble(host.endpoint, host.keys, *seen);
        answer.unknown = host.keys || *seen != Handshake::abandoned;
        answer.state = trouble.what;
        answer.advice = trouble.advice;
    } else if (const auto why = line.trouble(); !why.empty()) {
        answer.state += ": " + why;
    }
    return answer;
}

std::vector<HostAnswer> ask_state(const std::vector<AskedHost>& hosts, std::chrono::milliseconds patience) {
    const auto asked = ask_together(hosts, patience);
    std::vector<AskedHost> beside;
    for (const auto& one : asked)
        for (const auto& other : one.beside)
            if (std::none_of(asked.begin(), asked.end(),
                             [&](const auto& known) { return known.host.endpoint == other.endpoint; }))
                beside.push_back(other);
    std::vector<HostAnswer> answers;
    const auto add = [&](const std::vector<Asked>& all) {
        for (const auto& one : all) answers.insert(answers.end(), one.answers.begin(), one.answers.end());
    };
    add(asked);
    add(ask_together(beside, patience));
    return answers;
}

}  // namespace lightnet
