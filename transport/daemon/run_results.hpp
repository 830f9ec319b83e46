// Results of preparing that a hosted run is to have: where they come from, and whom they are given.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "transport/daemon/background_work.hpp"
#include "transport/daemon/results_from_others.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/store/arriving_bytes.hpp"
#include "transport/store/results.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {

/// What was expected is looked for in the cache, then asked of the nearest hosts of the run that have it, then of the
/// launcher; other hosts are given what lies here. Nothing waits: what takes time is done in the background. One
/// thread's, but for places, which read by find().
/// DECISIONS: from-the-nearest
class RunResults {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// To launcher and hosts of run `run`. Outlive it.
    struct Ways {
        std::uint64_t run = 0;
        std::function<void(packet::Type type, const packet::Fields& fields)> launcher;
        /// Of these hosts those that can be called without the launcher, the nearest first.
        std::function<std::vector<std::string>(std::vector<std::string> hosts)> nearest;
        std::function<void(Frames frames)> ask;     // [place][host][header][body]
        std::function<void(Frames& frames)> reply;  // [route][address][header][body]
        std::function<void(const std::string& said)> warn;
    };
    /// `background` outlives it.
    RunResults(std::shared_ptr<Results> results, BackgroundWork& background)
        : results_(std::move(results)), background_(background) {}
    RunResults(const RunResults&) = delete;
    RunResults& operator=(const RunResults&) = delete;

    /// Before anything is expected.
    void connect(Ways ways) { ways_ = std::move(ways); }
    bool in_memory(const Hash& hash) const { return results_->in_memory(hash); }
    /// The launcher is going to name it; `holders` have it.
    void expect(const Hash& hash, std::uint64_t size, std::vector<std::string> holders);
    /// Of the launcher. False: it is nothing that was expected. Throws Error when a whole result is not what it was
    /// named.
    bool take(const packet::Piece& piece);
    /// [header][body] from another host: a piece that it was asked for, or that it has none.
    void arrived(const std::string& host, const Frames& frames);
    /// What was under way to it and back may be lost.
    void lose(const std::string& host) { from_others_.lose(host); }
    /// [route][address][header][body]: another host asks for a piece.
    void asked(Frames frames);
    /// Says what has become of what was expected, asks for more, and gives what is read.
    void go_on(Time now);

private:
    // One on its way in.
    struct Expected {
        std::uint64_t size = 0;
        std::vector<std::string> holders;
        std::optional<ArrivingResult> arriving;  // from the launcher, since it has begun
    };
    struct Wish {
        Frames way;  // [route][address]
        std::uint64_t offset = 0, size = 0;
    };
    // One that others are given: held a little longer than it takes.
    struct Given {
        Bytes bytes;
        std::future<Bytes> reading;
        std::vector<Wish> wishes;
        Time used;
    };
    void look();
    void has(const Hash& hash);
    void lacks(const Hash& hash);
    bool has_room_for_others();
    void give(const Hash& hash, Wish wish, const Bytes& bytes);

    std::shared_ptr<Results> results_;
    BackgroundWork& background_;
    Ways ways_;
    std::map<Hash, std::future<Bytes>> looked_for_;
    std::map<Hash, Expected> expected_;
    ResultsFromOthers from_others_;
    std::map<Hash, Given> given_;
};

}  // namespace lightnet
