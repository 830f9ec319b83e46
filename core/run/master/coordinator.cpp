#include "core/run/master/coordinator.hpp"

#include <algorithm>
#include <memory>

namespace lightnet {
namespace {

// At once: a rehearsal that is broken off meanwhile, as nobody holds its node any more, may never come to its end.
constexpr auto most_rehearsing = std::chrono::milliseconds(50);

}  // namespace

bool Coordinator::prepare(std::chrono::nanoseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    std::chrono::nanoseconds left = most;
    do {
        lead_.advance();
        if (lead_.state().all_done()) return true;
        if (!lead_.render(std::min<std::chrono::nanoseconds>(left, most_rehearsing))) {
            wait(std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(20)));
            // Nobody else waits for any of it: no master renders.
            while (receive()) {
            }
        }
        left = end - std::chrono::steady_clock::now();
    } while (left.count() > 0);
    return false;
}

bool Coordinator::ask(const PlaceAt& to, Message& message) {
    const auto channel = message.channel;
    message.channel = epoch_.marked(channel);
    if (carrier_.ask(to, message)) return true;
    message.channel = channel;
    return false;
}

void Coordinator::give_up(std::uint32_t channel) {
    if (channel < Epoch::most_channels) carrier_.give_up(epoch_.marked(channel));  // else nothing was ever asked by it
}

void Coordinator::adopt(const Plan& plan) {
    carrier_.adopt(plan);
    Message message;
    message.type = Message::Type::plan;
    message.run = run_;
    message.plan = std::make_shared<const Plan>(plan);
    plans_.push_back(std::move(message));
}

std::optional<Message> Coordinator::receive() {
    while (true) {
        if (!plans_.empty()) {
            auto message = std::move(plans_.front());
            plans_.pop_front();
            return message;
        }
        auto message = carrier_.receive();
        if (!message) return std::nullopt;
        if (message->run != run_) continue;
        if (message->type == Message::Type::plan) {
            if (message->plan) propose(*message->plan);
        } else if (Epoch::is_own(message->channel)) {
            lead_.take(std::move(*message));
        } else if (epoch_.has(message->channel)) {
            message->channel = Epoch::channel_of(message->channel);
            return message;
        }
    }
}

void Coordinator::wait(std::chrono::nanoseconds most) {
    if (!plans_.empty()) return;
    carrier_.wait(most);
    lead_.tick();
}

}  // namespace lightnet
