// The calls that preparing nodes make to their services: pieces first, then a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/message/step.hpp"
#include "core/prepare/prepared.hpp"

namespace lightnet {

/// One call of a node's prepare(), which is the same on all its places.
class Call {
public:
    Call() = default;
    Call(const Report& what, bool rehearsed);

    const Report& what() const { return what_; }
    /// It is a rehearsal, or comes after one.
    bool rehearsed() const { return rehearsed_; }
    /// Null until it is there.
    const Bytes& result() const { return result_; }
    const Hash& name() const { return name_; }
    std::size_t missing() const { return missing_; }

    /// A shard for a place that has `under_way` of them: one that nobody does, or, for a place that has nothing else to
    /// do, one that another place is still at. It counts as handed out.
    std::optional<std::uint32_t> hand_out(std::size_t under_way);
    /// It was not handed out after all, or its place is lost.
    void take_back(std::uint32_t shard);
    /// The results of a shard. True when it was the last one.
    bool answer(std::uint32_t shard, const Bytes& results);
    void complete(Bytes result);
    void complete_from_shards() { complete(join(shards_)); }

private:
    static Bytes join(const std::vector<std::vector<std::byte>>& shards);

    Report what_;
    bool rehearsed_ = false;
    Bytes result_;
    Hash name_;
    std::vector<std::vector<std::byte>> shards_;
    std::vector<std::uint8_t> copies_;  // under way, by shard
    std::vector<bool> answered_;
    std::deque<std::uint32_t> to_do_;
    std::size_t missing_ = 0;
};

/// All calls of a run, by node and number.
class Calls {
public:
    /// `cache` may be null.
    Calls(const Graph& graph, std::string made_from, ResultCache* cache)
        : graph_(graph), recipes_(graph, std::move(made_from)), cache_(cache) {}

    /// The call that a place reports; begun, or found in the cache, when nobody has reported it before. Throws Error
    /// when another place has reported something else.
    Call& reported(std::size_t node, const Report& at);
    /// One that has been reported.
    Call& of(std::size_t node, std::uint32_t number) { return calls_.at({node, number}); }
    /// Keeps its result for later runs.
    void keep(std::size_t node, std::uint32_t number);
    /// Node → hash over all its results.
    std::map<std::string, Hash> hashes() const;
    /// Of the node's last call; null: it has none.
    Bytes last_result(std::size_t node) const;
    /// The call of the node that has no result yet.
    const Call* unfinished(std::size_t node) const;

private:
    const Graph& graph_;
    Recipes recipes_;
    ResultCache* cache_;
    std::map<std::pair<std::size_t, std::uint32_t>, Call> calls_;
};

}  // namespace lightnet
