// The dealer of the shards of one call of preparing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/run/schedule/multiplexer.hpp"

namespace lightnet {

/// Has every shard of a call done by one of the copies that wait for its result, as a multiplexer has tiles rendered:
/// by the same rules, and with the same votes. Several quick shards go together, and may be answered in part; but where
/// some are checked, each goes alone: two parts can't be compared, and nobody is to know what is checked.
/// Belongs to the launcher's thread.
class ShardDealer final : private BundleOwner<Step> {
public:
    struct Job {
        std::string node;  // its name
        std::uint32_t call = 0;
        std::uint32_t count = 0;  // of shards
        SpotChecks checks{};      // of shards that two hosts are asked
        /// Throws Error when these can't be results of the first of so many shards.
        std::function<void(std::uint32_t count, const Bytes& joined)> check = [](std::uint32_t, const Bytes&) {};
        /// Is given the results of the shard `first` and of those behind it, each once.
        std::function<void(std::uint32_t first, const Bytes& joined)> done = [](std::uint32_t, const Bytes&) {};
        std::function<void(const Failure& failure)> at_fault = [](const Failure&) {};  // see MultiplexerRules
        std::function<void(const Failure& lie)> doubt = [](const Failure&) {};
        std::function<double()> clock = steady_seconds;
    };
    explicit ShardDealer(Job job);
    /// An ask to work at, and one that waits.
    static constexpr Credit credit_of_each{2, ~std::size_t{0}, ~std::size_t{0}};

    /// The copies that wait for the result, see Multiplexer::use().
    void use(std::vector<Channel<Step>*> copies, const std::vector<Channel<Step>*>& draining = {}) {
        replicas_.use(std::move(copies), draining);
    }
    /// Sends what is due. `copies`: how many share the shards, or soon will; `more`: others may still come, whom to ask
    /// about what those that are there have failed at or disagree on.
    void deal(std::size_t copies, bool more);
    /// Shards without results.
    std::uint32_t missing() const { return missing_; }
    /// Why there will be none. Empty: there will.
    const std::optional<Error>& error() const { return error_; }

private:
    void answered(const Bundle<Step>& bundle, Bytes joined) override;
    std::string mistake_in(const Bundle<Step>& bundle, const Bytes& joined, const std::string& host) override;
    void failed(const Bundle<Step>&, const Failure& failure) override { error_ = Error(failure.why); }
    void returned(Bundle<Step>) override {}  // a multiplexer keeps what it has taken
    void set_aside(const Bundle<Step>& bundle, const std::string& why) override;
    Step take_next(std::size_t copies);
    void put_back(std::uint32_t first, std::uint32_t end);

    Job job_;
    std::uint32_t missing_;
    std::deque<std::uint32_t> to_do_;   // in nobody's hands
    std::vector<std::uint32_t> alone_;  // and these, one by one
    std::optional<Error> error_;
    Multiplexer<Step> replicas_;
};

}  // namespace lightnet
