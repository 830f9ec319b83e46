// The channel to one node at one other place, or at another host.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/run/message/carrier.hpp"
#include "core/run/message/channel.hpp"
#include "core/run/message/place_name.hpp"

namespace lightnet {

/// Turns bundles into messages, and replies into answers for their owner. Keeps nothing of what is under way: that is
/// its owner's business.
template <class Question>
class RemoteChannel final : public Channel<Question> {
public:
    /// From whom to whom.
    struct Address {
        std::uint64_t run = 0;
        std::uint32_t channel = 0;       // number among the channels of this place
        std::uint32_t node = 0;          // who is asked
        PlaceAt place;                   // where; any_place: wherever its host chooses
        std::uint64_t process = 0;       // see Channel
        std::uint64_t asker = 0;         // name_of() the place that asks; 0: the launcher
        bool reserve = false;            // see Channel
        bool within_process = false;     // see Channel
        std::uint64_t first_bundle = 0;  // on its way, a bundle has its number beyond this one
    };
    RemoteChannel(Carrier& carrier, Address address, Credit credit, Counters& counters)
        : carrier_(carrier), address_(std::move(address)), to_(address_.place), credit_(credit), counters_(counters) {}

    /// The edition of the plan by which it is asked from now on.
    void go_by(std::uint32_t edition) { edition_ = edition; }
    /// The places behind it, by index. Where it is one, that is asked itself: there is nothing to choose.
    void use(const std::vector<std::uint32_t>& places) {
        places_ = static_cast<std::uint32_t>(places.size());
        to_.index = places_ == 1 ? places.front() : any_place;
    }

    bool send(const Bundle<Question>& bundle) override {
        Message message;
        message.type = Message::Type::ask;
        message.run = address_.run;
        message.channel = address_.channel;
        message.bundle = address_.first_bundle + bundle.number;
        message.node = address_.node;
        message.width = bundle.width;
        message.asker = address_.asker;
        message.edition = edition_;
        message.questions = bundle.questions;
        if (!carrier_.ask(to_, message)) return false;
        owner_ = bundle.owner;
        counters_.bundles += 1;
        counters_.questions += bundle.questions->size();
        return true;
    }

    Credit credit() const override {
        return {places_ * credit_.bundles, places_ * credit_.questions, places_ * credit_.bytes};
    }
    std::uint32_t places() const override { return places_; }
    Load load() const override { return load_; }
    std::string host() const override { return address_.place.host; }
    std::uint64_t process() const override { return address_.process; }
    bool reserve() const override { return address_.reserve; }
    bool within_process() const override { return address_.within_process; }
    std::uint64_t pulse() const override { return carrier_.pulse(address_.place.host); }
    std::uint64_t name() const override { return name_of(address_.place); }

    /// A reply or a failure that names this channel.
    void arrived(Message& message) {
        if (closed_ || !owner_) {
            ++counters_.late_replies;
            return;
        }
        const Bundle<Question> bundle{nullptr, owner_, message.bundle - address_.first_bundle, message.width};
        if (message.type == Message::Type::failure) {
            if (message.trouble.host.empty()) message.trouble.host = address_.place.host;
            return owner_->failed(bundle, message.trouble);
        }
        if (!std::is_same_v<Question, Step>) load_ = message.load;  // which counts shards that go together as one
        owner_->answered(bundle, take_answers<Question>(message));
    }

    /// The place is gone: nothing more is sent, and what still comes from it is dropped.
    void close() {
        closed_ = true;
        carrier_.give_up(address_.channel);
        carrier_.forget(to_);
    }

private:
    Carrier& carrier_;
    Address address_;
    PlaceAt to_;
    std::uint32_t places_ = 1, edition_ = 0;
    Credit credit_;  // of one place
    Counters& counters_;
    Load load_;
    BundleOwner<Question>* owner_ = nullptr;  // of all that is under way
    bool closed_ = false;
};

}  // namespace lightnet
