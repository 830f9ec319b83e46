#include "transport/launcher/ask_state.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "transport/wire/packet.hpp"
#include "transport/zmq/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

struct Asked {
    std::string endpoint;
    Socket socket;
    bool sent = false, all = false;
    std::vector<HostAnswer> answers;

    HostAnswer answer_in(const Fields& fields) const {
        HostAnswer answer;
        answer.asked = endpoint;
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
        if (!sent) {
            auto frames = frames_of(packet::pack(Type::status, 0, {}));
            sent = socket.send(frames);
        }
        while (auto frames = socket.receive()) {
            if (frames->size() != 2) continue;  // the greeting
            const auto header = packet::read_header(bytes_of((*frames)[0]), bytes_of((*frames)[1]));
            const auto fields = packet::unpack_fields(bytes_of((*frames)[1]));
            if (!header || header->type != Type::state || !fields) continue;
            answers.push_back(answer_in(*fields));
            all = fields->number("left") == 0;
        }
    }
};

}  // namespace

std::vector<HostAnswer> ask_state(const std::vector<AskedHost>& hosts, std::chrono::milliseconds patience) {
    const SocketContext context;
    std::vector<Asked> asked;
    for (const auto& [endpoint, keys] : hosts) {
        if (std::any_of(asked.begin(), asked.end(),
                        [&, &it = endpoint](const auto& one) { return one.endpoint == it; }))
            continue;
        try {
            asked.push_back({endpoint, asking_socket(context, endpoint, keys), false, false, {}});
        } catch (const SocketError& error) {
            throw Error(endpoint, std::string("can't be called: ") + error.what());
        }
    }
    const auto end = Clock::now() + patience;
    while (Clock::now() < end && !std::all_of(asked.begin(), asked.end(), [](const auto& one) { return one.all; })) {
        Poll poll;
        for (const auto& one : asked) poll.add(one.socket);
        poll.wait(std::chrono::milliseconds(5));
        for (auto& one : asked) one.look();
    }
    std::vector<HostAnswer> answers;
    for (auto& one : asked) {
        if (one.answers.empty())
            one.answers.push_back({one.endpoint, false, one.endpoint, "does not answer", {}, {}, {}});
        answers.insert(answers.end(), one.answers.begin(), one.answers.end());
    }
    return answers;
}

}  // namespace lightnet
