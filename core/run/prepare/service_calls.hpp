// The calls that preparing nodes make to their services: pieces first, then a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/network/graph/layout.hpp"
#include "core/network/light/mapped.hpp"
#include "core/run/message/step.hpp"
#include "core/run/prepare/prepared.hpp"

namespace lightnet {

/// Shards of a call, one behind the other.
struct Shards {
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const Shards&, const Shards&) = default;
};

/// One call of a node's prepare(), which is the same on all its places.
class ServiceCall {
public:
    ServiceCall() = default;
    /// `parts`: how many results it has; more than one where each sector of a node gets its own.
    ServiceCall(const StepReport& what, bool rehearsed, std::uint32_t parts = 1);

    const StepReport& what() const { return what_; }
    /// It is a rehearsal, or comes after one.
    bool rehearsed() const { return rehearsed_; }
    std::uint32_t parts() const { return static_cast<std::uint32_t>(kept_.size()); }
    bool done() const { return !names_.empty(); }
    /// Null until it is there, and when it was let go of and nobody else has it.
    Bytes result(std::uint32_t part = 0) const { return kept_[part] ? kept_[part] : lent_[part].lock(); }
    const Hash& name(std::uint32_t part = 0) const { return names_[part]; }
    std::size_t missing() const { return missing_; }
    /// Does it take shards?
    bool shared_out() const { return what_.kind == StepReport::Kind::map || what_.kind == StepReport::Kind::sectors; }

    /// A place that wants shards.
    struct Asker {
        std::size_t under_way = 0;  // asks for shards that it has
        std::size_t places = 1;     // that share them
        double now = 0;             // seconds
    };
    /// Shards for it: some that nobody does, or, for a place that has nothing else to do, one that another place is at
    /// for long. They count as handed out.
    std::optional<Shards> hand_out(const Asker& asker);
    /// They were not handed out after all, or their place is lost.
    void take_back(const Shards& shards);
    /// The results of the first of these shards, or of more of them, by join_shards(); the others are taken back. True
    /// when none is missing any more. Throws Error when they are not what was asked for, or have not as many parts as
    /// they should.
    bool answer(const Shards& shards, const Bytes& joined, double now = 0);
    void complete(const Bytes& result) { complete({Result{content_hash(*result), result}}); }
    void complete(const std::vector<Result>& parts);
    void complete_from_shards();
    /// Lets the results go, which somebody else keeps.
    void let_go();
    /// One that was let go of is there again. False: it is another one.
    bool restore(std::uint32_t part, const Result& result);
    /// All shards are to be done once more.
    void begin_again();

private:
    struct Results {
        Bytes all;  // of what was done together
        std::span<const std::byte> own;
    };
    std::vector<std::span<const std::byte>> parts_of(const Results& shard) const;
    void take(const Results& results, std::uint32_t shard, double now);
    void join_what_is_next();
    bool is_late(std::uint32_t shard, double now) const;

    StepReport what_;
    bool rehearsed_ = false;
    std::vector<Bytes> kept_ = std::vector<Bytes>(1);  // results, by part
    std::vector<std::weak_ptr<const std::vector<std::byte>>> lent_ =
        std::vector<std::weak_ptr<const std::vector<std::byte>>>(1);
    std::vector<Hash> names_;           // of all parts, or none
    std::vector<Results> shards_;       // that wait for those before them
    std::vector<std::uint8_t> copies_;  // under way, by shard
    std::vector<bool> answered_;
    std::vector<double> begun_;  // when it was handed out first
    double seconds_ = 0;         // that those took that were answered
    struct Joined {
        ShardJoiner results;
        Hasher hasher;
    };
    std::vector<Joined> joined_;  // by part: of shards that came before next_
    std::size_t next_ = 0;
    std::deque<std::uint32_t> to_do_;
    std::size_t missing_ = 0;
};

/// All calls of a run, by node and number. The nodes that stand for the sectors of one node make the same calls, which
/// are that node's.
class ServiceCalls {
public:
    /// `cache` may be null.
    ServiceCalls(const Graph& graph, std::string made_from, ResultCache* cache)
        : graph_(graph), recipes_(graph, std::move(made_from)), cache_(cache) {}

    /// The call that a place reports; begun, or found in the cache, when nobody has reported it before. Throws Error
    /// when another place has reported something else.
    ServiceCall& reported(std::size_t node, const StepReport& at);
    /// One that has been reported.
    ServiceCall& of(std::size_t node, std::uint32_t number) { return calls_.at({whole_of(graph_, node), number}); }
    /// The result for a node that has a sector or is whole. Null when there is none, so far or any more: then its
    /// shards are to be done.
    Bytes result(std::size_t node, std::uint32_t number);
    /// Which part of a call's result a node gets.
    std::uint32_t part_of(std::size_t node, const ServiceCall& call) const;
    /// Keeps its result for later runs.
    void keep(std::size_t node, std::uint32_t number);
    /// Every copy of the node has its part: what is large and on disk need not be in memory as well.
    void all_have(std::size_t node, std::uint32_t number);
    /// Node → hash over all its results.
    std::map<std::string, Hash> hashes() const;
    /// Of the node's last call; null: it has none.
    Bytes last_result(std::size_t node) const;
    /// The call of the node that has no result yet.
    const ServiceCall* unfinished(std::size_t node) const;

private:
    Hash recipe_of(std::size_t whole, std::uint32_t number, const ServiceCall& call, std::uint32_t part) const;

    const Graph& graph_;
    Recipes recipes_;
    ResultCache* cache_;
    std::map<std::pair<std::size_t, std::uint32_t>, ServiceCall> calls_;
};

}  // namespace lightnet
