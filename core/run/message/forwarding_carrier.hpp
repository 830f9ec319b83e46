// A carrier that hands all on to another.
#pragma once

#include <utility>

#include "core/run/message/carrier.hpp"

namespace lightnet {

/// For those that stand before a carrier and change some of what goes over it. Does not own the other one.
class ForwardingCarrier : public Carrier {
public:
    explicit ForwardingCarrier(Carrier& carrier) : carrier_(carrier) {}

    bool ask(const PlaceAt& to, Message& message) override { return carrier_.ask(to, message); }
    void reply(Message message) override { carrier_.reply(std::move(message)); }
    std::optional<Message> receive() override { return carrier_.receive(); }
    void wait(std::chrono::nanoseconds most) override { carrier_.wait(most); }
    void give_up(std::uint32_t channel) override { carrier_.give_up(channel); }
    bool bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) override {
        return carrier_.bring(to, name, bytes);
    }
    void adopt(const Plan& plan) override { carrier_.adopt(plan); }
    bool take_out(const std::string& host, const std::string& why) override { return carrier_.take_out(host, why); }
    bool expects_hosts() const override { return carrier_.expects_hosts(); }
    void doubt(const Failure& lie) override { carrier_.doubt(lie); }
    std::uint64_t pulse(const std::string& host) const override { return carrier_.pulse(host); }
    void forget(const PlaceAt& place) override { carrier_.forget(place); }
    const Counters& counters() const override { return carrier_.counters(); }

protected:
    Carrier& carrier_;
};

}  // namespace lightnet
