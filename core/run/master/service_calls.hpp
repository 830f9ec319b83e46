// The calls that preparing nodes make to their services: pieces first, then a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/network/graph/layout.hpp"
#include "core/network/light/mapped.hpp"
#include "core/run/assembly/prepared.hpp"
#include "core/run/message/message.hpp"
#include "core/run/message/step.hpp"

namespace lightnet {

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
    /// Shards without results.
    std::size_t missing() const { return missing_; }
    /// Does it take shards?
    bool shared_out() const { return what_.kind == StepReport::Kind::map || what_.kind == StepReport::Kind::sectors; }

    /// Throws Error when these are not the results, by join_shards(), of one to `count` shards, each with as many parts
    /// as it should have.
    void check(std::uint32_t count, const Bytes& joined) const;
    /// Checked results of the shard `first` and of those behind it, each once.
    void take(std::uint32_t first, const Bytes& joined);
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
    void join_what_is_next();

    StepReport what_;
    bool rehearsed_ = false;
    std::vector<Bytes> kept_ = std::vector<Bytes>(1);  // results, by part
    std::vector<std::weak_ptr<const std::vector<std::byte>>> lent_ =
        std::vector<std::weak_ptr<const std::vector<std::byte>>>(1);
    std::vector<Hash> names_;      // of all parts, or none
    std::vector<Results> shards_;  // that wait for those before them
    std::vector<bool> answered_;
    struct Joined {
        ShardJoiner results;
        Hasher hasher;
    };
    std::vector<Joined> joined_;  // by part: of shards that came before next_
    std::size_t next_ = 0;
    std::size_t missing_ = 0;
};

/// All calls of a run, by node and number. The nodes that stand for the sectors of one node make the same calls, which
/// are that node's.
class ServiceCalls {
public:
    /// `cache` may be null. `renewed`: renewed_nodes(), whose results nobody wants in a later run.
    ServiceCalls(const Graph& graph, MadeFrom made_from, ResultCache* cache, std::vector<bool> renewed = {})
        : graph_(graph), recipes_(graph, std::move(made_from)), cache_(cache), renewed_(std::move(renewed)) {}

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
    /// Does the node learn anew for each pass?
    bool is_renewed(std::size_t node) const { return node < renewed_.size() && renewed_[node]; }
    /// The node will make other calls, for another pass.
    void forget(std::size_t node);
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
    /// All of the node's calls with shards to be done, by number. Those that somebody has gone past may be among them.
    std::vector<std::pair<std::uint32_t, ServiceCall*>> dealt_out(std::size_t node);

private:
    ResultCache* cache_for(std::size_t whole) const { return is_renewed(whole) ? nullptr : cache_; }
    Hash recipe_of(std::size_t whole, std::uint32_t number, const ServiceCall& call, std::uint32_t part) const;

    const Graph& graph_;
    Recipes recipes_;
    ResultCache* cache_;
    std::vector<bool> renewed_;
    std::map<std::pair<std::size_t, std::uint32_t>, ServiceCall> calls_;
};

}  // namespace lightnet
