// The port to a node at other places: gathers questions into bundles.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/light/port.hpp"
#include "core/runtime/channel.hpp"
#include "core/runtime/fiber.hpp"
#include "core/runtime/multiplexer.hpp"

namespace lightnet {

/// When a bundle goes.
struct BundleRules {
    std::size_t questions = 512;             // it is full
    std::chrono::microseconds oldest{1000};  // a question has waited so long
    std::size_t eager = 2;                   // else only when the place has nothing else to do and fewer are out
    friend bool operator==(const BundleRules&, const BundleRules&) = default;
};

/// Questions of all askers of this place to one node leave together. An asking fiber parks until all of its answers
/// are there. Lives on the place's thread.
class BundlePort final : public Port, public BundleOwner<Query> {
public:
    using Clock = std::chrono::steady_clock;
    using Wake = std::function<void(Fibers::Fiber*)>;

    BundlePort(Fibers& fibers, Wake wake, std::size_t width, BundleRules rules)
        : fibers_(fibers), wake_(std::move(wake)), width_(width), rules_(rules) {}

    /// Where the bundles go.
    Multiplexer<Query>& replicas() { return replicas_; }

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override;
    void finish(Ticket ticket) override;
    void abandon(Ticket ticket) noexcept override { asks_.erase(ticket); }

    /// Sends the bundles that are due; `idle`: the place has nothing else to do. True if anything was sent.
    bool flush(Clock::time_point now, bool idle);
    /// How long until something is due for its age alone.
    std::chrono::nanoseconds until_due(Clock::time_point now) const;

    void answered(const Bundle<Query>& bundle, std::vector<Rgb> answers) override;
    void failed(const Bundle<Query>& bundle, const std::string& why) override;
    void returned(Bundle<Query> bundle) override { again_.push_back(std::move(bundle)); }

private:
    struct Ask {
        std::span<const Query> questions;
        std::span<Rgb> answers;
        std::size_t bundled = 0;  // questions that are in bundles already
        std::size_t unanswered = 0;
        Clock::time_point begun;
        Fibers::Fiber* waiting = nullptr;
        std::string error;
    };
    // A run of questions of one ask inside a bundle.
    struct Piece {
        Ticket ask;
        std::size_t first, count;
    };

    bool due(Clock::time_point now, bool idle);
    Bundle<Query> make_bundle();
    void settle(Ask& ask);

    Fibers& fibers_;
    Wake wake_;
    std::size_t width_;
    BundleRules rules_;
    Multiplexer<Query> replicas_;
    std::unordered_map<Ticket, Ask> asks_;
    std::deque<Ticket> unbundled_;                                  // asks with questions in no bundle yet
    std::size_t waiting_ = 0;                                       // questions in no bundle yet
    std::unordered_map<std::uint64_t, std::vector<Piece>> pieces_;  // by number of the bundle
    std::deque<Bundle<Query>> again_;                               // came back unanswered
    Ticket next_ticket_ = 1;
    std::uint64_t next_bundle_ = 1;
};

}  // namespace lightnet
