#include "transport/launcher/own_host.hpp"

#include <utility>

namespace lightnet {

OwnHost::OwnHost(const std::shared_ptr<const SocketContext>& context, std::shared_ptr<const Network> network,
                 std::uint64_t run, std::uint32_t places, const Plan& plan, Tuning rules)
    : HostLink(""),
      gateway_(*context, run),
      transport_(context, run, "", places),
      threads_(transport_, std::move(network), run, "", places, plan, rules, PlaceThreads::AskedFrom::other_hosts) {
    state_ = State::building;
    places_ = places;
    machine_ = this_machine();
}

void OwnHost::watch(Poll& poll) {
    poll.add(threads_.news());
    gateway_.watch(poll);
    if (state_ == State::ready) poll.add(transport_.replies());
}

bool OwnHost::receive(Time, const Handlers& handlers) {
    threads_.clear_news();
    if (ending_) {
        if (threads_.over()) ended_ = threads_.stop();
        return false;
    }
    for (auto& failure : threads_.failures()) failures_.push_back(std::move(failure));
    if (!threads_.ready()) return false;
    state_ = State::ready;
    while (auto frames = gateway_.receive()) relay_ask(*frames, handlers);
    while (auto frames = transport_.receive()) {
        if (frames->size() == 1)
            handlers.work(take_message(frames->front()));
        else if (frames->size() == 3)
            handlers.relay(*this, *frames);
    }
    return false;
}

// [place][host][header][body], for another host.
void OwnHost::relay_ask(Frames& frames, const Handlers& handlers) {
    Frames relayed;
    relayed.emplace_back(seal({text_of(frames[1]), text_of(frames[0])}));
    for (const auto i : {2u, 3u}) relayed.push_back(std::move(frames[i]));
    handlers.relay(*this, relayed);
}

bool OwnHost::send(Message& message, std::uint32_t place) {
    if (state_ != State::ready || place >= places_) return false;
    auto frames = frames_of(std::move(message));
    if (transport_.forward(place, frames)) return true;
    message = take_message(frames[0]);
    return false;
}

bool OwnHost::forward_ask(Frames& frames, std::uint32_t place) {
    return state_ == State::ready && transport_.forward(place, frames);
}

bool OwnHost::forward_reply(const RelayAddress& asker, Frames& frames) {
    frames.erase(frames.begin());
    return gateway_.forward(asker.place, frames);
}

void OwnHost::watch_places() {
    if (state_ == State::ready) threads_.watch();
}

void OwnHost::use(const WrittenPlan& plan) {
    if (state_ == State::ready) threads_.use(plan.plan);
}

void OwnHost::send_end() {
    ending_ = true;
    threads_.begin_to_stop();
}

}  // namespace lightnet
