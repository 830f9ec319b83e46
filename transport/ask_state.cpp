#include "transport/ask_state.hpp"

#include <algorithm>
#include <zmq.hpp>

#include "core/error.hpp"
#include "transport/sockets.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using packet::Fields;
using packet::Type;

struct Asked {
    std::string endpoint;
    zmq::socket_t socket;
    bool sent = false, all = false;
    std::vector<HostAnswer> answers;

    void look() {
        if (!sent) {
            Frames frames;
            append(frames, packet::pack(Type::status, 0, {}));
            sent = send_frames(socket, frames);
        }
        while (auto frames = receive_frames(socket)) {
            if (frames->size() != 2) continue;  // the greeting
            const auto header = packet::read_header(bytes_of((*frames)[0]), bytes_of((*frames)[1]));
            const auto fields = packet::unpack_fields(bytes_of((*frames)[1]));
            if (!header || header->type != Type::state || !fields) continue;
            answers.push_back({endpoint, fields->text("name"), fields->text("state"), fields->text("who"),
                               fields->text("nodes"), machine_from(*fields), fields->number("places"),
                               fields->number("progress"), fields->number("bundles"),
                               fields->number("broken_packets")});
            all = fields->number("left") == 0;
        }
    }
};

}  // namespace

std::vector<HostAnswer> ask_state(const std::vector<std::string>& endpoints, std::chrono::milliseconds patience) {
    const auto its_context = make_context();
    auto& context = *its_context;
    std::vector<Asked> asked;
    for (const auto& endpoint : endpoints) {
        try {
            asked.push_back({endpoint, asking_socket(context, endpoint), false, false, {}});
        } catch (const zmq::error_t& error) {
            throw Error(endpoint, std::string("can't be called: ") + error.what());
        }
    }
    const auto end = Clock::now() + patience;
    while (Clock::now() < end && !std::all_of(asked.begin(), asked.end(), [](const auto& one) { return one.all; })) {
        std::vector<zmq_pollitem_t> items;
        for (auto& one : asked) items.push_back(readable(one.socket));
        poll(items, std::chrono::milliseconds(5));
        for (auto& one : asked) one.look();
    }
    std::vector<HostAnswer> answers;
    for (auto& one : asked) {
        if (one.answers.empty()) one.answers.push_back({one.endpoint, one.endpoint, "does not answer", {}, {}, {}});
        answers.insert(answers.end(), one.answers.begin(), one.answers.end());
    }
    return answers;
}

}  // namespace lightnet
