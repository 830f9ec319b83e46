// A transport of another make: a mailbox in memory for each place. What another transport has to do, and no more.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "transport/places/place_transport.hpp"

namespace lightnet::test {

/// All mailboxes of a process, by name. Any thread.
class Mailboxes {
public:
    void put(const std::string& box, Message message) {
        {
            const std::lock_guard lock(mutex_);
            boxes_[box].push_back(std::move(message));
        }
        filled_.notify_all();
    }
    std::optional<Message> take(const std::string& box) {
        const std::lock_guard lock(mutex_);
        auto& messages = boxes_[box];
        if (messages.empty()) return std::nullopt;
        Message message = std::move(messages.front());
        messages.pop_front();
        return message;
    }
    void wait(const std::string& box, std::chrono::nanoseconds most) {
        std::unique_lock lock(mutex_);
        filled_.wait_for(lock, most, [&] { return !boxes_[box].empty(); });
    }

private:
    std::mutex mutex_;
    std::condition_variable filled_;
    std::map<std::string, std::deque<Message>> boxes_;
};

class MailboxCarrier final : public Carrier {
public:
    MailboxCarrier(std::shared_ptr<Mailboxes> all, std::string mine) : all_(std::move(all)), mine_(std::move(mine)) {}

    bool ask(const PlaceAt& to, Message& message) override {
        message.route.hops = {mine_};
        all_->put(std::to_string(to.index), std::move(message));
        return true;
    }
    void reply(Message message) override {
        const auto to = message.route.hops.at(0);
        all_->put(to, std::move(message));
    }
    std::optional<Message> receive() override { return all_->take(mine_); }
    void wait(std::chrono::nanoseconds most) override { all_->wait(mine_, most); }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return counters_; }

private:
    std::shared_ptr<Mailboxes> all_;
    std::string mine_;
    Counters counters_;
};

class MailboxTransport final : public PlaceTransport {
public:
    std::unique_ptr<Carrier> carrier_of(std::uint32_t place, AtFault) override {
        return std::make_unique<MailboxCarrier>(all_, std::to_string(place));
    }
    std::unique_ptr<Carrier> asking_carrier() override { return std::make_unique<MailboxCarrier>(all_, "master"); }
    void tell(std::uint32_t place, Message message) override { all_->put(std::to_string(place), std::move(message)); }

private:
    std::shared_ptr<Mailboxes> all_ = std::make_shared<Mailboxes>();
};

/// For ThreadedRun.
inline std::unique_ptr<PlaceTransport> mailboxes(std::uint64_t, std::uint32_t) {
    return std::make_unique<MailboxTransport>();
}

}  // namespace lightnet::test
