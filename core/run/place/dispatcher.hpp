// A host's own multiplexers: who asks the host is given whichever of its places is free.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/run/message/asks_in_hand.hpp"
#include "core/run/message/asks_of_later_plans.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/message/tuning.hpp"
#include "core/run/schedule/multiplexer.hpp"
#include "core/run/schedule/remote_channels.hpp"

namespace lightnet {

/// Takes what other hosts and the launcher ask of this host as a whole (any_place), and deals it to those of its
/// places that hold the node, by the same Multiplexer by which the askers deal to hosts. Its replies tell how busy the
/// places are together. Has neither nodes nor fibers, so it is never busy itself. It goes by plans that are in force
/// alone, as others name places that are not prepared; what comes before the first one waits. One thread's.
class Dispatcher {
public:
    /// `nodes`: of the graph; `clock`: see MultiplexerRules.
    Dispatcher(std::string host, std::uint64_t run, std::size_t nodes, const Tuning& tuning, Carrier& carrier,
               std::function<double()> clock = steady_seconds);
    Dispatcher(const Dispatcher&) = delete;
    Dispatcher& operator=(const Dispatcher&) = delete;

    /// Serves until a stop message arrives or `stop` is set.
    void serve(const std::atomic<bool>& stop);
    /// Takes in what has arrived, and does what is due.
    void step();
    /// How long until something is due though nothing arrives.
    std::chrono::nanoseconds until_due() const;
    Counters counters() const;

private:
    /// All that is asked of one node.
    template <class Question>
    class Desk final : private BundleOwner<Question> {
    public:
        Desk(Dispatcher& all, std::uint32_t node, RemoteChannels<Question>& channels);
        void take(Message ask);
        void connect();
        void cancel(const std::set<std::uint64_t>& askers);
        bool tick() { return places_.tick(); }
        std::chrono::nanoseconds until_due() const { return places_.until_due(); }

    private:
        void answered(const Bundle<Question>& bundle, std::vector<Rgb> answers) override;
        void failed(const Bundle<Question>& bundle, const Failure& failure) override;
        void returned(Bundle<Question>) override {}  // a multiplexer keeps what it has taken
        void reply(const Bundle<Question>& bundle, const std::function<void(Message&)>& say);

        Dispatcher& all_;
        RemoteChannels<Question>& channels_;
        typename RemoteChannels<Question>::Edge edge_;
        Multiplexer<Question> places_;
        AsksInHand in_hand_;
        std::map<std::uint64_t, Message> asks_;  // by number of the bundle, without their questions
        std::uint64_t next_ = 1;
    };

    static constexpr std::uint32_t first_for_tiles = 1u << 31;  // number of a channel

    template <class Question>
    void take(Message ask, std::map<std::uint32_t, Desk<Question>>& desks, RemoteChannels<Question>& channels);
    void take(Message message);
    void use(const Plan& plan);
    Plan for_desk(std::uint32_t node) const;
    template <class Act>
    void for_each_desk(const Act& act) {
        for (auto& [node, desk] : light_) act(desk);
        for (auto& [node, desk] : images_) act(desk);
    }

    std::string host_;
    std::uint64_t run_;
    Plan plan_;
    Tuning tuning_;
    Carrier& carrier_;
    std::function<double()> clock_;
    bool stopping_ = false;
    AsksOfLaterPlans later_;
    Counters counters_, dealt_;
    RemoteChannels<Query> light_channels_;
    RemoteChannels<Tile> image_channels_;
    std::map<std::uint32_t, Desk<Query>> light_;  // by node
    std::map<std::uint32_t, Desk<Tile>> images_;
};

}  // namespace lightnet
