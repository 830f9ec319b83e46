// Values that the places of one process share, and make together.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>

#include "core/network/light/builders.hpp"

namespace lightnet {

/// One value: the first place that asks for it makes it, and those that come meanwhile do pieces of the work while they
/// wait. So as many threads build as have nothing else to do, and none is started. Any thread.
class SharedValue final : private Builders {
public:
    using Value = std::shared_ptr<const void>;
    using Make = std::function<Value(Builders&)>;
    /// Of who makes it; called before every piece, by whichever thread does that: see OneBuilder::Watch. May be empty.
    using Watch = OneBuilder::Watch;

    /// Throws what `make` throws, to all who ask.
    Value get(const Watch& watch, const Make& make);

private:
    using Lock = std::unique_lock<std::mutex>;

    void each(std::size_t count, const Piece& piece) override;
    void make_it(const Watch& watch, const Make& make);
    void do_next(Lock& lock);
    bool has_piece() const { return next_ < count_; }

    std::mutex mutex_;
    std::condition_variable changed_;
    bool begun_ = false, made_ = false;
    Value value_;
    std::exception_ptr failure_;
    // what its maker has others help with
    const Watch* watch_ = nullptr;
    const Piece* piece_ = nullptr;
    std::size_t next_ = 0, count_ = 0;
    std::size_t under_way_ = 0;
    std::exception_ptr piece_failure_;
};

/// All of them. Any thread.
class SharedValues {
public:
    using Value = SharedValue::Value;
    /// The `index`-th value of a node in a pass. Those of earlier passes are let go. Throws what `make` throws, to all
    /// who ask.
    Value get(std::size_t node, std::uint32_t index, const SharedValue::Watch& watch, const SharedValue::Make& make,
              std::uint32_t pass = 0);
    /// The node has left all places of the process: its values go with the last of them that looks at one.
    void forget(std::size_t node);
    /// How many are kept here.
    std::size_t size();

private:
    using Of = std::tuple<std::size_t, std::uint32_t, std::uint32_t>;  // node, pass, index

    std::mutex mutex_;
    std::map<Of, std::shared_ptr<SharedValue>> values_;
};

}  // namespace lightnet
