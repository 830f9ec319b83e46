// The shards of all calls that preparing nodes wait for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "core/run/master/prepare_state.hpp"
#include "core/run/master/service_calls.hpp"
#include "core/run/master/shard_dealer.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/schedule/remote_channel.hpp"

namespace lightnet {

/// Deals out the shards of each call to the copies of its node that have come to it, and ends calls whose shards are
/// all there. A copy has a channel for each call, so what comes late is never taken for an answer to another call. The
/// launcher's thread's.
class ShardWork {
public:
    /// Whose they are. All outlive them. `verify`: millionths of the shards that two hosts are asked.
    struct Lent {
        std::uint64_t run;
        std::uint32_t verify;
        PrepareState& state;
        ServiceCalls& calls;
        Carrier& carrier;
    };
    explicit ShardWork(const Lent& lent) : at_(lent) {}

    /// A copy waits for the result of the call that its follower is at, and does shards from now on. It may be told
    /// again.
    void join(const NodeCopy& copy, std::size_t position, ServiceCall& call);
    /// Another plan is proposed. Copies that it has not got answer what they have and are asked no more, or are lost
    /// with their place. Throws Error when a shard seems to have killed them.
    void keep();
    /// A copy is told to let go of all that it has. It may come back, and then has to come to each call again.
    void let_go(const NodeCopy& copy);
    /// Sends what is due at a position. Throws Error when its shards can't be done.
    void deal(std::size_t position);
    /// A reply. True: all shards of its call are there now. Throws Error when shards can't be done.
    bool arrived(Message& message);
    /// Calls whose shards are all there get their results. True: there were some.
    bool end_calls();
    /// Nobody waits for the calls at a position any more.
    void forget(std::size_t position);

private:
    using Call = std::pair<std::size_t, std::uint32_t>;  // the written node, and the number of its call
    struct Line {
        std::unique_ptr<RemoteChannel<Step>> channel;
        std::uint32_t number;  // of the channel
        bool draining = false;
    };
    struct Work {
        explicit Work(ShardDealer::Job job) : dealer(std::move(job)) {}
        std::map<NodeCopy, Line> lines;  // outlive the dealer
        ShardDealer dealer;
        std::size_t copies = 1;  // that share the shards, or soon will
        bool more = true;        // others may still come
    };
    Work& begin(const Call& of, ServiceCall& call);
    void close(const Line& line);
    static void use_lines(Work& work);
    static void deal(Work& work);
    std::uint32_t free_number();
    bool will_join(const NodeCopy& copy, const Call& of) const;

    Lent at_;
    Counters counters_;
    std::map<Call, Work> works_;
    std::map<std::uint32_t, std::pair<Work*, RemoteChannel<Step>*>> by_number_;
    std::uint32_t next_number_ = 0;
};

}  // namespace lightnet
