// Services that a node may use to prepare itself before the first question.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/query.hpp"
#include "core/network/light/builders.hpp"
#include "core/network/light/mapped.hpp"
#include "core/network/light/sectors.hpp"

namespace lightnet {

/// Handed to LightOp::prepare(). Preparing is collective: every place that holds the node runs the same prepare(),
/// which makes the same calls here in the same order, and each call returns the same to all. A place that comes later
/// gets what was computed before it came. Works alike in a run of one thread.
class Services {
public:
    virtual ~Services() = default;

    /// Has `work(i, results)` done once, somewhere, for each i < count; it appends to `results`, a std::vector<T>, and
    /// may ask the node's inputs. Returns all results in the order of i. `count` must depend on parameters and earlier
    /// results alone, never on places or cores; a shard should take no more than some 50 ms, and answer with less than
    /// 64 MB. `work` may be done again where a place was lost, so it must depend on i and on what is prepared so far.
    template <class T, class Work>
    Mapped<T> map(std::size_t count, const Work& work) {
        static_assert(std::is_trivially_copyable_v<T>, "results travel as bytes");
        return Mapped<T>(map_bytes(count, [&work](std::size_t shard, std::vector<std::byte>& out) {
            std::vector<T> results;
            work(shard, results);
            const auto* bytes = reinterpret_cast<const std::byte*>(results.data());
            out.assign(bytes, bytes + results.size() * sizeof(T));
        }));
    }

    /// Like map(), for results that lie somewhere in the scene: `where(result)` says where. Where the node is sharded
    /// (see RunTraits::landmarks), it gives this copy of it only those that lie within `reach` of a question that it
    /// may be asked; else all of them. In the order of i, but in several memories, each of which is free when it is let
    /// go of. The node can't know which; what it answers must not depend on what lies farther away than `reach`.
    template <class T, class Work, class Where>
    std::vector<Mapped<T>> map_near(std::size_t count, float reach, const Work& work, const Where& where) {
        const Sectors* cut = sectors();
        std::vector<Mapped<T>> near;
        if (!cut) near.push_back(map<T>(count, work));
        for (std::size_t first = 0; cut && first < count; first += shards_at_once) {
            const auto shard_of_sectors = [&](std::size_t shard, std::vector<std::byte>& out) {
                std::vector<T> results;
                work(first + shard, results);
                std::vector<std::vector<std::byte>> parts(cut->count());
                for (const T& result : results)
                    cut->near(where(result), reach, [&](std::uint32_t sector) {
                        const auto* bytes = reinterpret_cast<const std::byte*>(&result);
                        parts[sector].insert(parts[sector].end(), bytes, bytes + sizeof(T));
                    });
                out = *join_shards(parts);
            };
            near.emplace_back(map_sectors(std::min(shards_at_once, count - first), shard_of_sectors));
        }
        return near;
    }

    /// Makes a value from what is prepared so far, once per process; its places share it. `make` asks nobody. It is
    /// make(), or make(Builders&) where others that wait for the value can help.
    template <class T, class Work>
    std::shared_ptr<const T> once(const Work& make) {
        return std::static_pointer_cast<const T>(once_any([&make](Builders& builders) -> std::shared_ptr<const void> {
            if constexpr (std::is_invocable_v<const Work&, Builders&>)
                return std::make_shared<const T>(make(builders));
            else
                return std::make_shared<const T>(make());
        }));
    }

    /// Renders every `stride`-th pixel of every `stride`-th row, one sample each, through the whole network, and
    /// returns all questions that the node has noted with NodeContext::rehearsal() meanwhile: sorted, each once. The
    /// node is asked while it prepares, so light() must answer from what is there: anything will do, as it reaches no
    /// image. Strides of later calls must divide those of earlier ones.
    virtual std::vector<Query> rehearse(std::uint32_t stride) = 0;

    /// A line for the user: how many photons were kept, how large a cache is. What several places say alike is shown
    /// once.
    virtual void say(const std::string& text) = 0;

    /// What the node does from now on ("builds its tree"), and how much of it is done, in any unit; 0 of 0: the calls
    /// here know best, or nobody. It is shown while the node prepares, and the report tells how long each took. For
    /// display alone; may be called as often as you like, from prepare() and from what once() makes.
    virtual void doing(const std::string& what, std::uint64_t done = 0, std::uint64_t total = 0) = 0;
    /// Ends the work when nobody wants it any more: throws Cancelled. The calls here look by themselves; who computes
    /// for more than a tenth of a second between them calls this now and then. Costs next to nothing, and may be called
    /// from anywhere: from prepare(), shards, what once() makes, and pieces of it.
    virtual void look() const = 0;

protected:
    using Make = std::function<std::shared_ptr<const void>(Builders& builders)>;
    using Shard = std::function<void(std::size_t shard, std::vector<std::byte>& out)>;
    virtual Bytes map_bytes(std::size_t count, const Shard& work) = 0;
    /// How the scene is cut up for the copies of the node; null: each copy has all.
    virtual const Sectors* sectors() { return nullptr; }
    /// Does work whose results are one list per sector, by join_shards(), as map_bytes() does: gives those of the
    /// copy's own. Only where there are sectors.
    virtual Bytes map_sectors(std::size_t count, const Shard& work) { return map_bytes(count, work); }

    /// What is on its way to the copies at one time is the results of so many shards.
    static constexpr std::size_t shards_at_once = 64;
    virtual std::shared_ptr<const void> once_any(const Make& make) = 0;
};

}  // namespace lightnet
