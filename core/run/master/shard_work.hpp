// The shards of all calls that preparing nodes wait for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "core/run/master/node_copy.hpp"
#include "core/run/master/service_calls.hpp"
#include "core/run/master/shard_dealer.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/schedule/remote_channel.hpp"

namespace lightnet {

/// Deals out the shards of each call to the copies of its node that have come to it. A copy has a channel for each
/// call, so what comes late is never taken for an answer to another call. Belongs to the launcher's thread.
class ShardWork {
public:
    /// The written node and the number of its call.
    using Call = std::pair<std::size_t, std::uint32_t>;
    /// What does not change meanwhile.
    struct Job {
        std::uint64_t run = 0;
        std::uint32_t verify = 0;  // millionths of the shards that two hosts are asked
        /// Told of shards of a node that a host does otherwise than others.
        std::function<void(std::size_t node, Failure lie)> doubt = [](std::size_t, const Failure&) {};
    };
    ShardWork(Job job, Carrier& carrier) : job_(std::move(job)), carrier_(carrier) {}

    /// A copy waits for the result of a call, which goes by `name` in messages, and does shards from now on. It may be
    /// told again.
    void join(const NodeCopy& copy, const Call& of, ServiceCall& call, const std::string& name, std::uint64_t process);
    /// Has it joined?
    bool has(const NodeCopy& copy, const Call& of) const;
    /// Of those who have joined the calls of a node, the ones in `there` go on; others of the plan's places answer what
    /// they have and are asked no more; the rest is lost. Throws Error when a shard seems to have killed them.
    void keep(std::size_t node, const Plan& plan, const std::set<NodeCopy>& there);
    /// Sends what is due, see ShardDealer::deal(). Throws Error when shards can't be done.
    void deal(const Call& of, std::size_t copies, bool more);
    /// A reply. True: all shards of its call are there now. Throws Error when shards can't be done.
    bool arrived(Message& message);
    /// Nobody waits for the call any more.
    void end(const Call& of);
    /// Nor for any of the node's.
    void end_all(std::size_t node);

private:
    struct Line {
        std::unique_ptr<RemoteChannel<Step>> channel;
        std::uint32_t number;  // of the channel
        bool draining = false;
    };
    struct Work {
        explicit Work(ShardDealer::Job job) : dealer(std::move(job)) {}
        std::map<NodeCopy, Line> lines;  // outlive the dealer's last word to them
        ShardDealer dealer;
        std::size_t copies = 1;
        bool more = true;
    };
    Work& begin(const Call& of, ServiceCall& call, const std::string& name);
    void close(const Line& line);
    static void use_lines(Work& work);
    static void deal(Work& work);
    std::uint32_t free_number();

    Job job_;
    Carrier& carrier_;
    Counters counters_;
    std::map<Call, Work> works_;
    std::map<std::uint32_t, std::pair<Work*, RemoteChannel<Step>*>> by_number_;
    std::uint32_t next_number_ = 0;
};

}  // namespace lightnet
